/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/engine/rig.h"

#include "common/rigs/gauge.h"
#include "common/base/lanes.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_test_params
static const struct brc_param test_params[] = {BRC_PARAM_LIST(BRC_TEST_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_test_param_list = BRC_PARAMS(test_params, struct brc_test_params);

#define BRC_OWNER struct brc_curve
static const struct brc_field curve_fields[] = {BRC_CURVE_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

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
/* weight of a step in the mean kinetic energy of elastic loading */
static const double ELASTIC_WEIGHT = 0.1;
/* The rate stays for the first steps. The start is over after so many, over the target, at the
 * latest. */
static const double LONGEST_START = 3;
enum { LEAST_START = 20 };
/* Automatic strain of a step over strain_max: adaptive loading's first one, over the target too,
 * and that of fixed loading. */
static const double FIRST_PART = 0.005, FIXED_PART = 1e-5;
enum { UNBALANCED_STEPS = 5 };        /* steps between two measures of the unbalanced force */
static const double PLATENS_MEET = 1; /* strain in compression and in the Brazilian test */

int brc_rig_platens(const struct brc_test_params *test)
{
    return test->kind == BRC_TEST_NONE ? 0 : 2;
}

/* Two keys that bound something between them. */
static int check_pair(struct brc_context *ctx, const char *low, double low_value, const char *high,
                      double high_value)
{
    if (low_value < high_value)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INPUT, "test.%s = %g must be below test.%s = %g", low, low_value, high,
             high_value);
}

int brc_rig_check(struct brc_context *ctx, const struct brc_test_params *t)
{
    if (t->kind == BRC_TEST_NONE)
        return 0;
    if (t->kind != BRC_TEST_TENSION && t->strain_max >= PLATENS_MEET)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "test.strain_max = %g: the platens meet at a strain of 1; allowed in compression "
                 "and in the Brazilian test (0, 1)",
                 t->strain_max);
    if (t->loading == BRC_LOADING_ADAPTIVE && t->rate_min > t->rate_max)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "test.rate_min = %g 1/s is above test.rate_max = %g 1/s, so no rate is allowed: "
                 "lower the one or raise the other",
                 t->rate_min, t->rate_max);
    return check_pair(ctx, "modulus_low", t->modulus_low, "modulus_high", t->modulus_high);
}

/* Area that the force is divided by: the mean section, or pi D T / 2 (gt12 eq 16). */
static double section_area(const struct brc_specimen *s, const struct brc_test_params *test,
                           double length)
{
    double low[3], high[3];
    brc_specimen_extent(s, low, high);
    if (test->kind != BRC_TEST_BRAZILIAN)
        return s->domain_volume / length;
    double diameter = s->params.shape == BRC_SHAPE_CYLINDER ? s->params.diameter : length;
    return BRC_PI * diameter * (high[2] - low[2]) / 2; /* eq:gt12:16 */
}

static void place_platen(struct brc_sim *sim, int i, const double at[3], int axis, double sign)
{
    const struct brc_test_params *test = &sim->rig.params;
    struct brc_platen *p = &sim->rig.platen[i];
    bool plates = test->kind == BRC_TEST_BRAZILIAN && test->plate_width > 0;
    *p = (struct brc_platen){.body = (int32_t)sim->bodies.n_grains + i,
                             .surface = plates ? BRC_SURFACE_STRIP : BRC_SURFACE_PLANE,
                             .half_width = plates ? test->plate_width / 2 : HUGE_VAL,
                             .friction = test->friction};
    if (test->kind == BRC_TEST_TENSION)
        p->bonding = test->grip == 0 ? BRC_BONDING_GRIP : BRC_BONDING_FULL;
    p->n[axis] = sign;
    p->across[0] = 1;
    brc_copy(sim->bodies.x[p->body], at);
    brc_copy(sim->bodies.x0[p->body], at);
}

/* Platens move by half of the rate each. */
static void set_platen_velocities(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    for (int i = 0; i < rig->n_platens; i++)
        brc_scale(sim->bodies.v[rig->platen[i].body], rig->platen[i].n,
                  rig->sense * 0.5 * rig->rate * rig->length);
}

void brc_rig_start_curve(struct brc_sim *sim)
{
    struct brc_fieldset set = BRC_FIELDSET(curve_fields, struct brc_curve);
    brc_table_init(&sim->rig.curve.table, "curve", set, &sim->rig.curve);
}

double brc_rig_start_rate(const struct brc_test_params *test)
{
    bool is_adaptive = test->loading == BRC_LOADING_ADAPTIVE;
    if (test->rate > 0 || brc_rig_platens(test) == 0)
        return test->rate;
    return test->strain_max * (is_adaptive ? FIRST_PART * test->target : FIXED_PART);
}

