/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs, by blocks of rows (block.h): rows are looked at one by one, what must
 * be computed goes into work lists, and kernels.c does it four at a time. */
#include "step.h"

void poly_world(const struct brc_sim *sim, const struct poly_state *st)
{
    for (size_t i = 0; i < sim->bodies.n; i++)
        brc_quat_matrix(st->turn[i], sim->bodies.q[i]);
    st->kernels.world(sim, st);
}

void poly_pair_of(struct poly_pair *p, const struct brc_sim *sim, const struct poly_state *st,
                  int32_t a, int32_t b)
{
    const struct poly_shapes *s = &st->shapes;
    double radius = poly_params_of(sim)->radius;
    *p = (struct poly_pair){.a = poly_core_of(s, (size_t)a),
                            .b = poly_core_of(s, (size_t)b),
                            .xa = sim->bodies.x[a],
                            .xb = sim->bodies.x[b],
                            .ra = (const double(*)[3])st->turn[a],
                            .rb = (const double(*)[3])st->turn[b],
                            .va = (const double(*)[3])(st->world + s->vertex_first[a]),
                            .vb = (const double(*)[3])(st->world + s->vertex_first[b]),
                            .rest = radius + radius,
                            .ell = radius,
                            .reach = poly_core_reach(sim, a, b)};
}

void poly_pose_bond(struct poly_bond_pose *pose, const struct brc_contacts *c, size_t row,
                    const struct poly_state *st, const struct brc_bodies *bodies, bool torsion)
{
    const struct poly_rows *rows = c->model_columns;
    int32_t a = c->a[row], b = c->b[row];
    const double(*ra)[3] = (const double(*)[3])st->turn[a];
    const double(*rb)[3] = (const double(*)[3])st->turn[b];
    poly_to_space(pose->pa, ra, rows->bond[row] + POLY_BOND_CA);
    poly_to_space(pose->pb, rb, rows->bond[row] + POLY_BOND_CB);
    brc_add(pose->pa, pose->pa, bodies->x[a]);
    brc_add(pose->pb, pose->pb, bodies->x[b]);
    poly_to_space(pose->na, ra, rows->bond[row] + POLY_BOND_NA);
    poly_to_space(pose->nb, rb, rows->bond[row] + POLY_BOND_NB);
    if (torsion) {
        poly_to_space(pose->ta, ra, rows->bond[row] + POLY_BOND_TA);
        poly_to_space(pose->tb, rb, rows->bond[row] + POLY_BOND_TB);
    }
}

/* A broken bond: its force is gone at once. What it had stored, less the work that its last force
 * would have done in this step, is dissipated. */
__attribute__((noinline, cold)) static void break_bond(struct brc_sim *sim, size_t row,
                                                       const struct poly_bond *bond,
                                                       const struct poly_bond_result *r,
                                                       const struct poly_motion *m)
{
    struct brc_contacts *c = &sim->pairs;
    struct poly_rows *rows = c->model_columns;
    struct poly_wrench last = {0};
    double unused[3] = {0}, none[6] = {0};
    poly_push_bond(&last, unused, r, bond, m);
    struct brc_event event = {.a = c->a[row],
                              .b = c->b[row],
                              .facet = c->facet[row],
                              .mode = (enum brc_mode)poly_bond_mode(r),
                              .area = *poly_bond_area(rows, row),
                              .energy = r->energy - poly_work(none, &last, m)};
    brc_copy(event.x, r->x);
    brc_copy(event.n, r->n);
    c->status[row] = BRC_BROKEN;
    brc_events_add(sim->ctx, &sim->events, sim->step, &event);
    if (poly_is_condensed(sim))
        poly_account_bond(sim, row, event.energy);
    if (BRC_OPTION(sim->run.ledger)) {
        sim->ledger.damage += event.energy;
        sim->ledger.bond -= event.energy;
    }
}

/* Rows that have something to do, for the next block; returns the row after them. */
static size_t look_ahead(struct poly_block *block, size_t row)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    int32_t n = 0;
    for (; row < c->n && n < POLY_ROWS; row++)
        if (!rows->carried[row] &&
            (c->np[row] > 0 || !poly_is_idle(c, row) || poly_is_awake(block->sim, c, row)))
            block->ahead[n++] = (int32_t)row;
    block->n_ahead = n;
    return row;
}

