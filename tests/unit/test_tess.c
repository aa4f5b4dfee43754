/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tessellations: partitions of the domain, degenerate seeds, seeds without a cell, the disc mesh.
 */
#include "tests/near.h"
#include "tests/quality.h"

#include "common/specimen/cell_complex.h"
#include "common/specimen/tess.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <time.h>

static const double zero[3] = {0, 0, 0};
static struct brc_context ctx = BRC_CONTEXT_INIT;

/* One test pack: a cube of m^3 cells of edge 1 cm, seeds jittered by a part of the cell. */
struct pack {
    size_t n;
    double (*seed)[3], *radius, volume;
    struct brc_convex domain;
    struct brc_facets facets;
};

static double uniform(void)
{
    static uint64_t state = 2024;
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) / 9007199254740992.0;
}

static bool is_inside(const struct brc_convex *domain, const double x[3])
{
    for (size_t f = 0; f < domain->n_faces; f++)
        if (brc_dot(domain->plane[f].n, x) > domain->plane[f].d)
            return false;
    return true;
}

/* sides 0: the whole cube; else a prism inscribed in it. */
static void make_domain(struct pack *p, double edge, int sides)
{
    struct brc_plane planes[130];
    double low[3] = {0, 0, 0}, high[3] = {edge, edge, edge}, inertia[3][3], centre[3];
    p->domain = (struct brc_convex){0};
    if (sides == 0) {
        CHECK_OK(&ctx, brc_convex_box(&ctx, &p->domain, low, high));
    } else {
        for (int k = 0; k < sides; k++) {
            double angle = BRC_PI / 2 + 2 * BRC_PI * k / sides;
            brc_set(planes[k + 2].n, cos(angle), sin(angle), 0);
            planes[k + 2].d = (planes[k + 2].n[0] + planes[k + 2].n[1] + 1) * edge / 2;
            planes[k + 2].id = k + 2;
        }
        planes[0] = (struct brc_plane){{0, 0, -1}, 0, 0};
        planes[1] = (struct brc_plane){{0, 0, 1}, edge, 1};
        CHECK_OK(&ctx, brc_convex_from_planes(&ctx, &p->domain, planes, (size_t)sides + 2, high,
                                              4 * edge));
    }
    brc_convex_mass(&p->domain, &p->volume, centre, inertia);
}

static void make_pack(struct pack *p, int m, double jitter, int sides)
{
    double h = 0.01;
    size_t cap = (size_t)m * (size_t)m * (size_t)m;
    memset(p, 0, sizeof *p);
    make_domain(p, m * h, sides);
    p->seed = brc_alloc(&ctx, cap, sizeof *p->seed);
    p->radius = brc_alloc(&ctx, cap, sizeof *p->radius);
    for (size_t i = 0; i < cap; i++) {
        double x[3], u = (double)m;
        brc_set(x, (double)(i % (size_t)m), floor(fmod((double)i, u * u) / u),
                floor((double)i / (u * u)));
        for (int k = 0; k < 3; k++)
            x[k] = h * (x[k] + 0.5 + jitter * (uniform() - 0.5));
        if (is_inside(&p->domain, x)) {
            p->radius[p->n] = h * (0.3 + 0.2 * uniform());
            brc_copy(p->seed[p->n++], x);
        }
    }
}

static void free_pack(struct pack *p)
{
    brc_facets_free(&p->facets);
    brc_convex_free(&p->domain);
    free(p->seed);
    free(p->radius);
}

static double height_over(const struct brc_convex *domain, int32_t face, const double x[3])
{
    const struct brc_plane *plane = domain->plane;
    while (plane->id != face)
        plane++;
    return brc_dot(plane->n, x) - plane->d;
}

