/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinematics and statics of one contact: its frame, the affine motion of its points, and the
 * forces and moments that a set of point forces makes on the two spheres. For the loops and
 * energy.c: no law, no phases, no queues here.
 *
 * Increments are taken with the normal and the axes halfway through the step, so that a rigid
 * rotation opens nothing and the error of a finite rotation in N steps falls as 1/N^2; with the
 * geometry at the step's end it falls as 1/N only, and always to the same side. */
#ifndef VGCM_CONTACT_H
#define VGCM_CONTACT_H

#include "common/geometry/vec.h"
#include "vgcm/vgcm.h"

/* Four contacts that are treated side by side, each operation below for all at once. Where there
 * are fewer the last one is repeated. */
struct vgcm_index4 {
    int32_t at[BRC_LANES];
    bool is_consecutive; /* they follow each other */
};

struct vgcm_motion {
    brc_lanes n[3], s[3], t[3];  /* frame at the end of the step */
    brc_lanes d;                 /* m, distance of the centres */
    brc_lanes h;                 /* m, reference point from a along n */
    brc_lanes du[VGCM_N_MOTION]; /* increments of the generalised displacement */
};

/* Columns of four contacts to and from lanes. A load of four neighbours where they follow each
 * other, as most elastic contacts do; else each from its own place. */
VGCM_INLINE brc_lanes vgcm_at(const double *x, const struct vgcm_index4 *r)
{
    const int32_t *i = r->at;
    return r->is_consecutive ? brc_lanes_at(x + i[0])
                             : (brc_lanes){x[i[0]], x[i[1]], x[i[2]], x[i[3]]};
}

VGCM_INLINE void vgcm_put(double *x, const struct vgcm_index4 *r, brc_lanes a)
{
    if (r->is_consecutive)
        brc_lanes_put(x + r->at[0], a);
    else
        for (int k = BRC_LANES - 1; k >= 0; k--) /* the first of equal contacts is what stays */
            x[r->at[k]] = a[k];
}

VGCM_INLINE void vgcm_at3(brc_lanes a[3], double (*x)[3], const struct vgcm_index4 *r)
{
    if (r->is_consecutive)
        brc_lanes_at3(a, x + r->at[0]);
    else
        brc_lanes_gather3(a, x, r->at);
}

VGCM_INLINE void vgcm_put3(double (*x)[3], const struct vgcm_index4 *r, const brc_lanes a[3])
{
    if (r->is_consecutive)
        brc_lanes_put3(x + r->at[0], a);
    else
        brc_lanes_scatter3(x, r->at, a);
}

/* Point j of a contact with the shear stiffness ks [N/m], where its contact has no field of its
 * own. */
static inline struct vgcm_point vgcm_point_at(const struct vgcm_points *p, size_t j, double un,
                                              double ks)
{
    return (struct vgcm_point){
        .un = un, .fs = ks * p->law[j][VGCM_SLIP_S], .ft = ks * p->law[j][VGCM_SLIP_T], .dn = 1};
}

static inline void vgcm_point_put(const struct vgcm_points *p, size_t j, double per_ks,
                                  const struct vgcm_point *q)
{
    p->law[j][VGCM_SLIP_S] = per_ks * q->fs;
    p->law[j][VGCM_SLIP_T] = per_ks * q->ft;
}

/* s1 is s, given with the normal n0, turned with the least rotation from n0 to n1 (tilt) and by phi
 * about n1 (twirl). The length of s is kept at 1 to round-off. */
VGCM_INLINE void vgcm_frame_turn(brc_lanes s1[3], const brc_lanes s[3], const brc_lanes n0[3],
                                 const brc_lanes n1[3], brc_lanes phi)
{
    /* one Newton step for 1/|s|: the length is 1 to rounding, so a root would buy nothing. Sine and
     * cosine of phi to third order, as a step turns by little */
    brc_lanes tilted[3], q[3], size = 1.5 - 0.5 * brc_lanes_dot(s, s);
    brc_lanes tilt = size * brc_lanes_dot(n1, s) / (1 + brc_lanes_dot(n0, n1));
    for (int k = 0; k < 3; k++)
        tilted[k] = size * s[k] - tilt * (n0[k] + n1[k]);
    brc_lanes_cross(q, n1, tilted);
    for (int k = 0; k < 3; k++)
        s1[k] = (1 - phi * phi / 2) * tilted[k] + (phi - phi * phi * phi * (1.0 / 6)) * q[k];
}

/* Frames and increments of four contacts over the step that has just been made. Positions are those
 * at the end of the step and velocities those by which they came there, so that all of it is known
 * without the positions before. */
