/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a test reports: values that were measured, and why others were not. */
#include "common/engine/accounts.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>

static const char elastic[] = "interaction: all; sigma_t: 1e3 MPa; tau: 1e3 MPa; softening: none",
                  weak[] = "interaction: all; sigma_t: 1 MPa; tau: 8 MPa; softening: none",
                  pull[] = "kind: tension; loading: fixed; rate: 1e-6 1/s; strain_max: 3e-4; "
                           "stop_drop: 0.2";

static void load(struct fixture *f, const char *model, const char *test, int most)
{
    fixture_sim(f, brc_registry_find("vgcm"), model, test, "");
    while (!brc_rigs_done(&f->sim) && f->sim.step < most)
        fixture_steps(f, 1);
}

static void check_measured(const struct fixture *f, const char *name)
{
    struct brc_result r = fixture_result(f, name);
    if (r.note || !isfinite(r.value))
        fail_msg("%s = %g: %s", name, r.value, r.note ? r.note : "without a note");
}

static void check_missing(const struct fixture *f, const char *name, const char *note)
{
    struct brc_result r = fixture_result(f, name);
    if (!isnan(r.value) || !r.note || !strstr(r.note, note))
        fail_msg("%s = %g, expected none: %s; the note is %s", name, r.value, note, r.note);
}

static void a_load_that_rises_has_no_strength(void **state)
{
    struct fixture *f = *state;
    const char *const of_the_peak[] = {"strength", "strain_at_peak", "force_peak"};
    fixture_grid(f, 3, 3, 6, 0.01, 0.7);
    load(f, elastic, pull, 1000);
    for (int i = 0; i < 3; i++)
        check_missing(f, of_the_peak[i], "the load was still rising");
    check_missing(f, "ci_broken", "the load was still rising");
    check_measured(f, "E");
    check_measured(f, "nu");
    CHECK_BETWEEN(fixture_result(f, "E_r2").value, 0.99, 1); /* elastic */
    assert_true(f->sim.rig.force_peak > 0);
    load(f, weak, pull, 1000);
    assert_true(f->sim.events.table.n > 0);
    for (int i = 0; i < 3; i++)
        check_measured(f, of_the_peak[i]);
    check_measured(f, "ci_broken");
    fixture_specimen(f, "shape: cylinder; diameter: 3 cm; height: 2 cm; diameter_min: 8 mm; "
                        "diameter_max: 1 cm");
    load(f, elastic, "kind: brazilian; loading: fixed; rate: 1e-6 1/s; strain_max: 1e-4", 1000);
    check_missing(f, "S", "the load was still rising");
    check_missing(f, "strength", "the load was still rising");
}

static void without_a_row_nothing_is_measured(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 3, 3, 4, 0.01, 0.7);
    load(f, elastic, "kind: tension; loading: fixed; rate: 1e-6 1/s; sample_steps: 100", 99);
    assert_int_equal(f->sim.rig.curve.table.n, 0);
    const char *const names[] = {"E",        "nu",       "E_platen",       "E_r2",
                                 "nu_r2",    "strength", "strain_at_peak", "force_peak",
                                 "ci_broken"};
    for (int i = 0; i < 9; i++)
        check_missing(f, names[i], "fewer steps than test.sample_steps");
}

/* A middle layer alone has no strain but that of its round-off. */
static void moduli_need_a_gauge(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 3, 3, 3, 0.01, 0);
    load(f, elastic, pull, 1000);
    check_missing(f, "E", "fewer than 4 grains in the gauge");
    check_missing(f, "nu", "fewer than 4 grains in the gauge");
    check_measured(f, "E_platen");
    assert_true(isnan(f->sim.rig.curve.strain_axial[5]));
    fixture_grid(f, 3, 3, 4, 0.01, 0);
    load(f, elastic, pull, 1000);
    check_measured(f, "E");
    check_measured(f, "nu");
    fixture_grid(f, 1, 1, 8, 0.01, 0); /* a column has no width */
    load(f, elastic, pull, 1000);
    check_measured(f, "E");
    check_missing(f, "nu", "across the load");
    fixture_grid(f, 1, 1, 4, 0.01, 0); /* two grains */
    load(f, elastic, pull, 1000);
    check_missing(f, "E", "fewer than 4 grains in the gauge");
}