/* Makes the facets and checks what every partition must fulfil. */
static void check_partition(struct pack *p, bool is_laguerre, double closure)
{
    struct brc_facets_quality q;
    struct brc_facets *f = &p->facets;
    CHECK_OK(&ctx, brc_tess_laguerre(&ctx, p->seed, is_laguerre ? p->radius : NULL, p->n,
                                     &p->domain, 1e-4, f));
    assert_int_equal(f->n_cells, p->n);
    q = brc_facets_quality(f, p->volume);
    CHECK_NEAR(q.volume_error, 0, 1e-12, 0);
    CHECK_NEAR(q.closure_error, 0, closure, 0);
    assert_true(q.smallest_area > 0);
    for (size_t i = 0; i < f->n_facets; i++) {
        int32_t a = f->cell[i][0], b = f->cell[i][1];
        assert_true(b < 0 ? f->face[i] >= 0 : f->face[i] == -1 && a < b);
        double r[3], x[3];
        brc_sub(r, f->centroid[i], f->seed[a]);
        assert_true(brc_dot(r, f->normal[i]) > 0 || is_laguerre);
        for (size_t k = f->first[i]; b < 0 && k < f->first[i + 1]; k++)
            CHECK_NEAR(height_over(&p->domain, f->face[i], f->vertex[f->loop[k]]), 0, 6e-17, 0);
        if (b < 0)
            continue;
        /* a facet is where the powers of its two seeds are equal */
        brc_sub(x, f->centroid[i], f->seed[b]);
        double ra = f->radius[a], rb = f->radius[b];
        CHECK_NEAR(brc_norm2(r) - ra * ra, brc_norm2(x) - rb * rb, 1e-12, 0);
    }
}

static void test_random_voronoi(void **state)
{
    (void)state;
    struct pack p;
    for (int sides = 0; sides <= 64; sides += 32) {
        make_pack(&p, 9, 1, sides);
        check_partition(&p, false, 1e-12);
        free_pack(&p);
    }
}

static void test_random_laguerre(void **state)
{
    (void)state;
    struct pack p;
    for (int sides = 0; sides <= 64; sides += 16) {
        make_pack(&p, 9, 0.8, sides);
        check_partition(&p, true, 1e-12);
        free_pack(&p);
    }
}

/* Volume by chance: the share of random points that are nearest to a seed. */
static void test_against_nearest_seed(void **state)
{
    (void)state;
    struct pack p;
    int hits[27] = {0}, n = 200000;
    make_pack(&p, 3, 1, 0);
    check_partition(&p, true, 1e-12);
    for (int i = 0; i < n; i++) {
        double x[3] = {0.03 * uniform(), 0.03 * uniform(), 0.03 * uniform()}, best = INFINITY;
        int at = 0;
        for (int s = 0; s < 27; s++) {
            double r[3];
            brc_sub(r, x, p.seed[s]);
            double power = brc_norm2(r) - p.radius[s] * p.radius[s];
            if (power < best) {
                best = power;
                at = s;
            }
        }
        hits[at]++;
    }
    for (int s = 0; s < 27; s++) {
        double part = p.facets.volume[s] / p.volume;
        CHECK_NEAR(hits[s] / (double)n, part, 5 * sqrt(part / n), 0);
    }
    free_pack(&p);
}

static void test_exact_grid(void **state)
{
    (void)state;
    struct pack p;
    make_pack(&p, 8, 0, 0);
    check_partition(&p, false, 1e-14);
    assert_int_equal(p.facets.n_facets, 3 * 8 * 8 * 9);
    assert_int_equal(p.facets.n_vertices, 9 * 9 * 9);
    for (size_t f = 0; f < p.facets.n_facets; f++) {
        assert_int_equal(p.facets.first[f + 1] - p.facets.first[f], 4);
        CHECK_NEAR(p.facets.area[f], 1e-4, 0, 1e-13);
    }
    for (size_t i = 0; i < p.n; i++)
        CHECK_NEAR(p.facets.volume[i], 1e-6, 0, 1e-13);
    free_pack(&p);
}

/* Jitter from far below to far above the weld length, through it. */
static void test_small_jitter(void **state)
{
    (void)state;
    struct pack p;
    for (double jitter = 1e-16; jitter < 1e-3; jitter *= 3.1) {
        for (int sides = 0; sides <= 30; sides += 30) {
            make_pack(&p, 5, jitter, sides);
            check_partition(&p, false, 1e-8);
            free_pack(&p);
        }
    }
    make_pack(&p, 8, 1e-12, 0);
    check_partition(&p, false, 1e-11);
    assert_int_equal(p.facets.n_facets, 3 * 8 * 8 * 9);
    assert_int_equal(p.facets.n_vertices, 9 * 9 * 9);
    free_pack(&p);
}

