/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every test with specimens of every shape, cells read from a file among them: it runs, or says why
 * it cannot. */
#include "common/specimen/neper.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define GRAINS "; grains: packing; diameter_min: 5 mm; diameter_max: 7 mm; seed: 2"
#define WEIGHT "gravity: 0 m/s2, 0 m/s2, -9.81 m/s2"

static char folder[] = "/tmp/breccia-test-shapes-XXXXXX";

/* Shapes are settings with the folder in the place of @. */
enum { BOX, CORE, HEXAGON, FRUSTUM, OCTAHEDRON, TILTED, LENS, READ_BOX, READ_CORE, N_SHAPES };
static const struct shape {
    const char *name, *settings;
    const char *planes; /* file `name`; NULL: none */
    int written;        /* the cells of that shape, as a file of Neper; -1: of none */
} shapes[N_SHAPES] = {
    [BOX] = {"box", "shape: box; size: 2 cm, 2 cm, 2 cm" GRAINS, NULL, -1},
    [CORE] = {"core", "shape: cylinder; diameter: 2 cm; height: 2 cm" GRAINS, NULL, -1},
    [HEXAGON] = {"hexagon", "shape: polyhedron; planes: @/hexagon" GRAINS,
                 "0 0 -1 0\n0 0 1 0.03\n0 1 0 0.01\n0 -1 0 0.01\n"
                 "0.86602540378443865 0.5 0 0.01\n-0.86602540378443865 0.5 0 0.01\n"
                 "0.86602540378443865 -0.5 0 0.01\n-0.86602540378443865 -0.5 0 0.01\n",
                 -1},
    [FRUSTUM] = {"frustum", "shape: polyhedron; planes: @/frustum" GRAINS,
                 "0 0 -1 0\n0 0 1 0.03\n1 0 0.1 0.012\n-1 0 0.1 0.012\n0 1 0.1 0.012\n"
                 "0 -1 0.1 0.012\n",
                 -1},
    [OCTAHEDRON] = {"octahedron", "shape: polyhedron; planes: @/octahedron" GRAINS,
                    "1 1 1 0.016\n1 1 -1 0.016\n1 -1 1 0.016\n1 -1 -1 0.016\n-1 1 1 0.016\n"
                    "-1 1 -1 0.016\n-1 -1 1 0.016\n-1 -1 -1 0.016\n",
                    -1},
    /* a cube, by 20 degrees about x */
    [TILTED] = {"tilted", "shape: polyhedron; planes: @/tilted" GRAINS,
                "1 0 0 0.01\n-1 0 0 0.01\n"
                "0 0.93969262078590843 0.34202014332566871 0.01\n"
                "0 -0.93969262078590843 -0.34202014332566871 0.01\n"
                "0 -0.34202014332566871 0.93969262078590843 0.01\n"
                "0 0.34202014332566871 -0.93969262078590843 0.01\n",
                -1},
    /* two pyramids, base to base: all of the surface faces z */
    [LENS] = {"lens", "shape: polyhedron; planes: @/lens" GRAINS,
              "0.4 0 1 0.01\n-0.4 0 1 0.01\n0 0.4 1 0.01\n0 -0.4 1 0.01\n0.4 0 -1 0.01\n"
              "-0.4 0 -1 0.01\n0 0.4 -1 0.01\n0 -0.4 -1 0.01\n",
              -1},
    [READ_BOX] = {"read-box", "shape: polyhedron; grains: tess; tess: @/read-box", NULL, BOX},
    [READ_CORE] = {"read-core", "shape: polyhedron; grains: tess; tess: @/read-core", NULL, CORE}};

static void make(struct fixture *f, int shape)
{
    char text[400], *out = text;
    for (const char *at = shapes[shape].settings; *at; at++)
        out += *at == '@' ? sprintf(out, "%s", folder) : sprintf(out, "%c", *at);
    fixture_specimen(f, text);
}

