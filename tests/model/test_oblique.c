/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facets that are not normal to the line of their grains' centres: what vgcm makes of them. */
#include "tests/fixture.h"

#include "common/specimen/oblique.h"
#include "vgcm/vgcm.h"

#include <stdio.h>

#define GRID   "shape: box; grains: grid; size: 6 cm, 6 cm, 6 cm; cells: 6, 6, 6; "
#define AFFINE "interaction: all; eta: 1; mu: 0; softening: none; oblique: keep; "

static const double E_BAR = 48.8e9;

/* Cells and seeds multiplied along the axes. */
static void stretch(struct fixture *f, const double by[3])
{
    struct brc_facets *s = &f->specimen.facets;
    double volume = by[0] * by[1] * by[2];
    for (size_t i = 0; i < s->n_cells; i++)
        s->volume[i] *= volume;
    for (size_t i = 0; i < s->n_facets; i++) {
        for (int k = 0; k < 3; k++)
            s->normal[i][k] /= by[k];
        s->area[i] *= volume * brc_normalise(s->normal[i], s->normal[i]);
    }
    for (int k = 0; k < 3; k++) {
        for (size_t i = 0; i < s->n_vertices; i++)
            s->vertex[i][k] *= by[k];
        for (size_t i = 0; i < s->n_facets; i++)
            s->centroid[i][k] *= by[k];
        for (size_t i = 0; i < s->n_cells; i++) {
            s->seed[i][k] *= by[k];
            s->centre[i][k] *= by[k];
        }
    }
    f->specimen.domain_volume *= volume;
}

/* Seeds at the centroids of their cells, where they are no generators. */
static void centre_seeds(struct fixture *f)
{
    struct brc_facets *s = &f->specimen.facets;
    for (size_t i = 0; i < s->n_cells; i++)
        brc_copy(s->seed[i], s->centre[i]);
}

/* Stress of the contacts under a uniform strain g without turns, over the modulus, by the volume
 * between the centres, of which facets make up a third of A cos d along each axis. */
static void uniform_stress(struct fixture *f, const double strain[3], double stress[3])
{
    const struct brc_facets *s = &f->specimen.facets;
    const double zero[3] = {0, 0, 0};
    double volume = 0;
    fixture_free_sim(f, brc_registry_find("vgcm"), AFFINE "e_bar: 48.8 GPa", "");
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        double v[3];
        for (int k = 0; k < 3; k++)
            v[k] = strain[k] * f->sim.bodies.x[i][k];
        fixture_velocity(f, i, v, zero);
    }
    fixture_carry(f, 1);
    brc_set(stress, 0, 0, 0);
    for (size_t i = 0; i < f->sim.pairs.n; i++) {
        double branch[3], x;
        if (f->sim.pairs.facet[i] < 0)
            continue;
        brc_sub(branch, f->sim.bodies.x[f->sim.pairs.b[i]], f->sim.bodies.x[f->sim.pairs.a[i]]);
        x = brc_dot(branch, s->normal[f->sim.pairs.facet[i]]);
        volume += s->area[f->sim.pairs.facet[i]] * x / 3;
        for (int k = 0; k < 3; k++)
            stress[k] -= f->sim.pairs.f[i][k] * branch[k];
    }
    brc_scale(stress, stress, 1 / (volume * E_BAR));
}

/* The mean stress under a strain alike in all directions is exact for any cells and centres. */
static void the_mean_stiffness_is_exact(void **state)
{
    struct fixture *f = *state;
    const double strain[3] = {1e-7, 1e-7, 1e-7};
    static const double by[][3] = {{1, 1, 1}, {1, 1, 1}, {1.3, 1, 0.8}, {3, 1, 1.0 / 3}};
    for (size_t k = 0; k < sizeof by / sizeof *by; k++) {
        double stress[3];
        fixture_specimen(f, GRID "jitter: 0.9; min_area_ratio: 0");
        stretch(f, by[k]);
        if (k > 0)
            centre_seeds(f);
        uniform_stress(f, strain, stress);
        print_message("%g:%g:%g: %.6g %.6g %.6g\n", by[k][0], by[k][1], by[k][2], 1e7 * stress[0],
                      1e7 * stress[1], 1e7 * stress[2]);
        CHECK_NEAR((stress[0] + stress[1] + stress[2]) / 3, 1e-7, 0, 3e-6);
    }
}

