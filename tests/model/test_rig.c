/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loading: which rates a test goes through. */
#include "common/engine/integrate.h"
#include "common/engine/stability.h"
#include "tests/fixture.h"

#include <stdio.h>

static void pull(struct fixture *f, const char *loading, int steps)
{
    char test[200];
    snprintf(test, sizeof test, "kind: tension; strain_max: 0.05; %s", loading);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; "
                        "jitter: 0.7; seed: 3");
    fixture_sim(f, brc_registry_find("vgcm"),
                "interaction: all; e_bar: 20 GPa; eta: 0.3; " FIXTURE_ENERGIES, test, "");
    fixture_steps(f, steps);
}

static void a_fixed_rate_stays(void **state)
{
    struct fixture *f = *state;
    pull(f, "loading: fixed; rate: 3e-7 1/s", 200);
    const struct brc_curve *c = &f->sim.rig.curve;
    assert_true(c->table.n == 20);
    for (size_t i = 0; i < c->table.n; i++)
        assert_true(c->rate[i] == 3e-7);
    CHECK_NEAR(f->sim.rig.strain, 200 * 3e-7, 0, 1e-12);
}

static void adaptive_rates_keep_to_their_bounds(void **state)
{
    struct fixture *f = *state;
    const struct brc_rig *rig = &f->sim.rig;
    /* a target that is never reached, and one that always is */
    pull(f, "rate: 1e-7 1/s; rate_max: 4e-7 1/s; target: 0.999", 2000);
    CHECK_NEAR(rig->rate, 4e-7, 0, 1e-12);
    pull(f, "rate: 1e-6 1/s; rate_min: 2e-9 1/s; rate_max: 1e-6 1/s; target: 1e-7; stop_drop: 0",
         3000);
    assert_true(rig->strain_onset > 0);
    CHECK_NEAR(rig->rate, 2e-9, 0, 1e-12);
}

/* Fast while the specimen is elastic, whatever its scale of strain; then no faster than the target,
 * and slower while it breaks. */
static void the_rate_follows_the_onset_of_damage(void **state)
{
    struct fixture *f = *state;
    pull(f, "rate: 1e-8 1/s; target: 0.004; stop_drop: 0", 0);
    const struct brc_rig *rig = &f->sim.rig;
    double braked = HUGE_VAL, let_go = 0, elastic = 0;
    for (double before = rig->rate; rig->strain_onset == 0; before = rig->rate) {
        elastic = rig->rate;
        fixture_steps(f, 1);
        CHECK_BETWEEN(rig->rate / before, rig->strain_onset > 0 ? exp(-0.3001) : 1, exp(0.0501));
        assert_true(f->sim.step < 3000);
    }
    CHECK_NEAR(elastic, 2 * 0.004 * rig->strain_onset, 0, 0.05);
    assert_true(elastic > 30 * 1e-8);
    fixture_steps(f, 20); /* until the rate is down */
    for (int k = 0; k < 3000; k++) {
        double before = rig->rate;
        fixture_steps(f, 1);
        CHECK_BETWEEN(rig->rate / before, exp(-0.3001), exp(0.0501));
        double base = 0.004 * (rig->is_post_peak ? rig->strain : rig->strain_onset);
        assert_true(rig->rate > 0.0999 * 0.004 * rig->strain_onset);
        assert_true(rig->rate < 1.0001 * base || rig->rate < before);
        braked = fmin(braked, rig->rate / base);
        let_go = fmax(let_go, rig->rate / base / braked);
    }
    assert_true(rig->is_post_peak);
    assert_true(braked < 0.3);
    assert_true(let_go > 2);
}

/* Steps that are left, at most: not known before damage begins, then a bound that falls. */
static void what_is_left_falls(void **state)
{
    struct fixture *f = *state;
    const struct brc_rig *rig = &f->sim.rig;
    double first = 0, before = HUGE_VAL;
    int64_t at = 0;
    pull(f, "target: 0.004; strain_max: 0.005; stop_drop: 0", 0);
    for (; !brc_rigs_done(&f->sim); fixture_steps(f, 1)) {
        double left = brc_loading_steps_left(&f->sim);
        assert_true((left < HUGE_VAL) == (rig->strain_onset > 0));
        if (left == HUGE_VAL)
            continue;
        if (first == 0) {
            first = left;
            at = f->sim.step;
        }
        assert_true(left <= before);
        before = left;
    }
    print_message("at most %.0f steps left at step %lld of %lld\n", first, (long long)at,
                  (long long)f->sim.step);
    CHECK_BETWEEN(first / (double)(f->sim.step - at), 1, 10);
    pull(f, "loading: fixed; rate: 1e-6 1/s; strain_max: 0.005", 200);
    CHECK_NEAR(brc_loading_steps_left(&f->sim), 4800, 1e-6, 0);
}

