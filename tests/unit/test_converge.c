/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The statistics of a ladder on numbers whose answer is known by hand, and the judgement of a study
 * that is made up: reference, uncertainty, cheapest settings. */
#include "common/runs/converge_axes.h"
#include "common/runs/converge_table.h"
#include "tests/near.h"

#include <stdio.h>
#include <stdlib.h>

static void test_error(void **state)
{
    (void)state;
    const double value[] = {11, 9, 10.5, NAN}, reference[] = {10, 8, 12, 7};
    struct brc_converge_error e = brc_converge_error(value, reference, 4);
    assert_int_equal(e.n, 3);
    CHECK_NEAR(e.mean, 0.5 / 30, 0, 1e-12);
    /* differences 1, 1, -1.5: variance 25/12 */
    CHECK_NEAR(e.deviation, sqrt(25.0 / 12 / 3) / 10, 0, 1e-12);
    CHECK_NEAR(e.single, sqrt(4.25 / 3) / 10, 0, 1e-12);
    e = brc_converge_error(value, reference, 1);
    CHECK_NEAR(e.mean, 0.1, 0, 1e-12);
    assert_true(isnan(e.deviation));
    const double none[] = {NAN};
    assert_true(isnan(brc_converge_error(none, reference, 1).mean));
    const double below[] = {-9}, negative[] = {-10};
    CHECK_NEAR(brc_converge_error(below, negative, 1).mean, 0.1, 0, 1e-12);
}

static void test_moments(void **state)
{
    (void)state;
    double odd[] = {3, 1, 2}, even[] = {4, 1, 3, 2};
    CHECK_NEAR(brc_converge_median(odd, 3), 2, 0, 0);
    CHECK_NEAR(brc_converge_median(even, 4), 2.5, 0, 0);
    assert_true(isnan(brc_converge_median(odd, 0)));
    CHECK_NEAR(brc_converge_scatter(odd, 3), 0.5, 0, 1e-12);
    assert_true(isnan(brc_converge_scatter(odd, 1)));
    const struct brc_converge_error loading = {.mean = 0.03, .deviation = 0.01},
                                    step = {.mean = -0.04, .deviation = 0.02};
    CHECK_NEAR(brc_converge_uncertainty(&loading, &step), sqrt(25e-4 + 2e-4), 0, 1e-12);
}

/* Two ladders; the coarsest rung of the first is right by chance, and is cheapest of all. */
static const struct brc_converge_rung rungs[] = {
    {.ladder = 0, .fineness = 8, .error = 0.001, .cost = 80},
    {.ladder = 0, .fineness = 4, .error = -0.008, .cost = 40},
    {.ladder = 0, .fineness = 2, .error = 0.02, .cost = 20},
    {.ladder = 0, .fineness = 1, .error = -0.2, .cost = 10},
    {.ladder = 0, .fineness = 0.5, .error = 0.0001, .cost = 5},
    {.ladder = 7, .fineness = 2, .error = 0.005, .cost = 60},
    {.ladder = 7, .fineness = 1, .error = 0.04, .cost = 12},
    {.ladder = 7, .fineness = 0.5, .error = NAN, .cost = 1},
};
enum { N_RUNGS = sizeof rungs / sizeof rungs[0] };

static void test_cheapest(void **state)
{
    (void)state;
    assert_int_equal(brc_converge_cheapest(rungs, N_RUNGS, 0.01), 1);
    assert_int_equal(brc_converge_cheapest(rungs, N_RUNGS, 0.05), 6);
    assert_int_equal(brc_converge_cheapest(rungs, N_RUNGS, 0.0005), -1);
    assert_false(brc_converge_is_within(rungs, N_RUNGS, 4, 0.05));
    assert_true(brc_converge_is_within(rungs, N_RUNGS, 4, 0.3));
    assert_false(brc_converge_is_within(rungs, N_RUNGS, 7, 0.3));
}

static void test_cost(void **state)
{
    (void)state;
    /* between error 0.02 at 20 and 0.2 at 10, half way in the logarithm */
    struct brc_converge_cost c = brc_converge_cost(rungs, N_RUNGS, 0, sqrt(0.02 * 0.2));
    CHECK_NEAR(c.cost, sqrt(200), 0, 1e-12);
    assert_false(c.is_bound);
    c = brc_converge_cost(rungs, N_RUNGS, 0, 0.5);
    CHECK_NEAR(c.cost, 5, 0, 0);
    assert_true(c.is_bound);
    c = brc_converge_cost(rungs, N_RUNGS, 7, 0.05);
    CHECK_NEAR(c.cost, 12, 0, 0);
    assert_false(c.is_bound);
    assert_true(isnan(brc_converge_cost(rungs, N_RUNGS, 0, 0.0005).cost));
}

/* ---- a made-up study ----------------------------------------------------------------------- */

enum { N_SEEDS = 2 };

static void put(struct brc_converge_model *m, enum brc_converge_role role, const char *axis,
                double fineness, const double value[N_SEEDS], double cpu_s)
{
    struct brc_converge_setting *s = &m->setting[m->n];
    *s = (struct brc_converge_setting){.axis = axis, .role = role, .fineness = fineness};
    snprintf(s->label, sizeof s->label, "number=%d", m->n);
    for (int i = 0; i < N_SEEDS; i++) {
        s->run[i] = (struct brc_converge_run){.key = (uint64_t)(100 * m->n + i),
                                              .is_done = true,
                                              .ended_by = "test.stop_drop",
                                              .steps = (int64_t)(1000 * cpu_s),
                                              .cpu_s = cpu_s};
        s->run[i].result[1] = value[i];
    }
    m->n++;
}

