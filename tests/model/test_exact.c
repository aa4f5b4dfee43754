/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must hold to round-off: affine fields in vgcm with eta = 1, cubes of gt12, scale. And what
 * holds on average: E and nu of a random pack by the uniform-strain estimate. */
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>

static const struct brc_model *poly(void)
{
    return brc_registry_find("polyhedra");
}

static const struct brc_model *vgcm(void)
{
    return brc_registry_find("vgcm");
}

/* Every grain moves by G x in one step, none turns. */
static void affine_step(struct fixture *f, const double g[3][3], const double about[3])
{
    const double zero[3] = {0, 0, 0};
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        double r[3], v[3];
        brc_sub(r, f->sim.bodies.x[i], about);
        for (int k = 0; k < 3; k++)
            v[k] = brc_dot(g[k], r);
        fixture_velocity(f, i, v, zero);
    }
    fixture_carry(f, 1);
}

/* Cells that touch no boundary. */
static bool is_inner(const struct brc_facets *s, size_t cell)
{
    for (size_t k = s->cell_first[cell]; k < s->cell_first[cell + 1]; k++)
        if (s->cell[s->cell_facet[k]][1] < 0)
            return false;
    return true;
}

/* A neighbour without a facet: spheres that touch resist compression besides the facets. */
static bool touches_loosely(const struct fixture *f, size_t cell)
{
    const struct brc_contacts *c = &f->sim.pairs;
    for (size_t r = c->adjacent_first[cell]; r < c->adjacent_first[cell + 1]; r++)
        if (c->facet[c->adjacent[r] / 2] < 0)
            return true;
    return false;
}

/* Stress of one cell, sum of (place of the facet) x (force) over its facets / volume. */
static void cell_stress(const struct fixture *f, size_t cell, double stress[3][3])
{
    const struct brc_facets *s = &f->specimen.facets;
    memset(stress, 0, 9 * sizeof(double));
    for (size_t k = s->cell_first[cell]; k < s->cell_first[cell + 1]; k++) {
        int32_t facet = s->cell_facet[k];
        size_t row = fixture_row(f, s->cell[facet][0], s->cell[facet][1]);
        double arm[3], sign = s->cell[facet][0] == (int32_t)cell ? -1 : 1;
        brc_sub(arm, s->centroid[facet], s->centre[cell]);
        for (int p = 0; p < 3; p++)
            for (int q = 0; q < 3; q++)
                stress[p][q] += sign * arm[p] * f->sim.pairs.f[row][q] / s->volume[cell];
    }
}

/* Sizes: strains of 1e-7 change the geometry by 1e-7, so that is the floor; round-off of places is
 * 1e-17 m in steps of 1e-9 m. */
static void check_affine(struct fixture *f, const double g[3][3], bool stretch)
{
    const struct brc_facets *s = &f->specimen.facets;
    const double e_bar = 48.8e9, strain = 1e-7;
    double about[3] = {0.01, 0.02, 0.03};
    size_t n_inner = 0;
    affine_step(f, g, about);
    double force = e_bar * strain * cbrt(s->volume[0] * s->volume[0]);
    for (size_t i = 0; i < s->n_cells; i++) {
        double stress[3][3], expected[3][3];
        if (!is_inner(s, i) || (!stretch && touches_loosely(f, i)))
            continue;
        n_inner++;
        CHECK_NEAR(brc_norm(f->sim.bodies.f[i]), 0, 2e-6 * force, 0);
        CHECK_NEAR(brc_norm(f->sim.bodies.t[i]), 0, 2e-6 * force * cbrt(s->volume[i]), 0);
        cell_stress(f, i, stress);
        /* E-bar G: E = E-bar and nu = 0 in every cell by itself, tension positive */
        for (int k = 0; k < 9; k++)
            expected[k / 3][k % 3] = e_bar * g[k / 3][k % 3];
        CHECK_NEAR_ARRAY(&stress[0][0], &expected[0][0], 9, 2e-6 * e_bar * strain, 0);
    }
    assert_true(n_inner >= 8);
}

