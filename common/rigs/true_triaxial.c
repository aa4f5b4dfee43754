/* SPDX-License-Identifier: GPL-3.0-or-later */
/* True triaxial test: a box between six platens. Those along z are driven by the loading; those
 * along x and y are held, or pushed by a force that follows a rule (stress_path.h), so that no
 * stage needs a target in time: where the specimen softens, all axes wait for it together.
 *
 * Stresses are true ones, over the area now, and strains are of the platens; load and stress of the
 * curve are the deviator sigma_z - (sigma_x + sigma_y) / 2, by which moduli, peak and end are told.
 */
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/rigs/elastic_moduli.h"
#include "common/rigs/servo.h"
#include "common/rigs/stress_path.h"
#include "common/rigs/two_platens.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TRUE_TRIAXIAL_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                       \
    TEXT(stages, "isotropic to 10 MPa, lateral constant to strain 0.02",                       \
         "path of the test: isotropic, p constant, lateral constant, plane strain, uniaxial "  \
         "strain, lode ANGLE, ratio X Y, each 'to strain E' or 'to STRESS'; or stress X Y Z")  \
    CHOICE(bonds, "off|normal", "off",                                                         \
           "normal: grains on the platens are bonded to them, without end, along the normal; " \
           "off: a platen cannot pull")

struct true_triaxial_params {
    BRC_PARAM_MEMBERS(TRUE_TRIAXIAL_PARAMS)
};
#define BRC_OWNER struct true_triaxial_params
static const struct brc_param true_triaxial_params[] = {BRC_PARAM_LIST(TRUE_TRIAXIAL_PARAMS)};
#undef BRC_OWNER

/* x, y, z throughout */
#define STATE(SCALAR, VECTOR)                                                                  \
    VECTOR(double, mass, 2, BRC_STATE, "kg", "of the platens along x, y")                      \
    VECTOR(double, constant, 2, BRC_STATE, "Pa", "laws of the stage: sigma = constant")        \
    VECTOR(double, part, 2, BRC_STATE, "1", "+ part sigma_z")                                  \
    VECTOR(double, held, 2, BRC_STATE, "1", "1: the axis does not move")                       \
    VECTOR(double, sum, 3, BRC_STATE, "Pa", "stresses, summed since the last row")             \
    VECTOR(double, asked, 2, BRC_STATE, "Pa", "stresses asked for, summed since then")         \
    VECTOR(double, strain_sum, 3, BRC_STATE, "1", "strains of the platens, summed since then") \
    SCALAR(double, largest, BRC_STATE, "Pa", "largest stress of a row so far")                 \
    SCALAR(int64_t, is_over, BRC_STATE, "1", "1: the last stage has ended")