/* What is measured of the geometry is what the contacts do. */
static void stiffness_by_direction_is_foretold(void **state)
{
    struct fixture *f = *state;
    static const double by[3] = {1.4, 1, 0.7};
    double least = HUGE_VAL, most = 0;
    struct brc_oblique o;
    fixture_specimen(f, GRID "jitter: 0.5");
    stretch(f, by);
    brc_oblique_measure(&o, &f->specimen.facets, f->specimen.facets.seed, true);
    for (int k = 0; k < 3; k++) {
        double strain[3] = {0, 0, 0}, stress[3];
        strain[k] = 1e-7;
        uniform_stress(f, strain, stress);
        least = fmin(least, 1e7 * stress[k]);
        most = fmax(most, 1e7 * stress[k]);
    }
    print_message("mean cosine %.3f, stiffness %.3f to %.3f, measured %.3f to %.3f\n", o.mean_cos,
                  o.soft, o.stiff, least, most);
    /* the volume between the centres is not quite alike along the axes */
    CHECK_NEAR(o.soft, least, 0, 0.02);
    CHECK_NEAR(o.stiff, most, 0, 0.02);
}

/* Generators: normal to round-off, and areas are not touched. */
static void generators_are_not_oblique(void **state)
{
    struct fixture *f = *state;
    static const char *const specimen[] = {
        GRID "jitter: 1", "shape: cylinder; diameter: 30 mm; height: 20 mm; grains: packing"};
    for (int k = 0; k < 2; k++) {
        struct brc_oblique o;
        struct vgcm_census census;
        fixture_specimen(f, specimen[k]);
        const struct brc_facets *s = &f->specimen.facets;
        fixture_free_sim(f, brc_registry_find("vgcm"), "", "");
        brc_oblique_measure(&o, s, s->seed, false);
        CHECK_NEAR(o.mean_cos, 1, 1e-9, 0);
        CHECK_NEAR(o.soft, 1, 1e-8, 0);
        CHECK_NEAR(o.stiff, 1, 1e-8, 0);
        vgcm_census_measure(&census, f->sim.params, s);
        assert_false(census.is_projected);
    }
}

static int try(struct fixture *f, const char *settings)
{
    const struct brc_model *model = brc_registry_find("vgcm");
    struct vgcm_params values;
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, model->params, &values));
    fixture_set(f, model->params, &values, settings);
    return model->check(&f->ctx, &values, &f->specimen);
}

static void strong_obliqueness_is_refused(void **state)
{
    struct fixture *f = *state;
    static const double much[3] = {3, 1, 1.0 / 3}, little[3] = {1.05, 1, 1};
    fixture_specimen(f, GRID "jitter: 0.5");
    assert_int_equal(try(f, "g_fn: 1 kJ/m2"), 0);
    stretch(f, little);
    assert_int_equal(try(f, "g_fn: 1 kJ/m2"), 0);
    stretch(f, much);
    CHECK_FAILS(&f->ctx, try(f, "g_fn: 1 kJ/m2"), BRC_ERR_GEOMETRY, "oblique");
    assert_int_equal(try(f, "g_fn: 1 kJ/m2; energies: post_peak; oblique: keep"), 0);
    for (int k = 0; k < 3; k++) { /* two seeds change places */
        double *a = &f->specimen.facets.seed[0][k], *b = &f->specimen.facets.seed[1][k], x = *a;
        *a = *b;
        *b = x;
    }
    CHECK_FAILS(&f->ctx, try(f, "oblique: keep"), BRC_ERR_GEOMETRY, "wrong sides");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(the_mean_stiffness_is_exact),
        FIXTURE_TEST(stiffness_by_direction_is_foretold),
        FIXTURE_TEST(generators_are_not_oblique),
        FIXTURE_TEST(strong_obliqueness_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
