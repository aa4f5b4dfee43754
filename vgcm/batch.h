/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of points in the loop over contacts (forces.h): a batch of rows, the points of those that
 * have left the elastic range, and the three parts of their law. */
#ifndef VGCM_BATCH_H
#define VGCM_BATCH_H

#include "vgcm/contact.h"

struct batch;
struct booked;

struct loop {
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    /* takes the points of the rows that are listed so far */
    void (*items)(struct loop *l, struct batch *batch, struct booked *booked);
};

/* What the ledger gets, sums side by side [J]. */
struct booked {
    struct vgcm_energy_wide points[BRC_HALVES];
    struct vgcm_energy spheres;
    brc_lanes affine, viscous; /* stored by affine contacts; dissipated by viscous forces */
};

/* Rows are taken in batches: first the motion of all, then each part of the points' law for all,
 * so that the machine always has several chains of operations at hand. */
enum { BLOCKS = 2, ITEMS = 64, AHEAD = 8 };

/* Four rows on their way through a batch. */
struct block {
    brc_mask facet, points;
    struct vgcm_motion m;
    brc_lanes u[VGCM_N_MOTION]; /* fields at the end of the step */
    brc_lanes sum[VGCM_N_MOTION];
    brc_lanes moved; /* m, what the slack of rows of points loses in this step, or would */
    /* of rows of points: bonds, viscosity; four partial sums of each row */
    brc_lanes bond[VGCM_N_BOND], drag;
    brc_lanes force[VGCM_N_MOTION][BRC_LANES], drags[VGCM_N_MOTION][BRC_LANES];
    size_t i;                /* the first row */
    bool changes[BRC_LANES]; /* whether damage or plastic slip of the row did, or may at once */
};

/* Points of one row: eight, or one half of eight. */
struct item {
    struct block *block;
    int lane, half;
    int64_t n; /* points from the first on that are in the row */
    size_t j;  /* the first */
    struct vgcm_point_wide p;
};

struct batch {
    struct block block[BLOCKS];
    int n_blocks, n_items;
    struct item item[ITEMS];
};

/* ---- viscous forces ------------------------------------------------------------------------ */

/* Viscosity per area of rows i to i + 3, over dt: force = this times area times increment. */
VGCM_INLINE brc_lanes drag_of(const struct loop *l, size_t i)
{
    brc_lanes c = brc_lanes_all(0);
    double dt = l->sim->dt;
    const double *mass = l->sim->bodies.true_mass;
    for (int k = 0; k < BRC_LANES; k++) {
        double ma = mass[l->c->a[i + k]], mb = mass[l->c->b[i + k]];
        c[k] =
            dt > 0 ? l->law->viscous * ma * mb / (ma + mb) / (l->f->moment[i + k][VGCM_A] * dt) : 0;
    }
    return c;
}

/* Adds the viscous part to the generalised forces of the rows of the mask, and its dissipation to
 * what is booked. */
VGCM_INLINE void add_drag(struct loop *l, size_t i, int flags, brc_mask rows,
                          const brc_lanes du[VGCM_N_MOTION], const brc_lanes drag[VGCM_N_MOTION],
                          brc_lanes sum[VGCM_N_MOTION], brc_lanes *viscous)
{
    brc_lanes old[VGCM_N_MOTION], mean[VGCM_N_MOTION], now[VGCM_N_MOTION];
    brc_lanes_at6(old, l->f->drag + i);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (old[k] + drag[k]);
        now[k] = brc_lanes_pick(rows, drag[k], old[k]);
        sum[k] += brc_lanes_where(rows, drag[k]);
    }
    brc_lanes_put6(l->f->drag + i, now);
    if (flags & VGCM_LEDGER)
        *viscous += brc_lanes_where(rows, vgcm_force_work(mean, du));
}

/* Viscous force of points, c: viscosity times area. A broken point that is open has none, and one
 * that is closed is never pulled by it (fn: its normal force). */
