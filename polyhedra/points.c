/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The points of a block (block.h): what their touches are computed from, which are listed, and what
 * becomes of those that are apart. */
#include "step.h"

/* A point that has come apart stays awake while its gap is less than this many steps' path: to
 * look at it again costs as much as it does for that long. */
static const double DOZE = 4;

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

/* What the touch of edges is computed from, as item. */
static void set_edges(const struct poly_block *block, int32_t i, size_t p)
{
    const struct poly_shapes *s = &block->st->shapes;
    const struct poly_points *points = block->sim->pairs.point_columns;
    int32_t a = block->a[i], b = block->b[i], *item = points->item[p];
    const int32_t *ea = s->end[s->edge_first[a] + (size_t)points->i[p]];
    const int32_t *eb = s->end[s->edge_first[b] + (size_t)points->j[p]];
    int32_t va = (int32_t)s->vertex_first[a], vb = (int32_t)s->vertex_first[b];
    for (int k = 0; k < 2; k++) {
        item[POLY_ITEM_END + k] = va + ea[k];
        item[POLY_ITEM_END + 2 + k] = vb + eb[k];
    }
    item[POLY_ITEM_SIDE] = points->active[p] == 1 ? 1 : points->active[p] == 2 ? -1 : 0;
    item[POLY_ITEM_LIST] = POLY_CROSSING;
    double reach = poly_core_reach(block->sim, a, b);
    memcpy(item + POLY_ITEM_REACH, &reach, sizeof reach);
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

/* Numbers of the vertices near, of those that begin at first. */
static void set_near(int32_t *item, const int32_t near[POLY_NEAR], int32_t first, int32_t end)
{
    for (int k = 0; k < POLY_NEAR; k++)
        item[k] = near[k] < 0 ? -1 : first + near[k];
    if (near[0] == POLY_MANY_NEAR) {
        item[0] = first;
        item[1] = end - first;
    }
}

/* What the touch of a vertex at a sure place is computed from, as item. */
static void set_vertex(const struct poly_block *block, int32_t i, size_t p, bool merged)
{
    const struct poly_shapes *s = &block->st->shapes;
    const struct poly_points *points = block->sim->pairs.point_columns;
    bool of_b = points->kind[p] == POLY_VERTEX_B;
    int32_t own = of_b ? block->b[i] : block->a[i], other = of_b ? block->a[i] : block->b[i];
    int32_t vertex = of_b ? points->j[p] : points->i[p];
    int32_t place = of_b ? points->i[p] : points->j[p], index = merged ? place >> 2 : place;
    int32_t first = (int32_t)s->vertex_first[other], *item = points->item[p];
    bool flat = !merged || (place & 3) == POLY_ON_FACE;
    item[POLY_ITEM_VERTEX] = (int32_t)s->vertex_first[own] + vertex;
    set_near(item + POLY_ITEM_NEAR, points->near[p], first, (int32_t)s->vertex_first[other + 1]);
    item[POLY_ITEM_LIST] = vertex_list(points->near[p], flat) + (of_b ? 0 : POLY_OF_A);
    if (flat) {
        item[POLY_ITEM_PLACE] = (int32_t)s->face_first[other] + index;
        return;
    }
    const int32_t *end = s->end[s->edge_first[other] + (size_t)index];
    bool on_edge = (place & 3) == POLY_ON_EDGE;
    for (int k = 0; k < 2; k++)
        item[POLY_ITEM_PLACE + k] = first + (on_edge ? end[k] : index);
}

/* A point that has its item, into its work list. */
static void add_task(struct poly_block *block, const struct poly_points *points, size_t p)
{
    int32_t list = points->item[p][POLY_ITEM_LIST] & ~POLY_OF_A;
    block->task[list][block->n_tasks[list]++] =
        (struct poly_task){.slot = block->n_slots, .point = (int32_t)p};
}

/* Gives a point its item and lists it. What is computed where depends on the pose alone, not on
 * what is remembered. Returns the room above which the item stays right. */
static double list_point(struct poly_block *block, int32_t i, size_t p, double room)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    enum poly_rule rule = rule_of(block);
    if (rule == POLY_CLOSED) {
        touch_literally(block, i, p, block->n_slots);
        return HUGE_VAL;
    }
    bool is_set = points->item[p][POLY_ITEM_LIST] != POLY_NO_LIST;
    if (points->kind[p] == POLY_EDGES) {
        if (!is_set)
            set_edges(block, i, p);
        add_task(block, points, p);
        return 0;
    }
    if (room > points->hold[p]) {
        if (!is_set)
            set_vertex(block, i, p, rule == POLY_MERGED);
        add_task(block, points, p);
    } else if (touch_literally(block, i, p, block->n_slots)) {
        set_vertex(block, i, p, rule == POLY_MERGED);
        add_task(block, points, p);
    } else {
        points->item[p][POLY_ITEM_LIST] = POLY_NO_LIST;
    }
    return points->hold[p];
}

