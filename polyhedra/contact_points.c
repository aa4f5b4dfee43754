/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which contacts exist, which feature pairs each of them watches as its points, and in which order.
 * Called by sim.c when the neighbour list is new, and by the loop; computes no force. */
#include "polyhedra/poly.h"

#include <stdlib.h>
#include <string.h>

/* --- contacts --------------------------------------------------------------------------------- */

/* The neighbours, and what is bonded or touches: such a contact has a state, which must not be lost
 * though the neighbour list lacks it, as its lists have been made for a range of their own. */
static bool is_kept(const void *user, const struct brc_contacts *c, const int32_t pair[2],
                    int64_t contact, bool is_near)
{
    const struct poly_points *points = c->point_columns;
    (void)user, (void)pair;
    if (is_near || c->status[contact] == BRC_INTACT)
        return true;
    for (int32_t k = 0; k < c->np[contact]; k++)
        if (points->spring[(size_t)c->p0[contact] + (size_t)k][POLY_WEIGHT] > 0)
            return true;
    return false;
}

int poly_update_contacts(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                         const struct brc_neighbours *platens)
{
    (void)state;
    BRC_TRY(brc_contacts_merge(sim->ctx, &sim->pairs, grains, is_kept, NULL));
    return brc_contacts_merge(sim->ctx, &sim->platens, platens, is_kept, NULL);
}

/* --- feature lists ---------------------------------------------------------------------------- */

/* Order of a feature and a point, less than 0 where the feature comes before, 0 where they are the
 * same one. A vertex of `merged` is told by its own number alone: it keeps its point, and its
 * place among the others, wherever its closest feature is. */
static int32_t compare_point(const struct poly_feature *f, const struct poly_points *points,
                             size_t p, bool merged)
{
    int32_t di = f->i - points->i[p], dj = f->j - points->j[p];
    if (f->kind != points->kind[p])
        return f->kind - points->kind[p];
    if (merged && f->kind == POLY_VERTEX_A)
        return di;
    if (merged && f->kind == POLY_VERTEX_B)
        return dj;
    return di != 0 ? di : dj;
}

/* n points, which move up or down. Column by column: point by point takes twice as many
 * instructions. */
static void move_points(const struct poly_points *points, size_t to, size_t from, size_t n)
{
#define MOVE(column) memmove(points->column + to, points->column + from, n * sizeof *points->column)
    MOVE(kind);
    MOVE(active);
    MOVE(i);
    MOVE(j);
    MOVE(near);
    MOVE(item);
    MOVE(sleep);
    MOVE(feature_valid_to);
    MOVE(spring);
#undef MOVE
}

/* Moves the state of points that act to the front, in order; returns how many. Their closest
 * feature is looked for anew (feature_valid_to), as the skin that it was valid in has ended with
 * the old list. */
static size_t gather_active(const struct poly_points *points, size_t first, size_t n)
{
    size_t kept = first;
    for (size_t p = first; p < first + n; p++) {
        if (points->spring[p][POLY_WEIGHT] <= 0)
            continue;
        if (kept < p)
            move_points(points, kept, p, 1);
        points->feature_valid_to[kept++] = HUGE_VAL;
    }
    return kept - first;
}

/* A point without a spring, as all that are asleep or have just been listed. With its item, if it
 * has one. */
static void set_point(const struct poly_points *points, size_t p, const struct poly_feature *f,
                      const int32_t item[POLY_ITEM], double sleep, double hold)
{
    points->kind[p] = f->kind;
    points->i[p] = f->i;
    points->j[p] = f->j;
    memcpy(points->near[p], f->near, sizeof f->near);
    points->sleep[p] = sleep;
    points->feature_valid_to[p] = hold;
    memcpy(points->item[p], item, sizeof points->item[p]);
    points->active[p] = 0;
    memset(points->spring[p], 0, sizeof points->spring[p]);
}

/* Points that are awake stand in the order of compare_point, so that sums over them do not depend
 * on how they came there. A point that wakes up is put in its place among the others by insertion:
 * few wake in one step, and the rest are sorted already. */