VGCM_INLINE void point_drag(brc_wide drag[VGCM_N_MOTION], brc_wide c, const brc_wide du[3],
                            brc_wide_mask whole, brc_wide un, brc_wide fn, brc_wide s, brc_wide t)
{
    brc_wide pull = c * du[0], none = brc_wide_all(0);
    brc_wide_mask closed = brc_wide_less(un, none);
    pull = brc_wide_pick(whole, pull, brc_wide_where(closed, brc_wide_min(pull, -fn)));
    brc_wide fs = -c * du[1], ft = -c * du[2];
    vgcm_force_add(drag, pull, brc_wide_pick(whole, fs, brc_wide_where(closed, fs)),
                   brc_wide_pick(whole, ft, brc_wide_where(closed, ft)), s, t);
}

/* ---- rows of points ------------------------------------------------------------------------ */

/* Point j of row i has just broken. */
static void add_event(const struct loop *l, size_t i, size_t j)
{
    const struct brc_contacts *c = l->c;
    double t[3], branch[3], *xa = l->sim->bodies.x[c->a[i]];
    struct brc_event event = {.a = c->a[i],
                              .b = c->b[i],
                              .facet = c->facet[i],
                              .point = (int32_t)(j - (size_t)c->p0[i]),
                              .mode =
                                  l->p->dn[j] >= l->p->ds[j] ? BRC_MODE_TENSION : BRC_MODE_SHEAR,
                              .area = l->p->area[j],
                              .energy = l->p->lost[j]};
    brc_sub(branch, l->sim->bodies.x[c->b[i]], xa);
    brc_cross(t, l->f->n[i], l->f->s[i]);
    brc_copy(event.n, l->f->n[i]);
    brc_copy(event.x, xa);
    brc_axpy(event.x, 0.5 * brc_norm(branch) + l->f->plane[i], l->f->n[i]);
    brc_axpy(event.x, l->p->s[j], l->f->s[i]);
    brc_axpy(event.x, l->p->t[j], t);
    brc_events_add(l->sim->ctx, &l->sim->events, l->sim->step, &event);
    bool is_whole = false;
    for (size_t k = (size_t)c->p0[i], end = k + (size_t)c->np[i]; k < end; k++)
        is_whole |= l->p->dn[k] + l->p->ds[k] < 1;
    c->status[i] = is_whole ? BRC_INTACT : BRC_BROKEN;
}

static __attribute__((noinline)) void add_events(const struct loop *l, const struct item *q,
                                                 brc_wide_mask broke)
{
    for (int k = 0; k < BRC_WIDE; k++)
        if (brc_wide_is(broke, k))
            add_event(l, q->block->i + (size_t)q->lane, q->j + (size_t)k);
}

/* Field u of an item's row, wide. */
VGCM_INLINE void spread(brc_wide all[VGCM_N_MOTION], const brc_lanes u[VGCM_N_MOTION], int lane)
{
    for (int k = 0; k < VGCM_N_MOTION; k++)
        all[k] = brc_wide_all(u[k][lane]);
}

VGCM_INLINE void spread_bond(brc_wide all[VGCM_N_BOND], const struct item *q)
{
    for (int k = 0; k < VGCM_N_BOND; k++)
        all[k] = brc_wide_all(q->block->bond[k][q->lane]);
}

/* Plastic slip before the step: none where there is neither damage by slip nor a broken point, and
 * then it is not read; of points that are broken and open it is the whole displacement. */
VGCM_INLINE void item_slip(const struct loop *l, size_t j, const brc_wide at[3],
                           const brc_wide du[3], struct vgcm_point_wide *w)
{
    const struct vgcm_points *p = l->p;
    brc_wide none = brc_wide_all(0);
    brc_wide_mask broken = brc_wide_not(vgcm_wide_whole(w->damage_old));
    w->loose = brc_wide_both(brc_wide_less(none, w->un_old), broken);
    w->slip_s = w->slip_t = none;
    if (brc_wide_any(broken | brc_wide_less(none, w->ds))) {
        w->slip_s = brc_wide_pick(w->loose, at[1] - du[1], brc_wide_at(p->slip_s + j));
        w->slip_t = brc_wide_pick(w->loose, at[2] - du[2], brc_wide_at(p->slip_t + j));
    }
}

