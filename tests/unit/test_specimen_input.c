/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimens that are refused, before work begins, or warned about. */
#include "tests/specimens.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

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
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "at most 184 fit");
    p.count = 185;
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "at most 184 fit");
    p.count = 170;
    p.cache = 0;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    brc_specimen_free(&s);
    p = PARAMS("grains", "mesh", "triangle_area", "1e-12 m2");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "5.03e+09 triangles");
    for (int i = 0; i < 3; i++) {
        static const char *const sizes[] = {"1e-163 m", "1e-105 m", "1e160 m"};
        CHECK_FAILS(&specimens_ctx,
                    brc_params_set(&specimens_ctx, brc_specimen_param_list, &p, "specimen",
                                   "diameter", sizes[i], "test"),
                    BRC_ERR_INPUT, "allowed");
    }
    p = PARAMS("shape", "polyhedron", "grains", "points", "planes",
               specimens_path(planes, "planes"), "points", specimens_path(points, "points"));
    for (int i = 0; i < 2; i++) {
        char text[300];
        double d = i == 0 ? 1e-100 : 1e60;
        snprintf(text, sizeof text, "1 0 0 %g\n-1 0 0 0\n0 1 0 %g\n0 -1 0 0\n0 0 1 %g\n0 0 -1 0\n",
                 d, d, d);
        specimens_write(planes, text);
        specimens_write(points, "0 0 0\n");
        CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                    "specimen measures");
    }
    specimens_write(planes, "1 0 0 1\n-1 0 0 0\n0 1 0 1\n0 -1 0 0\n0 0 1 1\n0 0 -1 0\n");
    specimens_write(points, "0.2 0.5 0.5\n0.7 0.5 0.5\n\n0.20000001 0.5 0.5\n");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_GEOMETRY,
                "points:4: the seed at (0.2, 0.5, 0.5) m is 1e-08 m from that of line 1");
    specimens_write(points, "0.2 0.5 0.5\n0.7 0.5 0.5\n\n0.202 0.5 0.5\n");
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
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
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    assert_true(out && kept >= 0 && dup2(fileno(out), STDERR_FILENO) >= 0);
    brc_specimen_warn(&specimens_ctx, &s);
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
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "sides");
    p = PARAMS("sides", "2", "cache", "off");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "sides");
    p = PARAMS("grains", "grid");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT, "box");
    p = PARAMS("grains", "mesh", "shape", "box");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "cylinder");
    p = PARAMS("diameter_min", "7 mm");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT,
                "diameter_min");
    p = PARAMS("diameter", "3 mm", "height", "1 mm");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_GEOMETRY,
                "fit");
    p = PARAMS("shape", "box", "grains", "grid", "size", "4 cm, 2 cm, 2 cm", "cells", "2, 2, 2");
    CHECK_FAILS(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s), BRC_ERR_INPUT, "cube");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_few_grains),
        cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, specimens_set_up, specimens_tear_down);
}
