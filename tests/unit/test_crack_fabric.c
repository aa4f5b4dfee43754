/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cracks whose angles and plane are known. */
#include "common/geometry/vec.h"
#include "common/rigs/crack_fabric.h"
#include "tests/near.h"

#include <stdlib.h>

enum { N = 4000 };

static double draw(uint64_t *random)
{
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    return (double)(*random >> 11) / 9007199254740992.0;
}

static void draw_unit(uint64_t *random, double n[3])
{
    double z = 2 * draw(random) - 1, turn = 2 * BRC_PI * draw(random), r = sqrt(1 - z * z);
    brc_set(n, r * cos(turn), r * sin(turn), z);
}

static void add(struct brc_context *ctx, struct brc_events *e, int facet, const double n[3],
                double area, enum brc_mode mode)
{
    struct brc_event event = {
        .a = facet, .b = facet + 1, .facet = facet, .area = area, .mode = mode};
    brc_copy(event.n, n);
    brc_events_add(ctx, e, 1, &event);
    assert_int_equal(ctx->code, 0);
}

static void test_angles(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_events e;
    struct brc_crack_angles a;
    brc_events_init(&e);
    CHECK_OK(&ctx, brc_crack_angles_measure(&ctx, &e, 1, &a));
    assert_true(isnan(a.mean) && isnan(a.alignment));
    brc_crack_angles_free(&a);
    const double across[] = {0, -1, 0}, along[] = {1, 0, 0}, tilted[] = {0, 0.5, sqrt(0.75)};
    add(&ctx, &e, 0, across, 1, BRC_MODE_TENSION); /* the plane is normal to the load, along y */
    add(&ctx, &e, 1, along, 2, BRC_MODE_SHEAR);
    add(&ctx, &e, 2, tilted, 5, BRC_MODE_SHEAR); /* 30 degrees */
    CHECK_OK(&ctx, brc_crack_angles_measure(&ctx, &e, 1, &a));
    CHECK_NEAR(a.mean, (1 * BRC_PI / 2 + 5 * BRC_PI / 6) / 8, 0, 1e-12);
    CHECK_NEAR(a.alignment, (2 + 5 * 0.75) / 8, 0, 1e-12);
    CHECK_NEAR(a.tension[17], 1, 0, 0);
    CHECK_NEAR(a.shear[0], 2, 0, 0);
    CHECK_NEAR(a.shear[5] + a.shear[6], 5, 0, 0); /* the end of a bin, but for rounding */
    double random = 0;
    for (int k = 0; k < BRC_CRACK_BINS; k++)
        random += a.random[k];
    CHECK_NEAR(random, 8, 0, 1e-12);
    CHECK_NEAR(a.random[17], 8 * (1 - sin(85 * BRC_PI / 180)), 0, 1e-9);
    brc_crack_angles_free(&a);
    brc_events_free(&e);
}

static void test_random_angles(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_events e;
    struct brc_crack_angles a;
    uint64_t random = 88172645463325252U;
    brc_events_init(&e);
    for (int i = 0; i < N; i++) {
        double n[3];
        draw_unit(&random, n);
        add(&ctx, &e, i, n, 1, BRC_MODE_TENSION);
    }
    CHECK_OK(&ctx, brc_crack_angles_measure(&ctx, &e, 2, &a));
    CHECK_NEAR(a.mean, BRC_PI / 2 - 1, 0.02, 0);
    CHECK_NEAR(a.alignment, 2.0 / 3, 0.015, 0);
    for (int k = 0; k < BRC_CRACK_BINS; k++)
        CHECK_NEAR(a.tension[k], a.random[k], 5 * sqrt(a.random[k]), 0);
    brc_crack_angles_free(&a);
    brc_events_free(&e);
}

/* Facets in a cube, a part of them within a plane's slab; several breaks a facet. */
static void make_facets(struct brc_context *ctx, struct brc_facets *f, struct brc_events *e,
                        uint64_t *random, const double normal[3], double part, double thickness)
{
    *f = (struct brc_facets){.n_facets = N, .centroid = malloc(N * sizeof *f->centroid)};
    assert_non_null(f->centroid);
    brc_events_init(e);
    for (int i = 0; i < N; i++) {
        double *x = f->centroid[i];
        for (int k = 0; k < 3; k++)
            x[k] = draw(random) - 0.5;
        if (draw(random) < part)
            brc_axpy(x, 0.08 + thickness * (draw(random) - 0.5) - brc_dot(x, normal), normal);
        for (int k = 0; k < 2; k++)
            add(ctx, e, i, normal, 0.5, BRC_MODE_TENSION);
    }
}

static void test_plane_is_found(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    uint64_t random = 88172645463325252U;
    for (int trial = 0; trial < 5; trial++) {
        struct brc_facets f;
        struct brc_events e;
        struct brc_crack_plane plane;
        double normal[3];
        draw_unit(&random, normal);
        make_facets(&ctx, &f, &e, &random, normal, 0.4, 0.08);
        CHECK_OK(&ctx, brc_crack_plane_find(&ctx, &e, &f, 0.09, &plane));
        assert_int_equal(plane.n, N);
        print_message("part %.3f, off by %.4f\n", plane.part,
                      acos(fmin(fabs(brc_dot(plane.normal, normal)), 1)));
        CHECK_BETWEEN(plane.part, 0.4, 0.52); /* and what lies there by chance */
        CHECK_NEAR(fabs(brc_dot(plane.normal, normal)), 1, 1e-3, 0);
        free(f.centroid);
        brc_events_free(&e);
    }
}

/* Without a plane the best slab is hardly fuller than any; a slab as thick as all holds all. */
static void test_no_plane(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    uint64_t random = 362436069362436069U;
    struct brc_facets f;
    struct brc_events e;
    struct brc_crack_plane plane;
    const double normal[] = {0, 0, 1};
    make_facets(&ctx, &f, &e, &random, normal, 0, 0);
    CHECK_OK(&ctx, brc_crack_plane_find(&ctx, &e, &f, 0.1, &plane));
    CHECK_BETWEEN(plane.part, 0.13, 0.165); /* root of 2: across the diagonal of a face */
    CHECK_OK(&ctx, brc_crack_plane_find(&ctx, &e, &f, 2, &plane));
    CHECK_NEAR(plane.part, 1, 0, 1e-12);
    brc_events_free(&e);
    brc_events_init(&e);
    CHECK_OK(&ctx, brc_crack_plane_find(&ctx, &e, &f, 0.1, &plane));
    assert_true(plane.n == 0 && plane.part == 0);
    free(f.centroid);
    brc_events_free(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles), cmocka_unit_test(test_random_angles),
        cmocka_unit_test(test_plane_is_found), cmocka_unit_test(test_no_plane)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