/* An onset that was none is forgotten, and a finer target takes steps in proportion. */
static void a_false_alarm_costs_little(void **state)
{
    struct fixture *f = *state;
    const struct brc_rig *rig = &f->sim.rig;
    int64_t steps[3];
    const char *const targets[] = {"target: 0.002", "target: 0.0005", "target: 0.0005"};
    for (int k = 0; k < 3; k++) {
        pull(f, targets[k], 0);
        while (!brc_rigs_done(&f->sim)) {
            fixture_steps(f, 1);
            if (k == 2 && f->sim.step == 1500) {
                assert_true(rig->strain_onset == 0 && rig->is_steady);
                f->sim.rig.strain_onset = rig->strain / 10;
            }
            assert_true(f->sim.step < 60000);
        }
        steps[k] = f->sim.step;
    }
    print_message("%lld steps, a quarter of the target %lld, with a false alarm %lld\n",
                  (long long)steps[0], (long long)steps[1], (long long)steps[2]);
    CHECK_BETWEEN((double)steps[1] / (double)steps[0], 2, 6);
    CHECK_BETWEEN((double)steps[2] / (double)steps[1], 0.7, 1.3);
}

/* What a rate that rises adds to the velocities of an avalanche: not more than it adds in elastic
 * loading. */
static void a_rising_rate_drives_no_avalanche(void **state)
{
    struct fixture *f = *state;
    pull(f, "rate: 1e-7 1/s; target: 0.9; rate_min: 1e-7 1/s; rate_max: 1e-7 1/s", 200);
    struct brc_rig *rig = &f->sim.rig;
    double elastic = rig->kinetic_elastic, before = f->sim.ledger.rate_change;
    rig->strain_onset = rig->strain;
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) /* a hundred times as fast as loading */
        for (int k = 0; k < 3; k++) {
            f->sim.bodies.v[i][k] *= 100;
            f->sim.bodies.v_mean[i][k] *= 100;
        }
    f->sim.ledger.kinetic = 1e4 * elastic * rig->rate * rig->rate;
    rig->change = log(1.05);
    rig->params.sample_steps = 1000;
    rig->params.rate_min = 1.05e-7;
    rig->params.rate_max = 1.05e-7;
    f->sim.step += 1;
    CHECK_OK(&f->ctx, rig->type->drive(&f->sim));
    double given = before - f->sim.ledger.rate_change;
    /* 2 v dv of loading's dv and the avalanche's v */
    CHECK_BETWEEN(given / (elastic * 1e-14), 0.05, 2 * 100 * 0.0501);
}

/* Largest unbalanced force and residual of the ledger while an elastic specimen, loaded steadily at
 * first, is loaded ten times as fast within 100 steps. */
static void speed_up(struct fixture *f, bool is_with_the_specimen, double out[2])
{
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 6 cm; cells: 3, 3, 6; "
                        "jitter: 0.7; seed: 3");
    fixture_sim(f, brc_registry_find("vgcm"),
                "interaction: all; sigma_t: 1e3 MPa; tau: 1e3 MPa; "
                "softening: none",
                "kind: tension; rate: 1e-7 1/s; rate_min: 1e-7 1/s; rate_max: 1e-7 1/s; "
                "strain_max: 0.05; target: 0.9",
                "");
    fixture_steps(f, 1000);
    f->sim.rig.params.rate_max = 1e-6;
    f->sim.tracks_mean = is_with_the_specimen;
    out[0] = 0;
    for (int k = 0; k < 150; k++) {
        fixture_steps(f, 1);
        out[0] = fmax(out[0], f->sim.rig.unbalanced);
    }
    out[1] = brc_ledger_residual(&f->sim.ledger);
    assert_true(f->sim.rig.rate > 3e-7);
}

static void a_change_of_rate_makes_no_wave(void **state)
{
    struct fixture *f = *state;
    double with[2], without[2];
    speed_up(f, true, with);
    speed_up(f, false, without);
    printf("unbalanced %.2e, of platens alone %.2e; residual %.1e\n", with[0], without[0], with[1]);
    assert_true(with[0] < 0.2 * without[0]);
    assert_true(with[1] < 1e-6);
}

