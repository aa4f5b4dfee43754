/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over contacts of grains with platens, compiled for each instruction set and called once
 * a step. These contacts are few, so the flags are looked at as it runs, and four points of one
 * contact are taken side by side, not one point of four contacts. May not know what a test does: a
 * platen is its surface, its bonding, its friction and its motion (common/engine/platens.h).
 *
 * The points of boundary facets ride on the grain: frame (n, s, t) of the contact turns with it and
 * a point is at h n + s s + t t from the centre. The contact's own frame is fixed by the platen:
 * normal out of the grain, against the platen's. All vectors of a contact are in that frame until
 * its forces are summed up; on a curved surface increments and forces of a point are along the
 * surface's own frame there. */
#ifndef VGCM_PLATENS_KERNELS_H
#define VGCM_PLATENS_KERNELS_H

#include "common/engine/platen_surface.h"
#include "vgcm/contact.h"

#include <string.h>

struct vgcm_platen_loop {
    struct brc_sim *sim;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    const struct brc_platen *platen;
    struct brc_platen local; /* the same in the contact's frame, with its body at 0 */
    bool is_curved;
    struct vgcm_law law;      /* with the platen's friction */
    enum brc_bonding bonding; /* of the contact: grains that come near later are not held */
    struct vgcm_bond bond;
    double frame[3][3];  /* in space: normal from grain to platen, two axes of its plane */
    double riding[3][3]; /* frame that rides on the grain */
    double centre[3];    /* m, of the grain over the platen's place */
    double move[3];      /* m, of the platen against the grain's centre in this step */
    double turn[3];      /* rad, of the grain in this step */
    double viscosity;    /* viscous force over area and increment */
    double viscous;      /* J */
    struct vgcm_energy_lanes energy;
    brc_lanes force[6];         /* on the platen, moment about the grain */
    brc_lanes viscous_force[6]; /* the viscous part of it */
    brc_lanes gap;              /* m, smallest opening */
};

/* Four points of a contact. */
struct vgcm_platen_points {
    brc_mask live; /* lanes that are points; the others are room, without an area */
    brc_lanes area, r[3], du[3];
    brc_lanes n[3]; /* normal of the surface at the points, into the specimen */
    struct vgcm_friction_lanes q;
};

/* The frame that rides is normalised in each step: products of many turns would drift from length
 * 1. */
static void vgcm_platen_frames(struct vgcm_platen_loop *w, size_t i)
{
    const struct brc_bodies *b = &w->sim->bodies;
    size_t a = (size_t)w->c->a[i];
    double dt = w->sim->dt, q[4], m[3][3], turned[2][3], turn[3], move[3], across[3], over[3];
    brc_scale(w->frame[0], w->platen->n, -1);
    brc_copy(w->frame[1], w->platen->across);
    brc_cross(w->frame[2], w->frame[0], w->frame[1]);
    brc_scale(turn, b->w[a], dt);
    if (brc_norm2(turn) > 0) {
        brc_quat_from_rotation(q, turn);
        brc_quat_matrix(m, q);
        brc_mat_mul(turned[0], m, w->f->n[i]);
        brc_mat_mul(turned[1], m, w->f->s[i]);
        brc_normalise(w->f->n[i], turned[0]);
        brc_normalise(w->f->s[i], turned[1]);
    }
    brc_cross(across, w->f->n[i], w->f->s[i]);
    brc_sub(move, b->v[w->c->b[i]], b->v[a]);
    brc_scale(move, move, dt);
    brc_mat_mul(w->turn, w->frame, turn);
    brc_mat_mul(w->move, w->frame, move);
    brc_sub(over, b->x[a], b->x[w->c->b[i]]);
    brc_mat_mul(w->centre, w->frame, over);
    brc_mat_mul(w->riding[0], w->frame, w->f->n[i]);
    brc_mat_mul(w->riding[1], w->frame, w->f->s[i]);
    brc_mat_mul(w->riding[2], w->frame, across);
}

/* A vector from the contact's frame to the frame of a curved surface at each point, or back. All
 * surfaces are straight along the frame's third axis, so that one turn about it does. */