static const double STRETCH[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1e-7}};
static const double SQUEEZE[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, -1e-7}};
static const double GENERAL[3][3] = {
    {1e-7, 0.3e-7, -0.2e-7}, {0.3e-7, -0.7e-7, 0.5e-7}, {-0.2e-7, 0.5e-7, 0.4e-7}};

static void check_fields(struct fixture *f, const char *settings)
{
    fixture_free_sim(f, vgcm(), settings, "");
    check_affine(f, STRETCH, true);
    fixture_free_sim(f, vgcm(), settings, "");
    check_affine(f, SQUEEZE, false);
    fixture_free_sim(f, vgcm(), settings, "");
    check_affine(f, GENERAL, false);
}

static void vgcm_affine_on_voronoi(void **state)
{
    struct fixture *f = *state;
    const char *points[3] = {"points: paper", "points: exact", "points: one"};
    fixture_specimen(f, "shape: box; grains: grid; size: 5 cm, 5 cm, 5 cm; cells: 5, 5, 5; "
                        "jitter: 0.9; min_area_ratio: 0");
    for (int i = 0; i < 3; i++) {
        char settings[128];
        snprintf(settings, sizeof settings, "interaction: all; eta: 1; %s", points[i]);
        check_fields(f, settings);
    }
}

static void vgcm_affine_on_laguerre(void **state)
{
    struct fixture *f = *state;
    fixture_specimen(f, "shape: box; grains: packing; size: 3 cm, 3 cm, 3 cm; min_area_ratio: 0");
    check_fields(f, "interaction: all; eta: 1");
}

/* Uniaxial stretch of 3 x 3 x 3 cubes: normal bonds alone, nothing across. */
static void cubes_of_gt12(void **state)
{
    struct fixture *f = *state;
    const double stretch[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1e-6}};
    const struct {
        const char *settings;
        double modulus;
    } cases[2] = {
        {"radius: 1 mm; bn: 20 GPa; strain_length: centres; area: facet", 20e9},
        /* B_n (1 - 2 R / h)^2 h / (2 R) = 20 GPa x 0.64 x 5 */
        {"radius: 1 mm; bn: 20 GPa; strain_length: gap; area: eroded", 64e9},
    };
    for (int i = 0; i < 2; i++) {
        fixture_grid(f, 3, 3, 3, 1e-2, 0);
        fixture_free_sim(f, poly(), cases[i].settings, "dt: 1e-9 s");
        affine_step(f, stretch, (double[3]){0, 0, 0});
        double through = 0, across = 0;
        const struct brc_contacts *c = &f->sim.pairs;
        for (size_t r = 0; r < c->n; r++) {
            if (c->facet[r] < 0)
                continue;
            double d = f->sim.bodies.x[c->b[r]][2] - f->sim.bodies.x[c->a[r]][2];
            if (fabs(d) > 5e-3)
                through -= copysign(1, d) * c->f[r][2] / 2; /* two layers of nine */
            across = fmax(across, fmax(fabs(c->f[r][0]), fabs(c->f[r][1])));
        }
        /* places of 3 cm hold 3e-18 m of displacements of 1e-8 m */
        CHECK_NEAR(through / 9e-4, cases[i].modulus * 1e-6, 0, 1e-8);
        CHECK_NEAR(across, 0, 1e-8 * through, 0);
        for (size_t cube = 0; cube < 27; cube++)
            if (is_inner(&f->specimen.facets, cube))
                CHECK_NEAR(brc_norm(f->sim.bodies.f[cube]), 0, 1e-8 * through, 0);
    }
}