void poly_wake_points(struct brc_contacts *c, size_t contact, bool merged)
{
    const struct poly_points *points = c->point_columns;
    struct poly_contacts *columns = c->model_columns;
    size_t first = (size_t)c->p0[contact], end = first + (size_t)c->np[contact];
    size_t next = first + (size_t)columns->awake[contact];
    for (; next < end && columns->skin_left[contact] <= points->sleep[next]; next++) {
        struct poly_feature f = poly_point(points, next);
        double hold = points->feature_valid_to[next];
        int32_t item[POLY_ITEM];
        size_t p = next;
        memcpy(item, points->item[p], sizeof item);
        while (p > first && compare_point(&f, points, p - 1, merged) < 0)
            p--;
        if (p < next)
            move_points(points, p + 1, p, next - p);
        set_point(points, p, &f, item, columns->skin_left[contact], hold);
        columns->ready[contact] = 0;
    }
    columns->awake[contact] = (int32_t)(next - first);
}

/* Moves point p to its place among those that sleep, which are sorted by when they wake up; the
 * others, of which those before `awake` are awake, close up. */
static void move_to_sleep(const struct brc_contacts *c, size_t contact, size_t p, size_t awake,
                          double sleep)
{
    const struct poly_points *points = c->point_columns;
    struct poly_feature f = poly_point(points, p);
    double hold = points->feature_valid_to[p];
    int32_t item[POLY_ITEM];
    size_t to = p, end = (size_t)c->p0[contact] + (size_t)c->np[contact];
    memcpy(item, points->item[p], sizeof item);
    while (to + 1 < end && (to + 1 < awake || points->sleep[to + 1] > sleep))
        to++;
    if (to > p)
        move_points(points, p, p + 1, to - p);
    set_point(points, to, &f, item, sleep, hold);
}

/* Those that sleep stand sorted, so that to see whether one wakes up is to look at the first. If
 * all stay awake, bench_polyhedra takes 7.2 ms instead of 1.9 (bonded, literal), unbonded 4.9
 * instead of 3.6, and nothing that has points apart is linearised. */
void poly_sleep_point(struct brc_contacts *c, size_t contact, size_t p, double sleep)
{
    struct poly_contacts *columns = c->model_columns;
    size_t awake = (size_t)c->p0[contact] + (size_t)columns->awake[contact]--;
    move_to_sleep(c, contact, p, awake, sleep);
    columns->ready[contact] = 0;
}

void poly_sleep_on(struct brc_contacts *c, size_t contact, double sleep)
{
    const struct poly_contacts *columns = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t first = (size_t)c->p0[contact] + (size_t)columns->awake[contact];
    size_t end = (size_t)c->p0[contact] + (size_t)c->np[contact];
    /* Mostly it stays the first one. Then its other columns need not be fetched. */
    if (first + 1 < end && points->sleep[first + 1] > sleep)
        move_to_sleep(c, contact, first, first, sleep);
    else
        points->sleep[first] = sleep;
}

/* Pairs that may touch at once first, then by the path that they are free for. The order of what
 * sleeps. Ties are told by the features, so that the order does not hang on how the list was
 * made. */
static int compare_features(const void *x, const void *y)
{
    const struct poly_feature *f = x, *g = y;
    double path[2] = {poly_most(f->free, 0), poly_most(g->free, 0)};
    if (path[0] != path[1])
        return path[0] < path[1] ? -1 : 1;
    if (f->kind != g->kind)
        return f->kind < g->kind ? -1 : 1;
    return f->i != g->i ? (f->i > g->i) - (f->i < g->i) : (f->j > g->j) - (f->j < g->j);
}

/* The contact's points become the listed features; those that act keep their state. A point that
 * acts is always listed again, because it is within reach. */
