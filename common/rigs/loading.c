/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rate of a test, step by step: one policy for all tests, with its constants. Its stages, what
 * was tried, and what each constant was tuned against, are in docs/numerics.md (Loading) and
 * docs/speed-and-error.md.
 *
 * All constants are in units of test.target, so that one number decides between speed and error.
 * What it reads (strain, force, kinetic energy, unbalanced ratio) is summed exactly, as the rate
 * feeds back into all that follows. */
#include "common/rigs/loading.h"

#include "common/base/lanes.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"

#include <float.h>
#include <string.h>

/* Adaptive loading, in units of test.target: strain a step over the strain so far while the
 * specimen is elastic, and the unbalanced ratio that tells the onset of damage. */
static const double ELASTIC = 2, DAMAGING = 7.5;
/* Unbalanced ratio below which nothing is damaged, and how far beyond its onset. */
static const double STILL = 0.4, BEYOND = 2;
/* The rate rises and falls by these parts a step at most. */
static const double RATE_RISE = 0.05, RATE_FALL = 0.3;
/* Kinetic energy, over that of elastic loading at the same rate, that halves the rate, and the
 * least part of the rate that is left while an avalanche runs. */
static const double AVALANCHE = 1.2, SLOWEST = 0.1;
/* The load is lost below this part of its peak, and found again above that one. */
static const double LOAD_LOST = 0.8, LOAD_FOUND = 0.95;
/* It yields where the force over the strain falls below this part of its largest; no sign of it
 * where the force is below this part of that on a platen, as in an isotropic stage. */
static const double YIELDS = 0.5, NO_LOAD = 0.2;
/* Past the peak the rate goes along with the strain up to this many times the onset's. */
static const double FAR = 10;
/* weight of a step in the mean kinetic energy of elastic loading */
static const double ELASTIC_WEIGHT = 0.1;
/* The rate stays for the first steps. The start is over after so many, over the target, at the
 * latest. */
static const double LONGEST_START = 3;
enum { LEAST_START = 20 };
/* Automatic strain of a step over strain_max: adaptive loading's first one, over the target too,
 * and that of fixed loading. */
static const double FIRST_PART = 0.005, FIXED_PART = 1e-5;
enum { UNBALANCED_STEPS = 5 }; /* between two measures of the unbalanced force */

int brc_loading_check(struct brc_context *ctx, const struct brc_test_params *t)
{
    if (t->loading == BRC_LOADING_ADAPTIVE && t->rate_min > t->rate_max)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "test.rate_min = %g 1/s is above test.rate_max = %g 1/s, so no rate is allowed: "
                 "lower the one or raise the other",
                 t->rate_min, t->rate_max);
    return 0;
}

double brc_loading_start_rate(const struct brc_test_params *test)
{
    bool is_adaptive = test->loading == BRC_LOADING_ADAPTIVE;
    if (test->rate > 0)
        return test->rate;
    return test->strain_max * (is_adaptive ? FIRST_PART * test->target : FIXED_PART);
}

static brc_lanes sizes_of(double (*f)[3])
{
    brc_lanes v[3];
    brc_lanes_at3(v, f);
    return brc_lanes_sqrt(brc_lanes_dot(v, v));
}

/* Sums of the sizes of the forces on the grains and of those of their contacts, each contact with
 * its first grain: the exact sum then has one term a grain, however many contacts there are.
 * *active: how many contacts have a force. */
static void sum_sizes(const struct brc_sim *sim, double *on_grains, double *of_contacts,
                      size_t *active)
{
    const struct brc_bodies *b = &sim->bodies;
    const struct brc_contacts *c = &sim->pairs;
    *active = 0;
    for (size_t i = 0; i < b->n_grains; i += BRC_LANES)
        brc_lanes_put(b->terms + i, sizes_of(b->f + i)); /* rows past the last may be written */
    *on_grains = brc_sum_exact(b->terms, b->n_grains);
    memset(b->terms, 0, b->n_grains * sizeof *b->terms);
    for (size_t row = 0; row < c->n; row += BRC_LANES) {
        brc_lanes size = sizes_of(c->f + row);
        for (size_t k = 0; k < BRC_LANES && row + k < c->n; k++) {
            b->terms[c->a[row + k]] += size[k];
            *active += size[k] > 0;
        }
    }
    *of_contacts = brc_sum_exact(b->terms, b->n_grains);
}

double brc_loading_strain(const struct brc_rig *rig)
{
    return rig->stage_sense * (rig->strain - rig->stage_strain);
}

/* What has broken since the present stage began, and may be the onset of damage in it. */
static size_t n_events(const struct brc_sim *sim)
{
    return sim->events.table.n - (size_t)sim->rig.stage_events;
}

static int64_t steps_in_stage(const struct brc_sim *sim)
{
    return sim->step - sim->rig.stage_step;
}

