/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the loop over grain pairs does four at a time. Each kernel is written once, with constant
 * options, and compiled for each instruction set by the files that include this one. */
#ifndef POLY_KERNELS_H
#define POLY_KERNELS_H

#include "polyhedra/condensed.h"
#include "polyhedra/listing.h"

#include <string.h>

/* --- forces of touches ------------------------------------------------------------------------ */

/* What four points add to the sums of their rows (POLY_SUM_NORMAL and so on). */
struct sums {
    struct poly_wrenches normal, shear;
    brc_lanes k[3], stored, slid;
    struct poly_wrenches viscous;
    brc_lanes none;
};

BRC_LANES_INLINE void push(struct poly_wrenches *w, const brc_lanes f[3], const brc_lanes arm[3])
{
    set(w->f, f[0], f[1], f[2]);
    brc_lanes_cross(w->m, arm, f);
}

/* Elastic normal force (eq 4), with the gradient part under `merged`. */
BRC_LANES_INLINE void push_normal(struct sums *s, const struct poly_touches *t, double kn,
                                  const brc_lanes arm[3])
{
    brc_lanes f[3], grade = -0.5 * kn * t->delta * t->delta;
    scale(f, t->n, kn * t->weight * t->delta); /* eq:gt12:4 */
    axpy(f, grade, t->g);
    push(&s->normal, f, arm);
    axpy(s->normal.m, grade, t->c);
}

/* Old tangential displacement turned with the contact frame: tilt from the old to the new normal,
 * then twirl by the angle 2 t about it. The length is kept. */