int brc_rig_create(struct brc_sim *sim, const struct brc_test_params *test)
{
    struct brc_rig *rig = &sim->rig;
    BRC_TRY(brc_rig_check(sim->ctx, test));
    rig->params = *test;
    rig->params.rate = brc_rig_start_rate(test);
    rig->n_platens = brc_rig_platens(test);
    rig->axis = test->kind == BRC_TEST_BRAZILIAN ? 1 : 2;
    rig->sense = test->kind == BRC_TEST_TENSION ? -1 : 1;
    double low[3], high[3], at[3];
    brc_specimen_extent(sim->specimen, low, high);
    rig->length = high[rig->axis] - low[rig->axis];
    rig->section = section_area(sim->specimen, test, rig->length);
    for (int i = 0; i < rig->n_platens; i++) {
        for (int k = 0; k < 3; k++)
            at[k] = 0.5 * (low[k] + high[k]);
        at[rig->axis] = i == 0 ? low[rig->axis] : high[rig->axis];
        place_platen(sim, i, at, rig->axis, i == 0 ? 1 : -1);
    }
    if (rig->n_platens == 0)
        return 0;
    brc_gauge_judge(sim);
    rig->rate = rig->params.rate;
    set_platen_velocities(sim);
    for (size_t i = 0; i < sim->bodies.n_grains; i++) {
        brc_rig_field(sim, i, sim->bodies.v[i]);
        brc_copy(sim->bodies.v_mean[i], sim->bodies.v[i]);
    }
    return 0;
}

void brc_rig_field(const struct brc_sim *sim, size_t grain, double v[3])
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_platen *p = &rig->platen[0];
    double middle = sim->bodies.x0[p->body][rig->axis] + 0.5 * rig->length * p->n[rig->axis];
    brc_set(v, 0, 0, 0);
    v[rig->axis] = -rig->sense * rig->rate * (sim->bodies.x0[grain][rig->axis] - middle);
}

void brc_rig_free(struct brc_sim *sim)
{
    brc_table_free(&sim->rig.curve.table);
}

/* Sum of the sizes of n forces; *active is how many of them act. */
static double sum_of_sizes(double (*f)[3], size_t n, double *active)
{
    brc_lanes sum = brc_lanes_all(0), acting = brc_lanes_all(0), one = brc_lanes_all(1), v[3];
    for (size_t i = 0; i < n; i += BRC_LANES) { /* rows past the last are room */
        brc_lanes_at3(v, f + i);
        brc_lanes size = brc_lanes_sqrt(brc_lanes_dot(v, v));
        size = brc_lanes_where(brc_lanes_first((int64_t)(n - i)), size);
        sum += size;
        acting += brc_lanes_where(brc_lanes_less(brc_lanes_all(0), size), one);
    }
    *active = brc_lanes_sum(acting);
    return brc_lanes_sum(sum);
}

/* Mean unbalanced force on a grain over mean contact force. */
static double unbalanced_ratio(const struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    double acting, active;
    double unbalanced = sum_of_sizes(b->f, b->n_grains, &acting);
    double contact = sum_of_sizes(sim->pairs.f, sim->pairs.n, &active);
    if (contact <= 0)
        return 0;
    return unbalanced / (double)b->n_grains / (contact / active);
}

/* The start is over when the field of velocities is that of steady loading. */
static bool is_steady(const struct brc_sim *sim)
{
    bool is_calm =
        sim->step >= LEAST_START && sim->rig.unbalanced < 0.5 * DAMAGING * sim->rig.params.target;
    bool is_late = (double)sim->step >= LONGEST_START / sim->rig.params.target;
    return is_calm || is_late || sim->events.table.n > 0;
}

/* Up to the onset of damage: what kinetic energy goes with a rate, and whether damage has begun. */
static void watch_elastic(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    double kinetic = fmax(sim->ledger.kinetic, DBL_MIN) / (rig->rate * rig->rate);
    double weight = rig->kinetic_elastic > 0 ? ELASTIC_WEIGHT : 1;
    rig->kinetic_elastic += weight * (kinetic - rig->kinetic_elastic);
    bool is_shaken = rig->is_steady && rig->unbalanced > DAMAGING * rig->params.target;
    if (is_shaken || sim->events.table.n > 0)
        rig->strain_onset = rig->strain;
}

/* What was taken for the onset of damage was none: nothing has broken, and all is still. */
static bool was_false_alarm(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    return sim->events.table.n == 0 && rig->strain > BEYOND * rig->strain_onset &&
           rig->unbalanced < STILL * rig->params.target;
}

/* Part of the rate that is left beside an avalanche, told by kinetic energy that loading at the
 * present rate does not explain. */
static double brake(const struct brc_sim *sim, double base)
{
    const struct brc_rig *rig = &sim->rig;
    double rate = fmax(rig->rate, base);
    double usual = AVALANCHE * rig->kinetic_elastic * rate * rate;
    double excess = fmax(sim->ledger.kinetic, 0) / usual;
    return fmax(SLOWEST, 1 / (1 + excess * excess * excess * excess));
}

/* Until damage begins the rate goes along with the strain, so that no scale of it has to be known;
 * from then on it stays, as a peak may be many times as far away. */
