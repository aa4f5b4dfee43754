/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over contacts, of grain pairs and of platens, by batches (batch.h): contacts are looked
 * at one by one, what must be computed goes into work lists, and the kernels do it four at a time.
 * What a force is, they know alone. */
#include "polyhedra/motion_kernels.inc.h"

/* Room above the moments of stiffness, so that turning arms do not count as changes. */
#define POLY_K_ROOM 1.02

/* Stiffness of a contact: k_version changes when it grows, or has fallen for good. Masses and the
 * stable step are found anew when k_version changes; a moment
 * that has shrunk by less than the room twice over only leaves them on the safe side. */
static void store_stiffness(struct brc_contacts *c, size_t contact, const double k[3])
{
    double *old = c->k[contact];
    bool same = k[0] == old[0];
    for (int i = 1; i < 3; i++)
        same = same && k[i] <= old[i] && k[i] * POLY_K_ROOM * POLY_K_ROOM >= old[i];
    if (same)
        return;
    brc_set(old, k[0], k[1] * POLY_K_ROOM, k[2] * POLY_K_ROOM);
    c->k_version++;
}

/* True when the path of a contact's bodies calls for a new list. For contacts without listed
 * features, which have no relative path: the sum of the paths of both bodies is a bound of it. */
static bool is_awake(const struct brc_sim *sim, const struct brc_contacts *c, size_t contact)
{
    const struct poly_contacts *columns = c->model_columns;
    return sim->bodies.path_length[c->a[contact]] + sim->bodies.path_length[c->b[contact]] >=
           columns->rebuild_at[contact];
}

/* A contact without bond and listed features, which had no spring in the last step either: its
 * forces and works are zero already. */
static bool is_idle(const struct brc_contacts *c, size_t contact)
{
    return c->np[contact] == 0 && c->status[contact] != BRC_INTACT && c->k[contact][0] == 0;
}

/* A bond that breaks is gone at once, and the lanes lose it. What it had stored, less the work that
 * its last force would have done in this step, is dissipated. */
__attribute__((noinline, cold)) static void break_bond(struct poly_batch *batch, int32_t i)
{
    struct brc_sim *sim = batch->sim;
    struct brc_contacts *c = batch->contacts;
    struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    const struct poly_contacts *columns = c->model_columns;
    size_t contact = (size_t)batch->contact[i];
    int lane = i % BRC_LANES;
    struct poly_bond bond;
    poly_bond_of_contact(&bond, sim, batch->st, c, contact);
    double last = -0.5 * sim->dt * poly_power(&g->bond, g, g->x)[lane];
    struct brc_event event = {.a = c->a[contact],
                              .b = c->b[contact],
                              .facet = c->facet[contact],
                              .mode = (enum brc_mode)poly_bond_mode(&bond),
                              .area = columns->bond[contact][POLY_BOND_AREA],
                              .energy = bond.energy - last};
    brc_copy(event.x, bond.x);
    brc_copy(event.n, bond.n);
    brc_sub(event.branch, sim->bodies.x[event.b], sim->bodies.x[event.a]);
    for (int k = 0; k < 3; k++)
        event.force[k] = g->bond.f[k][lane];
    /* Energy and force are those of the pose that broke it, not of the limit: the step over
     * the limit is dissipated with it, and the ledger closes. */
    c->status[contact] = BRC_BROKEN;
    brc_events_add(sim->ctx, &sim->events, sim->step, &event);
    if (poly_is_linearised(sim))
        poly_account_bond(batch, i, event.energy);
    batch->energy[i][BRC_ACCOUNT_DAMAGE] += event.energy;
    batch->energy[i][BRC_ACCOUNT_BOND] -= event.energy;
    for (int k = 0; k < 3; k++)
        g->bond.f[k][lane] = g->bond.m[k][lane] = g->k[k][lane] = 0;
}

/* Contacts that have something to do, for the next batch; returns the contact after them. */
static size_t look_ahead(struct poly_batch *batch, size_t contact)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    int32_t n = 0;
    for (; contact < c->n && n < POLY_CONTACTS; contact++)
        if ((batch->is_platens || !columns->is_linearised[contact]) &&
            (c->np[contact] > 0 || !is_idle(c, contact) || is_awake(batch->sim, c, contact)))
            batch->ahead[n++] = (int32_t)contact;
    batch->n_ahead = n;
    return contact;
}