BRC_LANES_INLINE void turn_spring(brc_lanes xi[3], const brc_lanes n_old[3], const brc_lanes n[3],
                                  brc_lanes t)
{
    brc_lanes r[3], a[3], c = brc_lanes_dot(n_old, n), t2 = 1 + t * t, tilt = 1 + c;
    brc_lanes both = 1 / (t2 * tilt), per = both * tilt;
    brc_lanes_cross(r, n_old, n);
    brc_lanes along = brc_lanes_dot(r, xi) * (both * t2);
    brc_lanes_cross(a, r, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = c * xi[i] + a[i] + along * r[i];
    brc_lanes_cross(a, n, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = ((2 - t2) * xi[i] + 2 * t * a[i]) * per;
}

/* Adds the tangential part of du to xi and caps it (eqs 8-9): what is left over has slipped.
 * Returns where it has. */
BRC_LANES_INLINE brc_mask slide_spring(brc_lanes xi[3], const brc_lanes n[3], const brc_lanes du[3],
                                       brc_lanes limit)
{
    add(xi, xi, du); /* eq:gt12:9 */
    axpy(xi, -brc_lanes_dot(xi, n), n);
    brc_lanes xi2 = brc_lanes_dot(xi, xi);
    brc_mask slips = brc_lanes_less(limit * limit, xi2);
    brc_lanes cap = brc_lanes_pick(slips, limit / brc_lanes_sqrt(xi2), brc_lanes_all(1));
    scale(xi, xi, cap); /* eq:gt12:8 */
    return slips;
}

/* Springs of four points, as POLY_SPRING has them. */
struct springs {
    brc_lanes xi[3], weight, n[3], none;
};

/* Tangential springs: xi and the normals of the last step become those of now; old is the weight
 * that they had, where they touch now. */
BRC_LANES_INLINE brc_mask push_shear(struct springs *p, struct sums *s,
                                     const struct poly_touches *t, const struct frames *row,
                                     const struct poly_block *block, const brc_lanes du[3],
                                     const brc_lanes arm[3], brc_lanes old, const bool ledger)
{
    brc_lanes xi[3], before[3], f[3], turn[3];
    brc_mask touches = positive(t->weight);
    set(xi, p->xi[0], p->xi[1], p->xi[2]);
    set(turn, row->along[0].turn, row->along[1].turn, row->along[2].turn);
    turn_spring(xi, p->n, t->n, brc_lanes_dot(turn, t->n));
    mask(xi, positive(old), xi);
    set(before, xi[0], xi[1], xi[2]);
    brc_mask slips = slide_spring(xi, t->n, du, block->limit * t->delta);
    mask(xi, touches, xi);
    scale(f, xi, -block->kt * t->weight); /* eq:gt12:8 */
    push(&s->shear, f, arm);
    for (int k = 0; k < 3; k++) {
        p->xi[k] = brc_lanes_pick(touches, xi[k], p->xi[k]);
        p->n[k] = brc_lanes_pick(touches, t->n[k], p->n[k]);
    }
    if (!ledger)
        return slips;
    brc_lanes part[3], along = brc_lanes_dot(du, t->n);
    for (int k = 0; k < 3; k++)
        part[k] = (old * before[k] + t->weight * xi[k]);
    brc_lanes work = brc_lanes_dot(part, du) - along * brc_lanes_dot(part, t->n);
    s->slid = 0.5 * block->kt * work;
    s->stored =
        0.5 * block->kt * (t->weight * brc_lanes_dot(xi, xi) - old * brc_lanes_dot(before, before));
    return slips;
}

BRC_LANES_INLINE void push_viscous(struct sums *s, const struct poly_touches *t,
                                   const struct frames *row, const struct poly_block *block,
                                   const brc_lanes u[3], const brc_lanes arm[3])
{
    const double kn = block->kn;
    brc_lanes f[3], vn = brc_lanes_dot(u, t->n), gt = t->weight * row->gt;
    brc_lanes normal =
        brc_lanes_max(-t->weight * row->gn * vn, -kn * t->weight * t->delta); /* eq:gt12:10 */
    for (int i = 0; i < 3; i++)
        f[i] = normal * t->n[i] - gt * (u[i] - vn * t->n[i]);
    push(&s->viscous, f, arm);
}

/* Stiffness of four springs: A of df = -A d, columns a[j], for a shift d of b at the point. With
 * the energy w kn delta^2 / 2 and the slope g of w, the normal force gives
 * w kn n n - kn delta (n g + g n); a tangential spring that sticks w kt (1 - n n) + kt xi g; one
 * that slips along t has no stiffness in that direction, and -mu kn w t n by its cap. q is what a
 * change of weight does. */
BRC_LANES_INLINE void spring_stiffness(brc_lanes a[3][3], brc_lanes q[3],
                                       const struct poly_block *block, const struct poly_touches *t,
                                       const brc_lanes xi[3], brc_mask slips, const bool friction)
{
    const brc_lanes kn = block->kn * t->weight, none = brc_lanes_all(0);
    const brc_lanes kt = friction ? block->kt * t->weight : none;
    brc_lanes push = block->kn * t->delta, slide[3] = {none, none, none};
    brc_lanes size2 = brc_lanes_where(slips, brc_lanes_dot(xi, xi));
    brc_lanes per = brc_lanes_where(positive(size2), 1 / size2);
    for (int i = 0; i < 3; i++) {
        q[i] = -push * t->n[i];
        if (friction)
            q[i] += block->kt * xi[i];
    }
    if (friction)
        scale(slide, xi, kt * per);
    brc_lanes cap = block->limit * brc_lanes_sqrt(size2); /* mu kn w = kt w limit */
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            a[j][i] = (kn - kt) * t->n[i] * t->n[j] + q[i] * t->g[j] - push * t->g[i] * t->n[j];
            if (friction)
                a[j][i] -= slide[i] * (xi[j] + cap * t->n[j]);
            if (i == j)
                a[j][i] += kt;
        }
}

/* Adds the stiffness of four points to the tangents of their rows. */
BRC_LANES_INLINE void add_tangents(struct poly_block *block, const int32_t row[BRC_LANES],
                                   const struct poly_touches *t, const brc_lanes xi[3],
                                   brc_mask slips, const brc_lanes arm[3], const bool friction)
{
    brc_lanes a[3][3], q[3], k[36], force[3], moment[3];
    spring_stiffness(a, q, block, t, xi, slips, friction);
    for (int j = 0; j < 6; j++) {
        const int l = (j + 1) % 3, m = (j + 2) % 3;
        for (int i = 0; i < 3; i++)
            force[i] = j < 3 ? a[j][i] : arm[l] * a[m][i] - arm[m] * a[l][i] + q[i] * t->c[j % 3];
        brc_lanes_cross(moment, arm, force);
        for (int i = 0; i < 3; i++) {
            k[6 * j + i] = force[i];
            k[6 * j + i + 3] = moment[i];
        }
    }
    for (int n = 0; n < 36; n += BRC_LANES) {
        brc_lanes_transpose(k + n);
        for (int i = 0; i < BRC_LANES; i++) {
            double *to = block->tangent[row[i]] + n;
            brc_lanes_put(to, brc_lanes_at(to) + k[n + i]);
        }
    }
    for (int i = 0; i < BRC_LANES; i++)
        if (t->weight[i] > 0)
            block->lasting[row[i]] = poly_least(block->lasting[row[i]], t->lasts[i]);
}

/* Adds the lanes to the sums of their rows, one after the other: the points of a row are summed in
 * the order of the lists. */
BRC_LANES_INLINE void add_sums(struct poly_block *block, const int32_t row[BRC_LANES],
                               brc_lanes *sums, int end)
{
    for (int k = 0; k < end; k += BRC_LANES) {
        brc_lanes_transpose(sums + k);
        for (int i = 0; i < BRC_LANES; i++) {
            double *to = block->sum[row[i]] + k;
            brc_lanes_put(to, brc_lanes_at(to) + sums[k + i]);
        }
    }
}

/* Forces of four points, which touch or are apart. Returns where they slip. */
BRC_LANES_INLINE brc_mask push_points(const struct poly_block *block, struct sums *s,
                                      const struct poly_touches *t, const struct frames *row,
                                      struct springs *springs, const brc_lanes arm[3],
                                      const bool condensed, const bool friction, const bool viscous,
                                      const bool ledger)
{
    brc_lanes back[3], u[3], du[3], old = springs->weight;
    brc_mask touches = positive(t->weight), slips = {0};
    springs->weight = brc_lanes_pick(touches, t->weight, old);
    sub(back, arm, row->x);
    push_normal(s, t, block->kn, arm);
    brc_lanes stiff = brc_lanes_where(touches, brc_lanes_all(block->stiff));
    s->k[0] = stiff;
    s->k[1] = stiff * brc_lanes_dot(arm, arm);
    s->k[2] = stiff * brc_lanes_dot(back, back);
    s->stored = s->slid = brc_lanes_all(0);
    if (friction || viscous) {
        for (int k = 0; k < 3; k++)
            u[k] = brc_lanes_dot(row->along[k].slope, arm);
        add(u, u, row->slip);
    }
    if (friction) {
        scale(du, u, brc_lanes_all(condensed ? 1 : block->sim->dt));
        slips =
            push_shear(springs, s, t, row, block, du, arm, brc_lanes_where(touches, old), ledger);
    } else {
        clear((brc_lanes *)&s->shear, sizeof s->shear);
    }
    if (viscous)
        push_viscous(s, t, row, block, u, arm);
    else
        clear((brc_lanes *)&s->viscous, sizeof s->viscous);
    return slips & touches;
}

/* Points that begin to touch, and those that are apart. */
BRC_LANES_INLINE void note_changes(struct poly_block *block, const struct poly_task *task,
                                   int32_t n, const struct poly_touches *t, brc_lanes old)
{
    struct poly_points *points = block->sim->pairs.point_columns;
    brc_mask touches = positive(t->weight), taken = brc_lanes_first(n);
    if (!brc_lanes_any(taken & (~touches | ~positive(old))))
        return;
    for (int32_t k = 0; k < BRC_LANES && k < n; k++) {
        if (!touches[k]) {
            bool fades = t->fades[k] != 0;
            block->open[task[k].row] |= !fades;
            block->apart[block->n_apart++] =
                (struct poly_apart){task[k].row, task[k].point, poly_most(-t->delta[k], 0), fades};
        } else if (points->active[task[k].point] == 0)
            points->active[task[k].point] = 1;
    }
}

/* Forces of the four points from task on, of which the first n count. */
BRC_LANES_INLINE void act(struct poly_block *block, const struct poly_task *task, int32_t n,
                          const struct poly_touches *t, const bool condensed, const bool friction,
                          const bool viscous, const bool ledger)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const double *frame[BRC_LANES], *from[BRC_LANES];
    int32_t row[BRC_LANES];
    struct frames f;
    struct springs springs;
    struct sums s;
    for (int k = 0; k < BRC_LANES; k++) {
        row[k] = task[k].row;
        frame[k] = block->frame[row[k]];
        from[k] = points->spring[task[k].point];
    }
    gather_fours((brc_lanes *)&f, frame, friction || viscous ? POLY_FRAME : POLY_FRAME_SLIP);
    gather_fours((brc_lanes *)&springs, from, POLY_SPRING);
    brc_lanes arm[3], old = springs.weight;
    sub(arm, t->x, f.xa);
    brc_mask slips =
        push_points(block, &s, t, &f, &springs, arm, condensed, friction, viscous, ledger);
    note_changes(block, task, n, t, old);
    const bool *steady = block->steady;
    if (condensed && (steady[row[0]] | steady[row[1]] | steady[row[2]] | steady[row[3]]))
        add_tangents(block, row, t, springs.xi, slips, arm, friction);
    brc_lanes *part = (brc_lanes *)&springs;
    brc_lanes_transpose(part);
    brc_lanes_transpose(part + BRC_LANES);
    for (int k = 0; k < BRC_LANES && k < n; k++) {
        brc_lanes_put(points->spring[task[k].point], part[k]);
        brc_lanes_put(points->spring[task[k].point] + BRC_LANES, part[BRC_LANES + k]);
        block->nearest[row[k]] =
            poly_least(block->nearest[row[k]], t->weight[k] > 0 ? -t->delta[k] : HUGE_VAL);
    }
    s.none = brc_lanes_all(0);
    add_sums(block, row, (brc_lanes *)&s, viscous ? POLY_SUMS : POLY_SUM_SLID + BRC_LANES);
}

