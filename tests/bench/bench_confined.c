/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What confinement costs, on one specimen: steps of a triaxial test over those of compression, from
 * the start to the axial strain at which the unconfined one has its peak; and the time per step of
 * both at one fixed rate up to a third of that. Beyond it the unconfined specimen has more broken
 * points, which take longer than a pressure does, and adaptive loading has it move faster, so that
 * polyhedra are condensed more often. The confined strain counts from where the pressure is
 * reached, the steps from the first one, so that the ramp is paid for. Bars: 1.5 times the steps,
 * 1.15 times the time per step. */
#include "bench.h"

#include "common/rigs/curve.h"
#include "tests/fixture.h"

#include <math.h>

enum { REPEATS = 3, STEPS = 1000 };

struct cost {
    double strain; /* along z, of the loading */
    double steps, cpu_s;
};

/* Runs to the axial strain, or to the end of the test where that is 0. */
static struct cost run(struct fixture *f, const char *model, const char *test, const char *own,
                       double strain)
{
    fixture_test(f, brc_registry_find(model), "", test, own, "");
    struct brc_sim *s = &f->sim;
    double begin = cpu_seconds();
    while (!brc_rigs_done(s) &&
           !(strain > 0 && s->rig.stage == (*own ? 1 : 0) && brc_loading_strain(&s->rig) >= strain))
        fixture_steps(f, 1);
    struct cost c = {.cpu_s = cpu_seconds() - begin,
                     .steps = (double)s->step,
                     .strain = brc_loading_strain(&s->rig)};
    if (strain == 0) {
        size_t peak = brc_curve_peak_row(&s->rig);
        c.strain = s->rig.curve.strain[peak];
    }
    return c;
}

static void report(const char *model, const char *what, double ratio, double bar)
{
    char name[128];
    snprintf(name, sizeof name, "confined_%s_%s_ratio", model, what);
    bench_report(&(struct bench_value){name, ratio, "1", bar, 0, 0});
}

/* rate: a fixed one, 0: adaptive. */
static struct cost run_one(struct fixture *f, const char *model, bool is_confined, double strain,
                           double rate)
{
    char test[256], loading[128] = "";
    if (rate > 0)
        snprintf(loading, sizeof loading, "; loading: fixed; rate: %.6g 1/s", rate);
    snprintf(test, sizeof test, "kind: %s%s",
             is_confined ? "triaxial; stop_drop: 0" : "compression", loading);
    struct cost c = run(f, model, test, is_confined ? "pressure: 10 MPa" : "", strain);
    if (c.strain < strain) {
        fprintf(stderr, "%s: the test has ended before the strain %g\n", model, strain);
        exit(1);
    }
    return c;
}

static void compare(struct fixture *f, const char *model)
{
    double least[2] = {HUGE_VAL, HUGE_VAL}, steps[2];
    double strain = run_one(f, model, false, 0, 0).strain;
    for (int k = 0; k < 2; k++)
        steps[k] = run_one(f, model, k, strain, 0).steps;
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (int k = 0; k < 2; k++) { /* by turns: other programs slow down both alike */
            struct cost c = run_one(f, model, k, strain / 3, strain / 3 / STEPS);
            least[k] = fmin(least[k], c.cpu_s / c.steps);
        }
    printf("%s: %.0f steps unconfined, %.0f under 10 MPa, to the strain %.3g; %.3g and %.3g us a "
           "step to a third of it\n",
           model, steps[0], steps[1], strain, 1e6 * least[0], 1e6 * least[1]);
    report(model, "steps", steps[1] / steps[0], 1.5);
    report(model, "step_time", least[1] / least[0], 1.15);
}

int main(void)
{
    void *state;
    fixture_open(&state);
    fixture_grid(state, 5, 5, 10, 0.005, 0.8);
    compare(state, "polyhedra");
    compare(state, "vgcm");
    fixture_close(&state);
    return 0;
}
