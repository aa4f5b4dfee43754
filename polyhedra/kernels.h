/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the loop over grain pairs does four at a time. Each kernel is written once, with constant
 * options, and compiled for each instruction set by the files that include this one. */
#ifndef POLY_KERNELS_H
#define POLY_KERNELS_H

#include "polyhedra/listing.h"
#include "polyhedra/motion.h"

#include <string.h>

/* --- forces of touches ------------------------------------------------------------------------ */

/* One row, the same in all lanes. */
struct row_of_points {
    brc_lanes xa[3], x[3], slip[3], slope[3][3], turn[3], gn, gt;
    double kn, kt, limit; /* limit: of xi per overlap */
};

/* Sums over the points of a row. */
struct sums {
    struct poly_wrenches normal, shear, viscous;
    brc_lanes k[3], gap, stored, slid;
    brc_mask fresh;
};

BRC_LANES_INLINE void push(struct poly_wrenches *w, const brc_lanes f[3], const brc_lanes arm[3])
{
    brc_lanes m[3];
    brc_lanes_cross(m, arm, f);
    add(w->f, w->f, f);
    add(w->m, w->m, m);
}

/* Elastic normal force (eq 4), with the gradient part under `merged`. */
BRC_LANES_INLINE void push_normal(struct sums *s, const struct poly_touches *t, double kn,
                                  const brc_lanes arm[3])
{
    brc_lanes f[3], grade = -0.5 * kn * t->delta * t->delta;
    scale(f, t->n, kn * t->weight * t->delta); /* eq:gt12:4 */
    axpy(f, grade, t->g);
    axpy(s->normal.m, grade, t->c);
    push(&s->normal, f, arm);
}

/* Old tangential displacement turned with the contact frame: tilt from the old to the new normal,
 * then twirl by the angle 2 t about it. The length is kept. */
