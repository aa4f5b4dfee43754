/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The step: what is done in it, in which order, and what a simulation is made of before the first
 * one. Called by runs and by tests; it knows models and tests through their tables only (model.h,
 * rig.h), and neither files nor cases.
 *
 * The order of a step is that of docs/numerics.md: drift, neighbour search, forces, platens, masses
 * or time step, kick. Whatever feeds back into the motion hangs on global numbers alone: forces are
 * added in the order of the rows, sums over bodies are exact. So neither threads, nor the history
 * of the neighbour lists, nor a restart change a bit. */
#include "common/engine/sim.h"

#include "common/base/invariant.h"
#include "common/engine/accounts.h"
#include "common/engine/blowup.h"
#include "common/engine/integrate.h"
#include "common/engine/mass_scaling.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"

#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_run_params
static const struct brc_param run_params[] = {BRC_PARAM_LIST(BRC_RUN_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_run_param_list = BRC_PARAMS(run_params, struct brc_run_params);
const struct brc_physics brc_engine_physics[] = {{"engine", 1, NULL},
                                                 {"dynamic", 1, "run.regime=dynamic"},
                                                 {"quasi-static", 1, "run.regime=quasi_static"},
                                                 {NULL, 0, NULL}};

#define SIM_RENAMED(type, name, in_files, unit, meaning) \
    {#in_files, BRC_TYPE_OF(type), 1, BRC_STATE, unit, meaning, offsetof(struct brc_sim, name)},
#define SIM_SCALAR(type, name, unit, meaning) SIM_RENAMED(type, name, name, unit, meaning)
#define RIG_RENAMED(type, name, in_files, unit, meaning) \
    {"rig_" #in_files,                                   \
     BRC_TYPE_OF(type),                                  \
     1,                                                  \
     BRC_STATE,                                          \
     unit,                                               \
     meaning,                                            \
     offsetof(struct brc_sim, rig.name)},
#define RIG_SCALAR(type, name, unit, meaning) RIG_RENAMED(type, name, name, unit, meaning)
#define LEDGER_SCALAR(name, sign, meaning) \
    {"energy_" #name, BRC_F64, 1, BRC_STATE, "J", meaning, offsetof(struct brc_sim, ledger.name)},
#define PEAK_SCALAR(name, sign, meaning) \
    {"peak_energy_" #name,               \
     BRC_F64,                            \
     1,                                  \
     BRC_STATE,                          \
     "J",                                \
     "at the peak: " meaning,            \
     offsetof(struct brc_sim, ledger_at_peak.name)},
static const struct brc_field sim_scalars[] = {
    BRC_SIM_SCALARS(SIM_SCALAR, SIM_RENAMED) BRC_RIG_SCALARS(RIG_SCALAR, RIG_RENAMED)
        BRC_LEDGER_TERMS(LEDGER_SCALAR) LEDGER_SCALAR(start, 0, "energy at the start")
            BRC_LEDGER_TERMS(PEAK_SCALAR)};
const struct brc_fieldset brc_sim_scalars = BRC_FIELDSET(sim_scalars, struct brc_sim);

/* Steps between two looks at the memory that moved ranges of points have left behind: often enough
 * for a burst of contacts, too seldom to be seen in the time of a step. */
enum { TIDY_STEPS = 100 };
/* Growth of the largest sum k / m that calls for a new estimate of the limit. A power iteration
 * costs as much as many steps; the default dt_margin of 0.5 bears a limit that has fallen by 2.5 %
 * in between. */
static const double LIMIT_GROWTH = 1.05;
/* growth of all masses that calls for another look at the eigenfrequencies of small ones: masses
 * grow where contacts are new or stiffer, and where bonds break the frequencies only fall */
static const double MASS_GROWTH = 1.01;
/* factor on the scaled masses that needs no look at the eigenfrequencies, and the part of the limit
 * that a step may be with a smaller one */
static const double SAFE_MASS_MARGIN = 1.2, MASS_LIMIT = 0.9;

/* Adds the forces and moments of all rows to the bodies, row after row: for each body that is the
 * ascending order of its rows, so that the sums depend on global numbers only. The rows of one a
 * follow each other, after all those in which it is b. */
static void add_rows(const struct brc_contacts *c, double (*f)[3], double (*t)[3])
{
    for (size_t row = 0; row < c->n;) {
        int32_t a = c->a[row];
        double fa[3], ta[3];
        brc_copy(fa, f[a]);
        brc_copy(ta, t[a]);
        for (; row < c->n && c->a[row] == a; row++) {
            const double *of = c->f[row], *of_a = c->ta[row], *of_b = c->tb[row];
            double *restrict fb = f[c->b[row]], *restrict tb = t[c->b[row]];
            for (int k = 0; k < 3; k++) {
                double part = of[k];
                fa[k] -= part;
                fb[k] += part;
                ta[k] += of_a[k];
                tb[k] += of_b[k];
            }
        }
        brc_copy(f[a], fa);
        brc_copy(t[a], ta);
    }
}

/* The same for rows of platens. The sum on a grain has one term a platen; that on a platen has one
 * a grain of a whole face, which ranks will share, and it drives the loading: so it is exact. One
 * column at a time, since exact sums take their terms side by side and `terms` has room for one a
 * body; there are few rows, so twelve passes over them do not count. */
static void add_platen_rows(struct brc_sim *sim)
{
    const struct brc_contacts *c = &sim->platens;
    struct brc_bodies *b = &sim->bodies;
    for (size_t row = 0; row < c->n; row++) {
        brc_sub(b->f[c->a[row]], b->f[c->a[row]], c->f[row]);
        brc_add(b->t[c->a[row]], b->t[c->a[row]], c->ta[row]);
    }
    for (size_t p = b->n_grains; p < b->n; p++)
        for (int k = 0; k < 6; k++) {
            const double(*part)[3] = (const double(*)[3])(k < 3 ? c->f : c->tb);
            double *sum = k < 3 ? b->f[p] : b->t[p];
            size_t n = 0;
            for (size_t row = 0; row < c->n; row++)
                if ((size_t)c->b[row] == p)
                    b->terms[n++] = part[row][k % 3];
            sum[k % 3] += brc_sum_exact_of(b->terms, n, b->n_grains);
        }
}

/* Weight, then contacts. A model that ADDS has left its sums in `sum`, in the same order of rows
 * (model.h). */
static void gather(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    bool is_added = sim->model.flags & BRC_MODEL_ADDS;
    bool books = is_added && BRC_OPTION(sim->run.ledger);
    for (size_t i = 0; i < b->n; i++) {
        brc_scale(b->f[i], sim->run.gravity, b->true_mass[i]);
        brc_set(b->t[i], 0, 0, 0);
        if (is_added) {
            brc_add(b->f[i], b->f[i], b->sum[i]);
            brc_copy(b->t[i], b->sum[i] + 4);
        }
        if (books)
            b->energy[i][BRC_ACCOUNT_BOND] += b->sum[i][7];
    }
    if (!is_added)
        add_rows(&sim->pairs, b->f, b->t);
    add_platen_rows(sim);
}

/* Every grain against every platen: there are at most BRC_MAX_PLATENS, so a grid would save
 * nothing. */
int brc_sim_near_platens(const struct brc_sim *sim, struct brc_neighbours *out)
{
    const struct brc_bodies *b = &sim->bodies;
    out->n = 0;
    for (size_t i = 0; i < b->n_grains; i++) {
        for (size_t p = b->n_grains; p < b->n; p++) {
            double d[3];
            brc_sub(d, b->x[i], b->x[p]);
            if (brc_dot(d, brc_sim_platen(sim, (int32_t)p)->n) < b->bounding_radius[i] + sim->skin)
                BRC_TRY(brc_neighbours_add(sim->ctx, out, i, p));
        }
    }
    return 0;
}

/* Both lists anew, then the model's rows. From here on the paths of the bodies count for the skin.
 */
static int rebuild_neighbours(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    struct brc_neighbours grains = {0}, platens = {0};
    int code = brc_grid_pairs(sim->ctx, b->x, b->bounding_radius, b->n_grains, sim->skin, &grains);
    if (code == 0)
        code = brc_sim_near_platens(sim, &platens);
    if (code == 0)
        code = sim->model.pairs(sim, sim->state, &grains, &platens);
    brc_neighbours_free(&grains);
    brc_neighbours_free(&platens);
    memcpy(b->path_at_rebuild, b->path_length, b->n * sizeof *b->path_length);
    sim->n_rebuilds++;
    return code;
}

/* The neighbour list holds while no two bodies have come nearer by more than the skin, so for one
 * that has moved by half of it. All bodies are looked at in each step, as the search for what is no
 * number needs that anyway. */
static int check_path(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    bool stale = false;
    for (size_t i = 0; i < b->n; i++) {
        double moved = b->path_length[i] - b->path_at_rebuild[i];
        if (!(moved < BRC_BLOWUP_SKINS * sim->skin)) /* not a number included */
            return brc_blowup_path(sim);
        stale |= moved > 0.5 * sim->skin;
    }
    return stale ? rebuild_neighbours(sim) : 0;
}

/* Largest sum k / m over the bodies, translation and rotation: a cheap quantity that grows whenever
 * the stable limit may have fallen. */
static double stiffness_bound(const struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    double bound = 0;
    for (size_t i = 0; i < b->n_grains; i++) {
        double k[2], least = fmin(b->inertia[i][0], fmin(b->inertia[i][1], b->inertia[i][2]));
        brc_mass_scaling_stiffness(sim, i, k);
        bound = fmax(bound, k[0] / b->mass[i]);
        if (sim->model.flags & BRC_MODEL_ROTATES)
            bound = fmax(bound, k[1] / least);
    }
    return bound;
}

/* Dynamic regime: the step that goes with the limit. An automatic step only ever falls: a step that
 * grew again would make the work of a run hang on how often the limit is estimated. */
static int choose_dt(struct brc_sim *sim)
{
    if (sim->run.dt > sim->dt_limit)
        BRC_FAIL(
            sim->ctx, BRC_ERR_INPUT,
            "run.dt = %g s is above the stable limit of %g s at step %lld; use at most that, or "
            "0 s for an automatic step",
            sim->run.dt, sim->dt_limit, (long long)sim->step);
    if (sim->run.dt > 0)
        sim->dt = sim->run.dt;
    else if (sim->dt == 0 && !(sim->dt_limit < HUGE_VAL))
        BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                 "nothing is in contact yet, so there is no automatic time step: give run.dt");
    else if (sim->dt == 0 || sim->dt > sim->run.dt_margin * sim->dt_limit)
        sim->dt = sim->run.dt_margin * sim->dt_limit;
    return 0;
}

/* Dynamic regime: keeps dt below the stable limit of the springs that act, or may soon (is_listed:
 * the candidates are new). */
static int update_dt(struct brc_sim *sim, bool is_listed)
{
    double bound = stiffness_bound(sim);
    if (!is_listed && bound <= LIMIT_GROWTH * sim->stiffness_bound)
        return choose_dt(sim);
    sim->stiffness_bound = fmax(bound, sim->stiffness_bound);
    BRC_TRY(brc_stability_limit(sim, &sim->dt_limit));
    return choose_dt(sim);
}

/* Quasi-static regime: masses grow with the stiffness, and 1.2 times the bound of eq 26 is stable
 * for every network (proof in docs/numerics.md). A smaller margin is the user's choice: it is held
 * against the largest eigenfrequency of the present network, which costs an iteration, so only
 * where masses have grown. */
static int update_masses(struct brc_sim *sim, bool is_listed)
{
    double margin = sim->run.mass_margin, mass;
    brc_mass_scaling_update(sim);
    if (sim->step == 0)
        BRC_TRY(brc_mass_scaling_loose(sim));
    if (margin >= SAFE_MASS_MARGIN || !is_listed)
        return 0;
    mass = brc_sum_exact(sim->bodies.mass, sim->bodies.n_grains);
    if (mass <= MASS_GROWTH * sim->mass_checked)
        return 0;
    sim->mass_checked = mass;
    BRC_TRY(brc_stability_limit(sim, &sim->dt_limit));
    double least = margin / (MASS_LIMIT * MASS_LIMIT * sim->dt_limit * sim->dt_limit);
    if (least > margin)
        BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                 "run.mass_margin = %g is unstable at step %lld; use at least %.2g here, or %g, "
                 "which holds always",
                 margin, (long long)sim->step, least, SAFE_MASS_MARGIN);
    return 0;
}

/* Masses (quasi-static) or time step (dynamic) follow the stiffness of the contacts from the first
 * step on in which it has changed. Models count its changes (k_version), so that a step in which
 * nothing changed pays for two comparisons. */
static int follow_stiffness(struct brc_sim *sim, bool is_listed)
{
    bool is_same =
        sim->pairs.k_version == sim->k_seen[0] && sim->platens.k_version == sim->k_seen[1];
    if (is_same && !is_listed)
        return sim->run.regime == BRC_DYNAMIC ? choose_dt(sim) : 0;
    sim->k_seen[0] = sim->pairs.k_version;
    sim->k_seen[1] = sim->platens.k_version;
    if (sim->run.regime == BRC_DYNAMIC)
        return update_dt(sim, is_listed);
    return update_masses(sim, is_listed);
}

void brc_sim_forces(struct brc_sim *sim)
{
    if (sim->model.flags & BRC_MODEL_ADDS)
        memset(sim->bodies.sum, 0, sim->bodies.n * sizeof *sim->bodies.sum);
    sim->model.forces(sim, sim->state);
    sim->model.platens(sim, sim->state);
    gather(sim);
}

static double mean_grain_radius(const struct brc_sim *sim)
{
    const struct brc_facets *f = &sim->specimen->facets;
    double volume = 0;
    for (size_t i = 0; i < f->n_cells; i++)
        volume += f->volume[i];
    return cbrt(volume / (double)f->n_cells * 3 / (4 * BRC_PI));
}

/* Only the dynamic regime has true masses; scaled ones begin at zero and grow to what the first
 * contacts need, so that without gravity the density changes no bit. */
static void start_masses(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains && sim->run.regime == BRC_DYNAMIC; i++) {
        b->mass[i] = b->true_mass[i];
        brc_copy(b->inertia[i], b->true_inertia[i]);
    }
}

/* Grains, platens, contacts and candidates, then the model's choice of loops. In this order: a test
 * places platens by the grains' extent, a model bonds with the platens that are there, and the
 * search leaves the rows that bonding has opened. */
static int build(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    sim->skin = sim->run.skin * mean_grain_radius(sim);
    if (sim->model.create)
        BRC_TRY(sim->model.create(sim, &sim->state));
    BRC_TRY(sim->model.shape(sim, sim->state));
    for (size_t i = 0; i < b->n_grains; i++) {
        brc_copy(b->x0[i], b->x[i]);
        memcpy(b->q0[i], b->q[i], sizeof b->q[i]);
    }
    BRC_TRY(sim->rig.type->place(sim));
    start_masses(sim);
    BRC_TRY(sim->model.bond(sim, sim->state));
    BRC_TRY(rebuild_neighbours(sim));
    if (sim->model.select)
        sim->model.select(sim, sim->state);
    return 0;
}

/* Forces at rest, masses or time step, and the first half kick. Velocities are given for the time
 * of the positions: half a kick backwards and a whole one forwards make them those of the half
 * steps, without damping on the way back, which would be a gain of energy. The ledger begins after
 * all that. */
static int start(struct brc_sim *sim)
{
    sim->dt_limit = sim->run.regime == BRC_QUASI_STATIC ? 0 : HUGE_VAL;
    brc_sim_forces(sim);
    sim->dt = sim->run.regime == BRC_QUASI_STATIC ? 1 : 0;
    sim->k_seen[0] = sim->k_seen[1] = -1;
    BRC_TRY(follow_stiffness(sim, true));
    /* from v_0 back to v_-1/2, then the first whole kick */
    double alpha = sim->damping_alpha;
    sim->damping_alpha = 0;
    brc_integrate_kick(sim, -0.5 * sim->dt);
    sim->damping_alpha = alpha;
    brc_integrate_kick(sim, sim->dt);
    brc_platens_restore(sim);
    brc_accounts_open(sim);
    return sim->ctx->code;
}

/* A change of rate moves the mean velocities, so adaptive loading needs them in any case. */
static void choose_damped(struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    bool is_adaptive = rig->params.loading == BRC_LOADING_ADAPTIVE && rig->n_platens > 0;
    bool is_auto = sim->run.damped == BRC_DAMPED_AUTO;
    sim->damp_fluctuation = is_auto ? is_adaptive : sim->run.damped == BRC_DAMPED_FLUCTUATION;
    sim->tracks_mean =
        sim->run.regime == BRC_QUASI_STATIC && (is_adaptive || sim->damp_fluctuation);
    sim->damp_fluctuation &= sim->tracks_mean;
    double alpha = sim->damp_fluctuation ? sim->run.fluctuation_damping : sim->run.local_damping;
    sim->damping_alpha = sim->run.regime == BRC_QUASI_STATIC ? alpha : 0;
}

static void leave_out(struct brc_contacts *c, const char *names)
{
    brc_table_leave_out(&c->table, names);
    brc_table_leave_out(&c->model, names);
    brc_table_leave_out(&c->points, names);
}

/* Tables of all parts of the state. What a model declares as empty is left out of files and hashes
 * here, once, and stays in memory, since the loops of `engine` serve all models. */
static int make_tables(struct brc_sim *sim, size_t n_grains, size_t n_platens)
{
    const struct brc_model *m = &sim->model;
    size_t n = n_grains + n_platens;
    BRC_TRY(brc_bodies_create(sim->ctx, &sim->bodies, n_grains, n_platens, m->body_fields));
    BRC_TRY(
        brc_contacts_create(sim->ctx, &sim->pairs, "pairs", n, m->contact_fields, m->point_fields));
    BRC_TRY(brc_contacts_create(sim->ctx, &sim->platens, "platens", n, m->contact_fields,
                                m->point_fields));
    brc_table_leave_out(&sim->bodies.table, m->no_bodies);
    if (!sim->rig.type->has_sides)
        brc_table_leave_out(&sim->bodies.table, "side_area side_moment has_left");
    leave_out(&sim->pairs, m->no_pairs);
    leave_out(&sim->platens, m->no_platens);
    return 0;
}

/* What an empty simulation has: the model, the test and tables without a row. */
static int begin(struct brc_context *ctx, struct brc_sim *sim, const struct brc_model *model,
                 const struct brc_test *test, size_t n_grains)
{
    *sim = (struct brc_sim){.ctx = ctx, .model = *model};
    brc_events_init(&sim->events);
    BRC_TRY(brc_model_check(ctx, model));
    BRC_TRY(brc_rig_create(ctx, &sim->rig, test));
    return make_tables(sim, n_grains, (size_t)test->type->n_platens);
}

int brc_sim_tables(struct brc_context *ctx, struct brc_sim *sim, const struct brc_model *model)
{
    static const struct brc_rig_type no_test = {0};
    static const struct brc_test_params no_params = {0};
    const struct brc_test test = {.type = &no_test, .params = &no_params};
    int code = begin(ctx, sim, model, &test, 0);
    if (code != 0)
        brc_sim_free(sim);
    return code;
}

/* What a simulation has besides: everything that may call the model or the test. */
static int create(struct brc_sim *sim, const void *params, const struct brc_specimen *specimen,
                  const struct brc_run_params *run)
{
    size_t size = sim->model.params.owner_size;
    sim->specimen = specimen;
    sim->run = *run;
    sim->params = brc_alloc(sim->ctx, 1, size);
    if (!sim->params)
        return BRC_ERR_MEMORY;
    if (size > 0)
        memcpy(sim->params, params, size);
    if (sim->model.point_lanes > 0)
        sim->pairs.lanes = sim->platens.lanes = sim->model.point_lanes;
    BRC_TRY(build(sim));
    choose_damped(sim); /* a test whose load is given decides on its loading as it is placed */
    return start(sim);
}

int brc_sim_create(struct brc_context *ctx, struct brc_sim *sim, const struct brc_model *model,
                   const void *params, const struct brc_specimen *specimen,
                   const struct brc_test *test, const struct brc_run_params *run)
{
    *sim = (struct brc_sim){0};
    BRC_TRY(brc_simd_check(ctx, run->simd));
    if (model->check)
        BRC_TRY(model->check(ctx, params, specimen));
    BRC_TRY(brc_rig_check(ctx, test));
    int code = begin(ctx, sim, model, test, specimen->facets.n_cells);
    if (code == 0)
        code = create(sim, params, specimen, run);
    if (code != 0)
        brc_sim_free(sim);
    return code;
}

void brc_sim_free(struct brc_sim *sim)
{
    if (sim->model.free)
        sim->model.free(sim->state);
    brc_rig_free(&sim->rig);
    brc_contacts_free(&sim->pairs);
    brc_contacts_free(&sim->platens);
    brc_bodies_free(&sim->bodies);
    brc_events_free(&sim->events);
    free(sim->params);
    memset(sim, 0, sizeof *sim);
}

int brc_sim_step(struct brc_sim *sim)
{
    int64_t rebuilds = sim->n_rebuilds;
    double dt_before = sim->dt;
    BRC_ASSERT(sim->dt > 0 && sim->ctx->code == 0);
    brc_integrate_drift(sim);
    sim->step++;
    sim->time += sim->dt;
    BRC_TRY(check_path(sim));
    brc_sim_forces(sim);
    BRC_TRY(sim->ctx->code);
    /* rows are opened and closed by `pairs` alone */
    BRC_ASSERT(sim->pairs.n == sim->pairs.table.n && sim->platens.n == sim->platens.table.n);
    brc_platens_measure(sim);
    BRC_TRY(sim->rig.type->drive(sim));
    BRC_TRY(follow_stiffness(sim, sim->n_rebuilds > rebuilds));
    brc_integrate_kick(sim, 0.5 * (dt_before + sim->dt));
    if (!isfinite(sim->ledger.kinetic))
        return brc_blowup_number(sim);
    if (sim->step % TIDY_STEPS == 0) {
        BRC_TRY(brc_contacts_tidy(sim->ctx, &sim->pairs));
        BRC_TRY(brc_contacts_tidy(sim->ctx, &sim->platens));
    }
    return sim->rig.type->measure(sim);
}

int brc_sim_restore(struct brc_sim *sim)
{
    BRC_TRY(brc_contacts_restore(sim->ctx, &sim->pairs));
    BRC_TRY(brc_contacts_restore(sim->ctx, &sim->platens));
    BRC_TRY(brc_contacts_compact(sim->ctx, &sim->pairs));
    BRC_TRY(brc_contacts_compact(sim->ctx, &sim->platens));
    memset(sim->events.count, 0, sizeof sim->events.count);
    for (size_t i = 0; i < sim->events.table.n; i++)
        sim->events.count[sim->events.mode[i]]++;
    brc_platens_restore(sim);
    if (sim->rig.type->restore)
        sim->rig.type->restore(sim);
    if (sim->model.restore)
        BRC_TRY(sim->model.restore(sim, sim->state));
    if (sim->model.select)
        sim->model.select(sim, sim->state);
    return 0;
}

/* Over all that is saved and nothing else, so that a state that is read back has the hash it was
 * saved with. Point ranges count as they follow each other, wherever they lie in memory. */
uint64_t brc_sim_hash(struct brc_sim *sim)
{
    brc_accounts_settle(sim);
    uint64_t hash = brc_table_hash(&sim->bodies.table, BRC_HASH_SEED);
    hash = brc_table_hash(&sim->bodies.model, hash);
    hash = brc_contacts_hash(&sim->pairs, hash);
    hash = brc_contacts_hash(&sim->platens, hash);
    hash = brc_table_hash(&sim->events.table, hash);
    hash = brc_table_hash(&sim->rig.curve.table, hash);
    if (sim->rig.curve.own.set.n > 0)
        hash = brc_table_hash(&sim->rig.curve.own, hash);
    if (sim->rig.own_state.set.n > 0)
        hash = brc_table_hash(&sim->rig.own_state, hash);
    for (int i = 0; i < brc_sim_scalars.n; i++)
        hash = brc_hash_bytes((const char *)sim + sim_scalars[i].offset,
                              brc_field_size(&sim_scalars[i]), hash);
    return hash;
}