static FILE *open_file(const struct shape *s)
{
    char path[64];
    snprintf(path, sizeof path, "%s/%s", folder, s->name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    return out;
}

static void write_files(struct fixture *f)
{
    for (int i = 0; i < N_SHAPES; i++) {
        const struct shape *s = &shapes[i];
        if (s->planes) {
            FILE *out = open_file(s);
            fputs(s->planes, out);
            assert_int_equal(fclose(out), 0);
        }
        if (s->written >= 0) {
            make(f, s->written);
            FILE *out = open_file(s);
            CHECK_OK(&f->ctx, brc_neper_write(&f->ctx, out, &f->specimen));
            assert_int_equal(fclose(out), 0);
        }
    }
}

static void remove_files(void)
{
    for (int i = 0; i < N_SHAPES; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", folder, shapes[i].name);
        unlink(path);
    }
    rmdir(folder);
}

static const char tilted[] = "is tilted by 20 degrees against its platen",
                  no_ends[] = "none of the specimen's surface faces the platen at the lower end",
                  rough[] = "the lower end along z, so that its platen has nothing to hold",
                  no_box[] = "true_triaxial needs a box along the axes",
                  no_prism[] = "a cantilever needs a prism with flat ends",
                  no_faces[] = "a Brazilian test needs a disc, or a prism, with flat faces",
                  no_disc[] = "a Brazilian test between planes needs a disc along z",
                  no_sides[] = "so there are no sides for test.kind: triaxial";

/* What each says of each shape; NULL: it runs. */
static const struct {
    const char *test, *run;
    const char *error[N_SHAPES];
} tests[] = {
    {"compression", "", {[OCTAHEDRON] = no_ends, [TILTED] = tilted}},
    {"tension", "", {[OCTAHEDRON] = no_ends, [TILTED] = tilted, [LENS] = rough}},
    {"triaxial", "", {[OCTAHEDRON] = no_ends, [TILTED] = tilted, [LENS] = no_sides}},
    {"true_triaxial",
     "",
     {[CORE] = no_box,
      [HEXAGON] = no_box,
      [FRUSTUM] = no_box,
      [OCTAHEDRON] = no_box,
      [TILTED] = no_box,
      [LENS] = no_box,
      [READ_CORE] = no_box}},
    /* a cube that is turned about x is a beam along x */
    {"cantilever", "", {[FRUSTUM] = no_prism, [OCTAHEDRON] = no_prism, [LENS] = no_prism}},
    {"brazilian",
     "",
     {[BOX] = no_disc,
      [HEXAGON] = no_disc,
      [FRUSTUM] = no_faces,
      [OCTAHEDRON] = no_faces,
      [TILTED] = no_faces,
      [LENS] = no_faces,
      [READ_BOX] = no_disc}},
    {"brazilian; plate_width: 3 mm",
     "",
     {[FRUSTUM] = no_faces, [OCTAHEDRON] = no_faces, [TILTED] = no_faces, [LENS] = no_faces}},
    {"none", WEIGHT, {NULL}}};
enum { N_TESTS = sizeof tests / sizeof tests[0] };

/* It is loaded, at the latest when the platens have come to the tips of a lens; energies balance.
 */
static void run(struct fixture *f)
{
    const struct brc_ledger *l = &f->sim.ledger;
    do
        fixture_steps(f, 60);
    while (l->boundary == 0 && l->gravity == 0 && f->sim.step < 3000);
    CHECK_BETWEEN(brc_ledger_residual(l), 0, 1e-3);
    assert_true(l->boundary != 0 || l->gravity != 0);
}

static void every_test_runs_or_says_why_not(void **state)
{
    struct fixture *f = *state;
    assert_non_null(mkdtemp(folder));
    write_files(f);
    for (int shape = 0; shape < N_SHAPES; shape++) {
        make(f, shape);
        for (int i = 0; i < N_TESTS; i++)
            for (int m = 0; m < brc_registry_count(); m++) {
                char test[64];
                const char *error = tests[i].error[shape];
                snprintf(test, sizeof test, "kind: %s", tests[i].test);
                int code = fixture_try_sim(f, brc_registry_at(m), "", test, "", tests[i].run);
                if (code == 0 && !error)
                    run(f);
                else if (code == 0 || !error || !strstr(f->ctx.message, error))
                    fail_msg("%s, %s, %s: %s; expected: %s", shapes[shape].name, tests[i].test,
                             brc_registry_at(m)->name, code ? f->ctx.message : "runs",
                             error ? error : "runs");
                brc_error_clear(&f->ctx);
            }
    }
    remove_files();
}

int main(void)
{
    const struct CMUnitTest all[] = {FIXTURE_TEST(every_test_runs_or_says_why_not)};
    return cmocka_run_group_tests(all, NULL, NULL);
}
