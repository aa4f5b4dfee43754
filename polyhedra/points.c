/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The points of a batch (batch.h): what their touches are computed from, which are listed, and what
 * becomes of those that are apart. Called by forces.c for each contact; the kernels read what is
 * set here. Which point goes where may depend on its pose alone, or bits would hang on the history
 * of lists. */
#include "polyhedra/motion_kernels.inc.h"

/* A point that has come apart stays awake while its gap is less than this many steps' path: to
 * look at it again costs as much as it does for that long. Unless its contact may be linearised and
 * looks at those that sleep (linearise.c). */
static const double DOZE_STEPS = 4;

/* Row i of the batch as the literal functions want it. */
static const struct poly_pair *pair_of(struct poly_batch *batch, int32_t i)
{
    if (batch->pair_of_contact != batch->contact[i])
        poly_pair_of(&batch->pair, batch->sim, batch->st, batch->a[i], batch->b[i]);
    batch->pair_of_contact = batch->contact[i];
    return &batch->pair;
}

static enum poly_rule rule_of(const struct poly_batch *batch)
{
    return (enum poly_rule)poly_params_of(batch->sim)->features;
}

static void add_task(struct poly_batch *batch, int list, int32_t i, size_t p)
{
    batch->task[list][batch->n_tasks[list]++] =
        (struct poly_task){.contact = i, .point = (int32_t)p};
}

/* A point whose geometry is known: it touches, or how far it is apart. In the same form as the
 * kernels' own geometry, so that forces, springs and sums have one way for all points. */
static void add_known(struct poly_batch *batch, int32_t i, size_t p, bool touches,
                      const struct poly_geometry *t)
{
    int32_t k = batch->n_tasks[POLY_KNOWN];
    struct poly_geometry4 *to = &batch->known[k / BRC_LANES];
    int lane = k % BRC_LANES;
    to->delta[lane] = to->valid_path[lane] = t->delta;
    if (rule_of(batch) == POLY_CLOSED) /* as in poly_vertices_of_tasks */
        to->valid_path[lane] = poly_least(t->delta, batch->len.contact_distance - t->delta);
    to->weight[lane] = touches ? t->weight : 0;
    to->fades[lane] = 0;
    for (int m = 0; m < 3; m++) {
        to->n[m][lane] = touches ? t->n[m] : 0;
        to->x[m][lane] = touches ? t->x[m] : 0;
        to->g[m][lane] = touches ? t->g[m] : 0;
        to->c[m][lane] = touches ? t->c[m] : 0;
    }
    add_task(batch, POLY_KNOWN, i, p);
}

/* A point by the literal functions. True when it is a vertex whose closest feature is sure now:
 * then it belongs in the list of that feature. */
static bool find_literally(struct poly_batch *batch, int32_t i, size_t p)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    struct poly_points *points = batch->contacts->point_columns;
    struct poly_feature f = poly_point(points, p);
    struct poly_geometry t;
    double margin;
    bool touches =
        poly_find_contact(&t, pair_of(batch, i), &f, &points->active[p], &margin, rule_of(batch));
    points->i[p] = f.i;
    points->j[p] = f.j;
    if (f.kind != POLY_EDGES) {
        points->feature_valid_to[p] = columns->skin_left[batch->contact[i]] - margin;
        if (margin > 0)
            return true;
    }
    add_known(batch, i, p, touches, &t);
    return false;
}

/* What the touch of edges is computed from, as item. Reach goes along in the item, since it belongs
 * to the pair and four edges may be of four pairs. */
static void set_edges(const struct poly_batch *batch, int32_t i, size_t p)
{
    const struct poly_shapes *s = &batch->st->shapes;
    const struct poly_points *points = batch->contacts->point_columns;
    int32_t a = batch->a[i], b = batch->b[i], *item = points->item[p];
    const int32_t *ea = s->end[s->first[a].edge + (size_t)points->i[p]];
    const int32_t *eb = s->end[s->first[b].edge + (size_t)points->j[p]];
    int32_t va = (int32_t)s->first[a].vertex, vb = (int32_t)s->first[b].vertex;
    for (int k = 0; k < 2; k++) {
        item[POLY_ITEM_END + k] = va + ea[k];
        item[POLY_ITEM_END + 2 + k] = vb + eb[k];
    }
    item[POLY_ITEM_SIDE] = points->active[p] == 1 ? 1 : points->active[p] == 2 ? -1 : 0;
    item[POLY_ITEM_LIST] = POLY_CROSSING;
    double reach = poly_core_reach(batch->sim, a, b);
    memcpy(item + POLY_ITEM_REACH, &reach, sizeof reach);
}

/* Numbers of the vertices near, of those from first to end. Returns what the item says of them.
 * Numbers of all vertices of the core would not fit the item; they follow each other, so the first
 * one and their number are enough. */
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

/* What the touch of a vertex at a sure feature is computed from, as item. An edge by its two ends,
 * a vertex by itself twice: one kernel does both, and for a vertex the direction along the edge is
 * 0. */