/* Six cells around each axis: narrow facets may have vertices on one long side only. */
static void test_hexagons(void **state)
{
    (void)state;
    for (double jitter = 0; jitter<1e-4; jitter = jitter> 0 ? 7 * jitter : 1e-14) {
        struct pack p = {.n = 0};
        make_domain(&p, 0.05, 0);
        p.seed = brc_alloc(&ctx, 1000, sizeof *p.seed);
        p.radius = brc_alloc(&ctx, 1000, sizeof *p.radius);
        /* rings of six around points of a square grid, in layers */
        for (int i = 0; i < 5 * 5 * 5 * 6; i++) {
            double a = 2 * BRC_PI * (i % 6) / 6, x[3];
            brc_set(x, i / 6 % 5 + 0.5 + 0.25 * cos(a), i / 30 % 5 + 0.5 + 0.25 * sin(a),
                    i / 150 + 0.5);
            for (int k = 0; k < 3; k++)
                x[k] = 0.01 * (x[k] + jitter * (uniform() - 0.5));
            brc_copy(p.seed[p.n++], x);
        }
        check_partition(&p, false, 1e-7);
        free_pack(&p);
    }
}

/* Vertices of a prism that were moved a little return to its edges and corners. */
static void test_settle(void **state)
{
    (void)state;
    struct pack p;
    struct brc_cell_complex c = {.n_cells = 1};
    memset(&p, 0, sizeof p);
    make_domain(&p, 0.05, 30);
    for (size_t v = 0; v < p.domain.n_vertices; v++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = p.domain.vertex[v][k] + 1e-11 * (uniform() - 0.5);
        CHECK_OK(&ctx, brc_cell_complex_add_vertex(&ctx, &c, x));
    }
    for (size_t f = 0; f < p.domain.n_faces; f++) {
        size_t first = p.domain.first[f];
        struct brc_cell_complex_facet facet = {{0, -1}, p.domain.plane[f].id, 0, 0, {0, 0, 0}};
        facet.n = (int32_t)(p.domain.first[f + 1] - first);
        CHECK_OK(&ctx, brc_cell_complex_add_facet(&ctx, &c, &facet, p.domain.loop + first));
    }
    CHECK_OK(&ctx, brc_cell_complex_snap_to_planes(&ctx, &c, &p.domain));
    for (size_t v = 0; v < p.domain.n_vertices; v++)
        CHECK_NEAR_ARRAY(c.vertex[v], p.domain.vertex[v], 3, 1e-15, 0);
    brc_cell_complex_free(&c);
    free_pack(&p);
}

static void test_small_facets(void **state)
{
    (void)state;
    struct pack p;
    make_pack(&p, 6, 1e-3, 0);
    check_partition(&p, false, 1e-7);
    double dropped = 0;
    size_t n = 0;
    for (size_t f = 0; f < p.facets.n_facets; f++)
        if (!p.facets.is_contact[f]) {
            assert_true(p.facets.cell[f][1] >= 0 && p.facets.area[f] < 1e-8);
            dropped += p.facets.area[f];
            n++;
        }
    assert_true(n > 0);
    CHECK_NEAR(p.facets.area_dropped, dropped, 0, 1e-12);
    free_pack(&p);
}

static void test_one_and_two_cells(void **state)
{
    (void)state;
    struct pack p;
    make_pack(&p, 1, 0.5, 0);
    check_partition(&p, false, 1e-14);
    assert_int_equal(p.facets.n_facets, 6);
    free_pack(&p);
    make_pack(&p, 2, 0.1, 0);
    p.n = 2;
    check_partition(&p, false, 1e-14);
    assert_int_equal(p.facets.cell_first[1], 6);
    free_pack(&p);
    /* nearly coincident seeds share the cell fairly */
    make_pack(&p, 2, 0.1, 0);
    brc_copy(p.seed[1], p.seed[0]);
    p.seed[1][0] += 1e-15;
    check_partition(&p, false, 1e-7);
    free_pack(&p);
}