/* Fetching is inlined into what has effects: compilers leave out calls that only fetch. */
BRC_LANES_INLINE void fetch(const void *at, size_t size)
{
    for (size_t i = 0; i < size; i += 64)
        __builtin_prefetch((const char *)at + i);
    __builtin_prefetch((const char *)at + size - 1);
}

/* What the step reads of the contacts of the next batch, while this one is worked on: the step
 * waits for memory more than for anything else. Without it bench_scaling takes 350 instead of 285
 * ns a contact with 1e3 grains, and 647 instead of 385 with 1e4 (least of two runs by turns). */
BRC_LANES_INLINE void fetch_contacts(const struct poly_batch *batch, bool linearised)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    for (int32_t i = 0; i < batch->n_ahead; i++) {
        int32_t row = batch->ahead[i];
        fetch(c->f[row], sizeof c->f[row]);
        fetch(c->ta[row], sizeof c->ta[row]);
        fetch(c->tb[row], sizeof c->tb[row]);
        fetch(c->k[row], sizeof c->k[row]);
        fetch(columns->bond[row], sizeof columns->bond[row]);
        if (linearised) {
            fetch(columns->motion[row], sizeof columns->motion[row]);
        } else {
            fetch(columns->normal_old[row], sizeof columns->normal_old[row]);
            fetch(columns->bond_old[row], sizeof columns->bond_old[row]);
        }
    }
}

BRC_LANES_INLINE void fetch_points(const struct poly_batch *batch)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    const struct poly_points *points = c->point_columns;
    for (int32_t i = 0; i < batch->n_ahead; i++) {
        int32_t row = batch->ahead[i];
        size_t p = (size_t)c->p0[row], n = (size_t)columns->awake[row];
        if (n == 0)
            continue;
        fetch(points->item[p], n * sizeof points->item[p]);
        fetch(points->spring[p], n * sizeof points->spring[p]);
    }
}

/* The contacts ahead become those of the batch. Whole fours, filled up by the last contact once
 * more: what is computed for these lanes is written to the same places with the same values, so
 * that no kernel needs a remainder. */
static void take_contacts(struct poly_batch *batch)
{
    const struct brc_contacts *c = batch->contacts;
    int32_t n = batch->n_ahead;
    for (int32_t i = 0; i < n; i++) {
        int32_t contact = batch->ahead[i];
        batch->contact[i] = contact;
        batch->a[i] = c->a[contact];
        batch->b[i] = c->b[contact];
        batch->listed[i] = c->np[contact] > 0;
    }
    batch->n_contacts = n;
    if (BRC_OPTION(batch->sim->run.ledger))
        memset(batch->energy, 0, (size_t)n * sizeof *batch->energy);
    for (; n % BRC_LANES != 0; n++) {
        batch->contact[n] = batch->contact[n - 1];
        batch->a[n] = batch->a[n - 1];
        batch->b[n] = batch->b[n - 1];
    }
}

/* Lists the features of contact i of the batch anew when its path calls for it, and breaks its
 * bond. Here is all that may allocate, search or take a branch that no lane could follow; stable
 * contacts do without. */
static int prepare(struct poly_batch *batch, int32_t i)
{
    struct brc_sim *sim = batch->sim;
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    size_t contact = (size_t)batch->contact[i];
    int lane = i % BRC_LANES;
    if (batch->is_platens) {
        if (is_awake(sim, c, contact)) {
            BRC_TRY(poly_list_platen(sim, batch->st, contact));
            BRC_TRY(poly_foresee(sim, batch->st, contact, true));
        }
    } else if (batch->listed[i] ? columns->skin_left[contact] <= 0 : is_awake(sim, c, contact)) {
        BRC_TRY(poly_list_contact(sim, batch->st, contact));
        if (c->status[contact] != BRC_INTACT)
            BRC_TRY(poly_foresee(sim, batch->st, contact, false));
    }
    batch->listed[i] = c->np[contact] > 0; /* by the list just made */
    g->gap[lane] = columns->rebuild_at[contact] - sim->bodies.path_length[batch->a[i]] -
                   sim->bodies.path_length[batch->b[i]];
    if (!batch->is_platens && g->broken[lane] > 1 && poly_params_of(sim)->breakable)
        break_bond(batch, i);
    return 0;
}