/* Ends a list at a whole group: what is left over goes to a row that nobody reads. Returns its
 * number of tasks; the list is empty then. */
BRC_LANES_INLINE int32_t end_list(struct poly_block *block, int list)
{
    struct poly_task *task = block->task[list];
    int32_t n = block->n_tasks[list];
    for (int32_t k = n; k % BRC_LANES != 0; k++)
        task[k] = (struct poly_task){POLY_ROWS, task[n - 1].point};
    block->n_tasks[list] = 0;
    return n;
}

BRC_LANES_INLINE void points_of_list(struct poly_block *block, const int list, const bool merged,
                                     const bool condensed, const bool friction, const bool viscous,
                                     const bool ledger)
{
    const struct poly_task *task = block->task[list];
    int32_t n = end_list(block, list);
    for (int32_t k = 0; k < n; k += BRC_LANES) {
        struct poly_touches t;
        if (list == POLY_KNOWN)
            t = block->known[k / BRC_LANES];
        else if (list == POLY_CROSSING)
            touch_edges(&t, block, task + k, merged);
        else
            touch_vertices(&t, block, task + k, list == POLY_FLAT);
        act(block, task + k, n - k, &t, condensed, friction, viscous, ledger);
    }
}

BRC_LANES_INLINE void points_kernel(struct poly_block *block, const bool merged,
                                    const bool condensed, const bool friction, const bool viscous,
                                    const bool ledger)
{
    points_of_list(block, POLY_FLAT, merged, condensed, friction, viscous, ledger);
    if (merged)
        points_of_list(block, POLY_SHARP, merged, condensed, friction, viscous, ledger);
    points_of_list(block, POLY_CROSSING, merged, condensed, friction, viscous, ledger);
    points_of_list(block, POLY_KNOWN, merged, condensed, friction, viscous, ledger);
}

