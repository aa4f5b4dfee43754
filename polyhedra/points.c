/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The points of a block (block.h): what their touches are computed from, which are listed, and what
 * becomes of those that are apart. */
#include "step.h"

#include <stdlib.h>

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

static void add_task(struct poly_block *block, int list, int32_t i, size_t p)
{
    block->task[list][block->n_tasks[list]++] = (struct poly_task){.row = i, .point = (int32_t)p};
}

/* A touch that is known, or how far a point is apart. */
static void add_known(struct poly_block *block, int32_t i, size_t p, const struct poly_touch *t)
{
    int32_t k = block->n_tasks[POLY_KNOWN];
    struct poly_touches *to = &block->known[k / BRC_LANES];
    int lane = k % BRC_LANES;
    to->delta[lane] = t->delta;
    to->weight[lane] = t->weight;
    to->fades[lane] = 0;
    to->lasts[lane] = t->delta;
    for (int m = 0; m < 3; m++) {
        to->n[m][lane] = t->n[m];
        to->x[m][lane] = t->x[m];
        to->g[m][lane] = t->g[m];
        to->c[m][lane] = t->c[m];
    }
    add_task(block, POLY_KNOWN, i, p);
}

/* A point by the literal functions. True when it is a vertex whose foot on a face or place is sure
 * now: then it belongs in the list of that place. */
static bool touch_literally(struct poly_block *block, int32_t i, size_t p)
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
    add_known(block, i, p, touches ? &t : &apart);
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

/* Numbers of the vertices near, of those from first to end. Returns what the item says of them. */
static int32_t set_near(int32_t *item, const int32_t near[POLY_NEAR], int32_t first, int32_t end)
{
    int32_t n = 0;
    if (near[0] == POLY_MANY_NEAR) {
        item[0] = first;
        return POLY_IN_TURN + ((end - first) << POLY_NEAR_SHIFT);
    }
    for (; n < POLY_NEAR && near[n] != POLY_NONE_NEAR; n++)
        item[n] = first + near[n];
    return n << POLY_NEAR_SHIFT;
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
    item[POLY_ITEM_LIST] = (flat ? POLY_FLAT : POLY_SHARP) + (of_b ? 0 : POLY_OF_A) +
                           set_near(item + POLY_ITEM_NEAR, points->near[p], first,
                                    (int32_t)s->vertex_first[other + 1]);
    if (flat) {
        item[POLY_ITEM_PLACE] = (int32_t)s->face_first[other] + index;
        return;
    }
    const int32_t *end = s->end[s->edge_first[other] + (size_t)index];
    bool on_edge = (place & 3) == POLY_ON_EDGE;
    for (int k = 0; k < 2; k++)
        item[POLY_ITEM_PLACE + k] = first + (on_edge ? end[k] : index);
}

/* n points that have their items, into their lists: each is put at the end of all lists, one of
 * which grows. Nothing branches, and the ends stay in registers. */
static void list_items(struct poly_block *block, const struct poly_points *points, int32_t i,
                       size_t p, size_t n)
{
    int32_t flat = block->n_tasks[POLY_FLAT], sharp = block->n_tasks[POLY_SHARP];
    int32_t crossing = block->n_tasks[POLY_CROSSING];
    for (size_t q = p; q < p + n; q++) {
        struct poly_task task = {.row = i, .point = (int32_t)q};
        int32_t list = points->item[q][POLY_ITEM_LIST] & POLY_LIST;
        block->task[POLY_FLAT][flat] = task;
        block->task[POLY_SHARP][sharp] = task;
        block->task[POLY_CROSSING][crossing] = task;
        flat += list == POLY_FLAT;
        sharp += list == POLY_SHARP;
        crossing += list == POLY_CROSSING;
    }
    block->n_tasks[POLY_FLAT] = flat;
    block->n_tasks[POLY_SHARP] = sharp;
    block->n_tasks[POLY_CROSSING] = crossing;
}

/* Gives a point its item and lists it. What is computed where depends on the pose alone, not on
 * what is remembered. Returns the room above which the item stays right. */
static double list_point(struct poly_block *block, int32_t i, size_t p, double room)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    enum poly_rule rule = rule_of(block);
    if (rule == POLY_CLOSED) {
        touch_literally(block, i, p);
        return HUGE_VAL;
    }
    bool is_set = points->item[p][POLY_ITEM_LIST] != POLY_NO_LIST;
    if (points->kind[p] == POLY_EDGES) {
        if (!is_set)
            set_edges(block, i, p);
        list_items(block, points, i, p, 1);
        return 0;
    }
    if (room > points->hold[p]) {
        if (!is_set)
            set_vertex(block, i, p, rule == POLY_MERGED);
        list_items(block, points, i, p, 1);
    } else if (touch_literally(block, i, p)) {
        set_vertex(block, i, p, rule == POLY_MERGED);
        list_items(block, points, i, p, 1);
    } else {
        points->item[p][POLY_ITEM_LIST] = POLY_NO_LIST;
    }
    return points->hold[p];
}