BRC_LANES_INLINE void turn_spring(brc_lanes xi[3], const brc_lanes n_old[3], const brc_lanes n[3],
                                  brc_lanes t)
{
    brc_lanes r[3], a[3], per = 1 / (1 + t * t), c = brc_lanes_dot(n_old, n);
    brc_lanes_cross(r, n_old, n);
    brc_lanes along = brc_lanes_dot(r, xi) / (1 + c);
    brc_lanes_cross(a, r, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = c * xi[i] + a[i] + along * r[i];
    brc_lanes_cross(a, n, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = ((1 - t * t) * xi[i] + 2 * t * a[i]) * per;
}

/* Adds the tangential part of du to xi and caps it (eqs 8-9): what is left over has slipped. */
BRC_LANES_INLINE void slide_spring(brc_lanes xi[3], const brc_lanes n[3], const brc_lanes du[3],
                                   brc_lanes limit)
{
    add(xi, xi, du); /* eq:gt12:9 */
    axpy(xi, -brc_lanes_dot(xi, n), n);
    brc_lanes xi2 = brc_lanes_dot(xi, xi);
    brc_lanes cap = brc_lanes_pick(brc_lanes_less(limit * limit, xi2), limit / brc_lanes_sqrt(xi2),
                                   brc_lanes_all(1));
    scale(xi, xi, cap); /* eq:gt12:8 */
}

/* State of four points: where they follow each other in their columns, or are put together. */
struct springs {
    double (*xi)[3], (*n)[3], *weight;
};

/* Four vectors from p on become those of a where the mask is set; old is what they are. */
BRC_LANES_INLINE void keep3(double (*p)[3], brc_mask m, const brc_lanes a[3],
                            const brc_lanes old[3])
{
    brc_lanes r[3];
    for (int k = 0; k < 3; k++)
        r[k] = brc_lanes_pick(m, a[k], old[k]);
    brc_lanes_put3(p, r);
}

/* Tangential springs: xi and the normals of the last step become those of now; old is the weight
 * that they had, where they touch now. */
BRC_LANES_INLINE void push_shear(const struct springs *p, struct sums *s,
                                 const struct poly_touches *t, const struct row_of_points *row,
                                 const brc_lanes du[3], const brc_lanes arm[3], brc_lanes old,
                                 const bool ledger)
{
    brc_lanes xi[3], xi_old[3], n_old[3], before[3], f[3];
    brc_mask touches = positive(t->weight);
    brc_lanes_at3(xi_old, p->xi);
    brc_lanes_at3(n_old, p->n);
    set(xi, xi_old[0], xi_old[1], xi_old[2]);
    turn_spring(xi, n_old, t->n, brc_lanes_dot(row->turn, t->n));
    mask(xi, positive(old), xi);
    set(before, xi[0], xi[1], xi[2]);
    slide_spring(xi, t->n, du, row->limit * t->delta);
    mask(xi, touches, xi);
    scale(f, xi, -row->kt * t->weight); /* eq:gt12:8 */
    push(&s->shear, f, arm);
    keep3(p->xi, touches, xi, xi_old);
    keep3(p->n, touches, t->n, n_old);
    if (!ledger)
        return;
    brc_lanes part[3], along = brc_lanes_dot(du, t->n);
    for (int k = 0; k < 3; k++)
        part[k] = (old * before[k] + t->weight * xi[k]);
    brc_lanes work = brc_lanes_dot(part, du) - along * brc_lanes_dot(part, t->n);
    s->slid += 0.5 * row->kt * work;
    s->stored +=
        0.5 * row->kt * (t->weight * brc_lanes_dot(xi, xi) - old * brc_lanes_dot(before, before));
}

BRC_LANES_INLINE void push_viscous(struct sums *s, const struct poly_touches *t,
                                   const struct row_of_points *row, const brc_lanes u[3],
                                   const brc_lanes arm[3])
{
    const double kn = row->kn;
    brc_lanes f[3], vn = brc_lanes_dot(u, t->n), gt = t->weight * row->gt;
    brc_lanes normal =
        brc_lanes_max(-t->weight * row->gn * vn, -kn * t->weight * t->delta); /* eq:gt12:10 */
    for (int i = 0; i < 3; i++)
        f[i] = normal * t->n[i] - gt * (u[i] - vn * t->n[i]);
    push(&s->viscous, f, arm);
}

BRC_LANES_INLINE void push_group(const struct poly_block *block, struct sums *s,
                                 const struct poly_touches *t, const struct row_of_points *row,
                                 const struct springs *p, const bool friction, const bool viscous,
                                 const bool ledger)
{
    brc_lanes arm[3], back[3], u[3], du[3], old = brc_lanes_at(p->weight);
    brc_mask touches = positive(t->weight);
    brc_lanes_put(p->weight, brc_lanes_pick(touches, t->weight, old));
    s->fresh |= touches & ~positive(old);
    sub(arm, t->x, row->xa);
    sub(back, arm, row->x);
    push_normal(s, t, row->kn, arm);
    brc_lanes stiff = brc_lanes_where(touches, brc_lanes_all(block->stiff));
    s->k[0] += stiff;
    s->k[1] += stiff * brc_lanes_dot(arm, arm);
    s->k[2] += stiff * brc_lanes_dot(back, back);
    s->gap = brc_lanes_pick(touches, brc_lanes_min(s->gap, -t->delta), s->gap);
    for (int k = 0; k < 3; k++)
        u[k] = brc_lanes_dot(row->slope[k], arm);
    add(u, u, row->slip);
    if (friction) {
        scale(du, u, brc_lanes_all(block->sim->dt));
        push_shear(p, s, t, row, du, arm, brc_lanes_where(touches, old), ledger);
    }
    if (viscous)
        push_viscous(s, t, row, u, arm);
}

BRC_LANES_INLINE void row_of_segment(struct row_of_points *row, const struct poly_block *block,
                                     const struct poly_segment *segment)
{
    const struct poly_row_group *g = &block->group[segment->row / BRC_LANES];
    int lane = segment->row % BRC_LANES;
    spread(row->xa, g->xa, lane);
    spread(row->x, g->x, lane);
    spread(row->slip, g->slip, lane);
    spread(row->turn, g->turn, lane);
    for (int k = 0; k < 3; k++)
        spread(row->slope[k], g->slope[k], lane);
    row->gn = brc_lanes_all(g->gn[lane]);
    row->gt = brc_lanes_all(g->gt[lane]);
    row->kn = block->kn;
    row->kt = block->kt;
    row->limit = poly_params_of(block->sim)->mu * block->kn / block->kt;
}

/* Sums over lanes to where a row keeps them. */
BRC_LANES_INLINE void add_sums(double *to, const brc_lanes lanes[BRC_LANES])
{
    brc_lanes_put(to, brc_lanes_at(to) + brc_lanes_sums(lanes));
}

BRC_LANES_INLINE void add_row(struct poly_block *block, int32_t row, const struct sums *s,
                              const bool friction, const bool viscous)
{
    const brc_lanes none = brc_lanes_all(0), *f = s->normal.f, *m = s->normal.m, *sf = s->shear.f,
                    *sm = s->shear.m, *vf = s->viscous.f, *vm = s->viscous.m;
    double *sum = block->sum[row];
    add_sums(sum, (const brc_lanes[]){f[0], f[1], f[2], m[0]});
    add_sums(sum + 4, (const brc_lanes[]){m[1], m[2], sf[0], sf[1]});
    if (friction)
        add_sums(sum + 8, (const brc_lanes[]){sf[2], sm[0], sm[1], sm[2]});
    add_sums(sum + POLY_SUM_K, (const brc_lanes[]){s->k[0], s->k[1], s->k[2], s->stored});
    add_sums(sum + POLY_SUM_SLID, (const brc_lanes[]){s->slid, vf[0], vf[1], vf[2]});
    if (viscous)
        add_sums(sum + POLY_SUM_VISCOUS + 3, (const brc_lanes[]){vm[0], vm[1], vm[2], none});
    block->nearest[row] =
        poly_least(block->nearest[row],
                   poly_least(poly_least(s->gap[0], s->gap[1]), poly_least(s->gap[2], s->gap[3])));
}

/* Where some points of a segment do not touch. */
BRC_LANES_INLINE bool has_apart(const struct poly_block *block, const struct poly_segment *segment)
{
    brc_mask apart = {0};
    for (int32_t k = 0; k < segment->n; k += BRC_LANES)
        apart |= brc_lanes_first(segment->n - k) &
                 ~positive(block->touch[(segment->slot + k) / BRC_LANES].weight);
    return brc_lanes_any(apart);
}

/* Four points that do not follow each other, from and to their columns. */
struct together {
    double xi[BRC_LANES][3], n[BRC_LANES][3], weight[BRC_LANES];
};

BRC_LANES_INLINE void put_together(struct together *to, const struct poly_points *points,
                                   const int32_t *p, int32_t n)
{
    memset(to, 0, sizeof *to);
    for (int32_t i = 0; i < n && i < BRC_LANES; i++) {
        brc_copy(to->xi[i], points->xi[p[i]]);
        brc_copy(to->n[i], points->n[p[i]]);
        to->weight[i] = points->weight[p[i]];
    }
}

BRC_LANES_INLINE void put_back(const struct poly_points *points, const struct together *from,
                               const int32_t *p, int32_t n)
{
    for (int32_t i = 0; i < n && i < BRC_LANES; i++) {
        brc_copy(points->xi[p[i]], from->xi[i]);
        brc_copy(points->n[p[i]], from->n[i]);
        points->weight[p[i]] = from->weight[i];
    }
}

/* Touches of slots k to k + 3 of a segment, into the sums. */
BRC_LANES_INLINE void push_slots(const struct poly_block *block, struct sums *s,
                                 const struct poly_segment *segment, int32_t k,
                                 const struct row_of_points *row, const bool friction,
                                 const bool viscous, const bool ledger)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const int32_t slot = segment->slot + k, p = segment->point + k;
    struct poly_touches t = block->touch[slot / BRC_LANES];
    brc_mask taken = brc_lanes_first(segment->n - k);
    struct springs springs = {points->xi + p, points->n + p, points->weight + p};
    struct together together;
    t.delta = brc_lanes_where(taken, t.delta);
    t.weight = brc_lanes_where(taken, t.weight);
    if (!segment->follow) {
        put_together(&together, points, block->point + slot, segment->n - k);
        springs = (struct springs){together.xi, together.n, together.weight};
    }
    push_group(block, s, &t, row, &springs, friction, viscous, ledger);
    if (!segment->follow)
        put_back(points, &together, block->point + slot, segment->n - k);
}

BRC_LANES_INLINE void points_of_row(struct poly_block *block, struct poly_segment *segment,
                                    const bool friction, const bool viscous, const bool ledger)
{
    struct row_of_points row;
    struct sums s;
    if (has_apart(block, segment))
        poly_drop_apart(block, segment);
    row_of_segment(&row, block, segment);
    clear((brc_lanes *)&s, sizeof s);
    s.gap = brc_lanes_all(HUGE_VAL);
    s.fresh = (brc_mask){0};
    for (int32_t k = 0; k < segment->n; k += BRC_LANES)
        push_slots(block, &s, segment, k, &row, friction, viscous, ledger);
    segment->fresh = brc_lanes_any(s.fresh);
    add_row(block, segment->row, &s, friction, viscous);
}

BRC_LANES_INLINE void points_kernel(struct poly_block *block, const bool friction,
                                    const bool viscous, const bool ledger)
{
    for (int32_t i = 0; i < block->n_segments; i++)
        points_of_row(block, &block->segment[i], friction, viscous, ledger);
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
                                   const bool viscous)
{
    struct brc_contacts *c = &block->sim->pairs;
    struct poly_row_group *g = &block->group[group];
    const int32_t *row = block->row + BRC_LANES * group;
    brc_lanes s[POLY_SUMS], f[3], ta[3], tb[3];
    struct poly_wrenches normal, sticky;
    sums_of_group(s, block, group, viscous ? POLY_SUMS : POLY_SUM_SLID + 4);
    set(normal.f, s[0], s[1], s[2]);
    set(normal.m, s[3], s[4], s[5]);
    set(sticky.f, s[POLY_SUM_VISCOUS], s[POLY_SUM_VISCOUS + 1], s[POLY_SUM_VISCOUS + 2]);
    for (int k = 0; k < 3; k++) {
        sticky.m[k] = viscous ? s[POLY_SUM_VISCOUS + 3 + k] : brc_lanes_all(0);
        f[k] = g->bond.f[k] + normal.f[k] + s[POLY_SUM_SHEAR + k];
        ta[k] = g->bond.m[k] + normal.m[k] + s[POLY_SUM_SHEAR + 3 + k];
        if (viscous) {
            f[k] += sticky.f[k];
            ta[k] += sticky.m[k];
        }
        ta[k] = -ta[k];
        g->k[k] += s[POLY_SUM_K + k];
    }
    brc_lanes_cross(tb, g->x, f);
    for (int k = 0; k < 3; k++)
        tb[k] = -ta[k] - tb[k];
    brc_lanes_scatter3(c->f, row, f);
    brc_lanes_scatter3(c->ta, row, ta);
    brc_lanes_scatter3(c->tb, row, tb);
    g->gap = brc_lanes_min(g->gap, brc_lanes_at(block->nearest + BRC_LANES * group));
    g->stored = s[POLY_SUM_STORED];
    g->slid = s[POLY_SUM_SLID];
    if (ledger)
        works_of_group(block, g, row, &normal, &sticky, viscous);
}

BRC_LANES_INLINE void finish_kernel(struct poly_block *block, const bool ledger, const bool viscous)
{
    for (int32_t group = 0; BRC_LANES * group < block->n_rows; group++)
        finish_group(block, group, ledger, viscous);
}

/* --- choice ----------------------------------------------------------------------------------- */

#define KERNEL(name, call)                                              \
    __attribute__((flatten)) static void name(struct poly_block *block) \
    {                                                                   \
        call;                                                           \
    }
KERNEL(motion, motion_kernel(block, false))
KERNEL(motion_torsion, motion_kernel(block, true))
KERNEL(touch, touch_kernel(block, false))
KERNEL(touch_merged, touch_kernel(block, true))
KERNEL(finish, finish_kernel(block, false, false))
KERNEL(finish_sticky, finish_kernel(block, false, true))
KERNEL(finish_ledger, finish_kernel(block, true, false))
KERNEL(finish_viscous, finish_kernel(block, true, true))
KERNEL(points_000, points_kernel(block, false, false, false))
KERNEL(points_010, points_kernel(block, false, true, false))
KERNEL(points_100, points_kernel(block, true, false, false))
KERNEL(points_101, points_kernel(block, true, false, true))
KERNEL(points_110, points_kernel(block, true, true, false))
KERNEL(points_111, points_kernel(block, true, true, true))
#undef KERNEL

__attribute__((flatten)) static int list(struct brc_context *ctx, struct poly_list *l,
                                         const struct poly_pair *p, enum poly_rule rule,
                                         double skin, double *allowance)
{
    return list_features(ctx, l, p, rule, skin, allowance);
}

static struct poly_kernels choose_kernels(const struct brc_sim *sim)
{
    static poly_kernel *const points[2][2][2] = {
        {{points_000, points_000}, {points_010, points_010}},
        {{points_100, points_101}, {points_110, points_111}}};
    static poly_kernel *const finishes[2][2] = {{finish, finish_ledger},
                                                {finish_sticky, finish_viscous}};
    const struct poly_params *p = poly_params_of(sim);
    bool friction = BRC_OPTION(p->mu > 0 && p->kt > 0), ledger = BRC_OPTION(sim->run.ledger);
    bool viscous = BRC_OPTION(sim->run.regime == BRC_DYNAMIC && (p->gn > 0 || p->gt > 0));
    return (struct poly_kernels){.list = list,
                                 .motion = BRC_OPTION(p->torsion) ? motion_torsion : motion,
                                 .touch = p->features == POLY_MERGED ? touch_merged : touch,
                                 .points = points[friction][viscous][ledger],
                                 .finish = finishes[viscous][ledger]};
}

#endif
