/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts that have left the elastic range in the loop over contacts (forces_kernels.inc.h): the
 * law of their points. Four contacts side by side, one point of each at a time, and not four points
 * of one: facets have any number of points, seven in the mean, which would fill lanes badly, and
 * the sums over a contact's points would have to be made across lanes. May not know in which order
 * contacts come: a lane's result must not depend on its neighbours. */
#ifndef VGCM_DAMAGED_KERNELS_H
#define VGCM_DAMAGED_KERNELS_H

#include "vgcm/contact4_kernels.inc.h"

/* What the points of four contacts have in common, and their sums. */
struct vgcm_points4 {
    double *first[BRC_LANES]; /* the first points */
    int32_t np[BRC_LANES], most;
    brc_lanes bond[VGCM_N_BOND], viscosity; /* per area */
    brc_lanes force[VGCM_N_MOTION], viscous[VGCM_N_MOTION];
};

/* Viscous force of points, c: viscosity times area. A broken point that is open has none, and one
 * that is closed is never pulled by it (fn: its normal force). */
VGCM_INLINE void vgcm_points4_viscous(brc_lanes viscous[VGCM_N_MOTION], brc_lanes c,
                                      const brc_lanes du[3], brc_mask whole, brc_lanes un,
                                      brc_lanes fn, brc_lanes s, brc_lanes t)
{
    brc_lanes normal = c * du[0], none = brc_lanes_all(0);
    brc_mask closed = brc_lanes_less(un, none);
    normal = brc_lanes_pick(whole, normal, brc_lanes_where(closed, brc_lanes_min(normal, -fn)));
    brc_lanes fs = -c * du[1], ft = -c * du[2];
    vgcm_force_add(viscous, normal, brc_lanes_where(whole | closed, fs),
                   brc_lanes_where(whole | closed, ft), s, t);
}

/* Elastic stress of points whose damage begins: across the facet, and in shear. */
struct vgcm_onset {
    brc_lanes normal, s, t;
};

/* The elastic force of points whose damage begins: what their break will have set free, which is
 * not to be seen any more when they break, as softening has taken it all by then. Without the
 * friction of pressed points, which stays. In a column of its own and in axes of the contact: the
 * loop reads no byte of it, and a contact that turns as it softens takes it along. */
static __attribute__((noinline)) void vgcm_onset_put(const struct vgcm_loop *l,
                                                     double *const point[BRC_LANES],
                                                     const struct vgcm_onset *o, brc_mask begins)
{
    for (int k = 0; k < BRC_LANES; k++) {
        if (!begins[k])
            continue;
        size_t j = (size_t)(point[k] - l->p->law[0]) / VGCM_N_POINT;
        double area = point[k][VGCM_AREA], normal = o->normal[k];
        double shear = sqrt(o->s[k] * o->s[k] + o->t[k] * o->t[k]);
        double held = fmax(shear + l->law->mu * fmin(normal, 0), 0);
        double part = shear > 0 ? held / shear : 0;
        brc_set(l->p->onset[j], area * fmax(normal, 0), area * part * o->s[k],
                area * part * o->t[k]);
    }
}

/* Point j of contact i has just broken: rare, so that it may be slow, and out of the loop. The
 * status of the whole contact is looked up anew, as other points may have broken in the same step.
 * The mode is that of the larger part of the damage. */
static void vgcm_event_add(const struct vgcm_loop *l, size_t i, size_t j)
{
    const struct brc_contacts *c = l->c;
    const double *point = l->p->law[j], *onset = l->p->onset[j];
    double t[3], *xa = l->sim->bodies.x[c->a[i]];
    struct brc_event event = {.a = c->a[i],
                              .b = c->b[i],
                              .facet = c->facet[i],
                              .point = (int32_t)(j - (size_t)c->p0[i]),
                              .mode = point[VGCM_DN] >= point[VGCM_DS] ? BRC_MODE_TENSION
                                                                       : BRC_MODE_SHEAR,
                              .area = point[VGCM_AREA],
                              .energy = point[VGCM_DISSIPATED]};
    brc_sub(event.branch, l->sim->bodies.x[c->b[i]], xa);
    brc_cross(t, l->f->n[i], l->f->s[i]);
    brc_copy(event.n, l->f->n[i]);
    brc_copy(event.x, xa);
    brc_axpy(event.x, 0.5 * brc_norm(event.branch) + l->f->plane[i], l->f->n[i]);
    brc_axpy(event.x, point[VGCM_AT_S], l->f->s[i]);
    brc_axpy(event.x, point[VGCM_AT_T], t);
    brc_axpy(event.force, -onset[0], event.n); /* tension pulls b back */
    brc_axpy(event.force, onset[1], l->f->s[i]);
    brc_axpy(event.force, onset[2], t);
    brc_events_add(l->sim->ctx, &l->sim->events, l->sim->step, &event);
    bool is_whole = false;
    int flags = vgcm_law_flags(l->law);
    for (size_t k = (size_t)c->p0[i], end = k + (size_t)c->np[i]; k < end; k++)
        is_whole |= vgcm_law_is_whole(l->law, flags, l->p->law[k][VGCM_DN], l->p->law[k][VGCM_DS]);
    c->status[i] = is_whole ? BRC_INTACT : BRC_BROKEN;
}

