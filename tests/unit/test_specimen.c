/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimens: shapes, grid, packing and its statistics. */
#include "tests/specimens.h"

#include <time.h>

/* Spheres over domain, and the mean distance of centres over the inner facets: both are figures
 * that vgcm's paper gives for its specimens. */
static double solid_fraction(const struct brc_specimen *s)
{
    const struct brc_facets *f = &s->facets;
    double spheres = 0;
    for (size_t c = 0; c < f->n_cells; c++)
        spheres += 4 * BRC_PI / 3 * f->radius[c] * f->radius[c] * f->radius[c];
    return spheres / s->domain_volume;
}

static double mean_contact_distance(const struct brc_specimen *s)
{
    const struct brc_facets *f = &s->facets;
    double distance = 0, n = 0;
    for (size_t i = 0; i < f->n_facets; i++)
        if (f->cell[i][1] >= 0 && f->is_contact[i]) {
            distance += brc_distance(f->seed[f->cell[i][1]], f->seed[f->cell[i][0]]);
            n++;
        }
    return distance / n;
}

static void test_grid(void **state)
{
    (void)state;
    struct brc_specimen_params p = PARAMS("shape", "box", "grains", "grid", "size",
                                          "8 cm, 6 cm, 4 cm", "cells", "8, 6, 4", "jitter", "0.5");
    struct brc_specimen s, other;
    double low[3], high[3], step = 0, least = 1, most = 0;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    assert_int_equal(s.facets.n_cells, 8 * 6 * 4);
    CHECK_NEAR(s.domain_volume, 192e-6, 0, 1e-14);
    specimens_check_facets(&s);
    int seen[192] = {0};
    for (size_t i = 0; i < s.facets.n_cells; i++) {
        int at[3];
        for (int k = 0; k < 3; k++) {
            double x = s.facets.seed[i][k] / 0.01;
            at[k] = (int)x;
            CHECK_BETWEEN(x - at[k], 0.25, 0.75);
            least = fmin(least, x - at[k]);
            most = fmax(most, x - at[k]);
        }
        seen[at[0] + 8 * (at[1] + 6 * at[2])]++;
        if (i > 0) {
            double d[3];
            brc_sub(d, s.facets.seed[i], s.facets.seed[i - 1]);
            step += brc_norm(d) / 191;
        }
    }
    for (int i = 0; i < 192; i++)
        assert_int_equal(seen[i], 1);
    CHECK_BETWEEN(least, 0.25, 0.26);
    CHECK_BETWEEN(most, 0.74, 0.75);
    /* numbered along a curve: the next cell is a neighbour */
    CHECK_BETWEEN(step, 0.005, 0.015);
    brc_specimen_extent(&s, low, high);
    CHECK_NEAR_ARRAY(low, ((double[3]){0, 0, 0}), 3, 0, 0);
    CHECK_NEAR_ARRAY(high, ((double[3]){0.08, 0.06, 0.04}), 3, 0, 1e-15);
    CHECK_NEAR(solid_fraction(&s), 0, 0, 0);
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &other));
    assert_int_equal(specimens_hash(&s), specimens_hash(&other));
    brc_specimen_free(&other);
    p.seed = 2;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &other));
    assert_int_not_equal(specimens_hash(&s), specimens_hash(&other));
    brc_specimen_free(&other);
    brc_specimen_free(&s);
}

static void test_cubes(void **state)
{
    (void)state;
    struct brc_specimen_params p = PARAMS("shape", "box", "grains", "grid", "size",
                                          "3 cm, 3 cm, 3 cm", "cells", "3, 3, 3", "jitter", "0");
    struct brc_specimen s;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    assert_int_equal(s.facets.n_facets, 54 + 54);
    CHECK_NEAR(mean_contact_distance(&s), 0.01, 0, 1e-14);
    specimens_check_facets(&s);
    brc_specimen_free(&s);
}

static void test_cylinder(void **state)
{
    (void)state;
    struct brc_specimen_params p =
        PARAMS("diameter", "30 mm", "height", "20 mm", "sides", "12", "cache", "off");
    struct brc_specimen s;
    double low[3], high[3];
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    /* the area of the circle, flats to +-y */
    CHECK_NEAR(s.domain_volume, BRC_PI * 0.015 * 0.015 * 0.02, 0, 1e-13);
    specimens_check_facets(&s);
    brc_specimen_extent(&s, low, high);
    double apothem = 0.015 * sqrt(BRC_PI / (12 * tan(BRC_PI / 12)));
    CHECK_NEAR(high[1], apothem, 0, 1e-14);
    CHECK_NEAR(low[1], -apothem, 0, 1e-14);
    CHECK_NEAR(high[0], apothem, 0, 1e-14);
    CHECK_NEAR(low[2], 0, 0, 0);
    CHECK_NEAR(high[2], 0.02, 0, 1e-15);
    for (size_t i = 0; i < s.facets.n_facets; i++)
        if (s.facets.face[i] == 2 || s.facets.face[i] == 2 + 6)
            CHECK_NEAR(s.facets.normal[i][1], s.facets.face[i] == 2 ? 1 : -1, 0, 0);
    brc_specimen_free(&s);
}