/* First part of the law: opening, damage by it, trial shear force. */
VGCM_INLINE void item_open(const struct loop *l, int flags, struct item *q)
{
    const struct vgcm_points *p = l->p;
    size_t j = q->j;
    brc_wide s = brc_wide_at(p->s + j), t = brc_wide_at(p->t + j), at[3], du[3];
    brc_wide all[VGCM_N_MOTION], bond[VGCM_N_BOND];
    struct vgcm_point_wide *w = &q->p;
    spread(all, q->block->u, q->lane);
    vgcm_motion_at(at, all, s, t);
    spread(all, q->block->m.du, q->lane);
    vgcm_motion_at(du, all, s, t);
    spread_bond(bond, q);
    w->dn = brc_wide_at(p->dn + j);
    w->ds = brc_wide_at(p->ds + j);
    w->damage_old = w->dn + w->ds;
    w->un = at[0];
    w->un_old = at[0] - du[0];
    item_slip(l, j, at, du, w);
    w->s = w->slip_s - at[1]; /* eq:vgcm:16, eq:vgcm:18 */
    w->t = w->slip_t - at[2];
    w->s_old = w->s + du[1];
    w->t_old = w->t + du[2];
    w->force2 = w->s * w->s + w->t * w->t;
    vgcm_wide_open(l->law, bond, flags, w);
}

VGCM_INLINE void item_slide(const struct loop *l, int flags, struct item *q)
{
    brc_wide bond[VGCM_N_BOND];
    spread_bond(bond, q);
    vgcm_wide_slide(l->law, bond, flags, &q->p);
}

/* Adds the forces of an item to the partial sums of its row. */
VGCM_INLINE void item_add(brc_lanes sum[VGCM_N_MOTION][BRC_LANES], int lane,
                          const brc_wide part[VGCM_N_MOTION])
{
    for (int k = 0; k < VGCM_N_MOTION; k++)
        sum[k][lane] = brc_wide_add(sum[k][lane], part[k]);
}

/* Last part: energies, forces, and the new state. */
VGCM_INLINE void item_finish(struct loop *l, int flags, struct item *q, struct booked *booked)
{
    const struct vgcm_points *p = l->p;
    const struct vgcm_point_wide *w = &q->p;
    size_t j = q->j;
    brc_wide s = brc_wide_at(p->s + j), t = brc_wide_at(p->t + j), area = brc_wide_at(p->area + j);
    brc_wide bond[VGCM_N_BOND], sum[VGCM_N_MOTION];
    spread_bond(bond, q);
    brc_wide lost = vgcm_wide_account(l->law, bond, flags, area, w, &booked->points[q->half]);
    brc_wide fs = w->s, ft = w->t, damage = w->dn + w->ds;
    brc_wide_mask live = brc_wide_first(q->n), is = vgcm_wide_whole(damage);
    brc_wide_mask grows = brc_wide_less(w->damage_old, damage);
    brc_wide_mask closed = brc_wide_not(is | brc_wide_less(brc_wide_all(0), w->un));
    brc_wide_mask changes = grows | closed;
    if (w->slides) {
        fs *= w->part;
        ft *= w->part;
        changes |= brc_wide_both(is, brc_wide_less(w->part, brc_wide_all(1)));
    }
    if (brc_wide_any(brc_wide_both(live, changes)))
        q->block->changes[q->lane] = true;
    if (w->slides || brc_wide_any(w->loose)) {
        brc_wide_put(p->slip_s + j, w->slip_s - (w->s - fs));
        brc_wide_put(p->slip_t + j, w->slip_t - (w->t - ft));
    }
    if (brc_wide_any(grows)) {
        brc_wide_put(p->dn + j, w->dn);
        brc_wide_put(p->ds + j, w->ds);
        brc_wide_put(p->lost + j, brc_wide_at(p->lost + j) + brc_wide_where(grows, lost));
    }
    for (int k = 0; k < VGCM_N_MOTION; k++)
        sum[k] = brc_wide_all(0);
    vgcm_force_add(sum, area * w->pull, area * fs, area * ft, s, t);
    item_add(q->block->force, q->lane, sum);
    brc_wide_mask broke = brc_wide_both(live, vgcm_wide_whole(w->damage_old));
    broke = brc_wide_both(broke, brc_wide_not(is));
    if (brc_wide_any(broke))
        add_events(l, q, broke);
    if (flags & VGCM_VISCOUS) {
        brc_wide all[VGCM_N_MOTION], du[3];
        spread(all, q->block->m.du, q->lane);
        vgcm_motion_at(du, all, s, t);
        for (int k = 0; k < VGCM_N_MOTION; k++)
            sum[k] = brc_wide_all(0);
        point_drag(sum, area * q->block->drag[q->lane], du, is, w->un,
                   area * w->pull * (2 * bond[VGCM_HALF_KN]), s, t);
        item_add(q->block->drags, q->lane, sum);
    }
}