static void set_vertex(const struct poly_batch *batch, int32_t i, size_t p, int32_t code)
{
    const struct poly_shapes *s = &batch->st->shapes;
    const struct poly_points *points = batch->contacts->point_columns;
    bool of_b = points->kind[p] == POLY_VERTEX_B;
    int32_t own = of_b ? batch->b[i] : batch->a[i], other = of_b ? batch->a[i] : batch->b[i];
    int32_t vertex = of_b ? points->j[p] : points->i[p], index = code >> 2;
    int32_t first = (int32_t)s->first[other].vertex, *item = points->item[p];
    bool flat = (code & 3) == POLY_ON_FACE;
    item[POLY_ITEM_VERTEX] = (int32_t)s->first[own].vertex + vertex;
    item[POLY_ITEM_LIST] = (flat ? POLY_FLAT : POLY_SHARP) + (of_b ? 0 : POLY_OF_A) +
                           set_near(item + POLY_ITEM_NEAR, points->near[p], first,
                                    (int32_t)s->first[other + 1].vertex);
    if (flat) {
        item[POLY_ITEM_FEATURE] = (int32_t)s->first[other].face + index;
        return;
    }
    const int32_t *end = s->end[s->first[other].edge + (size_t)index];
    bool on_edge = (code & 3) == POLY_ON_EDGE;
    for (int k = 0; k < 2; k++)
        item[POLY_ITEM_FEATURE + k] = first + (on_edge ? end[k] : index);
}

/* The closest feature of a vertex, where it is sure, as a code. Points of `merged` remember it; for
 * `closed` they remember the face, and what of it is closest is found again whenever the item is
 * set, in the pose of then: while it is sure it is the same in every pose, so a restart finds what
 * went before. */
static int32_t feature_of(struct poly_batch *batch, int32_t i, size_t p)
{
    const struct poly_points *points = batch->contacts->point_columns;
    struct poly_feature f = poly_point(points, p);
    enum poly_rule rule = rule_of(batch);
    if (rule == POLY_CLOSED)
        return poly_feature_of_face(pair_of(batch, i), &f);
    int32_t feature = *poly_remembered(&f);
    return rule == POLY_MERGED ? feature : poly_feature_code(feature, POLY_ON_FACE);
}

/* n points that have their items, into their lists. */
static void list_items(struct poly_batch *batch, const struct poly_points *points, int32_t i,
                       size_t p, size_t n)
{
    for (size_t q = p; q < p + n; q++)
        add_task(batch, points->item[q][POLY_ITEM_LIST] & POLY_LIST, i, q);
}

/* Gives a point its item and lists it. What is computed where depends on the pose alone, not on
 * what is remembered. Returns the skin left above which the item stays right. */
static double list_point(struct poly_batch *batch, int32_t i, size_t p, double skin_left)
{
    const struct poly_points *points = batch->contacts->point_columns;
    bool is_set = points->item[p][POLY_ITEM_LIST] != POLY_NO_LIST;
    if (points->kind[p] == POLY_EDGES) {
        if (!is_set)
            set_edges(batch, i, p);
        list_items(batch, points, i, p, 1);
        return 0;
    }
    if (skin_left > points->feature_valid_to[p]) {
        if (!is_set)
            set_vertex(batch, i, p, feature_of(batch, i, p));
        list_items(batch, points, i, p, 1);
    } else if (find_literally(batch, i, p)) {
        set_vertex(batch, i, p, feature_of(batch, i, p));
        list_items(batch, points, i, p, 1);
    } else {
        points->item[p][POLY_ITEM_LIST] = POLY_NO_LIST;
    }
    return points->feature_valid_to[p];
}

/* The spring of a point that has come apart: what it held has become friction, with the work of its
 * last force, as if at the middle between the bodies. Where contacts may be linearised, that work
 * is part of the work of all that acts. */
static void release_spring(struct poly_batch *batch, int32_t i, size_t p)
{
    struct brc_sim *sim = batch->sim;
    const struct poly_points *points = batch->contacts->point_columns;
    const struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    double *xi = points->spring[p] + POLY_XI,
           part = 0.5 * batch->law.kt * points->spring[p][POLY_WEIGHT], du[3];
    if (BRC_OPTION(sim->run.ledger)) {
        struct poly_frame4 f;
        brc_lanes u[3], middle[3];
        poly_slip_of_four(&f, g, sim->dt);
        poly_scale3(middle, g->x, brc_lanes_all(0.5));
        poly_slip_at(u, &f, middle);
        poly_lane3(du, u, i % BRC_LANES);
        double stored = part * brc_norm2(xi), work = part * sim->dt * brc_dot(xi, du);
        batch->energy[i][BRC_ACCOUNT_SHEAR] -= stored;
        batch->energy[i][BRC_ACCOUNT_FRICTION] += stored + work;
        if (poly_is_linearised(sim))
            batch->energy[i][BRC_ACCOUNT_NORMAL] -= work;
    }
    brc_set(xi, 0, 0, 0);
}