/* --- sums of rows ----------------------------------------------------------------------------- */

/* The points' sums of a group's rows. */
BRC_LANES_INLINE void sums_of_group(brc_lanes r[POLY_SUMS], const struct poly_block *block,
                                    int32_t group, int n)
{
    for (int i = 0; i < n; i += BRC_LANES) {
        for (int row = 0; row < BRC_LANES; row++)
            r[i + row] = brc_lanes_at(&block->sum[BRC_LANES * group + row][i]);
        brc_lanes_transpose(r + i);
    }
}

/* Power of force and moments of a wrench on both bodies, for the offset x of the centres. */
BRC_LANES_INLINE brc_lanes power(const struct poly_wrenches *w, const struct poly_row_group *g,
                                 const brc_lanes x[3])
{
    brc_lanes tb[3];
    brc_lanes_cross(tb, x, w->f);
    sub(tb, w->m, tb);
    return brc_lanes_dot(w->f, g->dv) - brc_lanes_dot(w->m, g->wa) + brc_lanes_dot(tb, g->wb);
}

/* Work taken up by the source of a wrench over the step, by the trapezoid rule of ledger.h; the
 * wrench becomes the old one. */
BRC_LANES_INLINE brc_lanes work(double (*old)[6], const struct poly_wrenches *now,
                                const struct poly_row_group *g, const int32_t row[BRC_LANES],
                                double dt)
{
    struct poly_wrenches w;
    brc_lanes x_old[3], all[6];
    brc_lanes_gather6(all, old, row);
    set(w.f, all[0], all[1], all[2]);
    set(w.m, all[3], all[4], all[5]);
    for (int k = 0; k < 3; k++)
        x_old[k] = g->x[k] - g->dv[k] * dt;
    set(all, now->f[0], now->f[1], now->f[2]);
    set(all + 3, now->m[0], now->m[1], now->m[2]);
    brc_lanes_scatter6(old, row, all);
    return -0.5 * dt * (power(&w, g, x_old) + power(now, g, g->x));
}

