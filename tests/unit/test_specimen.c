/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimens: shapes, grid, packing and its statistics, the cache on disk, bad input. */
#include "tests/near.h"
#include "tests/quality.h"

#include "common/base/table.h"
#include "common/specimen/specimen.h"
#include "common/geometry/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <dirent.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;
static char folder[] = "/tmp/breccia-test-XXXXXX";

/* Defaults with key, value pairs set as in a case file; ends with NULL. */
static struct brc_specimen_params params(const char *const *pairs)
{
    struct brc_specimen_params p;
    CHECK_OK(&ctx, brc_params_defaults(&ctx, brc_specimen_param_list, &p));
    for (; *pairs; pairs += 2)
        CHECK_OK(&ctx, brc_params_set(&ctx, brc_specimen_param_list, &p, "specimen", pairs[0],
                                      pairs[1], "test"));
    return p;
}
#define PARAMS(...) params((const char *const[]){__VA_ARGS__, NULL})

/* Hash of all that a model reads. */
static uint64_t hash(const struct brc_specimen *s)
{
    const struct brc_facets *f = &s->facets;
    uint64_t h = brc_hash_bytes(f->vertex, f->n_vertices * sizeof *f->vertex, BRC_HASH_SEED);
    h = brc_hash_bytes(f->loop, f->first[f->n_facets] * sizeof *f->loop, h);
    h = brc_hash_bytes(f->area, f->n_facets * sizeof *f->area, h);
    h = brc_hash_bytes(f->seed, f->n_cells * sizeof *f->seed, h);
    return brc_hash_bytes(f->radius, f->n_cells * sizeof *f->radius, h);
}

static void check_facets(const struct brc_specimen *s)
{
    struct brc_facets_quality q;
    q = brc_facets_quality(&s->facets, s->domain_volume);
    CHECK_NEAR(q.volume_error, 0, 1e-12, 0);
    CHECK_NEAR(q.closure_error, 0, 1e-11, 0);
    /* every boundary facet lies on the plane of its face */
    for (size_t i = 0; i < s->facets.n_facets; i++) {
        const struct brc_plane *plane = s->domain.plane;
        if (s->facets.cell[i][1] >= 0)
            continue;
        while (plane->id != s->facets.face[i])
            plane++;
        CHECK_NEAR(brc_dot(plane->n, s->facets.centroid[i]), plane->d, 1e-14, 1e-13);
        CHECK_NEAR_ARRAY(s->facets.normal[i], plane->n, 3, 1e-15, 0);
    }
}

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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    assert_int_equal(s.facets.n_cells, 8 * 6 * 4);
    CHECK_NEAR(s.domain_volume, 192e-6, 0, 1e-14);
    check_facets(&s);
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &other));
    assert_int_equal(hash(&s), hash(&other));
    brc_specimen_free(&other);
    p.seed = 2;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &other));
    assert_int_not_equal(hash(&s), hash(&other));
    brc_specimen_free(&other);
    brc_specimen_free(&s);
}

static void test_cubes(void **state)
{
    (void)state;
    struct brc_specimen_params p = PARAMS("shape", "box", "grains", "grid", "size",
                                          "3 cm, 3 cm, 3 cm", "cells", "3, 3, 3", "jitter", "0");
    struct brc_specimen s;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    assert_int_equal(s.facets.n_facets, 54 + 54);
    CHECK_NEAR(mean_contact_distance(&s), 0.01, 0, 1e-14);
    check_facets(&s);
    brc_specimen_free(&s);
}

static void test_cylinder(void **state)
{
    (void)state;
    struct brc_specimen_params p =
        PARAMS("diameter", "30 mm", "height", "20 mm", "sides", "12", "cache", "off");
    struct brc_specimen s;
    double low[3], high[3];
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    /* the area of the circle, flats to +-y */
    CHECK_NEAR(s.domain_volume, BRC_PI * 0.015 * 0.015 * 0.02, 0, 1e-13);
    check_facets(&s);
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    check_packing(&s, (double)(clock() - start) / CLOCKS_PER_SEC);
    check_facets(&s);
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    check_facets(&s);
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 15 * 0.16 * sin(BRC_PI / 15) * 0.01, 0, 1e-13);
    check_facets(&s);
    brc_specimen_free(&s);
}