/* A point that does not touch: its spring is released, and it goes to sleep when the path that it
 * is free for is worth it. Returns whether it does. */
static bool come_apart(struct poly_block *block, int32_t i, size_t p, double path)
{
    struct brc_sim *sim = block->sim;
    const struct poly_rows *rows = sim->pairs.model_columns;
    struct poly_points *points = sim->pairs.point_columns;
    struct poly_spring_law law = poly_pair_law(sim);
    size_t row = (size_t)block->row[i];
    if (points->weight[p] > 0 && law.mu > 0 && law.kt > 0) {
        struct poly_motion m;
        poly_start_motion(&m, sim, block->a[i], block->b[i]);
        poly_release(BRC_OPTION(sim->run.ledger) ? &sim->ledger : NULL, &law, &m, points->xi[p],
                     points->weight[p]);
    }
    points->weight[p] = 0;
    points->active[p] = 0;
    if (points->kind[p] == POLY_EDGES)
        points->item[p][POLY_ITEM_SIDE] = 0;
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

/* The sums of a row are over touches alone. From the last slot on, so that points that are still to
 * come do not move. */
void poly_drop_apart(struct poly_block *block, struct poly_segment *segment)
{
    int32_t slot = segment->slot, end = slot + segment->n, to = slot;
    for (int32_t k = slot; k < end; k++)
        block->point[k] = segment->point + k - slot;
    for (int32_t k = end - 1; k >= slot; k--) {
        const struct poly_touches *t = &block->touch[k / BRC_LANES];
        if (t->weight[k % BRC_LANES] > 0)
            continue;
        if (come_apart(block, segment->row, (size_t)block->point[k],
                       poly_most(-t->delta[k % BRC_LANES], 0)))
            for (int32_t after = k + 1; after < end; after++)
                block->point[after]--;
    }
    for (int32_t k = slot; k < end; k++) {
        if (!(block->touch[k / BRC_LANES].weight[k % BRC_LANES] > 0))
            continue;
        block->point[to] = block->point[k];
        copy_touch(block, to++, k);
    }
    segment->n = to - slot;
    segment->follow = segment->n > 0 && block->point[slot] == segment->point &&
                      block->point[to - 1] - block->point[slot] == segment->n - 1;
}

/* Points that begin to touch. */
static void set_active(struct poly_block *block, const struct poly_segment *segment)
{
    struct poly_points *points = block->sim->pairs.point_columns;
    for (int32_t k = 0; k < segment->n; k++) {
        int32_t p = segment->follow ? segment->point + k : block->point[segment->slot + k];
        if (points->active[p] == 0)
            points->active[p] = 1;
    }
}

/* Computes all that is listed. */
void poly_work_off(struct poly_block *block)
{
    block->st->kernels.touch(block);
    block->st->kernels.points(block);
    for (int32_t i = 0; i < block->n_segments; i++)
        if (block->segment[i].fresh)
            set_active(block, &block->segment[i]);
    block->n_segments = block->n_slots = 0;
}

/* Points p to p + n of row i of the block take the next slots, from a whole group on; returns the
 * room above which their items stay right. */
static double list_segment(struct poly_block *block, int32_t i, size_t p, size_t n)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    double room = rows->room[block->row[i]], calm = 0;
    block->segment[block->n_segments++] = (struct poly_segment){
        .row = i, .slot = block->n_slots, .n = (int32_t)n, .point = (int32_t)p, .follow = true};
    for (size_t q = p; q < p + n; q++, block->n_slots++) {
        if (block->calm[i])
            add_task(block, points, q);
        else
            calm = poly_most(calm, list_point(block, i, q, room));
    }
    block->n_slots = (block->n_slots + BRC_LANES - 1) / BRC_LANES * BRC_LANES;
    return calm;
}

/* Lists the points of row i of the block that may touch. A row is never split, unless it fills all
 * slots by itself: its sums do not depend on the rows around it. */
void poly_list_points(struct poly_block *block, int32_t i)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t row = (size_t)block->row[i], p = (size_t)c->p0[row], n;
    if (!block->calm[i])
        poly_wake_points(&block->sim->pairs, row, rule_of(block) == POLY_MERGED);
    n = (size_t)rows->awake[row];
    double calm = n < (size_t)c->np[row] ? points->sleep[p + n] : 0;
    rows->ready[row] = n <= POLY_SLOTS;
    if ((size_t)block->n_slots + n > POLY_SLOTS)
        poly_work_off(block);
    /* parts from the last one on: those that are still to come do not move (poly_drop_apart) */
    while (n > 0) {
        size_t part = n % POLY_SLOTS > 0 ? n % POLY_SLOTS : POLY_SLOTS;
        n -= part;
        calm = poly_most(calm, list_segment(block, i, p + n, part));
        if (n > 0)
            poly_work_off(block);
    }
    if (!block->calm[i])
        rows->calm[row] = poly_most(calm, 0);
}