static double wanted_rate(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double target = rig->params.target / sim->dt;
    if (rig->strain_onset == 0)
        return fmax(rig->rate, ELASTIC * target * rig->strain);
    double base = target * (rig->is_post_peak ? rig->strain : rig->strain_onset);
    return base * brake(sim, base);
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
        sim->ledger.rate_change -= b->mass[i] * brc_dot(dv, v) + b->inertia[i][0] * brc_dot(dw, w) +
                                   0.5 * sim->dt * (brc_dot(dv, b->f[i]) + brc_dot(dw, b->t[i]));
        brc_add(b->v[i], b->v[i], dv);
        brc_add(b->w[i], b->w[i], dw);
        brc_axpy(b->v_mean[i], part, b->v_mean[i]);
        brc_axpy(b->w_mean[i], part, b->w_mean[i]);
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

static int add_row(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    struct brc_curve *c = &rig->curve;
    const struct brc_ledger *l = &sim->ledger;
    size_t i = c->table.n;
    BRC_TRY(brc_table_resize(sim->ctx, &c->table, i + 1));
    int across[2] = {0, rig->axis == 2 ? 1 : 2};
    double stored = l->bond + l->contact_normal + l->contact_shear;
    c->step[i] = sim->step;
    c->time[i] = sim->time;
    /* over the same steps: a fast rate would set them apart */
    double steps = (double)rig->n_summed, mean = rig->n_summed > 0 ? rig->strain_sum / steps : 0;
    double part = rig->strain > 0 ? mean / rig->strain : 1;
    c->strain[i] = mean;
    c->force[i] = rig->n_summed > 0 ? rig->force_sum / steps : 0;
    c->stress[i] = c->force[i] / rig->section;
    c->strain_axial[i] = part * rig->sense * brc_gauge_strain(sim, rig->axis);
    c->strain_lateral[i] = part * rig->sense * 0.5 *
                           (brc_gauge_strain(sim, across[0]) + brc_gauge_strain(sim, across[1]));
    c->rate[i] = rig->rate;
    c->unbalanced[i] = rig->unbalanced;
    c->kinetic_ratio[i] = stored > 0 ? l->kinetic / stored : 0;
    c->residual[i] = sim->run.ledger ? brc_ledger_residual(l) : 0;
    c->broken[i] = (int64_t)sim->events.table.n;
    rig->force_sum = rig->strain_sum = 0;
    rig->n_summed = 0;
    if (c->force[i] > rig->force_peak) {
        rig->force_peak = c->force[i];
        rig->strain_peak = c->strain[i];
    }
    return 0;
}

/* Forces of the platens on the specimen (along n), their mean in the sense of the test, their work.
 */
static void measure_platens(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    double mean = 0;
    for (int i = 0; i < rig->n_platens; i++) {
        struct brc_platen *p = &rig->platen[i];
        const struct brc_bodies *b = &sim->bodies;
        double force = -brc_dot(b->f[p->body], p->n);
        /* trapezoid rule of ledger.h; the platen moves along n alone */
        sim->ledger.boundary += 0.5 * (p->force + force) * brc_dot(b->v[p->body], p->n) * sim->dt;
        p->force = force;
        mean += rig->sense * force / rig->n_platens;
    }
    rig->force = mean;
    rig->force_sum += mean;
    rig->n_summed += 1;
}

int brc_rig_step(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    if (!BRC_OPTION(rig->n_platens > 0))
        return 0;
    measure_platens(sim);
    rig->strain += rig->rate * sim->dt;
    if (rig->sense > 0 && rig->strain >= PLATENS_MEET)
        BRC_FAIL(sim->ctx, BRC_ERR_BLOWUP,
                 "the platens have met at step %lld, at a strain of %g: lower test.strain_max (now "
                 "%g) or test.rate",
                 (long long)sim->step, rig->strain, rig->params.strain_max);
    rig->strain_sum += rig->strain;
    if (sim->step % UNBALANCED_STEPS == 0) {
        rig->unbalanced = unbalanced_ratio(sim);
        rig->is_steady = rig->is_steady || is_steady(sim);
    }
    if (sim->step >= LEAST_START && rig->params.loading == BRC_LOADING_ADAPTIVE)
        choose_change(sim);
    change_rate(sim);
    set_platen_velocities(sim);
    return 0;
}

int brc_rig_sample(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    if (sim->step % rig->params.sample_steps != 0)
        return 0;
    return add_row(sim);
}

bool brc_rig_done(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    size_t n = rig->curve.table.n;
    if (rig->strain >= rig->params.strain_max)
        return true;
    return n > 0 && rig->params.stop_drop > 0 && rig->force_peak > 0 && sim->events.table.n > 0 &&
           rig->curve.force[n - 1] < rig->params.stop_drop * rig->force_peak;
}

double brc_rig_steps_left(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double left = fmax(rig->params.strain_max - rig->strain, 0), rate = rig->rate;
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

void brc_rig_restore(struct brc_sim *sim)
{
    for (int i = 0; i < sim->rig.n_platens; i++) {
        struct brc_platen *p = &sim->rig.platen[i];
        p->force = -brc_dot(sim->bodies.f[p->body], p->n);
    }
}
