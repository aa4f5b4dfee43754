/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loading: which rates a test goes through. */
#include "common/stability.h"
#include "tests/fixture.h"

#include <stdio.h>

static void pull(struct fixture *f, const char *loading, int steps)
{
    char test[200];
    snprintf(test, sizeof test, "kind: tension; strain_max: 0.05; %s", loading);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; "
                        "jitter: 0.7; seed: 3");
    fixture_sim(f, brc_registry_find("vgcm"), "interaction: all; e_bar: 20 GPa; eta: 0.3", test,
                "");
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

static void adaptive_rates_reach_their_bounds(void **state)
{
    struct fixture *f = *state;
    /* a target that cannot be met, and one that cannot be missed */
    pull(f, "rate: 1e-7 1/s; rate_min: 2e-9 1/s; target: 1e-9", 4000);
    CHECK_NEAR(f->sim.rig.rate, 2e-9, 0, 1e-12);
    pull(f, "rate: 1e-7 1/s; rate_max: 4e-7 1/s; target: 0.999", 2000);
    CHECK_NEAR(f->sim.rig.rate, 4e-7, 0, 1e-12);
    /* without a word of it, a tenth of the first rate is the smallest */
    pull(f, "rate: 1e-7 1/s; target: 1e-9", 4000);
    CHECK_NEAR(f->sim.rig.rate, 1e-8, 0, 1e-12);
}

static void a_burst_brakes_and_lets_go(void **state)
{
    struct fixture *f = *state;
    pull(f, "rate: 1e-6 1/s; rate_min: 1e-10 1/s; target: 0.01; stop_drop: 0", 0);
    const struct brc_rig *rig = &f->sim.rig;
    double braked = 1;
    int let_go = 0;
    for (int k = 0; k < 6000; k++) {
        double before = rig->rate;
        fixture_steps(f, 1);
        if (f->sim.events.table.n > 0)
            braked = fmin(braked, rig->rate / rig->cruise);
        let_go += rig->unbalanced < rig->params.target && rig->rate == rig->cruise;
        CHECK_BETWEEN(rig->rate / before, exp(-0.51), exp(0.51));
        assert_true(rig->rate <= rig->cruise * exp(0.51));
    }
    assert_true(f->sim.events.table.n > 0);
    assert_true(braked < 0.2);
    assert_true(let_go > 100);
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
    CHECK_FAILS(&f->ctx,
                brc_sim_create(&f->ctx, &sim, brc_registry_find("vgcm"), f->sim.params,
                               &f->specimen, &f->sim.rig.params, &run),
                BRC_ERR_INPUT, "run.mass_margin = 0.05 is unstable at step 0; use at least 0.");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(a_fixed_rate_stays),         FIXTURE_TEST(adaptive_rates_reach_their_bounds),
        FIXTURE_TEST(a_burst_brakes_and_lets_go), FIXTURE_TEST(least_masses_are_stable),
        FIXTURE_TEST(smaller_masses_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