static int replace_points(struct brc_context *ctx, struct brc_contacts *c, size_t contact,
                          const struct poly_list *list, bool merged)
{
    static const int32_t none[POLY_ITEM] = {[POLY_ITEM_LIST] = POLY_NO_LIST};
    struct poly_contacts *columns = c->model_columns;
    double skin_left = columns->skin_left[contact];
    if (list->n > 1)
        qsort(list->feature, list->n, sizeof *list->feature, compare_features);
    /* Only what acts has a state worth keeping. The rest is known from the list that has just
     * been made, and better than before. */
    size_t kept = gather_active(c->point_columns, (size_t)c->p0[contact], (size_t)c->np[contact]);
    size_t n = kept + list->n;
    c->np[contact] = (int32_t)kept;
    BRC_TRY(brc_contacts_points(ctx, c, contact, (int32_t)n));
    struct poly_points *points = c->point_columns;
    size_t first = (size_t)c->p0[contact], next = first + kept;
    for (size_t k = 0; k < list->n; k++) {
        size_t p = first;
        while (p < first + kept && compare_point(&list->feature[k], points, p, merged) != 0)
            p++;
        if (p < first + kept) {
            memcpy(points->near[p], list->feature[k].near, sizeof points->near[p]);
            points->item[p][POLY_ITEM_LIST] = POLY_NO_LIST;
        } else if (next < first + n)
            set_point(points, next++, &list->feature[k], none, skin_left - list->feature[k].free,
                      HUGE_VAL);
    }
    c->np[contact] = (int32_t)(next - first);
    columns->awake[contact] = (int32_t)kept;
    columns->ready[contact] = 0;
    return 0;
}

/* Without a feature in reach, rebuild_at says when to look again, by the paths of both bodies,
 * which need no look at the pair; with some, skin_left does, by their relative path, which a common
 * motion leaves as it is. */
int poly_list_contact(struct brc_sim *sim, struct poly_state *st, size_t contact)
{
    struct brc_contacts *c = &sim->pairs;
    struct poly_contacts *columns = c->model_columns;
    const struct poly_params *params = poly_params_of(sim);
    struct poly_pair pair;
    double allowance;
    poly_pair_of(&pair, sim, st, c->a[contact], c->b[contact]);
    BRC_TRY(st->kernels.list(sim->ctx, &st->list, &pair, (enum poly_rule)params->features,
                             POLY_LIST_SKIN * params->radius, &allowance));
    columns->rebuild_at[contact] =
        sim->bodies.path_length[c->a[contact]] + sim->bodies.path_length[c->b[contact]] + allowance;
    columns->skin_left[contact] = allowance;
    return replace_points(sim->ctx, c, contact, &st->list, params->features == POLY_MERGED);
}

/* Vertices of the grain within the skin of the platen; the lowest of the others is the allowance.
 */
int poly_list_platen(struct brc_sim *sim, struct poly_state *st, size_t contact)
{
    struct brc_contacts *c = &sim->platens;
    struct poly_contacts *columns = c->model_columns;
    size_t a = (size_t)c->a[contact], first = st->shapes.first[a].vertex;
    size_t n = st->shapes.first[a + 1].vertex - first;
    double radius = poly_params_of(sim)->radius, reach = (1 + POLY_PLATEN_SKIN) * radius;
    double allowance = HUGE_VAL;
    const struct brc_platen *platen = brc_sim_platen(sim, c->b[contact]);
    st->list.n = 0;
    for (size_t v = 0; v < n; v++) {
        double height, n_platen[3];
        brc_platen_height(platen, sim->bodies.x[c->b[contact]], st->global_vertices[first + v],
                          &height, n_platen);
        struct poly_feature f = {.i = (int32_t)v, .j = 0, .kind = POLY_VERTEX_A};
        if (height < reach)
            BRC_TRY(poly_list_add(sim->ctx, &st->list, &f));
        else
            allowance = fmin(allowance, height - radius);
    }
    columns->rebuild_at[contact] =
        sim->bodies.path_length[a] + sim->bodies.path_length[c->b[contact]] + allowance;
    return replace_points(sim->ctx, c, contact, &st->list, false);
}