static char *path_of(char path[64], const char *name)
{
    snprintf(path, 64, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void test_polyhedron(void **state)
{
    (void)state;
    char path[64];
    struct brc_specimen s;
    struct brc_specimen_params p =
        PARAMS("shape", "polyhedron", "planes", path_of(path, "planes"), "count", "60",
               "diameter_min", "4 mm", "diameter_max", "6 mm", "cache", "off");
    /* a tetrahedron with legs of 30 mm; the last normal is not of unit length */
    write_file(path, "# nx ny nz d\n-1 0 0 0\n0 -1 0 0\n\n0 0 -1 0 # floor\n2 2 2 0.06\n");
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 0.03 * 0.03 * 0.03 / 6, 0, 1e-11);
    check_facets(&s);
    brc_specimen_free(&s);
    write_file(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1\n");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "planes:3");
    write_file(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1 0\n");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_GEOMETRY, "bound");
    write_file(path, "-1 0 0 0\n0 -1 0 0\n0 0 -1 0\n1 1 1 -0.06\n");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_GEOMETRY, "nothing");
    remove(path);
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_IO, "planes");
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
    FILE *file = fopen(path_of(planes, "planes"), "w");
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
    file = fopen(path_of(points, "points"), "w");
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
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, s));
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
        PARAMS("shape", "polyhedron", "grains", "points", "planes", path_of(planes, "planes"),
               "points", path_of(points, "points"));
    write_file(planes, "1 0 0 1.1\n-1 0 0 -1\n0 1 0 1.1\n0 -1 0 -1\n0 0 1 1.1\n0 0 -1 -1\n");
    write_file(points, "1.02 1.05 1.05\n1.08 1.05 1.06\n");
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    CHECK_NEAR(s.domain_volume, 1e-3, 0, 1e-14);
    CHECK_NEAR(s.facets.volume[0] + s.facets.volume[1], 1e-3, 0, 1e-14);
    brc_specimen_free(&s);
    remove(planes);
    remove(points);
}

/* What is asked for is refused before work begins, with what is possible. */
static void test_bounds(void **state)
{
    (void)state;
    char planes[64], points[64];
    struct brc_specimen s;
    time_t start = time(NULL);
    /* the volume of the cylinder over 68 mm3, that of a sphere in the mean */
    struct brc_specimen_params p = PARAMS("diameter", "20 mm", "height", "40 mm", "diameter_min",
                                          "4 mm", "diameter_max", "6 mm", "count", "20000");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "at most 184 fit");
    p.count = 185;
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "at most 184 fit");
    p.count = 170;
    p.cache = 0;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    brc_specimen_free(&s);
    p = PARAMS("grains", "mesh", "triangle_area", "1e-12 m2");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "5.03e+09 triangles");
    for (int i = 0; i < 3; i++) {
        static const char *const sizes[] = {"1e-163 m", "1e-105 m", "1e160 m"};
        CHECK_FAILS(&ctx,
                    brc_params_set(&ctx, brc_specimen_param_list, &p, "specimen", "diameter",
                                   sizes[i], "test"),
                    BRC_ERR_INPUT, "allowed");
    }
    p = PARAMS("shape", "polyhedron", "grains", "points", "planes", path_of(planes, "planes"),
               "points", path_of(points, "points"));
    for (int i = 0; i < 2; i++) {
        char text[300];
        double d = i == 0 ? 1e-100 : 1e60;
        snprintf(text, sizeof text, "1 0 0 %g\n-1 0 0 0\n0 1 0 %g\n0 -1 0 0\n0 0 1 %g\n0 0 -1 0\n",
                 d, d, d);
        write_file(planes, text);
        write_file(points, "0 0 0\n");
        CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "specimen measures");
    }
    write_file(planes, "1 0 0 1\n-1 0 0 0\n0 1 0 1\n0 -1 0 0\n0 0 1 1\n0 0 -1 0\n");
    write_file(points, "0.2 0.5 0.5\n0.7 0.5 0.5\n\n0.20000001 0.5 0.5\n");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_GEOMETRY,
                "points:4: the seed at (0.2, 0.5, 0.5) m is 1e-08 m from that of line 1");
    write_file(points, "0.2 0.5 0.5\n0.7 0.5 0.5\n\n0.202 0.5 0.5\n");
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    brc_specimen_free(&s);
    remove(planes);
    remove(points);
    assert_true(time(NULL) - start < 5);
}