BRC_LANES_INLINE void works_of_group(struct poly_block *block, struct poly_row_group *g,
                                     const int32_t *row, const struct poly_wrenches *normal,
                                     const struct poly_wrenches *sticky, const bool viscous)
{
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    double dt = block->sim->dt;
    g->work_normal = work(rows->normal_old, normal, g, row, dt);
    g->work_bond = work(rows->bond_old, &g->bond, g, row, dt);
    if (viscous)
        g->work_viscous = work(rows->viscous_old, sticky, g, row, dt);
}

/* Forces and moments of the rows of a group, and what else they need. */
BRC_LANES_INLINE void finish_group(struct poly_block *block, int32_t group, const bool ledger,
                                   const bool viscous, const bool condensed)
{
    struct brc_contacts *c = &block->sim->pairs;
    struct poly_row_group *g = &block->group[group];
    const int32_t *row = block->row + BRC_LANES * group;
    brc_lanes s[POLY_SUMS];
    struct poly_wrenches normal, sticky, all;
    sums_of_group(s, block, group, viscous ? POLY_SUMS : POLY_SUM_SLID + 4);
    set(normal.f, s[0], s[1], s[2]);
    set(normal.m, s[3], s[4], s[5]);
    set(sticky.f, s[POLY_SUM_VISCOUS], s[POLY_SUM_VISCOUS + 1], s[POLY_SUM_VISCOUS + 2]);
    for (int k = 0; k < 3; k++) {
        sticky.m[k] = viscous ? s[POLY_SUM_VISCOUS + 3 + k] : brc_lanes_all(0);
        all.f[k] = g->bond.f[k] + normal.f[k] + s[POLY_SUM_SHEAR + k];
        all.m[k] = g->bond.m[k] + normal.m[k] + s[POLY_SUM_SHEAR + 3 + k];
        if (viscous) {
            all.f[k] += sticky.f[k];
            all.m[k] += sticky.m[k];
        }
        g->k[k] += s[POLY_SUM_K + k];
    }
    g->gap = brc_lanes_min(g->gap, brc_lanes_at(block->nearest + BRC_LANES * group));
    g->stored = s[POLY_SUM_STORED];
    g->slid = s[POLY_SUM_SLID];
    if (ledger && condensed) {
        g->work_normal = work_of_rows(c, &all, g, row, block->sim->dt) - g->slid;
        g->work_bond = brc_lanes_all(0);
    } else if (ledger) {
        works_of_group(block, g, row, &normal, &sticky, viscous);
    }
    put_wrenches(c, &all, g, row);
}

BRC_LANES_INLINE void finish_kernel(struct poly_block *block, const bool ledger, const bool viscous,
                                    const bool condensed)
{
    for (int32_t group = 0; BRC_LANES * group < block->n_rows; group++)
        finish_group(block, group, ledger, viscous, condensed);
}

/* --- choice ----------------------------------------------------------------------------------- */