VGCM_INLINE void vgcm_motion_of(const struct brc_bodies *bodies, const struct brc_contacts *c,
                                const struct vgcm_index4 *index, double dt, struct vgcm_motion *m)
{
    const struct vgcm_contacts *f = vgcm_columns(c);
    const int32_t *i = index->at, a[] = {c->a[i[0]], c->a[i[1]], c->a[i[2]], c->a[i[3]]};
    const int32_t b[] = {c->b[i[0]], c->b[i[1]], c->b[i[2]], c->b[i[3]]};
    brc_lanes x[3], v[3], wa[3], wb[3], n0[3], s0[3], nm[3], sm[3], tm[3], half[3];
    brc_lanes_between3(x, bodies->x, a, b);
    brc_lanes_between3(v, bodies->v, a, b);
    brc_lanes_gather3(wa, bodies->w, a);
    brc_lanes_gather3(wb, bodies->w, b);
    vgcm_at3(n0, f->n, index);
    vgcm_at3(s0, f->s, index);
    m->d = brc_lanes_sqrt(brc_lanes_dot(x, x));
    m->h = 0.5 * m->d + vgcm_at(f->plane, index); /* eq:vgcm:7 eq:vgcm:8 */
    brc_lanes inv = 1 / m->d;
    for (int k = 0; k < 3; k++) {
        m->n[k] = x[k] * inv; /* eq:vgcm:6 */
        nm[k] = 0.5 * (n0[k] + m->n[k]);
        half[k] = 0.5 * dt * (wa[k] + wb[k]);
    }
    vgcm_frame_turn(m->s, s0, n0, m->n, brc_lanes_dot(half, nm)); /* eq:vgcm:18 */
    brc_lanes_cross(m->t, m->n, m->s);
    for (int k = 0; k < 3; k++) {
        sm[k] = 0.5 * (s0[k] + m->s[k]);
        half[k] = m->h * wa[k] + (m->d - m->h) * wb[k];
        wb[k] = dt * (wb[k] - wa[k]);
    }
    brc_lanes_cross(tm, nm, sm);
    brc_lanes_cross(half, half, nm);
    for (int k = 0; k < 3; k++)
        v[k] = dt * (v[k] - half[k]);        /* eq:vgcm:11 at the reference point */
    m->du[VGCM_OPEN] = brc_lanes_dot(v, nm); /* eq:vgcm:12 */
    m->du[VGCM_S] = brc_lanes_dot(v, sm);    /* eq:vgcm:13 */
    m->du[VGCM_T] = brc_lanes_dot(v, tm);
    m->du[VGCM_TWIST] = brc_lanes_dot(wb, nm);
    m->du[VGCM_BEND_S] = brc_lanes_dot(wb, sm);
    m->du[VGCM_BEND_T] = brc_lanes_dot(wb, tm);
}

/* Opening and slips of the affine field u at the places (s, t). Six numbers are enough: a
 * rigid plane over another moves by an opening, two slips and three small turns, and every
 * point's displacement is affine in its place in the plane. The sum over steps of affine fields
 * is one. */
VGCM_INLINE void vgcm_motion_at(brc_lanes at[3], const brc_lanes u[VGCM_N_MOTION], brc_lanes s,
                                brc_lanes t)
{
    at[0] = u[VGCM_OPEN] - u[VGCM_BEND_T] * s + u[VGCM_BEND_S] * t; /* eq:vgcm:9 eq:vgcm:11 */
    at[1] = u[VGCM_S] - u[VGCM_TWIST] * t;
    at[2] = u[VGCM_T] + u[VGCM_TWIST] * s;
}

/* Adds the points' normal forces (tension positive) and shear forces on b, the parts of
 * eq:vgcm:10, to the generalised force. */
VGCM_INLINE void vgcm_force_add(brc_lanes sum[VGCM_N_MOTION], brc_lanes fn, brc_lanes fs,
                                brc_lanes ft, brc_lanes s, brc_lanes t)
{
    sum[VGCM_OPEN] += fn; /* eq:vgcm:20 */
    sum[VGCM_S] += fs;
    sum[VGCM_T] += ft;
    sum[VGCM_TWIST] += s * ft - t * fs; /* eq:vgcm:21 */
    sum[VGCM_BEND_S] += t * fn;
    sum[VGCM_BEND_T] -= s * fn;
}

/* Generalised force of elastic points that follow the affine field u. The sums over points that
 * vgcm_force_add makes one by one, with the sums over places taken out: about 30 operations a
 * contact instead of 12 a point. */
