/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clipping of convex polyhedra against closed forms and random cuts. */
#include "tests/near.h"

#include "common/geometry/convex.h"
#include "common/geometry/vec.h"

#include <stdlib.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;
static const double zero[3] = {0, 0, 0};

/* Uniform in (-1, 1), from a generator of our own so that the test is the same everywhere. */
static double uniform(void)
{
    static uint64_t state = 12345;
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) / 4503599627370496.0 - 1;
}

static void unit_vector(double n[3])
{
    do
        brc_set(n, uniform(), uniform(), uniform());
    while (brc_norm2(n) > 1 || brc_norm2(n) < 0.01);
    brc_normalise(n, n);
}

/* Euler's formula, each edge once in each direction, every vertex inside every plane. */
static void check_valid(const struct brc_convex *c, double tolerance)
{
    size_t n_edges = c->first[c->n_faces];
    assert_int_equal(n_edges % 2, 0);
    assert_int_equal(c->n_vertices + c->n_faces, n_edges / 2 + 2);
    for (size_t f = 0; f < c->n_faces; f++) {
        size_t n = c->first[f + 1] - c->first[f];
        assert_true(n >= 3);
        for (size_t v = 0; v < c->n_vertices; v++)
            assert_true(brc_dot(c->plane[f].n, c->vertex[v]) < c->plane[f].d + tolerance);
        for (size_t i = 0; i < n; i++) {
            double x = brc_dot(c->plane[f].n, c->vertex[c->loop[c->first[f] + i]]);
            CHECK_NEAR(x, c->plane[f].d, tolerance, 0);
        }
    }
}

static void check_closed(const struct brc_convex *c)
{
    double sum[3] = {0, 0, 0}, total = 0, flux = 0, volume, centroid[3], inertia[3][3];
    for (size_t f = 0; f < c->n_faces; f++) {
        double centre[3],
            area = brc_polygon_area(c->vertex, c->loop + c->first[f], c->first[f + 1] - c->first[f],
                                    c->plane[f].n, centre);
        assert_true(area >= 0);
        brc_axpy(sum, area, c->plane[f].n);
        flux += area * c->plane[f].d / 3;
        total += area;
    }
    brc_convex_mass(c, &volume, centroid, inertia);
    CHECK_NEAR(brc_norm(sum), 0, 1e-13 * total, 0);
    CHECK_NEAR(volume, flux, 1e-14, 1e-12);
}

static void test_box(void **state)
{
    (void)state;
    struct brc_convex c = {0};
    double volume, centroid[3], inertia[3][3];
    const double low[3] = {1, 2, 3}, high[3] = {2, 4, 6}, centre[3] = {1.5, 3, 4.5};
    CHECK_OK(&ctx, brc_convex_box(&ctx, &c, low, high));
    check_valid(&c, 1e-15);
    check_closed(&c);
    brc_convex_mass(&c, &volume, centroid, inertia);
    CHECK_NEAR(volume, 6, 0, 1e-15);
    CHECK_NEAR_ARRAY(centroid, centre, 3, 1e-15, 0);
    CHECK_NEAR(inertia[0][0], 6 * (4 + 9) / 12.0, 0, 1e-14);
    CHECK_NEAR(inertia[1][1], 6 * (1 + 9) / 12.0, 0, 1e-14);
    CHECK_NEAR(inertia[2][2], 6 * (1 + 4) / 12.0, 0, 1e-14);
    CHECK_NEAR(inertia[0][1], 0, 1e-14, 0);
    CHECK_NEAR(brc_convex_reach(&c, low), sqrt(14), 0, 1e-15);
    for (size_t f = 0; f < 6; f++)
        assert_int_equal(c.plane[f].id, f);
    brc_convex_free(&c);
}

