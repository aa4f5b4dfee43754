/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cantilever: a beam held at its lower end, with a dead load across it at the other. The load grows
 * smoothly and then stays until the beam is at rest; what is measured is the static value. It knows
 * the rig and the bodies, and no contact model. */
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"
#include "common/rigs/curve.h"
#include "common/rigs/dead_load.h"
#include "common/rigs/loading.h"

#include <stdlib.h>
#include <string.h>

#define CANTILEVER_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                            \
    CHOICE(                                                                                      \
        axis, "auto|x|y|z", "auto",                                                              \
        "along the beam; auto: the longest of those with flat ends, and the last where several " \
        "are as long")                                                                           \
    CHOICE(direction, "auto|x|y|z|-x|-y|-z", "auto",                                             \
           "of the load, across the beam; auto: -z, or -y where the beam lies along z")          \
    REAL(load, "N", "10 N", "(0, inf)", "dead load on the free end")                             \
    CHOICE(load_follows, "fixed|followed", "fixed",                                              \
           "the load keeps its direction, or turns with the end")                                \
    INT(ramp, "0", "[0, 1000000000]",                                                            \
        "steps over which the load grows; 0: about one period of the beam")                      \
    REAL(tolerance, "1", "1e-4", "(0, 0.1]",                                                     \
         "the test ends when the full load is carried but for this part, see static_residual")   \
    REAL(poisson, "1", "0.2", "(-1, 0.5]",                                                       \
         "Poisson's ratio in the shear part of the deflection; it is not measured here")

struct cantilever_params {
    BRC_PARAM_MEMBERS(CANTILEVER_PARAMS)
};

#define BRC_OWNER struct cantilever_params
static const struct brc_param cantilever_params[] = {BRC_PARAM_LIST(CANTILEVER_PARAMS)};
#undef BRC_OWNER

#define CANTILEVER_COLUMNS(SCALAR, VECTOR)                                             \
    SCALAR(double, load, BRC_STATE, "N", "dead load")                                  \
    SCALAR(double, deflection, BRC_STATE, "m", "way of the loaded end along the load") \
    SCALAR(double, turn, BRC_STATE, "rad", "turn of the loaded end towards the load")  \
    SCALAR(double, root_moment, BRC_STATE, "N m",                                      \
           "moment on the beam at the root, against "                                  \
           "the load's")                                                               \
    SCALAR(double, imbalance, BRC_STATE, "1", "how far the beam is from rest, static_residual")

