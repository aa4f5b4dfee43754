/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs, by blocks of rows (block.h): rows are looked at one by one, what must
 * be computed goes into work lists, and kernels.c does it four at a time. */
#include "step.h"

/* A point that has come apart stays awake while its gap is less than this many steps' path: to
 * look at it again costs as much as it does for that long. */
static const double DOZE = 4;

void poly_world(const struct brc_sim *sim, const struct poly_state *st)
{
    const struct brc_bodies *b = &sim->bodies;
    const struct poly_shapes *s = &st->shapes;
    for (size_t i = 0; i < b->n; i++)
        brc_quat_matrix(st->turn[i], b->q[i]);
    for (size_t i = 0; i < b->n_grains; i++) {
        const double(*m)[3] = (const double(*)[3])st->turn[i];
        for (size_t v = s->vertex_first[i]; v < s->vertex_first[i + 1]; v++)
            for (int k = 0; k < 3; k++)
                st->world[v][k] = b->x[i][k] + brc_dot(m[k], s->vertex[v]);
        for (size_t f = s->face_first[i]; f < s->face_first[i + 1]; f++) {
            poly_to_space(st->plane[f], m, s->face[f].n);
            st->plane[f][3] = brc_dot(st->plane[f], b->x[i]) + s->face[f].d;
        }
    }
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
    poly_to_space(pose->pa, ra, rows->ca[row]);
    poly_to_space(pose->pb, rb, rows->cb[row]);
    brc_add(pose->pa, pose->pa, bodies->x[a]);
    brc_add(pose->pb, pose->pb, bodies->x[b]);
    poly_to_space(pose->na, ra, rows->na[row]);
    poly_to_space(pose->nb, rb, rows->nb[row]);
    if (torsion) {
        poly_to_space(pose->ta, ra, rows->ta[row]);
        poly_to_space(pose->tb, rb, rows->tb[row]);
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
                              .area = rows->area[row],
                              .energy = r->energy - poly_work(none, &last, m)};
    brc_copy(event.x, r->x);
    brc_copy(event.n, r->n);
    c->status[row] = BRC_BROKEN;
    brc_events_add(sim->ctx, &sim->events, sim->step, &event);
    if (BRC_OPTION(sim->run.ledger)) {
        sim->ledger.damage += event.energy;
        sim->ledger.bond -= event.energy;
    }
}

/* --- points ------------------------------------------------------------------------------------
 */

/* Row i of the block as the literal functions want it. */
static const struct poly_pair *pair_of(struct poly_block *block, int32_t i)
{
    if (block->pair_row != block->row[i])
        poly_pair_of(&block->pair, block->sim, block->st, block->a[i], block->b[i]);
    block->pair_row = block->row[i];
    return &block->pair;
}

static enum poly_rule rule_of(const struct poly_block *block)
{
    return (enum poly_rule)poly_params_of(block->sim)->features;
}

static void put_touch(struct poly_block *block, int32_t slot, const struct poly_touch *t)
{
    struct poly_touches *to = &block->touch[slot / BRC_LANES];
    int lane = slot % BRC_LANES;
    to->delta[lane] = t->delta;
    to->weight[lane] = t->weight;
    for (int k = 0; k < 3; k++) {
        to->n[k][lane] = t->n[k];
        to->x[k][lane] = t->x[k];
        to->g[k][lane] = t->g[k];
        to->c[k][lane] = t->c[k];
    }
}

/* A slot of a segment without a point. */
static void leave_empty(struct poly_block *block, const struct poly_segment *segment, int32_t slot)
{
    put_touch(block, slot, &(struct poly_touch){.weight = 0});
    block->point[slot] = block->point[segment->slot];
}

/* A point by the literal functions. True when it is a vertex whose foot on a face or place is sure
 * now: then the work list has it. */
static bool touch_literally(struct poly_block *block, int32_t i, size_t p, int32_t slot)
{
    struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    struct poly_points *points = c->point_columns;
    struct poly_feature f = poly_point(points, p);
    struct poly_touch t, apart = {.weight = 0};
    enum poly_rule rule = rule_of(block);
    const struct poly_pair *pair = pair_of(block, i);
    double room = rows->room[block->row[i]], margin = 0;
    int32_t *place = poly_remembered(&f);
    bool touches = poly_touch_again(&t, pair, &f, place, &points->active[p], &margin, rule);
    points->i[p] = f.i;
    points->j[p] = f.j;
    if (f.kind != POLY_EDGES) {
        points->hold[p] = room - margin;
        if (margin > 0)
            return true;
    }
    if (!touches)
        apart.delta = rule == POLY_MERGED ? t.delta : -poly_free_path(pair, &f, rule, room);
    put_touch(block, slot, touches ? &t : &apart);
    return false;
}