static __attribute__((noinline)) void vgcm_events_add(const struct vgcm_loop *l,
                                                      const struct vgcm_contact4 *x, int32_t k,
                                                      const int32_t np[BRC_LANES], brc_mask broke)
{
    for (int lane = 0; lane < BRC_LANES; lane++)
        if (broke[lane] && k < np[lane])
            vgcm_event_add(l, (size_t)x->index.at[lane], (size_t)(l->c->p0[x->index.at[lane]] + k));
}

/* Opening and trial shear force of points, from their state and the field of their contact. The
 * slip of those that were broken and open is the whole displacement. */
VGCM_INLINE void vgcm_points4_begin(const struct vgcm_loop *l, int flags,
                                    const struct vgcm_contact4 *x, const brc_lanes place[4],
                                    const brc_lanes own[4], brc_lanes du[3],
                                    struct vgcm_point_lanes *w)
{
    enum { OWN = VGCM_SLIP_S };
    brc_lanes at[3];
    vgcm_motion_at(at, x->u, place[VGCM_AT_S], place[VGCM_AT_T]);
    vgcm_motion_at(du, x->m.du, place[VGCM_AT_S], place[VGCM_AT_T]);
    w->dn = own[VGCM_DN - OWN];
    w->ds = own[VGCM_DS - OWN];
    w->damage_old = w->dn + w->ds;
    w->un = at[0];
    w->un_old = at[0] - du[0];
    w->loose = brc_lanes_less(brc_lanes_all(0), w->un_old) &
               ~vgcm_lanes_whole(l->law, flags, w->dn, w->ds);
    w->slip_s = brc_lanes_pick(w->loose, at[1] - du[1], own[VGCM_SLIP_S - OWN]);
    w->slip_t = brc_lanes_pick(w->loose, at[2] - du[2], own[VGCM_SLIP_T - OWN]);
    w->s = w->slip_s - at[1]; /* eq:vgcm:16, eq:vgcm:18 */
    w->t = w->slip_t - at[2];
    w->s_old = w->s + du[1];
    w->t_old = w->t + du[2];
    w->force2 = w->s * w->s + w->t * w->t;
}

/* Writes what has changed of the points' states. Most points of a damaged contact do not change
 * in a step: a line that is not written need not go back to memory. */
VGCM_INLINE void vgcm_points4_write(const struct vgcm_loop *l, double *const point[BRC_LANES],
                                    const struct vgcm_points4 *q, const struct vgcm_point_lanes *w,
                                    brc_lanes area, brc_lanes dissipated)
{
    brc_lanes fs = w->shear_ratio * w->s, ft = w->shear_ratio * w->t;
    brc_mask grows = brc_lanes_less(w->damage_old, w->dn + w->ds);
    bool grow = brc_lanes_any(grows);
    if (!grow && !w->slides && !brc_lanes_any(w->loose))
        return;
    brc_lanes none = brc_lanes_all(0);
    brc_mask begins = grows & ~brc_lanes_less(none, w->damage_old) & brc_lanes_less(none, area);
    if (grow && brc_lanes_any(begins)) {
        /* by copies: what a call sees by its address cannot stay in registers before it */
        brc_lanes kn = 2 * q->bond[VGCM_HALF_KN], ks = 2 * q->bond[VGCM_HALF_KS];
        const struct vgcm_onset onset = {kn * w->un, ks * w->s, ks * w->t};
        vgcm_onset_put(l, point, &onset, begins);
    }
    brc_lanes own[] = {w->slip_s - (w->s - fs), w->slip_t - (w->t - ft), w->dn, w->ds};
    brc_lanes_transpose(own);
    for (int k = 0; k < BRC_LANES; k++)
        brc_lanes_put(point[k] + VGCM_SLIP_S, own[k]);
    for (int k = 0; grow && k < BRC_LANES; k++)
        point[k][VGCM_DISSIPATED] += brc_lanes_where(grows, dissipated)[k];
}

/* Points number k of four contacts. Lanes without such a point work on none, which has no area. An
 * empty point instead of a mask: it has no area, so that it adds nothing to any sum, and what is
 * written to it is thrown away. */
