/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interaction points: area, centroid and second moments of the facet. */
#include "tests/near.h"
#include "tests/rotate.h"

#include "common/geometry/vec.h"
#include "vgcm/points.h"

enum { MOST = 64 };

/* A specimen of one plane polygon, turned and moved in space. */
struct facet {
    struct brc_facets facets;
    double vertex[MOST][3], area, centroid[1][3], normal[1][3];
    int32_t loop[MOST];
    size_t first[2];
};

static void make_facet(struct facet *f, const double (*flat)[2], size_t n)
{
    const double turn[4] = {0.5, 0.1, -0.7, 0.5}, up[3] = {0, 0, 1};
    double q[4], size = sqrt(0.25 + 0.01 + 0.49 + 0.25);
    *f = (struct facet){.first = {0, n}};
    for (int k = 0; k < 4; k++)
        q[k] = turn[k] / size;
    for (size_t i = 0; i < n; i++) {
        brc_set(f->vertex[i], flat[i][0], flat[i][1], 0.3);
        brc_quat_rotate(f->vertex[i], q, f->vertex[i]);
        f->loop[i] = (int32_t)i;
    }
    brc_quat_rotate(f->normal[0], q, up);
    f->area = brc_polygon_area(f->vertex, f->loop, n, f->normal[0], f->centroid[0]);
    f->facets = (struct brc_facets){.n_facets = 1,
                                    .area = &f->area,
                                    .centroid = f->centroid,
                                    .normal = f->normal,
                                    .first = f->first,
                                    .loop = f->loop,
                                    .vertex = f->vertex};
}

static void make_regular(struct facet *f, size_t n, double radius)
{
    double flat[MOST][2];
    for (size_t i = 0; i < n; i++) {
        flat[i][0] = radius * cos(2 * BRC_PI * (double)i / (double)n);
        flat[i][1] = radius * sin(2 * BRC_PI * (double)i / (double)n);
    }
    make_facet(f, (const double(*)[2])flat, n);
}

/* Sum of the areas, of area times place about the centroid, and of area times place times place. */
static void moments(const struct facet *f, enum vgcm_points_rule rule, double *area,
                    double first[3], double second[3][3])
{
    double x[MOST][3], a[MOST];
    int n = vgcm_points_count(rule, f->first[1]);
    vgcm_points_place(rule, &f->facets, 0, x, a);
    *area = 0;
    brc_set(first, 0, 0, 0);
    memset(second, 0, 9 * sizeof(double));
    for (int j = 0; j < n; j++) {
        double r[3];
        brc_sub(r, x[j], f->centroid[0]);
        *area += a[j];
        brc_axpy(first, a[j], r);
        for (int p = 0; p < 3; p++)
            brc_axpy(second[p], a[j] * r[p], r);
    }
}

static double polar(const struct facet *f, enum vgcm_points_rule rule)
{
    double area, first[3], second[3][3];
    moments(f, rule, &area, first, second);
    CHECK_NEAR(area, f->area, 0, 1e-13);
    CHECK_NEAR(brc_norm(first), 0, 1e-13 * f->area, 0);
    return second[0][0] + second[1][1] + second[2][2];
}

/* The facet's own second moments, by triangles about the centroid. */
static void own_moments(const struct facet *f, double second[3][3])
{
    size_t n = f->first[1];
    memset(second, 0, 9 * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        double a[3], b[3], c[3], sum[3];
        brc_sub(a, f->vertex[i], f->centroid[0]);
        brc_sub(b, f->vertex[(i + 1) % n], f->centroid[0]);
        brc_cross(c, a, b);
        brc_add(sum, a, b);
        double weight = brc_norm(c) / 24;
        for (int p = 0; p < 3; p++) {
            brc_axpy(second[p], weight * a[p], a);
            brc_axpy(second[p], weight * b[p], b);
            brc_axpy(second[p], weight * sum[p], sum);
        }
    }
}

/* Polar moment of a regular n-gon of circumradius 1 over its area. */
static double regular_polar(double n)
{
    return (2 + cos(2 * BRC_PI / n)) / 6;
}

static void paper_points_overstate_the_second_moment(void **state)
{
    static const struct {
        size_t n;
        double ratio;
    } known[] = {{3, 8.0 / 3}, {4, 2}, {5, 1.73}, {6, 1.6}, {60, 4.0 / 3}};
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        struct facet f;
        make_regular(&f, known[i].n, 1);
        double exact = regular_polar((double)known[i].n) * f.area;
        CHECK_NEAR(polar(&f, VGCM_POINTS_PAPER) / exact, known[i].ratio, 0.005, 0);
        CHECK_NEAR(polar(&f, VGCM_POINTS_EXACT) / exact, 1, 1e-12, 0);
        CHECK_NEAR(polar(&f, VGCM_POINTS_ONE), 0, 0, 0);
    }
}

static void exact_points_have_the_facets_second_moments(void **state)
{
    static const double flat[][2] = {{0, 0}, {3, -0.5}, {4, 0.2}, {3.5, 1}, {0.4, 0.9}};
    struct facet f;
    double area, first[3], second[3][3], own[3][3];
    (void)state;
    make_facet(&f, flat, 5);
    own_moments(&f, own);
    moments(&f, VGCM_POINTS_EXACT, &area, first, second);
    CHECK_NEAR(area, f.area, 0, 1e-13);
    CHECK_NEAR(brc_norm(first), 0, 1e-13, 0);
    CHECK_NEAR_ARRAY(&second[0][0], &own[0][0], 9, 1e-12, 0);
    moments(&f, VGCM_POINTS_PAPER, &area, first, second);
    CHECK_BETWEEN(second[0][0] / own[0][0], 1.3, 3);
}

static void slivers_keep_their_area_and_polar_moment(void **state)
{
    static const double flat[][2] = {{0, 0}, {1, 0}, {1, 1e-6}, {0.3, 1e-6}};
    struct facet f;
    double own[3][3], area, first[3], second[3][3];
    (void)state;
    make_facet(&f, flat, 4);
    own_moments(&f, own);
    moments(&f, VGCM_POINTS_EXACT, &area, first, second);
    CHECK_NEAR(area, f.area, 0, 1e-9);
    CHECK_NEAR((second[0][0] + second[1][1] + second[2][2]) / (own[0][0] + own[1][1] + own[2][2]),
               1, 1e-9, 0);
}

static void points_do_not_depend_on_the_unit(void **state)
{
    static const double flat[][2] = {{0, 0}, {3, -0.5}, {4, 0.2}, {3.5, 1}, {0.4, 0.9}};
    double x[2][MOST][3], a[2][MOST];
    struct facet f;
    (void)state;
    make_facet(&f, flat, 5);
    vgcm_points_place(VGCM_POINTS_EXACT, &f.facets, 0, x[0], a[0]);
    for (size_t i = 0; i < 5; i++)
        brc_scale(f.vertex[i], f.vertex[i], 1e-6);
    brc_scale(f.centroid[0], f.centroid[0], 1e-6);
    vgcm_points_place(VGCM_POINTS_EXACT, &f.facets, 0, x[1], a[1]);
    for (int j = 0; j < 6; j++) {
        brc_scale(x[0][j], x[0][j], 1e-6);
        CHECK_NEAR_ARRAY(x[1][j], x[0][j], 3, 1e-18, 0);
        CHECK_NEAR(a[1][j], 1e-12 * a[0][j], 0, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paper_points_overstate_the_second_moment),
        cmocka_unit_test(exact_points_have_the_facets_second_moments),
        cmocka_unit_test(slivers_keep_their_area_and_polar_moment),
        cmocka_unit_test(points_do_not_depend_on_the_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