static void list_edges(struct poly_block *block, int32_t i, size_t p, int32_t slot)
{
    const struct poly_shapes *s = &block->st->shapes;
    const struct poly_points *points = block->sim->pairs.point_columns;
    int32_t a = block->a[i], b = block->b[i];
    const int32_t *ea = s->end[s->edge_first[a] + (size_t)points->i[p]];
    const int32_t *eb = s->end[s->edge_first[b] + (size_t)points->j[p]];
    int32_t va = (int32_t)s->vertex_first[a], vb = (int32_t)s->vertex_first[b];
    int32_t side = points->active[p];
    block->edge[block->n_edges++] =
        (struct poly_edge_item){.slot = slot,
                                .end = {va + ea[0], va + ea[1], vb + eb[0], vb + eb[1]},
                                .side = side == 3 ? 0 : side,
                                .reach = poly_core_reach(block->sim, a, b)};
}

/* The work list for a vertex with these vertices near. */
static int vertex_list(const int32_t near[POLY_NEAR], bool flat)
{
    if (near[0] == POLY_MANY_NEAR)
        return flat ? POLY_FLAT_ALL : POLY_SHARP_ALL;
    if (near[1] == POLY_NONE_NEAR)
        return flat ? POLY_FLAT : POLY_SHARP;
    return flat ? POLY_FLAT_NEAR : POLY_SHARP_NEAR;
}

static void list_vertex(struct poly_block *block, int32_t i, size_t p, int32_t slot, bool merged)
{
    const struct poly_shapes *s = &block->st->shapes;
    const struct poly_points *points = block->sim->pairs.point_columns;
    bool of_b = points->kind[p] == POLY_VERTEX_B;
    int32_t own = of_b ? block->b[i] : block->a[i], other = of_b ? block->a[i] : block->b[i];
    int32_t vertex = of_b ? points->j[p] : points->i[p];
    int32_t place = of_b ? points->i[p] : points->j[p], index = merged ? place >> 2 : place;
    int32_t first = (int32_t)s->vertex_first[other];
    bool flat = !merged || (place & 3) == POLY_ON_FACE;
    int list = vertex_list(points->near[p], flat);
    struct poly_vertex_item *item = &block->vertex[list][block->n_vertices[list]++];
    item->slot = slot;
    item->vertex = (int32_t)s->vertex_first[own] + vertex;
    item->sign = of_b ? 1 : -1;
    item->first = first;
    item->n = (int32_t)s->vertex_first[other + 1] - first;
    memcpy(item->near, points->near[p], sizeof item->near);
    if (flat) {
        item->place[0] = (int32_t)s->face_first[other] + index;
        return;
    }
    const int32_t *end = s->end[s->edge_first[other] + (size_t)index];
    bool on_edge = (place & 3) == POLY_ON_EDGE;
    item->place[0] = first + (on_edge ? end[0] : index);
    item->place[1] = first + (on_edge ? end[1] : index);
}

/* A point into the work list that knows it. What is computed where depends on the pose alone, not
 * on what is remembered. */
static void list_point(struct poly_block *block, int32_t i, size_t p, int32_t slot, double room)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    enum poly_rule rule = rule_of(block);
    if (rule == POLY_CLOSED)
        touch_literally(block, i, p, slot);
    else if (points->kind[p] == POLY_EDGES)
        list_edges(block, i, p, slot);
    else if (room > points->hold[p] || touch_literally(block, i, p, slot))
        list_vertex(block, i, p, slot, rule == POLY_MERGED);
}

static struct poly_spring_law spring_law(const struct brc_sim *sim)
{
    const struct poly_params *p = poly_params_of(sim);
    return (struct poly_spring_law){.kn = poly_pair_stiffness(p->kn, p->kn),
                                    .kt = poly_pair_stiffness(p->kt, p->kt),
                                    .mu = p->mu};
}

/* A point that does not touch: its spring is released, and it goes to sleep when the path that it
 * is free for is worth it. Returns whether it does. */
static bool come_apart(struct poly_block *block, int32_t i, size_t p, double path)
{
    struct brc_sim *sim = block->sim;
    const struct poly_rows *rows = sim->pairs.model_columns;
    struct poly_points *points = sim->pairs.point_columns;
    struct poly_spring_law law = spring_law(sim);
    size_t row = (size_t)block->row[i];
    if (points->weight[p] > 0 && law.mu > 0 && law.kt > 0) {
        struct poly_motion m;
        poly_start_motion(&m, sim, block->a[i], block->b[i]);
        poly_release(BRC_OPTION(sim->run.ledger) ? &sim->ledger : NULL, &law, &m, points->xi[p],
                     points->weight[p]);
    }
    points->weight[p] = 0;
    points->active[p] = 0;
    if (path < DOZE * block->group[i / BRC_LANES].path[i % BRC_LANES])
        return false;
    poly_sleep_point(&sim->pairs, row, p, rows->room[row] - path);
    return true;
}