/* A point that does not touch: its spring is released, and it goes to sleep when the path that it
 * is free for is worth it. Its closest feature stays as it is, to begin the next walk at. At
 * platens nobody sleeps (list_at_platen). */
static void come_apart(struct poly_batch *batch, const struct poly_apart *apart)
{
    int32_t i = apart->contact;
    size_t p = (size_t)apart->point;
    const struct poly_contacts *columns = batch->contacts->model_columns;
    struct poly_points *points = batch->contacts->point_columns;
    size_t contact = (size_t)batch->contact[i];
    if (points->spring[p][POLY_WEIGHT] > 0)
        release_spring(batch, i, p);
    points->spring[p][POLY_WEIGHT] = 0;
    points->active[p] = 0;
    if (batch->is_platens)
        return;
    if (points->kind[p] == POLY_EDGES) {
        points->item[p][POLY_ITEM_SIDE] = 0;
        points->feature_valid_to[p] = apart->fades ? POLY_FADES : HUGE_VAL;
    }
    bool sleeps = batch->looks && batch->will_linearise[i];
    if (!sleeps && apart->path < DOZE_STEPS * batch->four[i / BRC_LANES].path[i % BRC_LANES])
        return;
    poly_sleep_point(batch->contacts, contact, p, columns->skin_left[contact] - apart->path);
}

/* In the order of points. By insertion, as there are some ten of a batch, which come from a few
 * lists that are in this order already. */
static void sort_apart(struct poly_apart *apart, int32_t n)
{
    for (int32_t i = 1; i < n; i++) {
        struct poly_apart x = apart[i];
        int32_t k = i;
        for (; k > 0 && apart[k - 1].point > x.point; k--)
            apart[k] = apart[k - 1];
        apart[k] = x;
    }
}

/* Computes all that is listed. Points that fall asleep move those behind them alone. */
void poly_work_off(struct poly_batch *batch)
{
    batch->n_apart = 0;
    batch->loop->points(batch);
    sort_apart(batch->apart, batch->n_apart);
    /* From the last one on, for a point that goes to sleep moves those behind it. */
    for (int32_t i = batch->n_apart - 1; i >= 0; i--)
        come_apart(batch, &batch->apart[i]);
    batch->n_points = 0;
}

/* Lists points p to p + n of contact i of the batch; returns the skin left above which their items
 * stay right. In a stable contact every awake point has its item, and the look at each of them is
 * left out. */
static double list_part(struct poly_batch *batch, int32_t i, size_t p, size_t n)
{
    const struct poly_points *points = batch->contacts->point_columns;
    const struct poly_contacts *columns = batch->contacts->model_columns;
    double skin_left = columns->skin_left[batch->contact[i]], stable_above = 0;
    batch->n_points += (int32_t)n;
    if (batch->is_stable[i])
        list_items(batch, points, i, p, n);
    else
        for (size_t q = p; q < p + n; q++)
            stable_above = poly_most(stable_above, list_point(batch, i, q, skin_left));
    return stable_above;
}

/* All points of a contact with a platen: none sleeps, as they are few and cheap. Its points may be
 * worked off in parts: none moves in the table by it. */
static void list_at_platen(struct poly_batch *batch, int32_t i)
{
    const struct brc_contacts *c = batch->contacts;
    size_t p = (size_t)c->p0[batch->contact[i]], n = (size_t)c->np[batch->contact[i]], end = p + n;
    if ((size_t)batch->n_points + n > POLY_TASKS)
        poly_work_off(batch);
    for (; p < end; p++) {
        if (batch->n_points++ == POLY_TASKS) {
            poly_work_off(batch);
            batch->n_points = 1;
        }
        add_task(batch, POLY_FLAT, i, p);
    }
}

/* Lists the points of contact i of the batch that may touch. A contact is never split, unless it
 * fills the lists by itself: its sums do not depend on the contacts around it. */
void poly_list_points(struct poly_batch *batch, int32_t i)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t contact = (size_t)batch->contact[i], p = (size_t)c->p0[contact], n;
    if (batch->is_platens) {
        list_at_platen(batch, i);
        return;
    }
    if (!batch->is_stable[i])
        poly_wake_points(batch->contacts, contact, rule_of(batch) == POLY_MERGED);
    n = (size_t)columns->awake[contact];
    double stable_above =
        !batch->is_stable[i] && n < (size_t)c->np[contact] ? points->sleep[p + n] : 0;
    columns->ready[contact] = n <= POLY_TASKS;
    if ((size_t)batch->n_points + n > POLY_TASKS)
        poly_work_off(batch);
    /* parts from the last one on: those that are still to come do not move (poly_work_off) */
    while (n > 0) {
        size_t part = n % POLY_TASKS > 0 ? n % POLY_TASKS : POLY_TASKS;
        n -= part;
        stable_above = poly_most(stable_above, list_part(batch, i, p + n, part));
        if (n > 0)
            poly_work_off(batch);
    }
    if (!batch->is_stable[i])
        columns->stable_above[contact] = poly_most(stable_above, 0);
}
