/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over facets that the first guess needs: closed forms on cubes, bounds and identities on
 * random cells. */
#include "calib/fabric.h"
#include "common/specimen/tess.h"
#include "tests/near.h"

#include <stdlib.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;

enum { SIDE = 5, N_SEEDS = SIDE * SIDE * SIDE };
static const double edge = 0.01;

/* One seed per cube, moved within part of its cube; radii 0.45 to 0.55 edges, NULL for Voronoi. */
static void make_facets(double part, bool has_radii, struct brc_facets *out)
{
    double seed[N_SEEDS][3], radius[N_SEEDS];
    const double low[3] = {0, 0, 0}, high[3] = {SIDE * edge, SIDE * edge, SIDE * edge};
    struct brc_convex domain = {0};
    uint64_t random = 7;
    for (int i = 0; i < N_SEEDS; i++) {
        const int place[3] = {i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)};
        for (int k = 0; k < 4; k++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            double r = (double)(random >> 11) * 0x1p-53;
            if (k < 3)
                seed[i][k] = edge * (place[k] + 0.5 + part * (r - 0.5));
            else
                radius[i] = edge * (0.45 + 0.1 * r);
        }
    }
    CHECK_OK(&ctx, brc_convex_box(&ctx, &domain, low, high));
    CHECK_OK(&ctx,
             brc_tess_laguerre(&ctx, seed, has_radii ? radius : NULL, N_SEEDS, &domain, 1e-4, out));
    brc_convex_free(&domain);
}

static void cubes_have_closed_forms(void **state)
{
    const double r = 1e-3;
    struct calib_fabric_rules rules = {.gap = HUGE_VAL};
    struct calib_fabric f;
    struct brc_facets facets;
    (void)state;
    make_facets(0, false, &facets);
    CHECK_OK(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &f));
    assert_int_equal(f.n_contacts, 3 * SIDE * SIDE * (SIDE - 1));
    CHECK_NEAR(f.mean_distance, edge, 0, 1e-12);
    CHECK_NEAR(f.coverage, 1, 0, 1e-12);
    CHECK_NEAR(f.bond, 1, 0, 1e-12);
    CHECK_NEAR(f.stretch, 1, 0, 1e-12);
    CHECK_NEAR(f.corners, 4 / edge, 0, 1e-12);
    /* gap and eroded: E_t = B_n (1 - 2R/h)^2 h/(2R) */
    rules = (struct calib_fabric_rules){HUGE_VAL, r, true, true};
    CHECK_OK(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &f));
    CHECK_NEAR(f.bond, (1 - 2 * r / edge) * (1 - 2 * r / edge) * edge / (2 * r), 0, 1e-11);
    CHECK_NEAR(f.stretch, edge / (2 * r), 0, 1e-12);
    brc_facets_free(&facets);
}

/* Cells that are not cubes: A d fills the volume whatever the facets; erosion takes area away. */
static void random_cells_are_bounded(void **state)
{
    struct calib_fabric_rules rules = {.gap = HUGE_VAL};
    struct calib_fabric all, near, eroded;
    struct brc_facets facets;
    (void)state;
    make_facets(0.8, true, &facets);
    CHECK_OK(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &all));
    CHECK_BETWEEN(all.coverage, 0.999, 1);
    CHECK_BETWEEN(all.bond, 0.9, 1);
    CHECK_BETWEEN(all.stretch, 0.9, 1);
    rules.gap = 0.2 * edge;
    CHECK_OK(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &near));
    assert_true(near.n_contacts < all.n_contacts);
    assert_true(near.mean_distance < all.mean_distance);
    CHECK_BETWEEN(near.coverage, 0.5, 0.999);
    assert_true(near.bond == all.bond && near.corners == all.corners);
    rules = (struct calib_fabric_rules){HUGE_VAL, 0.05 * edge, true, false};
    CHECK_OK(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &eroded));
    CHECK_BETWEEN(eroded.bond / all.bond, 0.5, 0.9);
    brc_facets_free(&facets);
}

static void bad_rules_are_named(void **state)
{
    struct calib_fabric_rules rules = {.gap = HUGE_VAL, .is_eroded = true};
    struct calib_fabric f;
    struct brc_facets facets;
    (void)state;
    make_facets(0, false, &facets);
    CHECK_FAILS(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &f), BRC_ERR_INPUT,
                "need a sphero-radius above 0");
    rules = (struct calib_fabric_rules){.gap = -edge};
    CHECK_FAILS(&ctx, calib_fabric_measure(&ctx, &facets, &rules, &f), BRC_ERR_INPUT,
                "no facet of the specimen is a contact");
    brc_facets_free(&facets);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_have_closed_forms),
        cmocka_unit_test(random_cells_are_bounded),
        cmocka_unit_test(bad_rules_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