static void copy_touch(struct poly_block *block, int32_t to, int32_t from)
{
    const double *x = (const double *)&block->touch[from / BRC_LANES] + from % BRC_LANES;
    double *y = (double *)&block->touch[to / BRC_LANES] + to % BRC_LANES;
    for (size_t k = 0; k < sizeof block->touch[0] / sizeof *x; k += BRC_LANES)
        y[k] = x[k];
}

/* Takes the slots of a segment out that do not touch: the sums of its row are over touches alone.
 * From the last one on, so that points that are still to come do not move. */
static void drop_apart(struct poly_block *block, struct poly_segment *segment)
{
    int32_t slot = segment->slot, end = slot + segment->n, to = end;
    for (int32_t k = end - 1; k >= slot; k--) {
        const struct poly_touches *t = &block->touch[k / BRC_LANES];
        if (t->weight[k % BRC_LANES] > 0)
            continue;
        to = k;
        if (come_apart(block, segment->row, (size_t)block->point[k],
                       poly_most(-t->delta[k % BRC_LANES], 0)))
            for (int32_t after = k + 1; after < end; after++)
                block->point[after]--;
    }
    if (to == end)
        return;
    for (int32_t k = to + 1; k < end; k++) {
        if (!(block->touch[k / BRC_LANES].weight[k % BRC_LANES] > 0))
            continue;
        block->point[to] = block->point[k];
        copy_touch(block, to++, k);
    }
    segment->n = to - slot;
    for (; to % BRC_LANES != 0; to++)
        leave_empty(block, segment, to);
}

/* What touches keeps its weight. */
static void store_weights(struct poly_block *block, const struct poly_segment *segment)
{
    struct poly_points *points = block->sim->pairs.point_columns;
    for (int32_t slot = segment->slot; slot < segment->slot + segment->n; slot++) {
        size_t p = (size_t)block->point[slot];
        if (points->active[p] == 0)
            points->active[p] = 1;
        points->weight[p] = block->touch[slot / BRC_LANES].weight[slot % BRC_LANES];
    }
}

/* Computes all that is listed. */
static void work_off(struct poly_block *block)
{
    block->st->kernels.touch(block);
    for (int32_t i = 0; i < block->n_segments; i++)
        drop_apart(block, &block->segment[i]);
    block->st->kernels.points(block);
    for (int32_t i = 0; i < block->n_segments; i++)
        store_weights(block, &block->segment[i]);
    block->n_segments = block->n_slots = 0;
}

/* Ends the last segment at a whole group: slots that are left over stay empty. */
static void end_segment(struct poly_block *block)
{
    struct poly_segment *segment = &block->segment[block->n_segments];
    segment->n = block->n_slots - segment->slot;
    for (; block->n_slots % BRC_LANES != 0; block->n_slots++)
        leave_empty(block, segment, block->n_slots);
    block->n_segments += segment->n > 0;
}

static void begin_segment(struct poly_block *block, int32_t i)
{
    block->segment[block->n_segments] = (struct poly_segment){.row = i, .slot = block->n_slots};
}

/* Lists the points of row i of the block that may touch. A row is never split, unless it fills all
 * slots by itself: its sums do not depend on the rows around it. */
static void list_points(struct poly_block *block, int32_t i)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    size_t row = (size_t)block->row[i], p = (size_t)c->p0[row], n;
    poly_wake_points(&block->sim->pairs, row, rule_of(block) == POLY_MERGED);
    n = (size_t)rows->awake[row];
    if (n == 0)
        return;
    if ((size_t)block->n_slots + n > POLY_SLOTS)
        work_off(block);
    /* parts from the last one on: those that are still to come do not move (settle_points) */
    while (n > 0) {
        size_t part = n % POLY_SLOTS > 0 ? n % POLY_SLOTS : POLY_SLOTS;
        n -= part;
        begin_segment(block, i);
        for (size_t q = p + n; q < p + n + part; q++) {
            block->point[block->n_slots] = (int32_t)q;
            list_point(block, i, q, block->n_slots++, rows->room[row]);
        }
        end_segment(block);
        if (n > 0)
            work_off(block);
    }
}

