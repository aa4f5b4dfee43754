/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimens of a shape that planes bound: the same cells whatever its size, its place and the
 * digits of its planes. */
#include "tests/specimens.h"

#include <stdio.h>

static void test_polyhedron(void **state)
{
    (void)state;
    char path[64];
    struct brc_specimen s;
    struct brc_specimen_params p =
        PARAMS("shape", "polyhedron", "planes", specimens_path(path, "planes"), "count", "60",
               "diameter_min", "4 mm", "diameter_max", "6 mm", "cache", "off");
    /* a tetrahedron with legs of 30 mm; the last normal is not of unit length */
    specimens_write(path, "# nx ny nz d\n-1 0 0 0\n0 -1 0 0\n\n0 0 -1 0 # floor\n2 2 2 0.06\n");
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 0.03 * 0.03 * 0.03 / 6, 0, 1e-11);
    specimens_check_facets(&s);
    brc_specimen_free(&s);
    specimens_write(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1\n");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "planes:3");
    specimens_write(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1 0\n");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_GEOMETRY,
                "bound");
    specimens_write(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1 0\n1 1 1 -0.06\n");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_GEOMETRY,
                "nothing");
    remove(path);
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_IO, "planes");
}

enum { N_PLACES = 30 };
static const double away_from[3] = {0.8, -0.5, 0.3};

static double uniform(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11) / 4503599627370496.0 - 1;
}

/* Cells of 30 seeds in a cuboctahedron of edge sqrt(2) size, its middle at a distance of `far`
 * sizes from the origin; four planes meet in each corner. Digits of the planes; each of them is
 * written `copies` times, as the triangles of a surface give it, each time a digit off. */
static void make_placed(struct brc_specimen *s, double size, double far, int digits, int copies)
{
    char planes[64], points[64];
    uint64_t random = 9;
    FILE *file = fopen(specimens_path(planes, "planes"), "w");
    assert_non_null(file);
    for (int i = 0; i < 14 * copies; i++) {
        int k = i % 14;
        double n[3] = {0, 0, 0}, d = 2 * size;
        if (k < 8)
            brc_set(n, k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
        else
            n[(k - 8) / 2] = k % 2 ? 2 : -2;
        d = d / brc_norm(n) + far * size * brc_dot(n, away_from) / brc_norm(n);
        brc_normalise(n, n);
        for (int j = 0; j < 3; j++)
            n[j] *= 1 + (copies > 1 ? 1e-9 * uniform(&random) : 0);
        fprintf(file, "%.*g %.*g %.*g %.*g\n", digits, n[0], digits, n[1], digits, n[2], digits, d);
    }
    assert_int_equal(fclose(file), 0);
    file = fopen(specimens_path(points, "points"), "w");
    assert_non_null(file);
    random = 4;
    for (int i = 0; i < N_PLACES;) {
        double x[3] = {uniform(&random), uniform(&random), uniform(&random)};
        if (fabs(x[0]) + fabs(x[1]) + fabs(x[2]) > 1.99)
            continue;
        for (int j = 0; j < 3; j++)
            fprintf(file, "%.17g ", size * (0.99 * x[j] + far * away_from[j]));
        fprintf(file, "\n");
        i++;
    }
    assert_int_equal(fclose(file), 0);
    struct brc_specimen_params p =
        PARAMS("shape", "polyhedron", "grains", "points", "planes", planes, "points", points);
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, s));
    remove(planes);
    remove(points);
}

/* Equal neighbours, volumes and areas; sizes in units of the specimen's. */
static void check_same_cells(const struct brc_specimen *s, const struct brc_specimen *reference,
                             double size, double tolerance)
{
    const struct brc_facets *f = &s->facets, *g = &reference->facets;
    assert_int_equal(f->n_cells, g->n_cells);
    assert_int_equal(f->n_facets, g->n_facets);
    assert_memory_equal(f->cell, g->cell, f->n_facets * sizeof *f->cell);
    assert_memory_equal(f->face, g->face, f->n_facets * sizeof *f->face);
    for (size_t i = 0; i < f->n_cells; i++)
        CHECK_NEAR(f->volume[i], g->volume[i] * pow(size, 3), tolerance * pow(size, 3), 0);
    for (size_t i = 0; i < f->n_facets; i++)
        CHECK_NEAR(f->area[i], g->area[i] * size * size, tolerance * size * size, 0);
    CHECK_NEAR(s->domain_volume, reference->domain_volume * pow(size, 3), 0, tolerance);
}

static void test_same_cells_anywhere(void **state)
{
    (void)state;
    static const double sizes[] = {1e-3, 0.1, 1, 30, 1e3}, far[] = {0, 1, 7, 100, 1e4};
    struct brc_specimen reference, s;
    make_placed(&reference, 1, 0, 17, 1);
    CHECK_NEAR(reference.domain_volume, 20. / 3, 0, 1e-13);
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 5; k++)
            for (int nine = 0; nine < 2; nine++) {
                make_placed(&s, sizes[i], far[k], nine ? 9 : 17, nine ? 3 : 1);
                check_same_cells(&s, &reference, sizes[i],
                                 (nine ? 1e-7 : 1e-13) * (1 + 1e1 * far[k]));
                brc_specimen_free(&s);
            }
    brc_specimen_free(&reference);
}

/* Planes at a distance, as a user gave them. */
static void test_away_from_the_origin(void **state)
{
    (void)state;
    char planes[64], points[64];
    struct brc_specimen s;
    struct brc_specimen_params p =
        PARAMS("shape", "polyhedron", "grains", "points", "planes",
               specimens_path(planes, "planes"), "points", specimens_path(points, "points"));
    specimens_write(planes, "1 0 0 1.1\n-1 0 0 -1\n0 1 0 1.1\n0 -1 0 -1\n0 0 1 1.1\n0 0 -1 -1\n");
    specimens_write(points, "1.02 1.05 1.05\n1.08 1.05 1.06\n");
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 1e-3, 0, 1e-14);
    CHECK_NEAR(s.facets.volume[0] + s.facets.volume[1], 1e-3, 0, 1e-14);
    brc_specimen_free(&s);
    remove(planes);
    remove(points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_polyhedron),
        cmocka_unit_test(test_same_cells_anywhere),
        cmocka_unit_test(test_away_from_the_origin),
    };
    return cmocka_run_group_tests(tests, specimens_set_up, specimens_tear_down);
}
