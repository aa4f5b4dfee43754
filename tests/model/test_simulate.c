/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objective with real runs of a small block: values reach the model, results come back. */
#include "common/rigs/rigs.h"
#include "calib/simulate.h"
#include "tests/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char case_text[] =
    "breccia: 1\n"
    "specimen: {shape: box, grains: grid, size: [30 mm, 30 mm, 40 mm], cells: [3, 3, 4],\n"
    "           jitter: 0.5}\n"
    "test: {kind: compression, loading: fixed, rate: 4e-6 1/s, strain_max: 0.03}\n"
    "run: {regime: quasi_static, checkpoint_steps: 0}\n";

struct place {
    char dir[64], path[80];
};

static int open_place(void **state)
{
    struct place *p = calloc(1, sizeof *p);
    strcpy(p->dir, "/tmp/breccia_test_simulate_XXXXXX");
    assert_non_null(mkdtemp(p->dir));
    snprintf(p->path, sizeof p->path, "%s/c.yaml", p->dir);
    FILE *file = fopen(p->path, "w");
    assert_non_null(file);
    fputs(case_text, file);
    fclose(file);
    *state = p;
    return 0;
}

static int close_place(void **state)
{
    struct place *p = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", p->dir);
    int code = system(command);
    free(p);
    return code;
}

static const struct calib_variable variables[] = {{"e_bar", 1e9, 1e12}};

static struct calib_targets make_targets(void)
{
    struct calib_targets t = {.title = "block", .n = 2};
    t.target[0] = (struct calib_target){CALIB_YOUNGS_MODULUS, 20e9, 0, ""};
    t.target[1] = (struct calib_target){CALIB_STRENGTH, 100e6, 10e6, ""};
    return t;
}

/* E follows e_bar; the specimen is made once, and equal values give equal bits. */
static void values_reach_the_model(void **state)
{
    struct place *p = *state;
    struct brc_context ctx = {.quiet = 1};
    struct calib_targets t = make_targets();
    struct calib_simulator s = {.dir = p->dir};
    s.path[brc_rigs_find("compression")] = p->path;
    struct calib_objective o = {"vgcm", &t, 1, variables, 0.05, {calib_simulate, &s}};
    struct calib_evaluation v[3];
    const double x[] = {40e9, 80e9, 40e9};
    for (int i = 0; i < 3; i++)
        CHECK_OK(&ctx, calib_objective_evaluate(&ctx, &o, &x[i], &v[i]));
    CHECK_BETWEEN(v[0].residual[0].measured / 40e9, 0.3, 0.8);
    CHECK_BETWEEN(v[1].residual[0].measured / v[0].residual[0].measured, 1.8, 2.2);
    CHECK_NEAR(v[0].residual[0].residual, (v[0].residual[0].measured - 20e9) / 1e9, 0, 1e-12);
    assert_true(v[0].residual[1].measured > 0 && v[0].n_runs == 1 && v[0].cpu_s > 0);
    assert_true(v[2].cost == v[0].cost && v[1].cost != v[0].cost);
    calib_simulator_free(&s);
    assert_int_equal(s.specimen[brc_rigs_find("compression")].facets.n_cells, 0);
}

static void bad_runs_are_named(void **state)
{
    struct place *p = *state;
    struct brc_context ctx = {.quiet = 1};
    struct calib_targets t = make_targets();
    struct calib_simulator s = {.dir = p->dir};
    s.path[brc_rigs_find("tension")] = p->path;
    struct calib_objective o = {"vgcm", &t, 1, variables, 0.05, {calib_simulate, &s}};
    struct calib_evaluation v;
    const double x[] = {40e9};
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT,
                "needs the compression test, but no case file is given for it");
    t.target[0].quantity = CALIB_TENSILE_STRENGTH;
    t.n = 1;
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT,
                "is given as the tension test, but its test.kind is compression");
    FILE *file = fopen(p->path, "w");
    assert_non_null(file);
    fputs("breccia: 1\ntest: {kind: none}\n", file);
    fclose(file);
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT,
                "is given as the tension test, but its test.kind is none");
    o.model = "vgmc";
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT, "vgmc");
    calib_simulator_free(&s);
}

static void assignments_are_exact(void **state)
{
    static const struct brc_param params[] = {
        {.key = "a", .kind = BRC_REAL, .unit = "Pa", .default_text = "1 Pa", .meaning = "a"},
        {.key = "b",
         .kind = BRC_REAL,
         .unit = "1",
         .default_text = "1",
         .offset = 8,
         .meaning = "b"},
    };
    static const struct calib_variable free_ones[] = {{"a", 0, 1}, {"b", 0, 1}, {"c", 0, 1}};
    struct brc_param_list list = {params, 2, 16};
    struct brc_context ctx = BRC_CONTEXT_INIT;
    const double x[] = {1.0 / 3, 0.1, 0};
    struct calib_trial trial = {"m", brc_rigs_find("compression"), 3, free_ones, x};
    char text[64];
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        double back = 0;
        CHECK_OK(&ctx, calib_assignment(&ctx, &trial, i, list, text, sizeof text));
        const char *equals = strchr(text, '=');
        assert_non_null(equals);
        CHECK_OK(&ctx, brc_params_quantity(&ctx, equals + 1, params[i].unit, &back, "here"));
        assert_true(back == x[i]);
        assert_int_equal(strncmp(text, i ? "m.b=" : "m.a=", 4), 0);
    }
    CHECK_FAILS(&ctx, calib_assignment(&ctx, &trial, 2, list, text, sizeof text), BRC_ERR_INPUT,
                "m.c is not a quantity of the model");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(values_reach_the_model, open_place, close_place),
        cmocka_unit_test_setup_teardown(bad_runs_are_named, open_place, close_place),
        cmocka_unit_test(assignments_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