/* Mean unbalanced force on a grain over mean contact force. */
static double unbalanced_ratio(const struct brc_sim *sim)
{
    double unbalanced, contact;
    size_t active;
    sum_sizes(sim, &unbalanced, &contact, &active);
    if (contact <= 0)
        return 0;
    return unbalanced / (double)sim->bodies.n_grains / (contact / (double)active);
}

/* The start is over when the field of velocities is that of steady loading. */
static bool is_steady(const struct brc_sim *sim)
{
    int64_t steps = steps_in_stage(sim);
    bool is_calm =
        steps >= LEAST_START && sim->rig.unbalanced < 0.5 * DAMAGING * sim->rig.params.target;
    bool is_late = (double)steps >= LONGEST_START / sim->rig.params.target;
    return is_calm || is_late || n_events(sim) > 0;
}

/* A cohesionless pack slides, and nothing breaks: that its stiffness falls tells it alone. The
 * first steps are a wave, stiffer than the specimen, and tell nothing. */
static double stiffness(const struct brc_rig *rig)
{
    double change = fabs(rig->force - rig->stage_force);
    bool tells = rig->is_steady && change >= NO_LOAD * fabs(rig->platen[0].force);
    return tells ? change / brc_loading_strain(rig) : 0;
}

static bool has_yielded(const struct brc_rig *rig)
{
    double now = stiffness(rig);
    return now > 0 && now < YIELDS * rig->stiffest;
}

/* Up to the onset of damage: what kinetic energy goes with a rate, and whether damage has begun.
 * Shaking tells it, too, for models that soften before anything breaks; but not at the start, where
 * the specimen still shakes from its first load. */
static void watch_elastic(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    double kinetic = fmax(sim->ledger.kinetic, DBL_MIN) / (rig->rate * rig->rate);
    double weight = rig->kinetic_elastic > 0 ? ELASTIC_WEIGHT : 1;
    rig->kinetic_elastic += weight * (kinetic - rig->kinetic_elastic);
    rig->stiffest = fmax(rig->stiffest, stiffness(rig));
    bool is_shaken = rig->is_steady && rig->unbalanced > DAMAGING * rig->params.target;
    bool is_damaged = is_shaken || n_events(sim) > 0;
    rig->is_flowing = !is_damaged && has_yielded(rig);
    if (is_damaged || rig->is_flowing)
        rig->strain_onset = brc_loading_strain(rig);
}

/* What was taken for the onset of damage was none: nothing has broken, and all is still. Without it
 * the rate would stay where the alarm was, far below the damage. */
static bool was_false_alarm(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    return n_events(sim) == 0 && !rig->is_flowing &&
           brc_loading_strain(rig) > BEYOND * rig->strain_onset &&
           rig->unbalanced < STILL * rig->params.target;
}

/* Part of the rate that is left beside an avalanche. Where grains break, kinetic energy that
 * loading at the present rate does not explain tells it, some steps before the load falls. Where
 * they only slide past each other it tells nothing: a pack that flows moves with many times the
 * kinetic energy of elastic loading, however slowly; whether it is in balance tells it there. */
static double avalanche_factor(const struct brc_sim *sim, double base)
{
    const struct brc_rig *rig = &sim->rig;
    double rate = fmax(rig->rate, base);
    double usual = AVALANCHE * rig->kinetic_elastic * rate * rate;
    double excess = rig->is_flowing && n_events(sim) == 0
                        ? rig->unbalanced / (DAMAGING * rig->params.target)
                        : fmax(sim->ledger.kinetic, 0) / usual;
    return fmax(SLOWEST, 1 / (1 + excess * excess * excess * excess));
}

/* Until damage begins the rate goes along with the strain, so that no scale of it has to be known;
 * from then on it stays, as a peak may be many times as far away. */
static double wanted_rate(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double target = rig->params.target / sim->dt;
    if (rig->strain_onset == 0)
        return fmax(rig->rate, ELASTIC * target * brc_loading_strain(rig));
    double far = fmin(brc_loading_strain(rig), FAR * rig->strain_onset);
    double base = target * (rig->is_post_peak ? far : rig->strain_onset);
    return base * avalanche_factor(sim, base);
}

static void choose_change(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    if (was_false_alarm(sim))
        rig->strain_onset = 0;
    if (rig->strain_onset == 0)
        watch_elastic(sim);
    rig->is_post_peak = rig->force < (rig->is_post_peak ? LOAD_FOUND : LOAD_LOST) * rig->force_peak;
    double rate = fmin(fmax(wanted_rate(sim), rig->params.rate_min), rig->params.rate_max);
    rig->change = fmin(fmax(log(rate / rig->rate), -RATE_FALL), RATE_RISE);
}

/* In slow loading all velocities are in proportion to the rate: when their mean goes along with a
 * change of rate, it makes no wave. Between the forces and the kick of a step. */