static void make_study(struct brc_converge_study *study, struct brc_converge_setting *settings)
{
    struct brc_converge_model *m = &study->model[0];
    study->results[1] = (struct brc_result){.name = "strength", .value = 0, .unit = "Pa"};
    study->n_results = 2;
    study->observable = 1;
    study->n_models = 1;
    m->model = brc_registry_at(0);
    m->setting = settings;
    put(m, BRC_CONVERGE_CASE, "case", 1, (double[]){102e6, 204e6}, 10);
    put(m, BRC_CONVERGE_REFERENCE, "reference", 1, (double[]){100e6, 200e6}, 160);
    put(m, BRC_CONVERGE_REFERENCE, "reference", 1, (double[]){100e6, 203e6}, 80);
    put(m, BRC_CONVERGE_REFERENCE, "reference", 1, (double[]){101e6, 202e6}, 40);
    put(m, BRC_CONVERGE_LADDER, "loading", 8, (double[]){100e6, 203e6}, 80);
    put(m, BRC_CONVERGE_LADDER, "loading", 1, (double[]){102e6, 204e6}, 10);
    put(m, BRC_CONVERGE_LADDER, "loading", 0.5, (double[]){108e6, 206e6}, 5);
    put(m, BRC_CONVERGE_LADDER, "rate", 1, (double[]){101e6, 201e6}, 100);
    put(m, BRC_CONVERGE_LADDER, "rate", 0.5, (double[]){112e6, 224e6}, 50);
    put(m, BRC_CONVERGE_CHOICE, "points", 1, (double[]){51e6, 102e6}, 10);
    m->setting[5].run[0].key = m->setting[0].run[0].key;
}

static void test_judge(void **state)
{
    (void)state;
    static struct brc_converge_study study;
    static struct brc_converge_setting settings[16];
    static struct brc_converge_report report;
    static struct brc_case run_case;
    const struct brc_converge_options order = {.run = {.run_case = &run_case}, .seeds = N_SEEDS};
    study.options = &order;
    make_study(&study, settings);
    brc_converge_report_make(&study, 0, &report);
    CHECK_NEAR(report.reference, 150e6, 0, 1e-12);
    CHECK_NEAR(report.scatter, sqrt(0.5) / 1.5, 0, 1e-12);
    CHECK_NEAR(report.step.mean, 0.01, 0, 1e-12);
    CHECK_NEAR(report.loading.mean, 0, 0, 1e-12);
    /* differences 0, 3 and 1, -1: standard errors 1.5 and 1 */
    CHECK_NEAR(report.uncertainty, sqrt(1e-4 + 0.5 * pow(1.5 / 150, 2)), 0, 1e-3);
    CHECK_NEAR(report.row[0].error.mean, 0.02, 0, 1e-12);
    CHECK_NEAR(report.row[9].error.mean, -0.5, 0, 1e-12);
    CHECK_NEAR(report.row[6].steps, 5000, 0, 0);
    assert_true(report.row[5].is_case);
    assert_false(report.row[4].is_case);
    assert_int_equal(report.cheapest[0], 4);
    assert_int_equal(report.cheapest[1], 6);
    assert_false(brc_converge_is_shown(&report, 4, 0.01));
    assert_true(brc_converge_is_shown(&report, 4, 0.05));
    assert_false(brc_converge_is_shown(&report, 6, 0.05));
    assert_true(brc_converge_is_shown(&report, 6, 0.07));
    /* a rung that lost a run has no error, and spoils what is coarser */
    snprintf(settings[5].run[1].ended_by, sizeof settings[5].run[1].ended_by, "failure");
    brc_converge_report_make(&study, 0, &report);
    assert_true(isnan(report.row[5].error.mean));
    assert_int_equal(report.row[5].n_good, 1);
    assert_int_equal(report.cheapest[1], 4);
    /* and so does one whose load was still rising at the end */
    snprintf(settings[5].run[1].ended_by, sizeof settings[5].run[1].ended_by, "test.strain_max");
    settings[5].run[1].result[1] = NAN;
    brc_converge_report_make(&study, 0, &report);
    assert_true(isnan(report.row[5].error.mean));
    assert_int_equal(report.row[5].n_good, 1);
}

static void test_print(void **state)
{
    (void)state;
    static struct brc_converge_study study;
    static struct brc_converge_setting settings[16];
    static struct brc_converge_report report;
    static struct brc_case run_case;
    const struct brc_converge_options order = {.run = {.run_case = &run_case}, .seeds = N_SEEDS};
    char *text = NULL;
    size_t size = 0;
    study.options = &order;
    make_study(&study, settings);
    brc_converge_report_make(&study, 0, &report);
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    brc_converge_print(out, &study, &report);
    fclose(out);
    assert_non_null(strstr(text, "reference strength 150.0 MPa"));
    assert_non_null(strstr(text, "cheapest within 5 %: loading number=6, 5000 steps, 5.000 s"));
    /* errors 2 % at 10000 and 4.67 % at 5000 steps; 0.67 % at 100000 and 12 % at 50000 */
    assert_non_null(
        strstr(text, " 5.00 %: at most 5000 against 61681, fixed takes 12.34 times as many"));
    assert_non_null(strstr(text, " 2.00 %: 10000 against 76839, fixed takes 7.68 times as many"));
    assert_non_null(strstr(text, "as written,  2.00 %: 10000 against 76839"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_error),    cmocka_unit_test(test_moments),
        cmocka_unit_test(test_cheapest), cmocka_unit_test(test_cost),
        cmocka_unit_test(test_judge),    cmocka_unit_test(test_print),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