/* PHYSICS of the packing: count and solid fraction to the mark, overlaps small, the mean distance
 * over all facets 5.5 mm and by the gap rule 5.1 mm. */
static void check_packing(const struct brc_specimen *s, double seconds)
{
    const struct brc_facets *f = &s->facets;
    double near = 0, overlap = 0;
    size_t n_near = 0, n_touch = 0, n_inner = 0;
    for (size_t i = 0; i < f->n_facets; i++) {
        int32_t a = f->cell[i][0], b = f->cell[i][1];
        if (b < 0)
            continue;
        double d[3], reach = f->radius[a] + f->radius[b];
        brc_sub(d, f->seed[b], f->seed[a]);
        double distance = brc_norm(d);
        n_inner++;
        if (distance < reach) {
            overlap += reach - distance;
            n_touch++;
        }
        if (distance < reach + 1e-3) {
            near += distance;
            n_near++;
        }
    }
    print_message("%zu spheres in %.2f s: solid fraction %.4f, mean distance %.3f mm, within 1 mm "
                  "%.3f mm (%.0f %% of the facets), mean overlap %.3f mm\n",
                  f->n_cells, seconds, solid_fraction(s), 1e3 * mean_contact_distance(s),
                  1e3 * near / (double)n_near, 100 * (double)n_near / (double)n_inner,
                  1e3 * overlap / (double)n_touch);
    CHECK_NEAR(solid_fraction(s), 0.676, 1e-3, 0);
    CHECK_BETWEEN(mean_contact_distance(s), 5.35e-3, 5.6e-3);
    CHECK_BETWEEN(near / (double)n_near, 5.0e-3, 5.2e-3);
    CHECK_BETWEEN((double)n_near / (double)n_inner, 0.72, 0.85);
    CHECK_BETWEEN(overlap / (double)n_touch, 1e-5, 2e-4);
    CHECK_BETWEEN(2 * (double)n_touch / (double)f->n_cells, 6, 8.5);
}

static void test_packing(void **state)
{
    (void)state;
    struct brc_specimen_params p = PARAMS("height", "40 mm", "cache", "off");
    struct brc_specimen s;
    double mean = 0, least = 1, most = 0, step = 0;
    clock_t start = clock();
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    check_packing(&s, (double)(clock() - start) / CLOCKS_PER_SEC);
    specimens_check_facets(&s);
    assert_int_equal(s.facets.n_cells, 1997);
    for (size_t i = 0; i < s.facets.n_cells; i++) {
        double d = 2 * s.facets.radius[i];
        mean += d / 1997;
        least = fmin(least, d);
        most = fmax(most, d);
        double r[3] = {0, 0, 0};
        if (i > 0)
            brc_sub(r, s.facets.seed[i], s.facets.seed[i - 1]);
        step += brc_norm(r) / 1996;
    }
    CHECK_BETWEEN(step, 4e-3, 8e-3);
    CHECK_NEAR(mean, 5e-3, 0, 1e-3);
    CHECK_BETWEEN(least, 4e-3, 4.01e-3);
    CHECK_BETWEEN(most, 5.99e-3, 6e-3);
    brc_specimen_free(&s);
    /* a given count is kept */
    p = PARAMS("height", "20 mm", "diameter", "30 mm", "count", "100", "cache", "off");
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    assert_int_equal(s.facets.n_cells, 100);
    CHECK_NEAR(solid_fraction(&s), 100 * BRC_PI / 6 * 130e-9 / s.domain_volume, 0, 5e-3);
    brc_specimen_free(&s);
}

/* Unequal spheres: each centre in its own cell, though the packing has to relax for it. */
static void test_unequal_spheres(void **state)
{
    (void)state;
    struct brc_specimen_params p = PARAMS("height", "25 mm", "diameter", "30 mm", "diameter_min",
                                          "1 mm", "diameter_max", "6 mm", "cache", "off");
    struct brc_specimen s;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    specimens_check_facets(&s);
    const struct brc_facets *f = &s.facets;
    for (size_t i = 0; i < f->n_cells; i++)
        for (size_t j = 0; j < f->n_cells; j++) {
            double d[3];
            brc_sub(d, f->seed[i], f->seed[j]);
            assert_true(i == j ||
                        brc_norm2(d) > f->radius[j] * f->radius[j] - f->radius[i] * f->radius[i]);
        }
    brc_specimen_free(&s);
}

static void test_disc(void **state)
{
    (void)state;
    struct brc_specimen_params p =
        PARAMS("grains", "mesh", "diameter", "80 cm", "height", "1 cm"); /* 30 sides */
    struct brc_specimen s;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 15 * 0.16 * sin(BRC_PI / 15) * 0.01, 0, 1e-13);
    specimens_check_facets(&s);
    brc_specimen_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grid),
        cmocka_unit_test(test_cubes),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_packing),
        cmocka_unit_test(test_unequal_spheres),
        cmocka_unit_test(test_disc),
    };
    return cmocka_run_group_tests(tests, specimens_set_up, specimens_tear_down);
}