static void change_velocities(struct brc_sim *sim, double part)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        double dv[3], dw[3], v[3], w[3]; /* v, w: means of before and after */
        brc_scale(dv, b->v_mean[i], part);
        brc_scale(dw, b->w_mean[i], part);
        brc_scale(v, dv, 0.5);
        brc_scale(w, dw, 0.5);
        brc_add(v, v, b->v[i]);
        brc_add(w, w, b->w[i]);
        /* what leaves the kinetic energy of the leapfrog form, see ledger.h */
        b->terms[i] = b->mass[i] * brc_dot(dv, v) + b->inertia[i][0] * brc_dot(dw, w) +
                      0.5 * sim->dt * (brc_dot(dv, b->f[i]) + brc_dot(dw, b->t[i]));
        brc_add(b->v[i], b->v[i], dv);
        brc_add(b->w[i], b->w[i], dw);
        brc_axpy(b->v_mean[i], part, b->v_mean[i]);
        brc_axpy(b->w_mean[i], part, b->w_mean[i]);
    }
    sim->ledger.rate_change -= brc_sum_exact(b->terms, b->n_grains);
    for (size_t i = b->n_grains; i < b->n;
         i++) { /* those that a force pushes; others have no mean */
        brc_axpy(b->v[i], part, b->v_mean[i]);
        brc_axpy(b->v_mean[i], part, b->v_mean[i]);
    }
}

/* Velocities are in proportion to the rate as far as their energy is that of elastic loading; those
 * of an avalanche are not, and would be driven by a rate that rises again. */
static double part_of_rate(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    if (rig->strain_onset == 0)
        return 1;
    double rate = sqrt(fmax(sim->ledger.kinetic, 0) / rig->kinetic_elastic);
    return rig->rate / fmax(rig->rate, rate);
}

static void change_rate(struct brc_sim *sim)
{
    double factor = exp(sim->rig.change);
    if (sim->rig.change == 0)
        return;
    if (sim->tracks_mean)
        change_velocities(sim, (factor - 1) * part_of_rate(sim));
    sim->rig.rate *= factor;
}

void brc_loading_step(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    rig->strain += rig->stage_sense * rig->rate * sim->dt;
    rig->strain_sum += rig->strain;
    if (sim->step % UNBALANCED_STEPS == 0) {
        rig->unbalanced = unbalanced_ratio(sim);
        rig->is_steady = rig->is_steady || is_steady(sim);
    }
    if (steps_in_stage(sim) >= LEAST_START && rig->params.loading == BRC_LOADING_ADAPTIVE)
        choose_change(sim);
    change_rate(sim);
}

/* A stage begins as a test does: slowly, as nothing is known of how far its damage is, and with all
 * motion damped until that of the stage before has died away. What broke before is no sign of
 * damage in it, or a single break in a ramp would hold up the shearing. */
void brc_loading_begin_stage(struct brc_sim *sim, double sense)
{
    struct brc_rig *rig = &sim->rig;
    rig->stage++;
    rig->stage_step = sim->step;
    rig->stage_row = (int64_t)rig->curve.table.n;
    rig->stage_events = (int64_t)sim->events.table.n;
    rig->stage_strain = rig->strain;
    rig->stage_sense = sense;
    rig->stage_force = rig->force;
    rig->stiffest = 0;
    rig->strain_onset = rig->kinetic_elastic = 0;
    rig->force_peak = rig->strain_peak = 0;
    rig->is_post_peak = rig->is_steady = 0;
    rig->change = 0;
    double rate = fmin(rig->rate, rig->params.rate);
    if (sim->tracks_mean)
        change_velocities(sim, rate / rig->rate - 1);
    rig->rate = rate;
}

bool brc_loading_fallen(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    size_t n = rig->curve.table.n;
    return n > (size_t)rig->stage_row && rig->params.stop_drop > 0 && rig->force_peak > 0 &&
           sim->events.table.n > 0 &&
           rig->curve.force[n - 1] < rig->params.stop_drop * rig->force_peak;
}

const char *brc_loading_end(const struct brc_sim *sim)
{
    if (brc_loading_strain(&sim->rig) >= sim->rig.params.strain_max)
        return "test.strain_max";
    return brc_loading_fallen(sim) ? "test.stop_drop" : NULL;
}

/* Avalanches only lengthen the way, so what is told is a least number of steps, which falls
 * steadily. */
double brc_loading_steps_left(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double left = fmax(rig->params.strain_max - brc_loading_strain(rig), 0), rate = rig->rate;
    if (rig->n_platens == 0)
        return HUGE_VAL;
    if (rig->params.loading == BRC_LOADING_ADAPTIVE) {
        if (rig->strain_onset == 0)
            return HUGE_VAL;
        rate = rig->params.target / sim->dt * rig->strain_onset;
        rate = fmin(fmax(rate, rig->params.rate_min), rig->params.rate_max);
    }
    return left / (rate * sim->dt);
}