static void test_bad_seeds(void **state)
{
    (void)state;
    struct pack p;
    make_pack(&p, 3, 0.2, 0);
    brc_copy(p.seed[20], p.seed[4]);
    CHECK_FAILS(&ctx, brc_tess_laguerre(&ctx, p.seed, NULL, p.n, &p.domain, 0, &p.facets),
                BRC_ERR_GEOMETRY, "coincide");
    CHECK_FAILS(&ctx, brc_tess_laguerre(&ctx, p.seed, p.radius, p.n, &p.domain, 0, &p.facets),
                BRC_ERR_GEOMETRY, "seeds ");
    free_pack(&p);
    /* a small sphere inside a large one */
    make_pack(&p, 3, 0.2, 0);
    p.radius[13] = 0.0001;
    p.radius[14] = 0.02;
    CHECK_FAILS(&ctx, brc_tess_laguerre(&ctx, p.seed, p.radius, p.n, &p.domain, 0, &p.facets),
                BRC_ERR_GEOMETRY, "has no cell");
    assert_null(p.facets.vertex);
    free_pack(&p);
    make_pack(&p, 3, 0.2, 0);
    p.seed[5][1] = 0.031;
    CHECK_FAILS(&ctx, brc_tess_laguerre(&ctx, p.seed, NULL, p.n, &p.domain, 0, &p.facets),
                BRC_ERR_GEOMETRY, "seed 5 ");
    p.seed[5][1] = NAN;
    CHECK_FAILS(&ctx, brc_tess_laguerre(&ctx, p.seed, NULL, p.n, &p.domain, 0, &p.facets),
                BRC_ERR_GEOMETRY, "seed 5 ");
    free_pack(&p);
}

/* A cell as a convex body agrees with the list, and a damaged list is found. */
static void test_cell_and_damage(void **state)
{
    (void)state;
    struct pack p;
    struct brc_convex c = {0};
    make_pack(&p, 4, 1, 0);
    check_partition(&p, true, 1e-12);
    for (size_t i = 0; i < p.n; i++) {
        double volume, centroid[3], inertia[3][3];
        CHECK_OK(&ctx, brc_facets_cell(&ctx, &p.facets, i, &c));
        brc_convex_mass(&c, &volume, centroid, inertia);
        CHECK_NEAR(volume, p.facets.volume[i], 0, 1e-12);
        CHECK_NEAR_ARRAY(centroid, p.facets.centre[i], 3, 1e-14, 0);
    }
    CHECK_OK(&ctx, brc_facets_verify(&ctx, &p.facets, p.volume, zero));
    double kept = p.facets.vertex[40][0];
    p.facets.vertex[40][0] += 1e-3;
    CHECK_FAILS(&ctx, brc_facets_verify(&ctx, &p.facets, p.volume, zero), BRC_ERR_GEOMETRY,
                "cell ");
    p.facets.vertex[40][0] = kept;
    int32_t swapped = p.facets.loop[3];
    p.facets.loop[3] = p.facets.loop[4];
    CHECK_FAILS(&ctx, brc_facets_verify(&ctx, &p.facets, p.volume, zero), BRC_ERR_GEOMETRY,
                "closed");
    p.facets.loop[3] = swapped;
    CHECK_FAILS(&ctx, brc_facets_verify(&ctx, &p.facets, p.volume * (1 + 1e-11), zero),
                BRC_ERR_GEOMETRY, "volume");
    brc_convex_free(&c);
    free_pack(&p);
}

/* The same shape at 1 cm and at 1 um has the same facets. */
static void test_scale(void **state)
{
    (void)state;
    struct pack p, small;
    make_pack(&p, 5, 1, 0);
    check_partition(&p, true, 1e-12);
    memset(&small, 0, sizeof small);
    make_domain(&small, 0.05 * 0.0001220703125, 0);
    small.n = p.n;
    small.seed = brc_alloc(&ctx, p.n, sizeof *small.seed);
    small.radius = brc_alloc(&ctx, p.n, sizeof *small.radius);
    for (size_t i = 0; i < p.n; i++) {
        brc_scale(small.seed[i], p.seed[i], 0.0001220703125);
        small.radius[i] = p.radius[i] * 0.0001220703125;
    }
    check_partition(&small, true, 1e-12);
    assert_int_equal(small.facets.n_facets, p.facets.n_facets);
    for (size_t f = 0; f < p.facets.n_facets; f++)
        CHECK_NEAR(small.facets.area[f], p.facets.area[f] * 0.0001220703125 * 0.0001220703125, 0,
                   1e-9);
    free_pack(&p);
    free_pack(&small);
}

