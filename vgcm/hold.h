/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows whose points rest: none of their damages and plastic slips changes, so that the forces are
 * linear in the row's field, and sums over the points make them. What a row may move before that
 * ends, its slack, is found once; each step then takes its motion off. Nothing is approximated: a
 * row whose slack is used up goes back to the law of the points before any of them can change. */
#ifndef VGCM_HOLD_H
#define VGCM_HOLD_H

#include "vgcm/batch.h"

/* steps as large as this one that slack must last for */
static const double LEAST_STEPS = 4;

/* By how much no point of the rows can have come nearer to a change: its force nears the strength
 * by what it slides, and by mu/eta of what it opens. */
VGCM_INLINE brc_lanes largest_motion(const struct vgcm_law *law, brc_lanes rim,
                                     const brc_lanes du[VGCM_N_MOTION])
{
    double weight = law->eta > 0 ? fmax(1, law->mu / law->eta) : 1;
    brc_lanes bend = brc_lanes_abs(du[VGCM_BEND_S]) + brc_lanes_abs(du[VGCM_BEND_T]);
    brc_lanes along = brc_lanes_abs(du[VGCM_OPEN]) + rim * bend;
    brc_lanes across =
        brc_lanes_abs(du[VGCM_S]) + brc_lanes_abs(du[VGCM_T]) + rim * brc_lanes_abs(du[VGCM_TWIST]);
    return weight * along + across;
}

VGCM_INLINE void load_held(brc_lanes held[VGCM_N_HELD], double (*rows)[VGCM_N_HELD])
{
    for (int k = 0; k + BRC_LANES <= VGCM_N_HELD; k += BRC_LANES) {
        for (int lane = 0; lane < BRC_LANES; lane++)
            held[k + lane] = brc_lanes_at(rows[lane] + k);
        brc_lanes_transpose(held + k);
    }
    const int last = VGCM_N_HELD - 1;
    held[last] = (brc_lanes){rows[0][last], rows[1][last], rows[2][last], rows[3][last]};
}

/* Which of a block's rows of points rest through this step, and their forces. Rows that are broken
 * all over rest while all their points are open: then they have none. */
VGCM_INLINE brc_mask resting_rows(struct loop *l, size_t i, int flags, struct block *b,
                                  struct booked *booked)
{
    b->moved = largest_motion(l->law, brc_lanes_at(l->f->rim + i), b->m.du);
    brc_lanes slack = brc_lanes_at(l->f->slack + i), left = slack - b->moved;
    brc_mask rest = b->points & brc_lanes_less(brc_lanes_all(0), left);
    if (brc_lanes_any(b->points & brc_lanes_less(brc_lanes_all(0), slack)))
        brc_lanes_put(l->f->slack + i, brc_lanes_where(rest, left));
    if (!brc_lanes_any(rest))
        return rest;
    brc_mask pulls = rest & ~brc_lanes_equal(l->c->status + i, BRC_BROKEN);
    brc_lanes held[VGCM_N_HELD], middle[VGCM_N_MOTION], sum[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        b->sum[k] = brc_lanes_where(~rest, b->sum[k]);
    if (!brc_lanes_any(pulls))
        return rest;
    brc_lanes kn = brc_lanes_at(l->f->kn + i), ks = l->law->eta * kn;
    load_held(held, l->f->held + i);
    if (flags & VGCM_LEDGER) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            middle[k] = b->u[k] - 0.5 * b->m.du[k];
        vgcm_force_held(sum, kn, ks, held, middle);
        booked->affine += brc_lanes_where(pulls, vgcm_force_work(sum, b->m.du));
    }
    vgcm_force_held(sum, kn, ks, held, b->u);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        b->sum[k] = brc_lanes_pick(pulls, sum[k], b->sum[k]);
    return rest;
}