/* --- rows --------------------------------------------------------------------------------------
 */

/* Takes rows that have something to do into the block; returns the next row. */
static size_t take_rows(struct poly_block *block, size_t row)
{
    const struct brc_contacts *c = &block->sim->pairs;
    int32_t n = 0;
    for (; row < c->n && n < POLY_ROWS; row++) {
        bool listed = c->np[row] > 0;
        if (!listed && poly_is_idle(c, row) && !poly_is_awake(block->sim, c, row))
            continue;
        block->row[n] = (int32_t)row;
        block->a[n] = c->a[row];
        block->b[n] = c->b[row];
        block->listed[n++] = listed;
    }
    block->n_rows = n;
    for (; n % BRC_LANES != 0; n++) {
        block->row[n] = block->row[n - 1];
        block->a[n] = block->a[n - 1];
        block->b[n] = block->b[n - 1];
    }
    return row;
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
    if (block->listed[i])
        rows->room[row] -= g->path[lane];
    if (block->listed[i] ? rows->room[row] <= 0 : poly_is_awake(sim, c, row))
        BRC_TRY(poly_list_row(sim, block->st, row));
    g->gap[lane] =
        rows->wake[row] - sim->bodies.travel[block->a[i]] - sim->bodies.travel[block->b[i]];
    if (g->broken[lane] > 1 && poly_params_of(sim)->breakable)
        break_row(block, i);
    return 0;
}

/* Forces, moments and stiffness of row i of the block from its lanes; works into the ledger. */
static void store_row(struct poly_block *block, int32_t i, bool viscous)
{
    struct brc_sim *sim = block->sim;
    struct brc_contacts *c = &sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    const struct poly_row_group *g = &block->group[i / BRC_LANES];
    size_t row = (size_t)block->row[i];
    int lane = i % BRC_LANES;
    for (int k = 0; k < 3; k++) {
        c->f[row][k] = g->total.f[k][lane];
        c->ta[row][k] = g->total.m[k][lane];
        c->tb[row][k] = g->tb[k][lane];
    }
    c->gap[row] = g->gap[lane];
    poly_store_k(c, row, (double[]){g->k[0][lane], g->k[1][lane], g->k[2][lane]});
    if (!BRC_OPTION(sim->run.ledger))
        return;
    for (int k = 0; k < 3; k++) {
        rows->normal_old[row][k] = g->normal.f[k][lane];
        rows->normal_old[row][3 + k] = g->normal.m[k][lane];
        rows->bond_old[row][k] = g->bond.f[k][lane];
        rows->bond_old[row][3 + k] = g->bond.m[k][lane];
        if (viscous) {
            rows->viscous_old[row][k] = g->viscous.f[k][lane];
            rows->viscous_old[row][3 + k] = g->viscous.m[k][lane];
        }
    }
    sim->ledger.contact_normal += g->work_normal[lane];
    sim->ledger.bond += g->work_bond[lane];
    if (viscous)
        sim->ledger.viscous += g->work_viscous[lane];
    sim->ledger.contact_shear += g->stored[lane];
    sim->ledger.friction += g->slid[lane] - g->stored[lane];
}

static void open_block(struct poly_block *block, struct brc_sim *sim, struct poly_state *st)
{
    struct poly_spring_law law = spring_law(sim);
    double radius = poly_params_of(sim)->radius;
    block->sim = sim;
    block->st = st;
    block->kn = law.kn;
    block->kt = law.kt;
    block->stiff = law.mu > 0 && law.kt > 0 ? poly_most(law.kn, law.kt) : law.kn;
    block->rest = radius + radius;
    block->ell = radius;
    block->skin = POLY_LIST_SKIN * radius;
    block->pair_row = -1;
    block->n_slots = block->n_segments = block->n_edges = 0;
    memset(block->n_vertices, 0, sizeof block->n_vertices);
}

void poly_forces(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    struct poly_block *block = st->block;
    const struct poly_params *p = poly_params_of(sim);
    bool viscous = sim->run.regime == BRC_DYNAMIC && (p->gn > 0 || p->gt > 0);
    poly_world(sim, st);
    open_block(block, sim, st);
    for (size_t row = 0; row < sim->pairs.n;) {
        row = take_rows(block, row);
        st->kernels.motion(block);
        for (int32_t i = 0; i < block->n_rows; i++)
            if (prepare_row(block, i) != 0)
                return;
        for (int32_t i = 0; i < block->n_rows; i++)
            list_points(block, i);
        work_off(block);
        st->kernels.finish(block);
        for (int32_t i = 0; i < block->n_rows; i++)
            store_row(block, i, viscous);
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