/* Fetching is inlined into what has effects: compilers leave out calls that only fetch. */
BRC_LANES_INLINE void fetch(const void *at, size_t size)
{
    for (size_t i = 0; i < size; i += 64)
        __builtin_prefetch((const char *)at + i);
    __builtin_prefetch((const char *)at + size - 1);
}

/* What the step reads of the rows of the next block, while this one is worked on: the step waits
 * for memory more than for anything else. */
BRC_LANES_INLINE void fetch_rows(const struct poly_block *block, bool condensed)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    for (int32_t i = 0; i < block->n_ahead; i++) {
        int32_t row = block->ahead[i];
        fetch(c->f[row], sizeof c->f[row]);
        fetch(c->ta[row], sizeof c->ta[row]);
        fetch(c->tb[row], sizeof c->tb[row]);
        fetch(c->k[row], sizeof c->k[row]);
        fetch(rows->bond[row], sizeof rows->bond[row]);
        if (condensed) {
            fetch(rows->shift[row], sizeof rows->shift[row]);
        } else {
            fetch(rows->normal_old[row], sizeof rows->normal_old[row]);
            fetch(rows->bond_old[row], sizeof rows->bond_old[row]);
        }
    }
}

BRC_LANES_INLINE void fetch_points(const struct poly_block *block)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    const struct poly_points *points = c->point_columns;
    for (int32_t i = 0; i < block->n_ahead; i++) {
        int32_t row = block->ahead[i];
        size_t p = (size_t)c->p0[row], n = (size_t)rows->awake[row];
        if (n == 0)
            continue;
        fetch(points->item[p], n * sizeof points->item[p]);
        fetch(points->spring[p], n * sizeof points->spring[p]);
    }
}

/* The rows ahead become those of the block. */
static void take_rows(struct poly_block *block)
{
    const struct brc_contacts *c = &block->sim->pairs;
    int32_t n = block->n_ahead;
    for (int32_t i = 0; i < n; i++) {
        int32_t row = block->ahead[i];
        block->row[i] = row;
        block->a[i] = c->a[row];
        block->b[i] = c->b[row];
        block->listed[i] = c->np[row] > 0;
    }
    block->n_rows = n;
    for (; n % BRC_LANES != 0; n++) {
        block->row[n] = block->row[n - 1];
        block->a[n] = block->a[n - 1];
        block->b[n] = block->b[n - 1];
    }
}

/* The bond of a row breaks: the lanes lose it. */
static void break_row(struct poly_block *block, int32_t i)
{
    struct poly_row_group *g = &block->group[i / BRC_LANES];
    const struct poly_params *params = poly_params_of(block->sim);
    struct brc_contacts *c = &block->sim->pairs;
    size_t row = (size_t)block->row[i];
    struct poly_bond bond = poly_bond_of(params, c->model_columns, row);
    struct poly_bond_pose pose;
    struct poly_bond_result r;
    struct poly_motion m;
    poly_start_motion(&m, block->sim, block->a[i], block->b[i]);
    poly_pose_bond(&pose, c, row, block->st, &block->sim->bodies, params->torsion);
    poly_bond_law(&r, &bond, &pose, params->torsion);
    break_bond(block->sim, row, &bond, &r, &m);
    for (int k = 0; k < 3; k++)
        g->bond.f[k][i % BRC_LANES] = g->bond.m[k][i % BRC_LANES] = g->k[k][i % BRC_LANES] = 0;
}

/* Lists the features of row i of the block anew when its path or travel calls for it, and breaks
 * its bond. */
static int prepare_row(struct poly_block *block, int32_t i)
{
    struct brc_sim *sim = block->sim;
    struct brc_contacts *c = &sim->pairs;
    struct poly_rows *rows = c->model_columns;
    struct poly_row_group *g = &block->group[i / BRC_LANES];
    size_t row = (size_t)block->row[i];
    int lane = i % BRC_LANES;
    if (block->listed[i] ? rows->room[row] <= 0 : poly_is_awake(sim, c, row)) {
        BRC_TRY(poly_list_row(sim, block->st, row));
        if (c->status[row] != BRC_INTACT)
            BRC_TRY(poly_foresee(sim, block->st, row, false));
    }
    block->listed[i] = c->np[row] > 0;
    g->gap[lane] = rows->wake[row] - sim->bodies.path_length[block->a[i]] -
                   sim->bodies.path_length[block->b[i]];
    if (g->broken[lane] > 1 && poly_params_of(sim)->breakable)
        break_row(block, i);
    return 0;
}