/* Whether the specimen of a grid is warned about. */
static bool is_warned(const char *size, const char *cells, char *text, size_t length)
{
    struct brc_specimen s;
    struct brc_specimen_params p =
        PARAMS("shape", "box", "grains", "grid", "size", size, "cells", cells);
    FILE *out = tmpfile();
    int kept = dup(STDERR_FILENO);
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    assert_true(out && kept >= 0 && dup2(fileno(out), STDERR_FILENO) >= 0);
    brc_specimen_warn(&ctx, &s);
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    brc_specimen_free(&s);
    rewind(out);
    text[fread(text, 1, length - 1, out)] = '\0';
    fclose(out);
    return strstr(text, "warning: ") != NULL;
}

static void test_few_grains(void **state)
{
    (void)state;
    char text[400];
    assert_false(is_warned("5 cm, 6 cm, 7 cm", "5, 6, 7", text, sizeof text));
    assert_true(is_warned("6 cm, 4 cm, 7 cm", "6, 4, 7", text, sizeof text));
    assert_non_null(strstr(text, "4.0 grains across along y"));
}

static void test_bad_input(void **state)
{
    (void)state;
    struct brc_specimen s;
    struct brc_specimen_params p = PARAMS("sides", "13", "cache", "off");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "sides");
    p = PARAMS("sides", "2", "cache", "off");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "sides");
    p = PARAMS("grains", "grid");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "box");
    p = PARAMS("grains", "mesh", "shape", "box");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "cylinder");
    p = PARAMS("diameter_min", "7 mm");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "diameter_min");
    p = PARAMS("diameter", "3 mm", "height", "1 mm");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_GEOMETRY, "fit");
    p = PARAMS("shape", "box", "grains", "grid", "size", "4 cm, 2 cm, 2 cm", "cells", "2, 2, 2");
    CHECK_FAILS(&ctx, brc_specimen_create(&ctx, &p, &s), BRC_ERR_INPUT, "cube");
}

/* Name of the only file in the cache folder. */
static void find_cache_file(char path[512])
{
    DIR *dir = opendir(folder);
    struct dirent *entry;
    int n = 0;
    assert_non_null(dir);
    while ((entry = readdir(dir)) != NULL)
        if (entry->d_name[0] != '.') {
            snprintf(path, 512, "%s/%s", folder, entry->d_name);
            n++;
        }
    closedir(dir);
    assert_int_equal(n, 1);
}

/* Through the cache the bits are the same; a damaged file is made anew, and the lack of a folder
 * does no harm. */
static void test_cache(void **state)
{
    (void)state;
    char path[512];
    struct stat info;
    struct brc_specimen_params p =
        PARAMS("diameter", "30 mm", "height", "20 mm", "count", "120", "cache", "on");
    struct brc_specimen s;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    uint64_t first = hash(&s);
    brc_specimen_free(&s);
    find_cache_file(path);
    for (int damage = 0; damage < 4; damage++) {
        assert_int_equal(stat(path, &info), 0);
        if (damage == 1)
            assert_int_equal(truncate(path, info.st_size - 8), 0);
        if (damage == 2)
            assert_int_equal(truncate(path, 0), 0);
        if (damage == 3) {
            FILE *file = fopen(path, "r+b");
            assert_non_null(file);
            fseek(file, info.st_size / 2, SEEK_SET);
            fputs("damage", file);
            fclose(file);
        }
        CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
        assert_int_equal(hash(&s), first);
        brc_specimen_free(&s);
        find_cache_file(path);
    }
    p.cache = 0;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    assert_int_equal(hash(&s), first);
    brc_specimen_free(&s);
    p.cache = 1;
    p.seed = 5;
    setenv("BRECCIA_CACHE", "/proc/no/such/folder", 1);
    ctx.quiet = 1;
    CHECK_OK(&ctx, brc_specimen_create(&ctx, &p, &s));
    ctx.quiet = 0;
    assert_int_not_equal(hash(&s), first);
    setenv("BRECCIA_CACHE", folder, 1);
    brc_specimen_free(&s);
    remove(path);
}

static int set_up(void **state)
{
    (void)state;
    return mkdtemp(folder) && setenv("BRECCIA_CACHE", folder, 1) == 0 ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    return rmdir(folder);
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
        cmocka_unit_test(test_polyhedron),
        cmocka_unit_test(test_same_cells_anywhere),
        cmocka_unit_test(test_away_from_the_origin),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_few_grains),
        cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_cache),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