VGCM_INLINE void vgcm_platen_turn(const brc_lanes n[3], double sense, brc_lanes v[3])
{
    brc_lanes cosine = -n[0], sine = -sense * n[1], first = cosine * v[0] + sine * v[1];
    v[1] = cosine * v[1] - sine * v[0];
    v[0] = first;
}

/* Motion of the platen against the grain's points: opening, slips. Where the surface is curved they
 * are along its frame halfway, as for pairs: with the frame at the end of the step a point that
 * slides would open by half the square of its way over the radius, always to the same side.
 * from: what the height is measured of. */
VGCM_INLINE void vgcm_platen_motion(const struct vgcm_platen_loop *w, const brc_lanes from[3],
                                    bool is_sphere, struct vgcm_platen_points *x)
{
    static const double origin[3];
    brc_lanes turn[3], swing[3], middle[3], h, n[3];
    for (int k = 0; k < 3; k++)
        turn[k] = brc_lanes_all(w->turn[k]);
    brc_lanes_cross(swing, turn, x->r);
    for (int k = 0; k < 3; k++)
        middle[k] = x->r[k] - 0.5 * swing[k]; /* the arm halfway through the step */
    brc_lanes_cross(swing, turn, middle);
    for (int k = 0; k < 3; k++)
        x->du[k] = w->move[k] - swing[k];
    if (!w->is_curved)
        return;
    for (int k = 0; k < 3; k++)
        middle[k] = from[k] + 0.5 * (is_sphere ? brc_lanes_all(w->move[k]) : x->du[k]);
    brc_platen_heights(&w->local, origin, middle, &h, n);
    vgcm_platen_turn(n, 1, x->du);
}

/* Four points of contact i from point j on. The height is total, as the surface has it, so that an
 * opening cannot drift from where the platen is. */
VGCM_INLINE void vgcm_platen_read(const struct vgcm_platen_loop *w, size_t i, size_t j,
                                  struct vgcm_platen_points *x)
{
    static const double origin[3];
    const struct vgcm_points *p = w->p;
    const double *place[BRC_LANES], *slip[BRC_LANES];
    bool is_sphere = w->f->phase[i] == VGCM_SPHERE;
    brc_lanes at[4], own[4], from[3], h = brc_lanes_at(p->h + j);
    for (size_t k = 0; k < BRC_LANES; k++) {
        place[k] = p->law[j + k];
        slip[k] = p->law[j + k] + VGCM_SLIP_S;
    }
    brc_lanes_gather4(at, place);
    brc_lanes_gather4(own, slip);
    x->live = brc_lanes_first((int64_t)((size_t)(w->c->p0[i] + w->c->np[i]) - j));
    x->area = at[VGCM_AREA];
    for (int k = 0; k < 3; k++) {
        x->r[k] =
            w->riding[0][k] * h + w->riding[1][k] * at[VGCM_AT_S] + w->riding[2][k] * at[VGCM_AT_T];
        from[k] = is_sphere ? brc_lanes_all(w->centre[k]) : w->centre[k] + x->r[k];
    }
    /* beyond a sharp edge, too: its width counts at the start alone (make_contacts.c) */
    brc_platen_heights(&w->local, origin, from, &x->q.un, x->n);
    x->q.un += 0; /* never -0, which would be other bits in a saved state */
    for (int k = 0; is_sphere && k < 3; k++)
        x->r[k] = -x->q.un * x->n[k];
    if (is_sphere)
        x->q.un -= w->f->contact_distance[i];
    x->q.s = own[0];
    x->q.t = own[1];
    vgcm_platen_motion(w, from, is_sphere, x);
}

/* Points held along the normal or fully: springs both ways that never break, without friction. In
 * total displacements along the normal, so that nothing drifts however long a test is. */
VGCM_INLINE void vgcm_platen_hold(const struct vgcm_platen_loop *w, struct vgcm_platen_points *x,
                                  struct vgcm_energy_lanes *e)
{
    struct vgcm_friction_lanes *q = &x->q;
    brc_lanes s_old = q->s, t_old = q->t, half = 0.5 * w->bond.kn * x->area;
    q->normal_force = q->un; /* eq:vgcm:17 */
    e->normal += half * ((q->un - x->du[0] + q->un) * x->du[0]);
    if (w->bonding == BRC_BONDING_GRIP)
        return;
    q->s -= x->du[1]; /* eq:vgcm:16, eq:vgcm:18 */
    q->t -= x->du[2];
    half = 0.5 * w->bond.ks * x->area;
    e->shear -= half * ((s_old + q->s) * x->du[1] + (t_old + q->t) * x->du[2]);
}