/* A corner cut off a unit cube at a, a, a: a tetrahedron of volume a^3/6 with a triangle face. */
static void test_corner(void **state)
{
    (void)state;
    struct brc_convex c = {0};
    const double high[3] = {1, 1, 1};
    double volume, centroid[3], inertia[3][3], a = 0.25, r = 1 / sqrt(3);
    struct brc_plane plane = {{-r, -r, -r}, -a * r, 77};
    bool changed;
    CHECK_OK(&ctx, brc_convex_box(&ctx, &c, zero, high));
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &plane, 1e-12, &changed));
    assert_true(changed);
    check_valid(&c, 1e-15);
    assert_int_equal(c.n_faces, 7);
    assert_int_equal(c.n_vertices, 10);
    assert_int_equal(c.plane[6].id, 77);
    brc_convex_mass(&c, &volume, centroid, inertia);
    CHECK_NEAR(volume, 1 - a * a * a / 6, 0, 1e-15);
    CHECK_NEAR(centroid[0], (0.5 - a * a * a / 6 * a / 4) / volume, 0, 1e-15);
    /* the complement is the tetrahedron itself: inertia by closed form, 3/80 m a^2 */
    struct brc_plane flip = {{r, r, r}, a * r, 78};
    CHECK_OK(&ctx, brc_convex_box(&ctx, &c, zero, high));
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &flip, 1e-12, &changed));
    check_valid(&c, 1e-15);
    assert_int_equal(c.n_vertices, 4);
    brc_convex_mass(&c, &volume, centroid, inertia);
    CHECK_NEAR(volume, a * a * a / 6, 0, 1e-14);
    CHECK_NEAR(inertia[0][0], volume * a * a * 2 * 3 / 80, 0, 1e-13);
    CHECK_NEAR(inertia[0][1], volume * a * a / 80, 0, 1e-13);
    brc_convex_free(&c);
}

/* Planes that touch within the tolerance leave the body alone; planes through vertices use them. */
static void test_touch(void **state)
{
    (void)state;
    struct brc_convex c = {0};
    const double high[3] = {1, 1, 1};
    double r = 1 / sqrt(2);
    bool changed;
    struct brc_plane face = {{1, 0, 0}, 1 - 1e-11, 7}, edge = {{r, r, 0}, 2 * r - 1e-11, 8};
    struct brc_plane middle = {{r, -r, 0}, 1e-11, 9}, away = {{1, 0, 0}, -1, 10};
    CHECK_OK(&ctx, brc_convex_box(&ctx, &c, zero, high));
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &face, 1e-10, &changed));
    assert_false(changed);
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &edge, 1e-10, &changed));
    assert_false(changed);
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &middle, 1e-10, &changed));
    assert_true(changed);
    assert_int_equal(c.n_vertices, 6);
    assert_int_equal(c.n_faces, 5);
    check_valid(&c, 1e-10);
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &away, 1e-10, &changed));
    assert_true(changed);
    assert_int_equal(c.n_faces, 0);
    CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &away, 1e-10, &changed));
    assert_false(changed);
    brc_convex_free(&c);
}

/* Random cuts: the two sides of each plane sum to the whole. */
static void copy_body(struct brc_convex *to, const struct brc_convex *from)
{
    size_t n_loop = from->first[from->n_faces];
    CHECK_OK(&ctx, brc_convex_reserve(&ctx, to, from->n_vertices, from->n_faces, n_loop));
    to->n_vertices = from->n_vertices;
    to->n_faces = from->n_faces;
    memcpy(to->vertex, from->vertex, from->n_vertices * sizeof *to->vertex);
    memcpy(to->plane, from->plane, from->n_faces * sizeof *to->plane);
    memcpy(to->first, from->first, (from->n_faces + 1) * sizeof *to->first);
    memcpy(to->loop, from->loop, n_loop * sizeof *to->loop);
}