struct cantilever_columns {
    CANTILEVER_COLUMNS(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct cantilever_columns
static const struct brc_field cantilever_columns[] = {CANTILEVER_COLUMNS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

#define CANTILEVER_PROFILE(SCALAR, VECTOR)                                                       \
    SCALAR(double, x, BRC_STATE, "m", "place along the beam, from the clamp")                    \
    SCALAR(double, deflection, BRC_STATE, "m", "mean of the grains there, along the load")       \
    SCALAR(double, euler, BRC_STATE, "m", "of a beam with E_c and the same tip, without shear")  \
    SCALAR(double, timoshenko, BRC_STATE, "m", "the same with the part of shear, and E_c_shear") \
    SCALAR(int64_t, n_grains, BRC_STATE, "1", "grains in the mean; 0: the clamp, the loaded end")

struct cantilever_profile {
    CANTILEVER_PROFILE(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct cantilever_profile
static const struct brc_field cantilever_profile[] = {CANTILEVER_PROFILE(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

enum { E_EULER, E_TIMOSHENKO, TIP, ROOT_FORCE, ROOT_MOMENT, RESIDUAL, N_RESULTS };
static const struct brc_quantity quantities[N_RESULTS] = {
    [E_EULER] = {"E_c", "Pa", "modulus in bending, from the tip by Euler-Bernoulli"},
    [E_TIMOSHENKO] = {"E_c_shear", "Pa",
                      "the same by Timoshenko: without the part of the deflection that is shear"},
    [TIP] = {"tip", "m", "deflection of the loaded end, along the load"},
    [ROOT_FORCE] = {"root_force", "N", "force of the clamp on the beam, against the load"},
    [ROOT_MOMENT] = {"root_moment", "N m", "moment of the clamp on the beam, against the load's"},
    [RESIDUAL] = {"static_residual", "1",
                  "the largest of: force left over, over the load; moment left over, over load "
                  "times length; root of the kinetic over the stored energy"}};

/* What the beam is, and its load; found again in `place`. */
struct beam {
    double direction[3]; /* of the load */
    double length;       /* m, between clamp and load */
    double area, second; /* m2, m4, of the section */
    int64_t ramp;        /* steps */
    struct brc_dead_load *load;
};

static const struct cantilever_params *params_of(const struct brc_sim *sim)
{
    return sim->rig.own;
}

static struct cantilever_columns *columns_of(const struct brc_sim *sim)
{
    return sim->rig.curve.own_columns;
}

/* --- the beam ----------------------------------------------------------------------------------
 */

/* Ends are flat, and the beam is a prism, where the facets in the end planes have the section that
 * volume over length gives, to this part: rough ends have none, a taper has others. */
static const double FLAT = 0.01;

/* The section, by the clamped end; false: the specimen is no prism along the axis. */
static bool is_beam(const struct brc_specimen *s, int axis, int along, struct brc_end_face *face)
{
    double low[3], high[3];
    struct brc_end_face other;
    brc_specimen_extent(s, low, high);
    double mean = s->domain_volume / (high[axis] - low[axis]);
    brc_end_face_measure(s, brc_end_of(s, axis, true), along, &other);
    brc_end_face_measure(s, brc_end_of(s, axis, false), along, face);
    return fabs(face->area - mean) < FLAT * mean && fabs(other.area - mean) < FLAT * mean;
}

static int find_axis(struct brc_sim *sim, int *axis)
{
    static const char *const name[] = {"auto", "x", "y", "z"};
    const struct cantilever_params *p = params_of(sim);
    double low[3], high[3], longest = 0;
    struct brc_end_face face;
    brc_specimen_extent(sim->specimen, low, high);
    for (int k = 0; k < 3; k++) {
        bool is_asked = p->axis == 0 || p->axis == k + 1;
        if (is_asked && high[k] - low[k] >= longest &&
            is_beam(sim->specimen, k, (k + 1) % 3, &face)) {
            longest = high[k] - low[k];
            *axis = k;
        }
    }
    if (longest == 0)
        BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
                 "a cantilever needs a prism with flat ends along its axis (cantilever.axis = %s): "
                 "facets in both end planes whose areas are volume over length to %g; choose "
                 "another axis, or another specimen",
                 name[p->axis], FLAT);
    return 0;
}

static int find_direction(struct brc_sim *sim, int axis, int *along, double direction[3])
{
    int choice = params_of(sim)->direction;
    double sense = choice >= 1 && choice <= 3 ? 1 : -1;
    *along = choice > 0 ? (choice - 1) % 3 : axis == 2 ? 1 : 2;
    if (*along == axis)
        BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                 "cantilever.direction lies along the beam, whose axis is %c: choose one of the "
                 "two directions across it",
                 "xyz"[axis]);
    brc_set(direction, 0, 0, 0);
    direction[*along] = sense;
    return 0;
}

/* One period of the lowest mode, w^2 = 12.4 E I / (rho A L^4): with the speed of waves that scaled
 * masses give, it was 19 L^2 / (H h) steps on cubes (docs/tests.md), H the height of a rectangle of
 * that section and h the size of a grain. Shorter ramps leave more to be damped afterwards, longer
 * ones are themselves the longer way. */
static int64_t automatic_ramp(const struct brc_sim *sim, const struct beam *beam)
{
    static const double PERIOD = 20, LEAST = 100;
    double height = sqrt(12 * beam->second / beam->area);
    double grain = cbrt(sim->specimen->domain_volume / (double)sim->bodies.n_grains);
    return (int64_t)fmax(LEAST, PERIOD * beam->length * beam->length / (height * grain));
}

/* At rest, bonded in all directions: it holds the root and does no work. */
static void place_clamp(struct brc_sim *sim, int axis, int along, const struct brc_end_face *face)
{
    struct brc_platen *p = &sim->rig.platen[0];
    *p = (struct brc_platen){.body = (int32_t)sim->bodies.n_grains,
                             .surface = BRC_SURFACE_PLANE,
                             .half_width = HUGE_VAL,
                             .bonding = BRC_BONDING_FULL};
    p->n[axis] = 1;
    p->across[along] = 1;
    brc_copy(sim->bodies.x[p->body], face->middle);
    brc_copy(sim->bodies.x0[p->body], face->middle);
}

/* The rate is never given here but follows from the load, so `fixed` is what the engine has to
 * know: local damping is then that of all motion (sim.c). Stress is that at the root's edge. */
static int place(struct brc_sim *sim)
{
    const struct cantilever_params *p = params_of(sim);
    struct brc_rig *rig = &sim->rig;
    struct brc_end_face face;
    int axis = 0, along = 0;
    double low[3], high[3];
    struct beam *beam = rig->memory = brc_alloc(sim->ctx, 1, sizeof *beam);
    if (!beam)
        return BRC_ERR_MEMORY;
    BRC_TRY(find_axis(sim, &axis));
    BRC_TRY(find_direction(sim, axis, &along, beam->direction));
    is_beam(sim->specimen, axis, along, &face);
    brc_specimen_extent(sim->specimen, low, high);
    for (int k = 0; k < 3; k++)
        rig->length[k] = high[k] - low[k];
    beam->length = rig->length[axis];
    beam->area = face.area;
    beam->second = face.second;
    beam->ramp = p->ramp > 0 ? p->ramp : automatic_ramp(sim, beam);
    rig->axis = axis;
    rig->sense = 1;
    rig->section = face.second / (beam->length * face.farthest);
    rig->params.loading = BRC_LOADING_FIXED;
    place_clamp(sim, axis, along, &face);
    return brc_dead_load_create(sim, brc_end_of(sim->specimen, axis, true), beam->direction,
                                p->load_follows == 1, &beam->load);
}

static void drop(void *memory)
{
    struct beam *beam = memory;
    if (beam)
        brc_dead_load_free(beam->load);
    free(beam);
}

/* --- loading -----------------------------------------------------------------------------------
 */

/* A smooth step has no jump of the load's rate at either end, which would set the beam ringing. */
static double load_now(const struct brc_sim *sim)
{
    const struct beam *beam = sim->rig.memory;
    double x = fmin(1, (double)sim->step / (double)beam->ramp);
    return params_of(sim)->load * x * x * (3 - 2 * x);
}

/* The load's work is in the deflection, so that over the length is what strain is here. Its rate
 * only tells when strain_max would be reached; a beam on its way back reaches it never. */
static int drive(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    const struct beam *beam = rig->memory;
    brc_dead_load_apply(sim, beam->load, load_now(sim));
    rig->force = brc_dot(sim->bodies.f[rig->platen[0].body], beam->direction);
    rig->force_sum += rig->force;
    rig->n_summed += 1;
    rig->rate = (brc_dead_load_way(sim, beam->load) / beam->length - rig->strain) / sim->dt;
    brc_loading_step(sim);
    rig->rate = fmax(rig->rate, 0);
    return 0;
}

static void restore(struct brc_sim *sim)
{
    const struct beam *beam = sim->rig.memory;
    brc_dead_load_restore(sim, beam->load, load_now(sim));
}

/* --- at rest? ----------------------------------------------------------------------------------
 */

/* Exact, since the end of the test hangs on it. */
static double left_over(const struct brc_sim *sim, bool is_moment)
{
    const struct brc_bodies *b = &sim->bodies;
    const double *root = b->x[sim->rig.platen[0].body];
    double sum[3];
    for (int k = 0; k < 3; k++) {
        for (size_t i = 0; i < b->n_grains; i++) {
            double arm[3], moment[3];
            brc_sub(arm, b->x[i], root);
            brc_cross(moment, arm, b->f[i]);
            b->terms[i] = is_moment ? moment[k] + b->t[i][k] : b->f[i][k];
        }
        sum[k] = brc_sum_exact(b->terms, b->n_grains);
    }
    return brc_norm(sum);
}

/* A beam that swings is out of balance at its turning points and fast between them, so that one of
 * the three is always large until it rests. The mean unbalanced ratio is small long before: of a
 * slow swing each grain feels next to nothing. */
static double imbalance(const struct brc_sim *sim, const struct brc_ledger *l)
{
    const struct beam *beam = sim->rig.memory;
    double load = params_of(sim)->load;
    double stored = l->bond + l->contact_normal + l->contact_shear;
    double speed = stored > 0 ? sqrt(fmax(l->kinetic, 0) / stored) : 0;
    double force = left_over(sim, false) / load;
    return fmax(speed, fmax(force, left_over(sim, true) / (load * beam->length)));
}

static double root_moment(const struct brc_sim *sim)
{
    const struct beam *beam = sim->rig.memory;
    double outward[3], about[3];
    brc_copy(outward, sim->rig.platen[0].n);
    brc_cross(about, outward, beam->direction); /* the load's moment turns about it */
    return brc_dot(sim->bodies.t[sim->rig.platen[0].body], about);
}

static int measure(struct brc_sim *sim)
{
    const struct beam *beam = sim->rig.memory;
    size_t n = sim->rig.curve.table.n;
    BRC_TRY(brc_curve_sample(sim));
    if (sim->rig.curve.table.n == n)
        return 0;
    struct cantilever_columns *c = columns_of(sim);
    c->load[n] = load_now(sim);
    c->deflection[n] = brc_dead_load_way(sim, beam->load);
    c->turn[n] = brc_dead_load_turn(sim, beam->load);
    c->root_moment[n] = root_moment(sim);
    c->imbalance[n] = imbalance(sim, &sim->ledger); /* settled for the row */
    return 0;
}

/* The last row says whether the beam has come to rest under its full load. */
static bool is_static(const struct brc_sim *sim)
{
    const struct beam *beam = sim->rig.memory;
    size_t n = sim->rig.curve.table.n;
    return n > 0 && sim->rig.curve.step[n - 1] >= beam->ramp &&
           columns_of(sim)->imbalance[n - 1] <= params_of(sim)->tolerance;
}

static const char *end(const struct brc_sim *sim)
{
    if (is_static(sim))
        return "cantilever.tolerance";
    return sim->rig.strain >= sim->rig.params.strain_max ? "test.strain_max" : NULL;
}

/* --- results -----------------------------------------------------------------------------------
 */

/* Deflection at a distance from the root of a beam with E = 1 under a load of 1. */
static double euler(const struct beam *beam, double x)
{
    return x * x * (3 * beam->length - x) / (6 * beam->second); /* eq:gt12:29 */
}

/* The part of shear, 1 / (k G A) a length, with the coefficient k = 10 (1 + nu) / (12 + 11 nu) of a
 * rectangle. */
static double shear(const struct beam *beam, double x, double nu)
{
    return x * (12 + 11 * nu) / (5 * beam->area);
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    static const char no_row[] = "no row of the curve: fewer steps than test.sample_steps";
    static const char moves[] = "the beam was not yet at rest under the full load";
    const struct beam *beam = sim->rig.memory;
    const struct cantilever_params *p = params_of(sim);
    size_t n = sim->rig.curve.table.n;
    const char *note = n == 0 ? no_row : is_static(sim) ? NULL : moves;
    double tip = n > 0 ? columns_of(sim)->deflection[n - 1] : NAN, nu = p->poisson;
    double bending = euler(beam, beam->length);
    const double value[N_RESULTS] = {
        [E_EULER] = p->load * bending / tip,
        [E_TIMOSHENKO] = p->load * (bending + shear(beam, beam->length, nu)) / tip,
        [TIP] = tip,
        [ROOT_FORCE] = n > 0 ? sim->rig.curve.force[n - 1] : NAN,
        [ROOT_MOMENT] = n > 0 ? columns_of(sim)->root_moment[n - 1] : NAN,
        [RESIDUAL] = n > 0 ? columns_of(sim)->imbalance[n - 1] : NAN};
    for (int i = 0; i < N_RESULTS; i++) {
        const char *why = i == RESIDUAL && n > 0 ? NULL : note;
        out[i] = (struct brc_measured){why ? NAN : value[i], why};
    }
}

/* Deflections of beams with the tip's, by both theories: their moduli then do not matter. */
static void add_theories(const struct brc_sim *sim, struct cantilever_profile *c, size_t row)
{
    const struct beam *beam = sim->rig.memory;
    double nu = params_of(sim)->poisson, x = c->x[row], l = beam->length;
    double tip = brc_dead_load_way(sim, beam->load);
    c->euler[row] = tip * euler(beam, x) / euler(beam, l);
    c->timoshenko[row] =
        tip * (euler(beam, x) + shear(beam, x, nu)) / (euler(beam, l) + shear(beam, l, nu));
}

/* A row a slice of about one grain, by volume: single grains stand out of the line, the more the
 * fewer there are. The first and the last row are the clamp and the loaded end. */
static int profile(const struct brc_sim *sim, struct brc_table *out)
{
    const struct beam *beam = sim->rig.memory;
    const struct brc_bodies *b = &sim->bodies;
    const struct brc_platen *clamp = &sim->rig.platen[0];
    double grain = cbrt(sim->specimen->domain_volume / (double)b->n_grains);
    size_t n = (size_t)fmax(1, round(beam->length / grain)), rows = 1;
    double(*sum)[3] = brc_alloc(sim->ctx, n, sizeof *sum);
    size_t *grains = brc_alloc(sim->ctx, n, sizeof *grains);
    int code = sum && grains ? brc_table_resize(sim->ctx, out, n + 2) : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < b->n_grains; i++) {
        double way[3], x = b->x0[i][sim->rig.axis] - b->x0[clamp->body][sim->rig.axis];
        size_t slice = (size_t)fmin(fmax(x / beam->length, 0) * (double)n, (double)n - 1);
        brc_sub(way, b->x[i], b->x0[i]);
        sum[slice][0] += b->volume[i];
        sum[slice][1] += b->volume[i] * x;
        sum[slice][2] += b->volume[i] * brc_dot(way, beam->direction);
        grains[slice]++;
    }
    struct cantilever_profile *c = out->columns;
    for (size_t i = 0; code == 0 && i < n; i++) {
        if (grains[i] == 0)
            continue;
        c->x[rows] = sum[i][1] / sum[i][0];
        c->deflection[rows] = sum[i][2] / sum[i][0];
        c->n_grains[rows++] = (int64_t)grains[i];
    }
    free(sum);
    free(grains);
    BRC_TRY(code);
    c->x[rows] = beam->length;
    c->deflection[rows++] = brc_dead_load_way(sim, beam->load);
    for (size_t i = 0; i < rows; i++)
        add_theories(sim, c, i);
    return brc_table_resize(sim->ctx, out, rows);
}

static const struct brc_rig_view view = {.strain = "strain",
                                         .strain_label = "deflection / length",
                                         .stress_label = "bending stress at the root"};

const struct brc_rig_type brc_rig_cantilever = {
    .name = "cantilever",
    .meaning = "a beam held at one end, with a dead load at the other",
    .physics = 1,
    .keys = "strain_max sample_steps",
    .params = BRC_PARAMS(cantilever_params, struct cantilever_params),
    .columns = BRC_FIELDSET(cantilever_columns, struct cantilever_columns),
    .along = BRC_FIELDSET(cantilever_profile, struct cantilever_profile),
    .quantities = quantities,
    .n_quantities = N_RESULTS,
    .n_platens = 1,
    .sides = BRC_CORE_SIDES,
    .view = &view,
    .place = place,
    .drive = drive,
    .measure = measure,
    .results = results,
    .end = end,
    .restore = restore,
    .free = drop,
    .profile = profile};