VGCM_INLINE void vgcm_force_affine(brc_lanes sum[VGCM_N_MOTION], brc_lanes kn, brc_lanes ks,
                                   const brc_lanes m[VGCM_N_MOMENTS],
                                   const brc_lanes u[VGCM_N_MOTION])
{
    brc_lanes open = kn * u[VGCM_OPEN], bs = kn * u[VGCM_BEND_S], bt = kn * u[VGCM_BEND_T];
    brc_lanes us = ks * u[VGCM_S], ut = ks * u[VGCM_T], twist = ks * u[VGCM_TWIST];
    sum[VGCM_OPEN] = m[VGCM_A] * open - m[VGCM_A_S] * bt + m[VGCM_A_T] * bs;
    sum[VGCM_BEND_S] = m[VGCM_A_T] * open - m[VGCM_A_ST] * bt + m[VGCM_A_TT] * bs;
    sum[VGCM_BEND_T] = m[VGCM_A_SS] * bt - m[VGCM_A_S] * open - m[VGCM_A_ST] * bs;
    sum[VGCM_S] = m[VGCM_A_T] * twist - m[VGCM_A] * us;
    sum[VGCM_T] = -m[VGCM_A_S] * twist - m[VGCM_A] * ut;
    sum[VGCM_TWIST] = m[VGCM_A_T] * us - m[VGCM_A_S] * ut - (m[VGCM_A_SS] + m[VGCM_A_TT]) * twist;
}

/* Work that the motion u does against the generalised force: what the contact takes up. */
VGCM_INLINE brc_lanes vgcm_force_work(const brc_lanes f[VGCM_N_MOTION],
                                      const brc_lanes u[VGCM_N_MOTION])
{
    return f[VGCM_OPEN] * u[VGCM_OPEN] + f[VGCM_BEND_S] * u[VGCM_BEND_S] +
           f[VGCM_BEND_T] * u[VGCM_BEND_T] - f[VGCM_S] * u[VGCM_S] - f[VGCM_T] * u[VGCM_T] -
           f[VGCM_TWIST] * u[VGCM_TWIST];
}

/* Twice the energy of affine points with the field u. */
VGCM_INLINE brc_lanes vgcm_energy_affine(brc_lanes kn, brc_lanes ks,
                                         const brc_lanes m[VGCM_N_MOMENTS],
                                         const brc_lanes u[VGCM_N_MOTION])
{
    brc_lanes open = u[VGCM_OPEN], bs = u[VGCM_BEND_S], bt = u[VGCM_BEND_T];
    brc_lanes us = u[VGCM_S], ut = u[VGCM_T], twist = u[VGCM_TWIST];
    brc_lanes normal = open * (m[VGCM_A] * open + 2 * (m[VGCM_A_T] * bs - m[VGCM_A_S] * bt)) +
                       bt * (m[VGCM_A_SS] * bt - 2 * m[VGCM_A_ST] * bs) + m[VGCM_A_TT] * (bs * bs);
    brc_lanes polar = m[VGCM_A_SS] + m[VGCM_A_TT];
    brc_lanes shear = twist * (polar * twist + 2 * (m[VGCM_A_S] * ut - m[VGCM_A_T] * us)) +
                      m[VGCM_A] * (us * us + ut * ut);
    return kn * normal + ks * shear;
}

/* Forces on b and moments about both centres of the generalised forces. Moments of a contact about
 * the two centres by its lever h on a and d - h on b; those of bending are handed on as they
 * are. */
VGCM_INLINE void vgcm_force_of(brc_lanes f[3], brc_lanes ta[3], brc_lanes tb[3],
                               const struct vgcm_motion *m, const brc_lanes sum[VGCM_N_MOTION])
{
    brc_lanes h = m->h, g = m->d - m->h, twist = sum[VGCM_TWIST];
    brc_lanes as = sum[VGCM_BEND_S] + h * sum[VGCM_T], at = sum[VGCM_BEND_T] - h * sum[VGCM_S];
    brc_lanes bs = g * sum[VGCM_T] - sum[VGCM_BEND_S], bt = -g * sum[VGCM_S] - sum[VGCM_BEND_T];
    for (int k = 0; k < 3; k++) { /* on b; a gets the opposite: eq:vgcm:22 eq:vgcm:23 */
        f[k] = sum[VGCM_S] * m->s[k] + sum[VGCM_T] * m->t[k] -
               sum[VGCM_OPEN] * m->n[k];                       /* eq:vgcm:19 */
        ta[k] = as * m->s[k] + at * m->t[k] - twist * m->n[k]; /* eq:vgcm:24 */
        tb[k] = bs * m->s[k] + bt * m->t[k] + twist * m->n[k]; /* eq:vgcm:25 */
    }
}

#endif