/* Stiffness of row i of the block; works into the ledger. */
static void store_row(struct poly_block *block, int32_t i)
{
    struct brc_sim *sim = block->sim;
    struct brc_contacts *c = &sim->pairs;
    const struct poly_row_group *g = &block->group[i / BRC_LANES];
    size_t row = (size_t)block->row[i];
    int lane = i % BRC_LANES;
    c->gap[row] = g->gap[lane];
    poly_store_k(c, row, (double[]){g->k[0][lane], g->k[1][lane], g->k[2][lane]});
    if (!BRC_OPTION(sim->run.ledger))
        return;
    sim->ledger.contact_normal += g->work_normal[lane];
    sim->ledger.bond += g->work_bond[lane];
    if (block->viscous)
        sim->ledger.viscous += g->work_viscous[lane];
    sim->ledger.contact_shear += g->stored[lane];
    sim->ledger.friction += g->slid[lane] - g->stored[lane];
}

static void open_block(struct poly_block *block, struct brc_sim *sim, struct poly_state *st)
{
    struct poly_spring_law law = poly_pair_law(sim);
    const struct poly_params *p = poly_params_of(sim);
    double radius = p->radius;
    block->sim = sim;
    block->st = st;
    block->kn = law.kn;
    block->kt = law.kt;
    block->stiff = law.mu > 0 && law.kt > 0 ? poly_most(law.kn, law.kt) : law.kn;
    block->limit = law.mu * law.kn / law.kt;
    block->rest = radius + radius;
    block->ell = radius;
    block->skin = POLY_LIST_SKIN * radius;
    block->pair_row = -1;
    block->n_points = 0;
    block->viscous = poly_is_viscous(sim);
    memset(block->n_tasks, 0, sizeof block->n_tasks);
}

void poly_forces(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    struct poly_block *block = st->block;
    bool condensed = poly_is_condensed(sim);
    poly_world(sim, st);
    open_block(block, sim, st);
    if (condensed)
        st->kernels.carry(block);
    size_t row = look_ahead(block, 0);
    while (block->n_ahead > 0) {
        take_rows(block);
        row = look_ahead(block, row);
        fetch_rows(block, condensed);
        st->kernels.motion(block);
        for (int32_t i = 0; i < block->n_rows; i++) {
            block->nearest[i] = block->lasting[i] = HUGE_VAL;
            block->open[i] = false;
            if (!block->calm[i] && prepare_row(block, i) != 0)
                return;
        }
        for (int32_t i = 0; i < block->n_rows; i++) {
            poly_list_points(block, i);
            if (condensed)
                poly_begin_tangent(block, i);
        }
        fetch_points(block);
        poly_work_off(block);
        st->kernels.finish(block);
        for (int32_t i = 0; i < block->n_rows; i++) {
            store_row(block, i);
            if (condensed)
                poly_condense_row(block, i);
        }
    }
}

void poly_each_active(const struct brc_sim *sim, const struct poly_state *st,
                      void (*visit)(void *user, const struct poly_active *active), void *user)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct poly_points *points = c->point_columns;
    enum poly_rule rule = (enum poly_rule)poly_params_of(sim)->features;
    poly_world(sim, st);
    for (size_t row = 0; row < c->n; row++) {
        struct poly_pair pair;
        poly_pair_of(&pair, sim, st, c->a[row], c->b[row]);
        for (int32_t k = 0; k < c->np[row]; k++) {
            size_t p = (size_t)c->p0[row] + (size_t)k;
            struct poly_active found = {.a = c->a[row],
                                        .b = c->b[row],
                                        .row = row,
                                        .point = p,
                                        .feature = poly_point(points, p)};
            uint8_t active = points->active[p];
            if (poly_touch(&found.touch, &pair, &found.feature, poly_remembered(&found.feature),
                           &active, rule))
                visit(user, &found);
        }
    }
}