#define BRC_OWNER struct state
struct state {
    STATE(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field state_fields[] = {STATE(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

#define COLUMNS(SCALAR, VECTOR)                                                                    \
    SCALAR(int64_t, stage, BRC_STATE, "1", "stage, from 1")                                        \
    SCALAR(double, sigma_x, BRC_STATE, "Pa", "stress along x")                                     \
    SCALAR(double, sigma_y, BRC_STATE, "Pa", "along y")                                            \
    SCALAR(double, sigma_z, BRC_STATE, "Pa", "along z")                                            \
    SCALAR(double, p, BRC_STATE, "Pa", "mean stress")                                              \
    SCALAR(double, q, BRC_STATE, "Pa", "deviatoric stress")                                        \
    SCALAR(double, lode, BRC_STATE, "rad", "Lode angle: 0 in triaxial compression")                \
    SCALAR(double, eps_x, BRC_STATE, "1", "strain of the platens along x, compression +")          \
    SCALAR(double, eps_y, BRC_STATE, "1", "along y")                                               \
    SCALAR(double, eps_z, BRC_STATE, "1", "along z")                                               \
    SCALAR(double, eps_v, BRC_STATE, "1", "volume strain")                                         \
    SCALAR(double, eps_d, BRC_STATE, "1", "deviatoric strain, conjugate to q")                     \
    SCALAR(double, eps_d_printed, BRC_STATE, "1",                                                  \
           "the same as eq 23 of gt12 has it: sqrt(3) of it")                                      \
    SCALAR(double, missed, BRC_STATE, "1",                                                         \
           "largest difference of a stress asked for from its mean over the row, over the larger " \
           "of it and 1 % of the largest stress")
#define BRC_OWNER struct columns
struct columns {
    COLUMNS(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field columns_fields[] = {COLUMNS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* What the case has asked for. It is read again from the text of the case after a restart, so that
 * the saved state holds numbers alone. */
struct plan {
    struct brc_stage stage[BRC_MAX_STAGES];
    int n;
};

enum { X, Y, Z };
/* first platen of the pair along each axis: those of z come first, as in other tests */
static const int pair_of[3] = {2, 4, 0};

static const struct brc_stage *stage_now(const struct brc_sim *sim)
{
    const struct plan *plan = sim->rig.memory;
    return &plan->stage[sim->rig.stage];
}

/* --- beginning ---------------------------------------------------------------------------------
 */

/* The path is read here and thrown away, and once more by place: a mistake in it is told with the
 * line of the case, before a specimen is made. */
static int check(struct brc_context *ctx, const struct brc_test_params *t, const void *own)
{
    const struct true_triaxial_params *params = own;
    struct plan plan;
    BRC_TRY(brc_stages_read(ctx, params->stages, plan.stage, &plan.n));
    return brc_two_platens_check(ctx, t, own);
}

/* Six platens close a box alone: a side that lies on none would be free, and its stress nobody's.
 */
static int check_box(struct brc_sim *sim)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct brc_facing *facing;
    size_t n, on = 0, boundary = 0;
    BRC_TRY(brc_platens_facing(sim, &facing, &n));
    for (size_t i = 0; i < n; i++)
        on += facing[i].is_on;
    free(facing);
    for (size_t i = 0; i < f->n_facets; i++)
        boundary += f->cell[i][1] < 0;
    if (on == boundary)
        return 0;
    BRC_FAIL(
        sim->ctx, BRC_ERR_INPUT,
        "true_triaxial needs a box along the axes: %zu of %zu facets of the specimen's surface "
        "lie on none of the six platens; use specimen.shape: box, or another test",
        boundary - on, boundary);
}

/* A straight path is told by sigma_z, so it must change on it. */
static int set_laws(struct brc_sim *sim, const double sigma[3])
{
    struct state *s = sim->rig.own_scalars;
    struct brc_axis_law law[2];
    if (stage_now(sim)->kind == BRC_PATH_STRESS && stage_now(sim)->value[Z] == sigma[Z])
        BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                 "true_triaxial, stage %lld: sigma_z is %g MPa at its start and its end, and z is "
                 "the axis that is driven: give another stress along z",
                 (long long)sim->rig.stage + 1, 1e-6 * sigma[Z]);
    brc_stage_laws(stage_now(sim), sigma, law);
    for (int k = 0; k < 2; k++) {
        s->constant[0][k] = law[k].constant;
        s->part[0][k] = law[k].part;
        s->held[0][k] = law[k].is_held;
    }
    return 0;
}

/* A stage by strain has the start of a test of that strain: the loading's first rate is a part of
 * strain_max, which the case has none of here. */
static void set_strain_max(struct brc_rig *rig, const struct brc_stage *stage)
{
    if (stage->is_to_strain)
        rig->params.strain_max = fabs(stage->to);
}

/* An axis moves along with z, by the same strain, where the stage has all stresses grow together.
 */
static bool moves_along(const struct brc_sim *sim, int k)
{
    const struct state *s = sim->rig.own_scalars;
    return s->part[0][k] > 0 && !s->held[0][k];
}

/* Both platens of a pair, towards each other: the middle of the specimen stays. */
static void set_speed(struct brc_sim *sim, int axis, double speed)
{
    for (int i = pair_of[axis]; i < pair_of[axis] + 2; i++) {
        const struct brc_platen *p = &sim->rig.platen[i];
        brc_scale(sim->bodies.v[p->body], p->n, speed);
    }
}

/* Of one platen: the two approach by the rate together, so that the middle stays where it is. */
static double driven_speed(const struct brc_rig *rig, int axis)
{
    return 0.5 * rig->stage_sense * rig->rate * rig->length[axis];
}

static int place(struct brc_sim *sim)
{
    static const double nothing[3] = {0, 0, 0};
    struct brc_rig *rig = &sim->rig;
    const struct true_triaxial_params *params = rig->own;
    const struct brc_platen like = {.friction = rig->params.friction,
                                    .bonding =
                                        params->bonds ? BRC_BONDING_NORMAL : BRC_BONDING_NONE};
    struct plan *plan = rig->memory = brc_alloc(sim->ctx, 1, sizeof *plan);
    if (!plan)
        return BRC_ERR_MEMORY;
    BRC_TRY(brc_stages_read(sim->ctx, params->stages, plan->stage, &plan->n));
    set_strain_max(rig, stage_now(sim));
    BRC_TRY(set_laws(sim, nothing));
    rig->stage_sense = brc_stage_sense(stage_now(sim), nothing);
    for (int k = 0; k < 3; k++)
        brc_two_platens_face(sim, pair_of[k], k, &like);
    brc_two_platens_begin(sim, Z, 1, brc_two_platens_section(sim, Z));
    BRC_TRY(check_box(sim));
    for (int k = 0; k < 3; k++)
        set_speed(sim, k, k == Z || moves_along(sim, k) ? driven_speed(rig, k) : 0);
    return 0;
}

/* Only axes that begin to move: the grains of a held one would run into its platens. */
/* Axes that are held or pushed begin at rest: how fast a pushed one will move hangs on Poisson's
 * ratio, which nobody knows yet. */
static void field(const struct brc_sim *sim, size_t grain, double v[3])
{
    const struct brc_rig *rig = &sim->rig;
    brc_set(v, 0, 0, 0);
    for (int k = 0; k < 3; k++)
        if (k == Z || moves_along(sim, k)) {
            const struct brc_platen *p = &rig->platen[pair_of[k]];
            double middle = sim->bodies.x0[p->body][k] + 0.5 * rig->length[k];
            v[k] = -rig->stage_sense * rig->rate * (sim->bodies.x0[grain][k] - middle);
        }
}

/* --- a step ------------------------------------------------------------------------------------
 */

static double length_now(const struct brc_sim *sim, int axis)
{
    const struct brc_platen *p = &sim->rig.platen[pair_of[axis]];
    return sim->bodies.x[p[1].body][axis] - sim->bodies.x[p[0].body][axis];
}

/* By the platens and not by the grains: gaps at the corners are part of the area, as a platen of a
 * machine has them under it, too. */
/* Between the platens of the other axes, and not of the grains: a dilating pack has a rough side,
 * and the platens' distance is what its work goes with. */
static double area_now(const struct brc_sim *sim, int axis)
{
    return length_now(sim, (axis + 1) % 3) * length_now(sim, (axis + 2) % 3);
}

/* Mean of both platens: they differ by what the grains between them are accelerated with. */
/* The mean of both platens, as they differ while the specimen accelerates. */
static double stress_now(const struct brc_sim *sim, int axis)
{
    const struct brc_platen *p = &sim->rig.platen[pair_of[axis]];
    return 0.5 * (p[0].force + p[1].force) / area_now(sim, axis);
}

/* Platens without bonds cannot pull; rounding about a free face is none. */
static int check_tension(struct brc_sim *sim, int axis, double asked)
{
    const struct true_triaxial_params *params = sim->rig.own;
    const struct state *s = sim->rig.own_scalars;
    if (params->bonds || asked >= -0.01 * s->largest[0])
        return 0;
    BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
             "true_triaxial, stage %lld: sigma_%c would have to be %.3g MPa, and platens without "
             "bonds cannot pull (a constant p needs q <= 3 p): end the stage before, raise the "
             "confinement, or use true_triaxial.bonds: normal",
             (long long)sim->rig.stage + 1, "xyz"[axis], 1e-6 * asked);
}

/* A held axis misses nothing, so it asks for what it has: rows that two stages share stay right. */
static int drive_axis(struct brc_sim *sim, int axis, const double sigma[3])
{
    struct state *s = sim->rig.own_scalars;
    if (s->held[0][axis]) {
        s->asked[0][axis] += sigma[axis];
        set_speed(sim, axis, 0);
        return 0;
    }
    double asked = s->constant[0][axis] + s->part[0][axis] * sigma[Z];
    s->asked[0][axis] += asked;
    BRC_TRY(check_tension(sim, axis, asked));
    brc_servo_push(sim, pair_of[axis], asked * area_now(sim, axis), &s->mass[0][axis]);
    return 0;
}

/* The laws of a stage begin from what the stage before was to reach, or what was reached where it
 * ended by strain: a p of 110 MPa is then 110 MPa, and not a step more. */
static int next_stage(struct brc_sim *sim, const double reached[3])
{
    struct brc_rig *rig = &sim->rig;
    struct plan *plan = rig->memory;
    struct state *s = rig->own_scalars;
    if (rig->stage + 1 == plan->n) {
        s->is_over[0] = 1;
        return 0;
    }
    double sigma[3];
    brc_stage_reaches(stage_now(sim), reached, sigma);
    brc_loading_begin_stage(sim, brc_stage_sense(stage_now(sim) + 1, sigma));
    set_strain_max(rig, stage_now(sim));
    return set_laws(sim, sigma);
}

/* Sums before a stage may end: the row that two stages share has each step in it once. z comes
 * last, as its velocity is that of the rate which the load of this step has chosen. */
/* In this order: a stage that ends does so on the stresses of this step; its successor's laws hold
 * from the same step on; and z is driven last, as the loading may have changed the rate. */
static int drive(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    struct state *s = rig->own_scalars;
    double sigma[3];
    for (int k = 0; k < 3; k++) {
        sigma[k] = stress_now(sim, k);
        s->sum[0][k] += sigma[k];
        s->strain_sum[0][k] += 1 - length_now(sim, k) / rig->length[k];
    }
    if (brc_stage_is_over(stage_now(sim), rig->stage_sense, brc_loading_strain(rig), sigma))
        BRC_TRY(next_stage(sim, sigma));
    for (int k = 0; k < 2; k++)
        BRC_TRY(drive_axis(sim, k, sigma));
    BRC_TRY(brc_two_platens_load(sim, (sigma[Z] - 0.5 * (sigma[X] + sigma[Y])) * rig->section));
    set_speed(sim, Z, driven_speed(rig, Z));
    return 0;
}

/* stop_drop ends the last stage alone: in those before it a load that falls may be what the path
 * asks for. */
/* A drop of the load ends the last stage alone: those before are there to reach a state. */
static const char *end(const struct brc_sim *sim)
{
    const struct state *s = sim->rig.own_scalars;
    const struct plan *plan = sim->rig.memory;
    if (sim->rig.stage + 1 < plan->n)
        return NULL;
    bool is_over = s->is_over[0] || (stage_now(sim)->is_to_strain &&
                                     brc_loading_strain(&sim->rig) >= fabs(stage_now(sim)->to));
    return is_over ? "true_triaxial.stages" : brc_loading_fallen(sim) ? "test.stop_drop" : NULL;
}

/* The plan itself was read by place; strain_max is no part of the state, as each stage has its own.
 */
/* params are those of the case: what a stage has made of them is not saved. */
static void restore(struct brc_sim *sim)
{
    set_strain_max(&sim->rig, stage_now(sim));
}

/* --- rows and results --------------------------------------------------------------------------
 */

/* What the servo has missed over a row, where one was at work. */
static double missed(const struct state *s, const double sigma[3], double steps)
{
    double worst = 0;
    for (int k = 0; k < 2; k++) {
        double asked = s->asked[0][k] / steps, scale = fmax(fabs(asked), 0.01 * s->largest[0]);
        if (!s->held[0][k] && scale > 0)
            worst = fmax(worst, fabs(sigma[k] - asked) / scale);
    }
    return worst;
}

/* Means of the step, like all of the curve: q of the means is not the mean of q, and smaller where
 * stresses shake. */
/* Stresses and strains are means over the same steps, or a row's stress would be half a row behind
 * its strain, and every modulus of a quickly loaded test too small. */
static void fill_row(struct brc_sim *sim, size_t row, double steps)
{
    struct columns *c = sim->rig.curve.own_columns;
    struct state *s = sim->rig.own_scalars;
    double sigma[3], eps[3];
    for (int k = 0; k < 3; k++) {
        sigma[k] = s->sum[0][k] / steps;
        eps[k] = s->strain_sum[0][k] / steps;
        s->largest[0] = fmax(s->largest[0], fabs(sigma[k]));
    }
    c->stage[row] = sim->rig.stage + 1;
    c->sigma_x[row] = sigma[X];
    c->sigma_y[row] = sigma[Y];
    c->sigma_z[row] = sigma[Z];
    c->p[row] = brc_mean_stress(sigma);
    c->q[row] = brc_deviatoric_stress(sigma);
    c->lode[row] = brc_lode_angle(sigma);
    c->eps_x[row] = eps[X];
    c->eps_y[row] = eps[Y];
    c->eps_z[row] = eps[Z];
    c->eps_v[row] = brc_volume_strain(eps);
    c->eps_d[row] = brc_deviatoric_strain(eps);
    c->eps_d_printed[row] = sqrt(3) * c->eps_d[row];
    c->missed[row] = missed(s, sigma, steps);
}

static int measure(struct brc_sim *sim)
{
    struct state *s = sim->rig.own_scalars;
    size_t row = sim->rig.curve.table.n;
    double steps = (double)sim->rig.n_summed;
    BRC_TRY(brc_curve_sample(sim));
    if (sim->rig.curve.table.n == row)
        return 0;
    fill_row(sim, row, steps);
    memset(s->sum[0], 0, sizeof s->sum[0]);
    memset(s->asked[0], 0, sizeof s->asked[0]);
    memset(s->strain_sum[0], 0, sizeof s->strain_sum[0]);
    return 0;
}

static const struct brc_quantity quantities[] = {
    {"E", "Pa", "Young's modulus, from G and the bulk modulus by stresses and gauge strains"},
    {"nu", "1", "Poisson's ratio, likewise"},
    {"G", "Pa", "shear modulus by deviators of stress and gauge strain"},
    {"strength", "Pa", "largest sigma_z - (sigma_x + sigma_y) / 2, once it has fallen from it"},
    {"strain_at_peak", "1", "strain along z there, since the stage began"},
    {"p_at_peak", "Pa", "mean stress there"},
    {"q_at_peak", "Pa", "deviatoric stress there"},
    {"lode_at_peak", "rad", "Lode angle there"},
    {"q_residual", "Pa", "mean deviatoric stress of the last quarter of the last stage's rows"},
    {"servo_missed", "1", "largest `missed` of the rows: see the columns of the curve"}};
enum { N_QUANTITIES = sizeof quantities / sizeof quantities[0] };

static const char no_rows[] = "fewer than 3 rows of the curve from test.modulus_low to "
                              "test.modulus_high: lower test.sample_steps or load more slowly",
                  no_gauge[] = "fewer than 4 grains in the gauge, or all close to one place along "
                               "an axis",
                  no_pressure[] = "the mean stress stays, so that G alone can be told";

/* Change of the mean stress, over that of the deviator, from which K is worth something. */
static const double P_CHANGES = 0.05;

/* One row's deviators or means of stress [0] and gauge strain [1]. */
static void shear_pair(const struct brc_rig *rig, size_t row, double pair[2])
{
    const struct brc_curve *c = &rig->curve;
    pair[0] = c->stress[row];
    pair[1] = c->strain_axial[row] - c->strain_lateral[row];
}

static void bulk_pair(const struct brc_rig *rig, size_t row, double pair[2])
{
    const struct brc_curve *c = &rig->curve;
    pair[0] = ((const struct columns *)c->own_columns)->p[row];
    pair[1] = c->strain_axial[row] + 2 * c->strain_lateral[row];
}

static struct brc_line fit(const struct brc_sim *sim, size_t first, size_t n,
                           void (*pair_of_row)(const struct brc_rig *, size_t, double[2]))
{
    struct brc_line line = {NAN, NAN, NAN};
    double *stress = brc_alloc(sim->ctx, n, sizeof *stress), pair[2];
    double *strain = brc_alloc(sim->ctx, n, sizeof *strain);
    for (size_t i = 0; stress && strain && i < n; i++) {
        pair_of_row(&sim->rig, first + i, pair);
        stress[i] = pair[0];
        strain[i] = pair[1];
    }
    if (stress && strain)
        line = brc_line_fit(strain, stress, n);
    free(stress);
    free(strain);
    return line;
}

/* G by deviators, K by means: with both, E and nu do not hang on which stresses the path keeps. */
static void moduli(const struct brc_sim *sim, struct brc_measured out[3])
{
    const struct brc_rig *rig = &sim->rig;
    const char *note = brc_curve_why_no_peak(rig);
    size_t first = 0, end = 0;
    struct brc_line shear = {0}, bulk = {0};
    if (note == NULL || note == brc_curve_no_peak) {
        bool is_gauged = rig->has_gauge[0] && rig->has_gauge[1] && rig->has_gauge[2];
        brc_moduli_rows(rig, &first, &end);
        note = end < first + 3 ? no_rows : is_gauged ? NULL : no_gauge;
    }
    if (!note) {
        shear = fit(sim, first, end - first, shear_pair);
        bulk = fit(sim, first, end - first, bulk_pair);
    }
    double g = note ? NAN : shear.slope / 2, k = bulk.slope;
    const char *both = note ? note : bulk.varies > P_CHANGES * shear.varies ? NULL : no_pressure;
    out[0] = (struct brc_measured){both ? NAN : 9 * k * g / (3 * k + g), both};
    out[1] = (struct brc_measured){both ? NAN : (3 * k - 2 * g) / (6 * k + 2 * g), both};
    out[2] = (struct brc_measured){g, note};
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    const struct brc_rig *rig = &sim->rig;
    const struct columns *c = rig->curve.own_columns;
    const char *note = brc_curve_why_no_peak(rig);
    size_t n = rig->curve.table.n, peak = brc_curve_peak_row(rig),
           rest = n - (n - (size_t)rig->stage_row) / 4;
    moduli(sim, out);
    const double at_peak[] = {rig->force_peak / rig->section, rig->strain_peak - rig->stage_strain,
                              note ? 0 : c->p[peak], note ? 0 : c->q[peak],
                              note ? 0 : c->lode[peak]};
    for (int i = 0; i < 5; i++)
        out[3 + i] = (struct brc_measured){note ? NAN : at_peak[i], note};
    double q = 0, worst = 0;
    for (size_t i = rest; i < n; i++)
        q += c->q[i] / (double)(n - rest);
    for (size_t i = 0; i < n; i++)
        worst = fmax(worst, c->missed[i]);
    const char *none = rest < n ? NULL : "fewer than 4 rows of the curve in the last stage";
    out[8] = (struct brc_measured){none ? NAN : q, none};
    out[9] = (struct brc_measured){worst, NULL};
}

/* In the order of the axes: which of them is the largest may change along a path. */
static void stresses(const struct brc_sim *sim, size_t row, double sigma[3])
{
    const struct columns *c = sim->rig.curve.own_columns;
    sigma[X] = c->sigma_x[row];
    sigma[Y] = c->sigma_y[row];
    sigma[Z] = c->sigma_z[row];
}

const struct brc_rig_type brc_rig_true_triaxial = {
    .name = "true_triaxial",
    .meaning = "a box between six platens, along a path of stresses and strains",
    /* without strain_max: stages say where they end */
    .physics = 1,
    .keys = "loading rate target rate_min rate_max stop_drop " BRC_CURVE_KEYS BRC_MODULI_KEYS
            "friction",
    .params = BRC_PARAMS(true_triaxial_params, struct true_triaxial_params),
    .state = BRC_FIELDSET(state_fields, struct state),
    .columns = BRC_FIELDSET(columns_fields, struct columns),
    .quantities = quantities,
    .n_quantities = N_QUANTITIES,
    .n_platens = 6,
    .view = &brc_curve_deviator_view,
    .check = check,
    .place = place,
    .drive = drive,
    .measure = measure,
    .results = results,
    .stresses = stresses,
    .field = field,
    .end = end,
    .restore = restore,
    .free = free};