/* Lists the points of a block's rows of points. */
VGCM_INLINE void list_items(struct loop *l, int flags, struct batch *batch, struct block *b,
                            struct booked *booked)
{
    vgcm_lanes_bond(b->bond, l->law, brc_lanes_at(l->f->kn + b->i));
    if (flags & VGCM_VISCOUS)
        b->drag = drag_of(l, b->i);
    for (int lane = 0; lane < BRC_LANES; lane++) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            b->force[k][lane] = brc_lanes_all(0);
        for (int k = 0; k < VGCM_N_MOTION && flags & VGCM_VISCOUS; k++)
            b->drags[k][lane] = brc_lanes_all(0);
        b->changes[lane] = false;
        size_t i = b->i + (size_t)lane;
        int64_t n = b->points[lane] ? l->c->np[i] : 0;
        for (int64_t k = 0; k < n; k += BRC_WIDE) {
            if (batch->n_items == ITEMS)
                l->items(l, batch, booked);
            struct item *q = &batch->item[batch->n_items++];
            q->block = b;
            q->lane = lane;
            q->half = (int)(k / BRC_WIDE) % BRC_HALVES;
            q->n = n - k;
            q->j = (size_t)(l->c->p0[i] + k);
        }
    }
}

VGCM_INLINE void step_items(struct loop *l, int flags, struct batch *batch, struct booked *booked)
{
    for (int k = 0; k < batch->n_items; k++)
        item_open(l, flags, &batch->item[k]);
    for (int k = 0; k < batch->n_items; k++)
        item_slide(l, flags, &batch->item[k]);
    for (int k = 0; k < batch->n_items; k++)
        item_finish(l, flags, &batch->item[k], booked);
    batch->n_items = 0;
}

/* The sums of a block's rows of points. */
VGCM_INLINE void sum_points(struct loop *l, int flags, struct block *b, struct booked *booked)
{
    brc_lanes kn = brc_lanes_at(l->f->kn + b->i), drags[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        bool is_normal = k == VGCM_OPEN || k == VGCM_BEND_S || k == VGCM_BEND_T;
        brc_lanes stiffness = is_normal ? kn : l->law->eta * kn;
        b->sum[k] = brc_lanes_pick(b->points, stiffness * brc_lanes_sums(b->force[k]), b->sum[k]);
    }
    if (flags & VGCM_VISCOUS) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            drags[k] = brc_lanes_sums(b->drags[k]);
        add_drag(l, b->i, flags, b->points, b->m.du, drags, b->sum, &booked->viscous);
    }
}

#endif