/* A curve that is made up: `rows` rows of the way up lie between modulus_low and modulus_high. */
static void make_curve(struct fixture *f, int rows)
{
    struct brc_rig *rig = &f->sim.rig;
    const double low = rig->params.modulus_low, high = rig->params.modulus_high;
    for (int i = 0; i < rows + 3; i++) {
        size_t k;
        CHECK_OK(&f->ctx, brc_rig_add_row(&f->ctx, rig, &k));
        double part = low + (i + 0.5) * (high - low) / rows; /* of the peak */
        part = i < rows ? part : i < rows + 2 ? 0.5 * (i - rows + 1) : 0.2;
        rig->curve.step[k] = 10 * (i + 1);
        rig->curve.force[k] = part;
        rig->curve.stress[k] = part * 1e6;
        rig->curve.strain[k] = rig->curve.strain_axial[k] = 1e-4 * (part + (i == 1 ? 0.01 : 0));
        rig->curve.strain_lateral[k] = -2e-5 * part;
    }
    rig->force_peak = 1;
    rig->strain_peak = 1e-4;
    memset(rig->has_gauge, true, sizeof rig->has_gauge);
}

/* R2 of points of which one is off the line, by the definition; a line through two points is none
 * that rows have shown. */
static void moduli_say_how_well_they_fit(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 2, 2, 2, 0.01, 0);
    fixture_sim(f, brc_registry_find("vgcm"), elastic, "", "");
    make_curve(f, 2);
    check_measured(f, "E");
    check_measured(f, "nu");
    check_missing(f, "E_r2", "only 2 rows");
    check_missing(f, "nu_r2", "only 2 rows");
    fixture_sim(f, brc_registry_find("vgcm"), elastic, "", "");
    make_curve(f, 4);
    const struct brc_curve *c = &f->sim.rig.curve;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (int i = 0; i < 4; i++) {
        x += c->strain_axial[i] / 4;
        y += c->stress[i] / 4;
    }
    for (int i = 0; i < 4; i++) {
        xx += (c->strain_axial[i] - x) * (c->strain_axial[i] - x);
        yy += (c->stress[i] - y) * (c->stress[i] - y);
        xy += (c->strain_axial[i] - x) * (c->stress[i] - y);
    }
    CHECK_NEAR(fixture_result(f, "E").value, xy / xx, 0, 1e-9);
    CHECK_NEAR(fixture_result(f, "E_r2").value, xy * xy / (xx * yy), 0, 1e-9);
    assert_true(fixture_result(f, "E_r2").value < 0.99);
}

/* Cracks of which the first is smaller than a hundredth of what is broken at the peak; one that
 * breaks behind the peak does not count. */
static void the_first_percent_of_the_cracks_has_a_stress(void **state)
{
    struct fixture *f = *state;
    const int64_t step[] = {15, 25, 45, 58, 65};
    const double area[] = {0.009, 0.002, 0.49, 0.5, 100};
    fixture_grid(f, 2, 2, 2, 0.01, 0);
    fixture_sim(f, brc_registry_find("vgcm"), elastic, "", "");
    make_curve(f, 4);
    check_missing(f, "ci_broken", "nothing had broken at the peak");
    for (int i = 0; i < 5; i++) {
        const struct brc_event event = {.a = i, .b = i + 1, .n = {0, 0, 1}, .area = area[i]};
        brc_events_add(&f->ctx, &f->sim.events, step[i], &event);
    }
    const struct brc_curve *c = &f->sim.rig.curve;
    assert_true(c->step[2] == 30 && c->force[5] == 1);
    CHECK_NEAR(fixture_result(f, "ci_broken").value, c->stress[2], 0, 1e-12);
}

/* `stop_drop: 0` is never, also when the specimen pulls the platens together. */
static void a_test_ends_at_no_drop(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 3, 3, 4, 0.01, 0.7);
    load(f, weak, pull, 1000);
    struct brc_rig *rig = &f->sim.rig;
    assert_true(f->sim.events.table.n > 0 && rig->strain < rig->params.strain_max);
    rig->curve.force[rig->curve.table.n - 1] = -1e-3 * rig->force_peak;
    assert_true(brc_rigs_done(&f->sim));
    rig->params.stop_drop = 0;
    assert_false(brc_rigs_done(&f->sim));
}

static void platens_that_meet_end_the_run(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 2, 2, 2, 0.01, 0.5);
    fixture_sim(f, brc_registry_find("vgcm"), "", "loading: fixed; rate: 1e-6 1/s", "");
    fixture_steps(f, 2);
    f->sim.rig.strain = 1 - 1e-7;
    CHECK_FAILS(&f->ctx, f->sim.rig.type->drive(&f->sim), BRC_ERR_BLOWUP,
                "the platens have met at step 2, at a strain of 1: lower test.strain_max");
    fixture_sim(f, brc_registry_find("vgcm"), "", "kind: tension; loading: fixed; rate: 1e-6 1/s",
                "");
    f->sim.rig.strain = 1;
    CHECK_OK(&f->ctx, f->sim.rig.type->drive(&f->sim));
}

