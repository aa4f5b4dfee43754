/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cores of the polyhedra model: features, half-planes, principal axes. */
#include "tests/near.h"
#include "tests/poly_solids.h"

#include "common/geometry/vec.h"

static double edge_length(const struct poly_core *c, int32_t e)
{
    double along[3];
    brc_sub(along, c->vertex[c->end[e][1]], c->vertex[c->end[e][0]]);
    return brc_norm(along);
}

static void test_box(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    const double half[3] = {1, 2, 3};
    CHECK_OK(&ctx, solid_box(&ctx, &s, half));
    struct poly_core c = poly_core_of(&s, 0);
    assert_int_equal(c.n_vertices, 8);
    assert_int_equal(c.n_edges, 12);
    assert_int_equal(c.n_faces, 6);
    double length = 0;
    for (int32_t f = 0; f < c.n_faces; f++) {
        assert_int_equal(c.face[f].n_sides, 4);
        CHECK_NEAR(c.face[f].d, fabs(brc_dot(c.face[f].n, half)), 1e-14, 0);
    }
    for (int32_t e = 0; e < c.n_edges; e++)
        length += edge_length(&c, e);
    CHECK_NEAR(length, 4 * (2 + 4 + 6), 1e-12, 0);
    CHECK_NEAR(solid_reach(&s, 0), sqrt(14), 1e-14, 0);
    poly_shapes_free(&s);
}

/* Every vertex is on its faces and inside all others; sides and edges refer to each other. */
static void check_core(const struct poly_core *c)
{
    assert_int_equal(c->n_vertices - c->n_edges + c->n_faces, 2);
    for (int32_t f = 0; f < c->n_faces; f++)
        for (int32_t v = 0; v < c->n_vertices; v++)
            assert_true(poly_height(&c->face[f], c->vertex[v]) < 1e-12);
    for (int32_t f = 0; f < c->n_faces; f++)
        for (int32_t k = c->face[f].first; k < c->face[f].first + c->face[f].n_sides; k++) {
            int32_t index = c->link[k].edge;
            const struct poly_edge *e = &c->edge[index];
            CHECK_NEAR(poly_height(&c->face[f], c->vertex[c->link[k].v]), 0, 1e-12, 0);
            CHECK_NEAR(brc_dot(c->side[k].m, c->vertex[c->end[index][0]]), c->side[k].off, 1e-12,
                       0);
            CHECK_NEAR(brc_dot(c->side[k].m, c->vertex[c->end[index][1]]), c->side[k].off, 1e-12,
                       0);
            CHECK_NEAR(brc_dot(c->side[k].m, c->face[f].n), 0, 1e-12, 0);
            assert_true(e->side[0] == k || e->side[1] == k);
            assert_true(e->face[0] == f || e->face[1] == f);
            for (int32_t other = c->face[f].first; other < k; other++)
                assert_true(brc_dot(c->side[k].m, c->vertex[c->link[other].v]) <
                            c->side[k].off + 1e-12);
        }
}

static void test_random_cores(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    unsigned seed = 7;
    for (int i = 0; i < 40; i++)
        CHECK_OK(&ctx, solid_random(&ctx, &s, &seed, 1));
    for (size_t i = 0; i < s.n; i++) {
        struct poly_core c = poly_core_of(&s, i);
        check_core(&c);
        for (int32_t v = 0; v < c.n_vertices; v++)
            for (int32_t k = c.star_first[v]; k < c.star_first[v + 1]; k++)
                assert_true(c.end[c.star[k]][0] == v || c.end[c.star[k]][1] == v);
        assert_int_equal(c.star_first[c.n_vertices], 2 * c.n_edges);
    }
    poly_shapes_free(&s);
}

static void test_open_solid_is_an_error(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    double v[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    size_t first[] = {0, 3, 6, 9};
    int32_t loop[] = {0, 2, 1, 0, 1, 3, 0, 3, 2};
    struct brc_convex open = {
        .n_vertices = 4, .vertex = v, .n_faces = 3, .first = first, .loop = loop};
    struct brc_plane plane[3];
    solid_planes(&open, plane);
    CHECK_FAILS(&ctx, poly_shapes_add(&ctx, &s, &open), BRC_ERR_GEOMETRY, "not a closed");
    poly_shapes_free(&s);
}

static void test_principal_axes(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    unsigned seed = 3;
    for (int i = 0; i < 20; i++) {
        double q[4], m[3][3], t[3][3], found[4], f[3][3], moment[3];
        const double d[3] = {1, 2 + i % 3, 5};
        solid_rotation(q, &seed);
        brc_quat_matrix(m, q);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                t[r][c] =
                    m[r][0] * d[0] * m[c][0] + m[r][1] * d[1] * m[c][1] + m[r][2] * d[2] * m[c][2];
        CHECK_OK(&ctx, poly_principal(&ctx, (const double(*)[3])t, moment, found));
        CHECK_NEAR_ARRAY(moment, d, 3, 1e-12, 0);
        brc_quat_matrix(f, found);
        for (int k = 0; k < 3; k++) {
            double axis[3] = {f[0][k], f[1][k], f[2][k]}, image[3];
            brc_mat_mul(image, t, axis);
            brc_axpy(image, -moment[k], axis);
            CHECK_NEAR(brc_norm(image), 0, 1e-12, 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_random_cores),
        cmocka_unit_test(test_open_solid_is_an_error),
        cmocka_unit_test(test_principal_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