/* Points of a row: what they add to its sums, and how far each is from a change [m]. */
VGCM_INLINE brc_wide hold_points(const struct loop *l, int flags, size_t j,
                                 const brc_wide u[VGCM_N_MOTION], const brc_wide bond[VGCM_N_BOND],
                                 brc_wide_mask live, brc_wide part[VGCM_N_HELD])
{
    const struct vgcm_points *p = l->p;
    brc_wide s = brc_wide_at(p->s + j), t = brc_wide_at(p->t + j), at[3], none = brc_wide_all(0);
    brc_wide slip_s = brc_wide_at(p->slip_s + j), slip_t = brc_wide_at(p->slip_t + j);
    brc_wide dn = brc_wide_at(p->dn + j), damage = dn + brc_wide_at(p->ds + j);
    vgcm_motion_at(at, u, s, t);
    brc_wide_mask whole = vgcm_wide_whole(damage), open = brc_wide_less(none, at[0]);
    brc_wide strength = vgcm_wide_strength(l->law, flags, damage);
    brc_wide largest = flags & VGCM_BRITTLE ? brc_wide_all(1) : 1 + dn * bond[VGCM_WN_U0];
    brc_wide left = brc_wide_pick(open, strength / largest, brc_wide_all(1));
    brc_wide fs = slip_s - at[1], ft = slip_t - at[2];
    brc_wide limit = vgcm_wide_limit(l->law, bond[VGCM_E0], left * at[0], strength);
    brc_wide room =
        brc_wide_min(limit - brc_wide_sqrt(fs * fs + ft * ft), bond[VGCM_U0] * largest - at[0]);
    room = brc_wide_pick(whole, room, brc_wide_all(HUGE_VAL));
    brc_wide to_zero = brc_wide_max(at[0], -at[0]);
    room = brc_wide_pick(brc_wide_less(none, damage), brc_wide_min(room, to_zero), room);
    brc_wide area = brc_wide_where(brc_wide_both(whole, live), brc_wide_at(p->area + j));
    brc_wide normal = area * left, as = area * s, at_t = area * t;
    part[VGCM_A] = normal;
    part[VGCM_A_S] = normal * s;
    part[VGCM_A_T] = normal * t;
    part[VGCM_A_SS] = normal * s * s;
    part[VGCM_A_ST] = normal * s * t;
    part[VGCM_A_TT] = normal * t * t;
    part[VGCM_HELD_A] = area;
    part[VGCM_HELD_A_S] = as;
    part[VGCM_HELD_A_T] = at_t;
    part[VGCM_HELD_POLAR] = as * s + at_t * t;
    part[VGCM_HELD_SLIP_S] = area * slip_s;
    part[VGCM_HELD_SLIP_T] = area * slip_t;
    part[VGCM_HELD_SLIP_TWIST] = as * slip_t - at_t * slip_s;
    return brc_wide_pick(live, room, brc_wide_all(HUGE_VAL));
}

/* Gives a row of a block its slack, if that lasts, and its sums. */
static __attribute__((noinline)) void hold_row(const struct loop *l, int flags,
                                               const struct block *b, int lane)
{
    size_t i = b->i + (size_t)lane;
    brc_lanes sum[VGCM_N_HELD], room = brc_lanes_all(HUGE_VAL);
    brc_wide u[VGCM_N_MOTION], bond[VGCM_N_BOND], part[VGCM_N_HELD];
    spread(u, b->u, lane);
    for (int k = 0; k < VGCM_N_BOND; k++)
        bond[k] = brc_wide_all(b->bond[k][lane]);
    for (int k = 0; k < VGCM_N_HELD; k++)
        sum[k] = brc_lanes_all(0);
    for (int64_t n = 0; n < l->c->np[i]; n += BRC_WIDE) {
        brc_wide_mask live = brc_wide_first(l->c->np[i] - n);
        brc_wide near = hold_points(l, flags, (size_t)(l->c->p0[i] + n), u, bond, live, part);
        room = brc_wide_least(room, near);
        for (int k = 0; k < VGCM_N_HELD; k++)
            sum[k] = brc_wide_add(sum[k], part[k]);
    }
    room = brc_lanes_min(room, __builtin_shufflevector(room, room, 2, 3, 0, 1));
    room = brc_lanes_min(room, __builtin_shufflevector(room, room, 1, 0, 3, 2));
    if (!(room[0] > LEAST_STEPS * b->moved[lane]))
        return;
    l->f->slack[i] = room[0];
    for (int k = 0; k < VGCM_N_HELD; k++)
        l->f->held[i][k] = brc_lanes_sum(sum[k]);
}

/* The rows of points of a block that have not changed in this step. */
VGCM_INLINE void hold_rows(const struct loop *l, int flags, const struct block *b)
{
    for (int lane = 0; lane < BRC_LANES; lane++)
        if (b->points[lane] && !b->changes[lane])
            hold_row(l, flags, b, lane);
}

#endif