/* A grip holds the end grains. A grain behind them that the skin lists is not glued to the platen,
 * however wide the skin is. */
static void a_grip_holds_end_grains_alone(void **state)
{
    struct fixture *f = *state;
    const char *const grips[] = {"kind: tension; loading: fixed; rate: 1e-7 1/s; grip: axial",
                                 "kind: tension; loading: fixed; rate: 1e-7 1/s; grip: full"};
    fixture_grid(f, 3, 3, 4, 0.01, 0.7);
    for (int i = 0; i < 2; i++) {
        double force[2];
        struct brc_sim wide;
        fixture_sim(f, brc_registry_find("vgcm"), elastic, grips[i], "");
        fixture_steps(f, 50);
        struct brc_run_params run = f->sim.run;
        run.skin = 3;
        const struct brc_test test = brc_rigs_test(&f->sim.rig.params, NULL);
        CHECK_OK(&f->ctx, brc_sim_create(&f->ctx, &wide, &f->sim.model, f->sim.params, &f->specimen,
                                         &test, &run));
        for (int k = 0; k < 50; k++)
            CHECK_OK(&f->ctx, brc_sim_step(&wide));
        assert_true(wide.platens.n > f->sim.platens.n);
        force[0] = f->sim.rig.force;
        force[1] = wide.rig.force;
        brc_sim_free(&wide);
        CHECK_NEAR(force[1], force[0], 0, 0.1); /* masses differ, and so does the start */
    }
}

/* The ledger of the largest row stays when the load has fallen: what was dissipated by then. */
static void the_ledger_is_kept_at_the_peak(void **state)
{
    struct fixture *f = *state;
    struct brc_ledger seen = {0};
    double largest = 0;
    fixture_grid(f, 3, 3, 4, 0.01, 0.4);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    while (!brc_rigs_done(&f->sim) && f->sim.step < 2000) {
        fixture_steps(f, 1);
        size_t n = f->sim.rig.curve.table.n;
        if (n == 0 || f->sim.rig.curve.force[n - 1] <= largest)
            continue;
        largest = f->sim.rig.curve.force[n - 1];
        seen = *brc_accounts_settle(&f->sim);
    }
    assert_null(brc_curve_why_no_peak(&f->sim.rig));
    assert_memory_equal(&f->sim.ledger_at_peak, &seen, sizeof seen);
    assert_true(brc_accounts_settle(&f->sim)->damage > seen.damage);
}

static void check_test(struct fixture *f, const char *settings, const char *message)
{
    struct brc_test_params test;
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_test_param_list, &test));
    fixture_set(f, brc_test_param_list, &test, settings);
    struct brc_test rig = brc_rigs_test(&test, NULL);
    void *own = calloc(1, rig.type->params.owner_size + 1);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, rig.type->params, own));
    rig.own = own;
    if (message)
        CHECK_FAILS(&f->ctx, brc_rig_check(&f->ctx, &rig), BRC_ERR_INPUT, message);
    else
        CHECK_OK(&f->ctx, brc_rig_check(&f->ctx, &rig));
    free(own);
}

static void keys_that_bound_each_other_are_in_order(void **state)
{
    struct fixture *f = *state;
    check_test(f, "strain_max: 1", "test.strain_max = 1: the platens meet at a strain of 1");
    check_test(f, "kind: brazilian; strain_max: 2", "test.strain_max = 2: the platens meet");
    check_test(f, "kind: tension; strain_max: 2", NULL);
    check_test(f, "rate_min: 2e-6 1/s; rate_max: 1e-6 1/s",
               "test.rate_min = 2e-06 1/s is above test.rate_max = 1e-06 1/s");
    check_test(f, "rate_min: 1e-6 1/s; rate_max: 1e-6 1/s", NULL);
    check_test(f, "modulus_low: 0.3", "test.modulus_low = 0.3 must be below test.modulus_high");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(a_load_that_rises_has_no_strength),
        FIXTURE_TEST(without_a_row_nothing_is_measured),
        FIXTURE_TEST(moduli_need_a_gauge),
        FIXTURE_TEST(moduli_say_how_well_they_fit),
        FIXTURE_TEST(the_first_percent_of_the_cracks_has_a_stress),
        FIXTURE_TEST(a_test_ends_at_no_drop),
        FIXTURE_TEST(a_grip_holds_end_grains_alone),
        FIXTURE_TEST(platens_that_meet_end_the_run),
        FIXTURE_TEST(the_ledger_is_kept_at_the_peak),
        FIXTURE_TEST(keys_that_bound_each_other_are_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
