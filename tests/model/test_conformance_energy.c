/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every contact model owes to the framework: a ledger that holds the energy it stores, and
 * springs that give the limit of the step. Runs over every registered model, the first over the
 * null model, too. */
#include "tests/subjects.h"

#include <stdio.h>

/* A free pack is set in random motion, without any damping. */
static void set_in_motion(struct fixture *f, const struct brc_model *model, const char *run,
                          double speed)
{
    char settings[320];
    snprintf(settings, sizeof settings, "%s%s", subject_of(model).elastic,
             fixture_is(model, "polyhedra") ? "; mu: 0; breakable: off" : "");
    fixture_free_sim(f, model, settings, fixture_is(model, "null") ? "dt: 1e-7 s" : run);
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        double v[3], w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = speed * fixture_draw(f);
            w[k] = model->flags & BRC_MODEL_ROTATES ? speed / SUBJECT_GRAIN * fixture_draw(f) : 0;
        }
        fixture_velocity(f, i, v, w);
    }
    fixture_ledger(f);
}

static void ledger_is_the_stored_energy(void **state)
{
    /* elastic and undamped: each stored term of the ledger follows the energy that the model finds
     * from its state, and nothing is lost */
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        set_in_motion(f, fixture_model(i), "dt_margin: 0.1", 0.02);
        double total = f->sim.ledger.start, largest = 0;
        for (int k = 0; k < 400; k++) {
            double stored[3];
            fixture_steps(f, 1);
            const struct brc_ledger *l = &f->sim.ledger;
            brc_accounts_stored(&f->sim, stored);
            const double kept[3] = {l->bond, l->contact_normal, l->contact_shear};
            /* trapezoid rule at a tenth of the stable step: springs that begin or end within a step
             * are off by (0.1)^2 of one step's work */
            CHECK_NEAR_ARRAY(kept, stored, 3, 5e-4 * total, 0);
            CHECK_NEAR(fabs(brc_ledger_imbalance(l)), 0, 5e-4 * total, 0);
            largest = fmax(largest, stored[0] + stored[1] + stored[2]);
        }
        if (!fixture_is(fixture_model(i), "null"))
            assert_true(largest > 0.1 * total);
        CHECK_NEAR(f->sim.ledger.friction + f->sim.ledger.damage + f->sim.ledger.viscous, 0,
                   1e-12 * total, 0);
    }
}

static void nothing_is_lost_in_breaking(void **state)
{
    /* pulled apart by the rig, quasi-statically, with every kind of dissipation */
    struct fixture *f = *state;
    subject_pack(f);
    const char *tests[2] = {"kind: tension; grip: full; loading: fixed; rate: 2e-6 1/s",
                            "kind: compression; friction: 0.3; loading: fixed; rate: 2e-6 1/s"};
    for (int i = 0; i < brc_registry_count(); i++)
        for (int t = 0; t < 2; t++) {
            struct subject s = subject_of(brc_registry_at(i));
            fixture_sim(f, brc_registry_at(i), s.breaking, tests[t], "");
            fixture_steps(f, t == 0 ? 600 : 2500);
            const struct brc_ledger *l = &f->sim.ledger;
            print_message("%s, %s: %zu events, residual %.2e; damage %.2e, friction %.2e, damping "
                          "%.2e, mass %.2e of the work\n",
                          brc_registry_at(i)->name, t == 0 ? "tension" : "compression",
                          f->sim.events.table.n, brc_ledger_residual(l), l->damage / l->boundary,
                          l->friction / l->boundary, l->local_damping / l->boundary,
                          l->mass_scaling / l->boundary);
            if (strlen(s.breaking) > 0)
                assert_true(f->sim.events.table.n > 0);
            CHECK_NEAR(brc_ledger_residual(l), 0, 0.01, 0);
        }
}

/* Largest kinetic energy over the start's in n steps at a part of the stable limit; above 1 the
 * step is forced on the framework, which would refuse it. */
static double energy_after(struct fixture *f, const struct brc_model *model, double factor, int n)
{
    char run[64];
    snprintf(run, sizeof run, "dt_margin: %g", fmin(factor, 0.95));
    set_in_motion(f, model, run, 1e-3);
    double start = f->sim.ledger.start, largest = 0;
    for (int i = 0; i < n; i++) {
        if (factor > 1)
            f->sim.dt = factor * f->sim.dt_limit;
        if (brc_sim_step(&f->sim) != 0) {
            brc_error_clear(&f->ctx);
            return HUGE_VAL;
        }
        largest = fmax(largest, fixture_kinetic(f) / start);
    }
    return largest;
}

static void the_default_step_keeps_the_energy(void **state)
{
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < brc_registry_count(); i++) {
        set_in_motion(f, brc_registry_at(i), "", 1e-3);
        double start = f->sim.ledger.start;
        fixture_steps(f, 1500);
        /* at 0.8 of the limit polyhedra come to 1.6 */
        CHECK_NEAR((f->sim.ledger.kinetic + fixture_stored(f)) / start, 1, 0.05, 0);
    }
}

static void the_step_limit_is_sharp(void **state)
{
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        double part = subject_of(model).stable_part;
        double below = energy_after(f, model, part, 1500);
        double above = energy_after(f, model, 1.5, 1500);
        print_message("%s: largest kinetic energy / start: %.2g at %g of the limit, %.2g at 1.5\n",
                      model->name, below, part, above);
        /* near the limit the leapfrog velocity of the fastest mode is amplified by
         * 1 / sqrt(1 - part^2) */
        CHECK_BETWEEN(below, 0, 2 / (1 - part * part));
        assert_true(above > 1e3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(ledger_is_the_stored_energy),
        FIXTURE_TEST(nothing_is_lost_in_breaking),
        FIXTURE_TEST(the_default_step_keeps_the_energy),
        FIXTURE_TEST(the_step_limit_is_sharp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