static void test_random_cuts(void **state)
{
    (void)state;
    struct brc_convex c = {0}, other = {0};
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    for (int round = 0; round < 200; round++) {
        double whole = 8;
        CHECK_OK(&ctx, brc_convex_box(&ctx, &c, low, high));
        for (int k = 0; k < 30; k++) {
            double part, rest = 0, centroid[3], inertia[3][3];
            struct brc_plane plane = {{0, 0, 0}, 0.6 + 0.3 * uniform(), 10 + k}, flip;
            bool changed;
            unit_vector(plane.n);
            brc_scale(flip.n, plane.n, -1);
            flip.d = -plane.d;
            copy_body(&other, &c);
            CHECK_OK(&ctx, brc_convex_clip(&ctx, &c, &plane, 1e-12, &changed));
            CHECK_OK(&ctx, brc_convex_clip(&ctx, &other, &flip, 1e-12, &changed));
            check_valid(&c, 1e-14);
            check_closed(&c);
            brc_convex_mass(&c, &part, centroid, inertia);
            if (other.n_faces > 0)
                brc_convex_mass(&other, &rest, centroid, inertia);
            CHECK_NEAR(part + rest, whole, 1e-13, 0);
            whole = part;
        }
    }
    brc_convex_free(&c);
    brc_convex_free(&other);
}

static void test_from_planes(void **state)
{
    (void)state;
    struct brc_convex c = {0};
    struct brc_plane planes[64];
    double volume, centroid[3], inertia[3][3], centre[3] = {3, -2, 5};
    int n = 12;
    for (int k = 0; k < n; k++) {
        double angle = 2 * BRC_PI * k / n;
        brc_set(planes[k].n, cos(angle), sin(angle), 0);
        planes[k].d = brc_dot(planes[k].n, centre) + 1;
        planes[k].id = 100 + k;
    }
    planes[n] = (struct brc_plane){{0, 0, -1}, -4, 200};
    planes[n + 1] = (struct brc_plane){{0, 0, 1}, 6, 201};
    CHECK_OK(&ctx, brc_convex_from_planes(&ctx, &c, planes, (size_t)n + 2, centre, 10));
    check_valid(&c, 1e-13);
    brc_convex_mass(&c, &volume, centroid, inertia);
    CHECK_NEAR(volume, 2 * n * tan(BRC_PI / n), 0, 1e-14);
    CHECK_NEAR_ARRAY(centroid, centre, 3, 1e-14, 0);
    assert_int_equal(c.n_faces, n + 2);
    assert_int_equal(c.plane[n + 1].id, 201);
    /* without its lid the prism has no end */
    CHECK_FAILS(&ctx, brc_convex_from_planes(&ctx, &c, planes, (size_t)n + 1, centre, 10),
                BRC_ERR_GEOMETRY, "do not bound");
    planes[n + 1].d = 3;
    CHECK_OK(&ctx, brc_convex_from_planes(&ctx, &c, planes, (size_t)n + 2, centre, 10));
    assert_int_equal(c.n_faces, 0);
    brc_convex_free(&c);
}

/* A cube, each face of it many planes that are parallel to within a small angle: of 1e-14 to 1e-4,
 * and moved by as much. It is a closed body all the same, and as large as a cube to that angle. */
static void test_nearly_coplanar(void **state)
{
    (void)state;
    struct brc_convex c = {0};
    for (int trial = 0; trial < 2000; trial++) {
        struct brc_plane planes[60];
        double angle = pow(10, -9 + 5 * uniform()), centroid[3], inertia[3][3], volume;
        for (int i = 0; i < 60; i++) {
            planes[i] = (struct brc_plane){{0, 0, 0}, 1 + angle * 0.5 * uniform(), i};
            for (int k = 0; k < 3; k++)
                planes[i].n[k] = angle * 0.5 * uniform();
            planes[i].n[i % 3] += i % 6 < 3 ? 1 : -1;
            brc_normalise(planes[i].n, planes[i].n);
        }
        CHECK_OK(&ctx, brc_convex_from_planes(&ctx, &c, planes, 60, zero, 4));
        check_valid(&c, 1e-7);
        brc_convex_mass(&c, &volume, centroid, inertia);
        CHECK_NEAR(volume, 8, 40 * angle + 1e-7, 0);
        for (int i = 0; i < 60; i++)
            for (size_t v = 0; v < c.n_vertices; v++)
                assert_true(brc_dot(planes[i].n, c.vertex[v]) < planes[i].d + 1e-7);
    }
    brc_convex_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),         cmocka_unit_test(test_corner),
        cmocka_unit_test(test_touch),       cmocka_unit_test(test_random_cuts),
        cmocka_unit_test(test_from_planes), cmocka_unit_test(test_nearly_coplanar),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