/* Viscous forces per area on the platen: a plain contact is never pulled by them, and what only
 * friction holds feels them while it is closed. */
VGCM_INLINE void vgcm_platen_viscous(const struct vgcm_platen_loop *w,
                                     const struct vgcm_platen_points *x, brc_lanes viscous[3])
{
    bool is_plain = w->bonding == BRC_BONDING_NONE;
    brc_mask closed = brc_lanes_less(x->q.un, brc_lanes_all(0));
    for (int k = 0; k < 3; k++)
        viscous[k] = -w->viscosity * x->du[k];
    if (is_plain)
        viscous[0] = brc_lanes_max(viscous[0], w->bond.kn * x->q.normal_force);
    if (w->bonding == BRC_BONDING_GRIP)
        viscous[1] = viscous[2] = brc_lanes_all(0);
    for (int k = is_plain ? 0 : 1; k < 3 && w->bonding != BRC_BONDING_FULL; k++)
        viscous[k] = brc_lanes_where(closed, viscous[k]);
}

/* Adds forces per area, along the surface's own frame, to a sum of forces and moments about the
 * grain. About the grain's centre; the moment about the platen's follows for all points together
 * (vgcm_platen_finish). */
VGCM_INLINE void vgcm_platen_add(const struct vgcm_platen_loop *w, brc_lanes sum[6],
                                 const struct vgcm_platen_points *x, const brc_lanes per_area[3])
{
    brc_lanes force[3], moment[3];
    for (int k = 0; k < 3; k++)
        force[k] = x->area * per_area[k];
    if (w->is_curved)
        vgcm_platen_turn(x->n, -1, force);
    brc_lanes_cross(moment, x->r, force);
    for (int k = 0; k < 3; k++) {
        sum[k] += force[k];
        sum[3 + k] += moment[k];
    }
}

/* Four points of contact i from point j on. */
VGCM_INLINE void vgcm_platen_points_step(struct vgcm_platen_loop *w, size_t i, size_t j, int flags)
{
    struct vgcm_platen_points x;
    struct vgcm_friction_lanes *q = &x.q;
    vgcm_platen_read(w, i, j, &x);
    if (w->bonding == BRC_BONDING_GRIP || w->bonding == BRC_BONDING_FULL)
        vgcm_platen_hold(w, &x, &w->energy);
    else
        vgcm_lanes_friction(&w->bond, w->bonding == BRC_BONDING_NORMAL, x.area, x.du, q,
                            &w->energy);
    brc_lanes_put(w->p->un + j, q->un);
    for (size_t k = 0; k < BRC_LANES; k++) {
        w->p->law[j + k][VGCM_SLIP_S] = q->s[k];
        w->p->law[j + k][VGCM_SLIP_T] = q->t[k];
    }
    brc_lanes per_area[3] = {-w->bond.kn * q->normal_force, w->bond.ks * q->s, w->bond.ks * q->t};
    vgcm_platen_add(w, w->force, &x, per_area); /* eq:vgcm:19 */
    if (flags & VGCM_VISCOUS) {
        vgcm_platen_viscous(w, &x, per_area);
        vgcm_platen_add(w, w->viscous_force, &x, per_area);
    }
    w->gap = brc_lanes_min(brc_lanes_pick(x.live, q->un, w->gap), w->gap);
}

/* Dissipation of the viscous forces, by the mean of those before and after the step. Over all
 * points at once: the increments of a rigid grain are those of six numbers, and so is the work. */
static void vgcm_platen_account(struct vgcm_platen_loop *w, size_t i, double force[6])
{
    double *old = w->f->viscous_force[i], viscous[6];
    for (int k = 0; k < 6; k++) {
        viscous[k] = brc_lanes_sum(w->viscous_force[k]);
        force[k] += viscous[k];
    }
    for (int k = 0; k < 3; k++)
        w->viscous += 0.5 * (old[3 + k] + viscous[3 + k]) * w->turn[k] -
                      0.5 * (old[k] + viscous[k]) * w->move[k];
    memcpy(old, viscous, sizeof viscous);
}