/* A grain in the mean motion, pushed along it and against it: what a kick does over what the force
 * alone would do. */
static void kick_of(struct fixture *f, const char *run, double part[2])
{
    const double mean[3] = {1e-6, 1e-6, 1e-6}, push[3] = {1, -1, 0};
    pull(f, "rate: 1e-7 1/s; loading: fixed", 0);
    fixture_sim(f, brc_registry_find("vgcm"), "", "kind: tension; loading: fixed", run);
    struct brc_bodies *b = &f->sim.bodies;
    f->sim.rig.is_steady = 1;
    brc_copy(b->v[0], mean);
    brc_copy(b->v_mean[0], mean);
    brc_copy(b->f[0], push);
    brc_integrate_kick(&f->sim, 1);
    for (int k = 0; k < 2; k++)
        part[k] = (b->v[0][k] - mean[k]) * b->mass[0] / push[k];
}

static void damping_spares_the_mean_motion(void **state)
{
    double printed[2], spared[2];
    kick_of(*state, "local_damping: 0.7; fluctuation_damping: 0; damped: motion", printed);
    kick_of(*state, "local_damping: 0; fluctuation_damping: 0.7; damped: fluctuation", spared);
    CHECK_NEAR(printed[0], 0.3, 0, 1e-9);
    CHECK_NEAR(printed[1], 1.7, 0, 1e-9);
    CHECK_NEAR(spared[0], 1, 0, 1e-9);
    CHECK_NEAR(spared[1], 1, 0, 1e-9);
}

/* A free vibration with the least masses that are accepted: in the leapfrog's velocities at half
 * steps, the energy is at most 1 / (1 - 0.9^2) of what was given. */
static void least_masses_are_stable(void **state)
{
    struct fixture *f = *state;
    const struct brc_model *vgcm = brc_registry_find("vgcm");
    const char *const bonds = "interaction: all; sigma_t: 1e3 MPa; tau: 1e3 MPa; softening: none",
                      *const free_run = "kind: none";
    char run[100];
    double limit, given = 0;
    fixture_grid(f, 4, 4, 4, 0.01, 0.5);
    fixture_sim(f, vgcm, bonds, free_run, "local_damping: 0");
    CHECK_OK(&f->ctx, brc_stability_limit(&f->sim, &limit));
    double least = 1.2 / (0.81 * limit * limit);
    CHECK_BETWEEN(least, 0.1, 0.6);
    snprintf(run, sizeof run, "local_damping: 0; mass_margin: %.17g", 1.001 * least);
    fixture_sim(f, vgcm, bonds, free_run, run);
    for (size_t i = 0; i < 64; i++)
        for (int k = 0; k < 3; k++) {
            f->sim.bodies.v[i][k] = 1e-9 * fixture_draw(f);
            given += 0.5 * f->sim.bodies.mass[i] * pow(f->sim.bodies.v[i][k], 2);
        }
    for (int step = 0; step < 5000; step++) {
        fixture_steps(f, 1);
        assert_true(f->sim.ledger.kinetic < given / (1 - 0.81));
    }
}

static void smaller_masses_are_refused(void **state)
{
    struct fixture *f = *state;
    struct brc_run_params run;
    fixture_grid(f, 4, 4, 4, 0.01, 0.5);
    fixture_sim(f, brc_registry_find("vgcm"), "", "", "");
    run = f->sim.run;
    run.mass_margin = 0.05;
    struct brc_sim sim;
    const struct brc_test test = brc_rigs_test(&f->sim.rig.params, NULL);
    CHECK_FAILS(&f->ctx,
                brc_sim_create(&f->ctx, &sim, brc_registry_find("vgcm"), f->sim.params,
                               &f->specimen, &test, &run),
                BRC_ERR_INPUT, "run.mass_margin = 0.05 is unstable at step 0; use at least 0.");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(a_fixed_rate_stays),
        FIXTURE_TEST(adaptive_rates_keep_to_their_bounds),
        FIXTURE_TEST(the_rate_follows_the_onset_of_damage),
        FIXTURE_TEST(what_is_left_falls),
        FIXTURE_TEST(a_false_alarm_costs_little),
        FIXTURE_TEST(a_rising_rate_drives_no_avalanche),
        FIXTURE_TEST(a_change_of_rate_makes_no_wave),
        FIXTURE_TEST(damping_spares_the_mean_motion),
        FIXTURE_TEST(least_masses_are_stable),
        FIXTURE_TEST(smaller_masses_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