/* A jittered pack squeezed and twisted by random motions; forces over modulus x edge^2. */
static size_t forces_at_scale(struct fixture *f, const struct brc_model *model, double edge,
                              double *force, size_t cap)
{
    char settings[512];
    const double e = 20e9;
    f->random = 1;
    fixture_grid(f, 3, 3, 3, edge, 0.6);
    if (model == poly())
        snprintf(settings, sizeof settings,
                 "radius: %.17g m; kn: %.17g N/m; kt: %.17g N/m; bn: 20 GPa; bt: 10 GPa; "
                 "gn: 0 1/s",
                 0.1 * edge, e * edge, e * edge);
    else
        snprintf(settings, sizeof settings,
                 "interaction: all; e_bar: 20 GPa; g_fn: %.17g J/m2; g_fs: %.17g J/m2", 1e5 * edge,
                 1e7 * edge);
    fixture_free_sim(f, model, settings, "");
    for (int step = 0; step < 5; step++) {
        for (size_t i = 0; i < f->sim.bodies.n; i++) {
            double v[3], w[3];
            for (int k = 0; k < 3; k++) {
                v[k] = 1e-4 * edge * (fixture_draw(f) - 2 * (f->sim.bodies.x[i][k] / edge - 1.5));
                w[k] = 1e-4 * fixture_draw(f);
            }
            fixture_velocity(f, i, v, w);
        }
        fixture_carry(f, 1);
    }
    size_t n = 0;
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        for (int k = 0; k < 3; k++) {
            assert_true(n < cap);
            force[n++] = f->sim.pairs.f[i][k] / (e * edge * edge);
        }
    return n;
}

static void scale_does_not_matter(void **state)
{
    struct fixture *f = *state;
    enum { CAP = 3000 };
    double *force[3];
    for (int s = 0; s < 3; s++)
        force[s] = test_calloc(CAP, sizeof(double));
    const struct brc_model *models[2] = {poly(), vgcm()};
    for (int m = 0; m < 2; m++) {
        size_t n[3];
        double largest = 0;
        for (int s = 0; s < 3; s++)
            n[s] = forces_at_scale(f, models[m], s == 0 ? 1 : s == 1 ? 1e-3 : 1e-6, force[s], CAP);
        assert_int_equal(n[0], n[1]);
        assert_int_equal(n[0], n[2]);
        for (size_t i = 0; i < n[0]; i++)
            largest = fmax(largest, fabs(force[0][i]));
        assert_true(largest > 1e-5);
        /* displacements of 1e-4 of the edge are known to 1e-12 of themselves */
        for (size_t i = 0; i < n[0]; i++) {
            CHECK_NEAR(force[1][i], force[0][i], 1e-9 * largest, 0);
            CHECK_NEAR(force[2][i], force[0][i], 1e-9 * largest, 0);
        }
    }
    for (int s = 0; s < 3; s++)
        test_free(force[s]);
}

/* E and nu of random packs against the uniform-strain estimate, which is an upper bound of E that
 * relaxation of a real pack comes near to. */
static void uniform_strain_estimate(void **state)
{
    struct fixture *f = *state;
    const double etas[2] = {0.125, 0.5};
    for (int e = 0; e < 2; e++) {
        double eta = etas[e], modulus = 0, poisson = 0;
        enum { N_SAMPLES = 3 };
        for (int s = 0; s < N_SAMPLES; s++) {
            char text[256];
            snprintf(text, sizeof text,
                     "shape: box; grains: packing; size: 3 cm, 3 cm, 4 cm; seed: %d", s + 1);
            fixture_specimen(f, text);
            snprintf(text, sizeof text,
                     "interaction: all; eta: %g; sigma_t: 10 GPa; tau: 10 GPa; "
                     "softening: none",
                     eta);
            fixture_sim(f, vgcm(), text,
                        "loading: fixed; rate: 1e-7 1/s; strain_max: 1e-4; modulus_low: 0.5; "
                        "modulus_high: 1",
                        "");
            fixture_steps(f, 1000);
            modulus += fixture_result(f, "E").value / 48.8e9 / N_SAMPLES;
            poisson += fixture_result(f, "nu").value / N_SAMPLES;
        }
        double estimate = (2 + 3 * eta) / (4 + eta), ratio = (1 - eta) / (4 + eta);
        print_message("eta %g: E/E-bar %.3f, estimate %.3f; nu %.3f, estimate %.3f\n", eta, modulus,
                      estimate, poisson, ratio);
        CHECK_BETWEEN(modulus / estimate, 0.85, 1.05);
        CHECK_BETWEEN(poisson / ratio, 0.8, 1.3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(vgcm_affine_on_voronoi),  FIXTURE_TEST(vgcm_affine_on_laguerre),
        FIXTURE_TEST(cubes_of_gt12),           FIXTURE_TEST(scale_does_not_matter),
        FIXTURE_TEST(uniform_strain_estimate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