static void vgcm_platen_begin(struct vgcm_platen_loop *w, size_t i)
{
    struct brc_contacts *c = w->c;
    const struct brc_sim *sim = w->sim;
    w->platen = brc_sim_platen(sim, c->b[i]);
    w->law.mu = w->platen->friction;
    w->bonding = vgcm_platen_bonding(c, i, w->platen);
    w->is_curved = vgcm_platen_is_curved(w->platen);
    w->local = *w->platen;
    brc_set(w->local.n, -1, -0.0, -0.0); /* -0: forces on a plane have the signs of plain sums */
    brc_set(w->local.across, 0, 1, 0);
    w->bond = vgcm_springs_of(&w->law, w->f->kn[i]);
    w->gap = brc_lanes_all(HUGE_VAL);
    w->viscosity = sim->dt > 0 ? w->law.viscous * sim->bodies.true_mass[c->a[i]] /
                                     (w->f->moment[i][VGCM_A] * sim->dt)
                               : 0;
    for (int k = 0; k < 6; k++)
        w->force[k] = w->viscous_force[k] = brc_lanes_all(0);
    w->energy = (struct vgcm_energy_lanes){.bond = brc_lanes_all(0)};
    w->viscous = 0;
    vgcm_platen_frames(w, i);
}

/* Force on the platen and moments about both centres, in space. */
static void vgcm_platen_finish(struct vgcm_platen_loop *w, size_t i, const double force[6])
{
    const struct brc_bodies *b = &w->sim->bodies;
    struct brc_contacts *c = w->c;
    double moment[3], arm[3];
    brc_mat_mul_t(c->f[i], w->frame, force);
    brc_mat_mul_t(moment, w->frame, force + 3);
    brc_scale(c->ta[i], moment, -1);
    brc_sub(arm, b->x[c->a[i]], b->x[c->b[i]]);
    brc_cross(c->tb[i], arm, c->f[i]);
    brc_add(c->tb[i], c->tb[i], moment);
    c->gap[i] = fmin(fmin(w->gap[0], w->gap[1]), fmin(w->gap[2], w->gap[3]));
}

/* Contacts of a grain come in the order of its platens, after those with other grains. */
static void vgcm_platen_book(const struct vgcm_platen_loop *w, size_t i)
{
    double *e = w->sim->bodies.energy[w->c->a[i]];
    e[BRC_ACCOUNT_NORMAL] += brc_lanes_sum(w->energy.normal);
    e[BRC_ACCOUNT_SHEAR] += brc_lanes_sum(w->energy.shear);
    e[BRC_ACCOUNT_FRICTION] += brc_lanes_sum(w->energy.friction);
    e[BRC_ACCOUNT_VISCOUS] += w->viscous;
}

static void vgcm_platen_step(struct vgcm_platen_loop *w, size_t i, int flags)
{
    double force[6];
    vgcm_platen_begin(w, i);
    for (size_t j = (size_t)w->c->p0[i], end = j + (size_t)w->c->np[i]; j < end; j += BRC_LANES)
        vgcm_platen_points_step(w, i, j, flags);
    for (int k = 0; k < 6; k++)
        force[k] = brc_lanes_sum(w->force[k]);
    if (flags & VGCM_VISCOUS)
        vgcm_platen_account(w, i, force);
    vgcm_platen_finish(w, i, force);
    if (flags & VGCM_LEDGER)
        vgcm_platen_book(w, i);
}

static void vgcm_platens_loop(struct brc_sim *sim, const struct vgcm_law *law, int flags)
{
    struct vgcm_platen_loop w = {.sim = sim,
                                 .c = &sim->platens,
                                 .f = vgcm_columns(&sim->platens),
                                 .p = vgcm_point_columns(&sim->platens),
                                 .law = *law};
    for (size_t i = 0; i < w.c->n; i++)
        vgcm_platen_step(&w, i, flags);
}

#endif