/* The bars: 8000 cells under 3 s of one core. */
static void test_time(void **state)
{
    (void)state;
    struct pack p;
    struct brc_facets_quality q;
    make_pack(&p, 20, 0.7, 0);
    clock_t start = clock();
    check_partition(&p, true, 1e-12);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    q = brc_facets_quality(&p.facets, p.volume);
    print_message("%zu Laguerre cells: %.2f s, volume error %.1e, closure error %.1e\n", p.n,
                  seconds, q.volume_error, q.closure_error);
#ifndef BRC_DEBUG
    assert_true(seconds < 3);
#endif
    free_pack(&p);
}

static void test_disc(void **state)
{
    (void)state;
    struct brc_facets f, g;
    struct brc_facets_quality q;
    double radius = 0.4, thickness = 0.01, area = 0, largest = 0;
    int sides = 30, count[32] = {0};
    CHECK_OK(&ctx, brc_tess_disc(&ctx, radius, thickness, sides, 5e-4, &f));
    print_message("disc of 30 sides, radius 40 cm, triangles of at most 5 cm2: %zu\n", f.n_cells);
    double exact = sides * radius * radius * sin(2 * BRC_PI / sides) / 2;
    q = brc_facets_quality(&f, exact * thickness);
    CHECK_NEAR(q.volume_error, 0, 1e-13, 0);
    CHECK_NEAR(q.closure_error, 0, 1e-13, 0);
    for (size_t i = 0; i < f.n_facets; i++)
        if (f.cell[i][1] < 0) {
            assert_in_range(f.face[i], 0, sides + 1);
            count[f.face[i]]++;
            if (f.face[i] == 0)
                largest = fmax(largest, f.area[i]);
            if (f.face[i] >= 2)
                area += f.area[i];
        }
    for (int k = 0; k < sides + 2; k++)
        assert_true(count[k] > 0);
    assert_int_equal(count[0], f.n_cells);
    assert_true(largest <= 5e-4);
    CHECK_BETWEEN((double)f.n_cells, exact / 5e-4, 2.5 * exact / 5e-4);
    CHECK_NEAR(area, sides * 2 * radius * sin(BRC_PI / sides) * thickness, 0, 1e-13);
    /* side 0 faces +y */
    for (size_t i = 0; i < f.n_facets; i++)
        if (f.cell[i][1] < 0 && f.face[i] == 2)
            CHECK_NEAR(f.centroid[i][1], radius * cos(BRC_PI / sides), 1e-15, 0);
    CHECK_OK(&ctx, brc_tess_disc(&ctx, radius, thickness, sides, 5e-4, &g));
    assert_int_equal(f.n_vertices, g.n_vertices);
    assert_memory_equal(f.vertex, g.vertex, f.n_vertices * sizeof *f.vertex);
    brc_facets_free(&f);
    brc_facets_free(&g);
    CHECK_FAILS(&ctx, brc_tess_disc(&ctx, radius, thickness, 2, 5e-4, &f), BRC_ERR_GEOMETRY,
                "disc");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_voronoi),
        cmocka_unit_test(test_random_laguerre),
        cmocka_unit_test(test_against_nearest_seed),
        cmocka_unit_test(test_exact_grid),
        cmocka_unit_test(test_small_jitter),
        cmocka_unit_test(test_hexagons),
        cmocka_unit_test(test_settle),
        cmocka_unit_test(test_small_facets),
        cmocka_unit_test(test_one_and_two_cells),
        cmocka_unit_test(test_bad_seeds),
        cmocka_unit_test(test_cell_and_damage),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_time),
        cmocka_unit_test(test_disc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