/* The spring of a point that has come apart is released. Where rows may be condensed, the work of
 * its last force is part of the work of all that acts. */
static void release_spring(struct poly_block *block, int32_t i, size_t p)
{
    struct brc_sim *sim = block->sim;
    const struct poly_points *points = sim->pairs.point_columns;
    struct poly_spring_law law = poly_pair_law(sim);
    struct brc_ledger released = {0};
    struct poly_motion m;
    poly_start_motion(&m, sim, block->a[i], block->b[i]);
    poly_release(&released, &law, &m, poly_xi(points, p), *poly_weight(points, p));
    if (!BRC_OPTION(sim->run.ledger))
        return;
    sim->ledger.contact_shear += released.contact_shear;
    sim->ledger.friction += released.friction;
    if (poly_is_condensed(sim))
        sim->ledger.contact_normal -= released.contact_shear + released.friction;
}

/* A point that does not touch: its spring is released, and it goes to sleep when the path that it
 * is free for is worth it. */
static void come_apart(struct poly_block *block, const struct poly_apart *apart)
{
    int32_t i = apart->row;
    size_t p = (size_t)apart->point;
    struct brc_sim *sim = block->sim;
    const struct poly_rows *rows = sim->pairs.model_columns;
    struct poly_points *points = sim->pairs.point_columns;
    struct poly_spring_law law = poly_pair_law(sim);
    size_t row = (size_t)block->row[i];
    if (*poly_weight(points, p) > 0 && law.mu > 0 && law.kt > 0)
        release_spring(block, i, p);
    *poly_weight(points, p) = 0;
    points->active[p] = 0;
    if (points->kind[p] == POLY_EDGES) {
        points->item[p][POLY_ITEM_SIDE] = 0;
        points->hold[p] = apart->fades ? POLY_FADES : HUGE_VAL;
    }
    if (apart->path < DOZE * block->group[i / BRC_LANES].path[i % BRC_LANES])
        return;
    poly_sleep_point(&sim->pairs, row, p, rows->room[row] - apart->path);
}

/* The last point first. */
static int compare_apart(const void *x, const void *y)
{
    const struct poly_apart *p = x, *q = y;
    return (p->point < q->point) - (p->point > q->point);
}

/* Computes all that is listed. Points that fall asleep move those behind them alone. */
void poly_work_off(struct poly_block *block)
{
    block->n_apart = 0;
    block->st->kernels.points(block);
    if (block->n_apart > 1)
        qsort(block->apart, (size_t)block->n_apart, sizeof *block->apart, compare_apart);
    for (int32_t i = 0; i < block->n_apart; i++)
        come_apart(block, &block->apart[i]);
    block->n_points = 0;
}

/* Lists points p to p + n of row i of the block; returns the room above which their items stay
 * right. */
static double list_part(struct poly_block *block, int32_t i, size_t p, size_t n)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    double room = rows->room[block->row[i]], calm = 0;
    block->n_points += (int32_t)n;
    if (block->calm[i])
        list_items(block, points, i, p, n);
    else
        for (size_t q = p; q < p + n; q++)
            calm = poly_most(calm, list_point(block, i, q, room));
    return calm;
}

/* Lists the points of row i of the block that may touch. A row is never split, unless it fills the
 * lists by itself: its sums do not depend on the rows around it. */
void poly_list_points(struct poly_block *block, int32_t i)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t row = (size_t)block->row[i], p = (size_t)c->p0[row], n;
    if (!block->calm[i])
        poly_wake_points(&block->sim->pairs, row, rule_of(block) == POLY_MERGED);
    n = (size_t)rows->awake[row];
    double calm = !block->calm[i] && n < (size_t)c->np[row] ? points->sleep[p + n] : 0;
    rows->ready[row] = n <= POLY_TASKS;
    if ((size_t)block->n_points + n > POLY_TASKS)
        poly_work_off(block);
    /* parts from the last one on: those that are still to come do not move (poly_work_off) */
    while (n > 0) {
        size_t part = n % POLY_TASKS > 0 ? n % POLY_TASKS : POLY_TASKS;
        n -= part;
        calm = poly_most(calm, list_part(block, i, p + n, part));
        if (n > 0)
            poly_work_off(block);
    }
    if (!block->calm[i])
        rows->calm[row] = poly_most(calm, 0);
}