VGCM_INLINE void vgcm_points4_step(struct vgcm_loop *l, int flags, struct vgcm_contact4 *x,
                                   struct vgcm_points4 *q, int32_t k, double none[VGCM_N_POINT])
{
    double *at[BRC_LANES];
    const double *own_at[BRC_LANES];
    struct vgcm_point_lanes w;
    brc_lanes place[4], own[4], du[3];
    for (int lane = 0; lane < BRC_LANES; lane++) {
        at[lane] = k < q->np[lane] ? q->first[lane] + VGCM_N_POINT * k : none;
        own_at[lane] = at[lane] + VGCM_SLIP_S;
    }
    brc_lanes_gather4(place, (const double *const *)at);
    brc_lanes_gather4(own, own_at);
    brc_lanes s = place[VGCM_AT_S], t = place[VGCM_AT_T], area = place[VGCM_AREA];
    vgcm_points4_begin(l, flags, x, place, own, du, &w);
    vgcm_lanes_open(l->law, q->bond, flags, &w);
    vgcm_lanes_slide(l->law, q->bond, flags, &w);
    brc_lanes dissipated = vgcm_lanes_account(l->law, q->bond, flags, area, &w, &x->energy);
    brc_lanes fs = w.shear_ratio * w.s, ft = w.shear_ratio * w.t;
    vgcm_points4_write(l, at, q, &w, area, dissipated);
    vgcm_force_add(q->force, area * w.normal_force, area * fs, area * ft, s, t);
    brc_mask is = vgcm_lanes_whole(l->law, flags, w.dn, w.ds), broke = w.was_intact & ~is;
    if (brc_lanes_any(broke))
        vgcm_events_add(l, x, k, q->np, broke);
    if (flags & VGCM_VISCOUS)
        vgcm_points4_viscous(q->viscous, area * q->viscosity, du, is, w.un,
                             area * w.normal_force * (2 * q->bond[VGCM_HALF_KN]), s, t);
}

/* Generalised forces of four contacts from the sums over their points. One multiplication a
 * contact, as the forces of points have been counted per stiffness. */
VGCM_INLINE void vgcm_points4_sum(struct vgcm_loop *l, int flags, struct vgcm_contact4 *x,
                                  const struct vgcm_points4 *q)
{
    brc_lanes kn = 2 * q->bond[VGCM_HALF_KN], ks = 2 * q->bond[VGCM_HALF_KS];
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        bool is_normal = k == VGCM_OPEN || k == VGCM_BEND_S || k == VGCM_BEND_T;
        x->sum[k] = (is_normal ? kn : ks) * q->force[k];
    }
    if (flags & VGCM_VISCOUS)
        vgcm_contact4_viscous(l, x, q->viscous);
}

/* Contacts that are broken and surely open all over are loose from now on. By the same bound
 * that wakes them again, so that no contact goes to and fro without having closed. */
VGCM_INLINE void vgcm_contact4_loosen(const struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    brc_lanes range[2];
    vgcm_openings(range, x->u, vgcm_at(l->f->facet_radius, &x->index));
    brc_mask open = brc_lanes_less(brc_lanes_all(0), range[0]);
    for (int k = 0; brc_lanes_any(open) && k < BRC_LANES; k++)
        if (open[k] && l->c->status[x->index.at[k]] == BRC_BROKEN)
            l->f->phase[x->index.at[k]] = VGCM_LOOSE;
}

VGCM_INLINE void vgcm_points4_of(const struct vgcm_loop *l, int flags,
                                 const struct vgcm_contact4 *x, struct vgcm_points4 *q)
{
    vgcm_lanes_bond(q->bond, l->law, vgcm_at(l->f->kn, &x->index));
    if (flags & VGCM_VISCOUS)
        q->viscosity = vgcm_viscosity(l, &x->index);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        q->force[k] = q->viscous[k] = brc_lanes_all(0);
    q->most = 0;
    for (int lane = 0; lane < BRC_LANES; lane++) {
        int32_t contact = x->index.at[lane];
        q->np[lane] = x->live[lane] ? l->c->np[contact] : 0;
        q->most = q->np[lane] > q->most ? q->np[lane] : q->most;
        q->first[lane] = l->p->law[l->c->p0[contact]];
    }
}

/* Four contacts of points from end to end. */
VGCM_INLINE void vgcm_contact4_damaged(struct vgcm_loop *l, int flags, struct vgcm_contact4 *x)
{
    double none[VGCM_N_POINT] = {0};
    struct vgcm_points4 q;
    vgcm_contact4_move(l, x);
    vgcm_contact4_write(l, x);
    vgcm_points4_of(l, flags, x, &q);
    for (int32_t k = 0; k < q.most; k++)
        vgcm_points4_step(l, flags, x, &q, k, none);
    vgcm_points4_sum(l, flags, x, &q);
    vgcm_contact4_apply(l, x, flags & VGCM_LEDGER);
    vgcm_contact4_loosen(l, x);
}

#endif