#define KERNEL(name, call)                                              \
    __attribute__((flatten)) static void name(struct poly_block *block) \
    {                                                                   \
        call;                                                           \
    }
KERNEL(motion, motion_kernel(block, false, false))
KERNEL(motion_torsion, motion_kernel(block, true, false))
KERNEL(motion_condensed, motion_kernel(block, false, true))
KERNEL(motion_torsion_condensed, motion_kernel(block, true, true))
KERNEL(finish, finish_kernel(block, false, false, false))
KERNEL(finish_sticky, finish_kernel(block, false, true, false))
KERNEL(finish_ledger, finish_kernel(block, true, false, false))
KERNEL(finish_viscous, finish_kernel(block, true, true, false))
KERNEL(finish_condensed, finish_kernel(block, false, false, true))
KERNEL(finish_condensed_ledger, finish_kernel(block, true, false, true))
KERNEL(carry, carry_kernel(block, false))
KERNEL(carry_ledger, carry_kernel(block, true))
#define POINTS(name, ...)                                           \
    KERNEL(points_##name, points_kernel(block, false, __VA_ARGS__)) \
    KERNEL(merged_##name, points_kernel(block, true, __VA_ARGS__))
POINTS(plain, false, false, false, false)
POINTS(viscous, false, false, true, false)
POINTS(rub, false, true, false, false)
POINTS(rub_ledger, false, true, false, true)
POINTS(rub_viscous, false, true, true, false)
POINTS(rub_viscous_ledger, false, true, true, true)
POINTS(condensed, true, false, false, false)
POINTS(condensed_rub, true, true, false, false)
POINTS(condensed_rub_ledger, true, true, false, true)
#undef POINTS
#undef KERNEL

__attribute__((flatten)) static void world(const struct brc_sim *sim, const struct poly_state *st)
{
    place_cores(sim, st);
}

__attribute__((flatten)) static int list(struct brc_context *ctx, struct poly_list *l,
                                         const struct poly_pair *p, enum poly_rule rule,
                                         double skin, double *allowance)
{
    return list_features(ctx, l, p, rule, skin, allowance);
}

static struct poly_kernels choose_condensed(const struct poly_params *p, bool friction, bool ledger)
{
    static poly_kernel *const points[2][2][2] = {
        {{points_condensed, points_condensed}, {points_condensed_rub, points_condensed_rub_ledger}},
        {{merged_condensed, merged_condensed},
         {merged_condensed_rub, merged_condensed_rub_ledger}}};
    bool merged = p->features == POLY_MERGED;
    return (struct poly_kernels){.world = world,
                                 .list = list,
                                 .motion = BRC_OPTION(p->torsion) ? motion_torsion_condensed
                                                                  : motion_condensed,
                                 .points = points[merged][friction][ledger],
                                 .finish = ledger ? finish_condensed_ledger : finish_condensed,
                                 .carry = ledger ? carry_ledger : carry};
}

static struct poly_kernels choose_kernels(const struct brc_sim *sim)
{
    static poly_kernel *const points[2][2][2][2] = {
        {{{points_plain, points_plain}, {points_viscous, points_viscous}},
         {{points_rub, points_rub_ledger}, {points_rub_viscous, points_rub_viscous_ledger}}},
        {{{merged_plain, merged_plain}, {merged_viscous, merged_viscous}},
         {{merged_rub, merged_rub_ledger}, {merged_rub_viscous, merged_rub_viscous_ledger}}}};
    static poly_kernel *const finishes[2][2] = {{finish, finish_ledger},
                                                {finish_sticky, finish_viscous}};
    const struct poly_params *p = poly_params_of(sim);
    bool friction = BRC_OPTION(p->mu > 0 && p->kt > 0), ledger = BRC_OPTION(sim->run.ledger);
    bool merged = p->features == POLY_MERGED;
    bool viscous = BRC_OPTION(poly_is_viscous(sim));
    if (poly_is_condensed(sim))
        return choose_condensed(p, friction, ledger);
    return (struct poly_kernels){.world = world,
                                 .list = list,
                                 .motion = BRC_OPTION(p->torsion) ? motion_torsion : motion,
                                 .points = points[merged][friction][viscous][ledger],
                                 .finish = finishes[viscous][ledger]};
}

#endif