static void store_contact(struct poly_batch *batch, int32_t i)
{
    struct brc_contacts *c = batch->contacts;
    const struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    size_t contact = (size_t)batch->contact[i];
    int lane = i % BRC_LANES;
    c->gap[contact] = g->gap[lane];
    store_stiffness(c, contact, (double[]){g->k[0][lane], g->k[1][lane], g->k[2][lane]});
}

/* The works of contact i of the batch, and what else it has booked, on the accounts of a. The sum
 * of a contact first and then the account, so that the order of additions on a grain's account is
 * that of its contacts. */
static void book_contact(struct poly_batch *batch, int32_t i)
{
    const struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    double *e = batch->energy[i], *account = batch->sim->bodies.energy[batch->a[i]];
    int lane = i % BRC_LANES;
    e[BRC_ACCOUNT_NORMAL] += g->work_normal[lane];
    e[BRC_ACCOUNT_BOND] += g->work_bond[lane];
    if (batch->viscous)
        e[BRC_ACCOUNT_VISCOUS] += g->work_viscous[lane];
    e[BRC_ACCOUNT_SHEAR] += g->stored[lane];
    e[BRC_ACCOUNT_FRICTION] += g->slid[lane] - g->stored[lane];
    for (int k = 0; k < BRC_N_ACCOUNTS; k += BRC_LANES)
        brc_lanes_put(account + k, brc_lanes_at(account + k) + brc_lanes_at(e + k));
}

/* Once a step: what all contacts of the case share is read here and not by kernels. */
static void open_batch(struct poly_batch *batch, struct brc_sim *sim, struct poly_state *st,
                       bool is_platens)
{
    const struct poly_params *p = poly_params_of(sim);
    double radius = p->radius, kn = poly_pair_stiffness(p->kn, p->kn),
           kt = poly_pair_stiffness(p->kt, p->kt);
    batch->sim = sim;
    batch->st = st;
    batch->is_platens = is_platens;
    batch->contacts = is_platens ? &sim->platens : &sim->pairs;
    batch->loop = is_platens ? &st->kernels.platens : &st->kernels.pairs;
    batch->law = (struct poly_spring_law){kn, kt, poly_most(kn, kt), p->mu * kn / kt};
    batch->len = (struct poly_lengths){radius + radius, radius, POLY_LIST_SKIN * radius};
    batch->pair_of_contact = -1;
    batch->n_points = 0;
    batch->viscous = poly_is_viscous(sim);
    batch->looks = p->features == POLY_CLOSED && poly_is_linearised(sim);
    memset(batch->is_stable, 0, sizeof batch->is_stable);
    memset(batch->n_tasks, 0, sizeof batch->n_tasks);
}

static void work_through(struct poly_batch *batch, bool linearised)
{
    /* The contacts of a batch are chosen before the last one is worked off, for their memory to
     * be fetched meanwhile. */
    size_t contact = look_ahead(batch, 0);
    while (batch->n_ahead > 0) {
        take_contacts(batch);
        contact = look_ahead(batch, contact);
        fetch_contacts(batch, linearised);
        batch->loop->motion(batch);
        for (int32_t i = 0; i < batch->n_contacts; i++) {
            batch->nearest[i] = batch->valid_path[i] = HUGE_VAL;
            batch->has_apart[i] = false;
            if (!batch->is_stable[i] && prepare(batch, i) != 0)
                return;
        }
        /* Only when all contacts have their lists: to make one may move the points of the table
         * in memory. */
        for (int32_t i = 0; i < batch->n_contacts; i++) {
            poly_list_points(batch, i);
            if (linearised)
                poly_begin_tangent(batch, i);
        }
        fetch_points(batch);
        poly_work_off(batch);
        batch->loop->finish(batch);
        for (int32_t i = 0; i < batch->n_contacts; i++) {
            store_contact(batch, i);
            if (linearised)
                poly_linearise(batch, i);
            if (BRC_OPTION(batch->sim->run.ledger))
                book_contact(batch, i);
        }
    }
}

void poly_forces(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    bool linearised = poly_is_linearised(sim);
    poly_pose_bodies(sim, st);
    open_batch(st->batch, sim, st, false);
    if (linearised)
        st->kernels.linearised(st->batch);
    work_through(st->batch, linearised);
}

void poly_platens(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    open_batch(st->batch, sim, st, true);
    work_through(st->batch, false);
}
