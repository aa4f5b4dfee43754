/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinematics and statics of one contact: its frame, the affine motion of its points, and the
 * forces and moments that a set of point forces makes on the two spheres.
 *
 * Increments are taken with the normal and the axes halfway through the step, so that a rigid
 * rotation opens nothing and the error of a finite rotation in N steps falls as 1/N^2; with the
 * geometry at the step's end it falls as 1/N only, and always to the same side. */
#ifndef VGCM_CONTACT_H
#define VGCM_CONTACT_H

#include "common/vec.h"
#include "vgcm/vgcm.h"

/* Four contacts side by side: each operation below is done for all at once. */
struct vgcm_motion {
    brc_lanes n[3], s[3], t[3];  /* frame at the end of the step */
    brc_lanes d;                 /* m, distance of the centres */
    brc_lanes h;                 /* m, reference point from a along n */
    brc_lanes du[VGCM_N_MOTION]; /* increments of the generalised displacement */
};

/* Point j of a row with the shear stiffness ks [N/m], where its row has no field of its own. */
static inline struct vgcm_point vgcm_point_at(const struct vgcm_points *p, size_t j, double un,
                                              double ks)
{
    return (struct vgcm_point){.un = un, .fs = ks * p->slip_s[j], .ft = ks * p->slip_t[j], .dn = 1};
}

static inline void vgcm_point_put(const struct vgcm_points *p, size_t j, double ks,
                                  const struct vgcm_point *q)
{
    double inv = ks > 0 ? 1 / ks : 0;
    p->slip_s[j] = inv * q->fs;
    p->slip_t[j] = inv * q->ft;
}

/* First of the four rows among which row i is treated. */
static inline size_t vgcm_block(size_t i)
{
    return i & ~(size_t)(BRC_LANES - 1);
}

/* s1 is s, given with the normal n0, turned with the least rotation from n0 to n1 (tilt) and by phi
 * about n1 (twirl). The length of s is kept at 1 to round-off. */
VGCM_INLINE void vgcm_frame_turn(brc_lanes s1[3], const brc_lanes s[3], const brc_lanes n0[3],
                                 const brc_lanes n1[3], brc_lanes phi)
{
    brc_lanes tilted[3], q[3], size = 1.5 - 0.5 * brc_lanes_dot(s, s);
    brc_lanes tilt = size * brc_lanes_dot(n1, s) / (1 + brc_lanes_dot(n0, n1));
    for (int k = 0; k < 3; k++)
        tilted[k] = size * s[k] - tilt * (n0[k] + n1[k]);
    brc_lanes_cross(q, n1, tilted);
    for (int k = 0; k < 3; k++)
        s1[k] = (1 - phi * phi / 2) * tilted[k] + (phi - phi * phi * phi / 6) * q[k];
}

/* Frames and increments of contacts i to i + 3 over the step that has just been made. */
VGCM_INLINE void vgcm_motion_of(const struct brc_bodies *bodies, const struct brc_contacts *c,
                                size_t i, double dt, struct vgcm_motion *m)
{
    const struct vgcm_contacts *f = vgcm_columns(c);
    const int32_t *a = c->a + i, *b = c->b + i;
    brc_lanes xa[3], xb[3], va[3], vb[3], wa[3], wb[3], n0[3], s0[3], v[3], nm[3], sm[3], tm[3];
    brc_lanes_gather3(xa, bodies->x, a);
    brc_lanes_gather3(xb, bodies->x, b);
    brc_lanes_gather3(va, bodies->v, a);
    brc_lanes_gather3(vb, bodies->v, b);
    brc_lanes_gather3(wa, bodies->w, a);
    brc_lanes_gather3(wb, bodies->w, b);
    brc_lanes_at3(n0, f->n + i);
    brc_lanes_at3(s0, f->s + i);
    for (int k = 0; k < 3; k++)
        xb[k] -= xa[k];
    brc_lanes half[3];
    m->d = brc_lanes_sqrt(brc_lanes_dot(xb, xb));
    m->h = 0.5 * m->d + brc_lanes_at(f->plane + i); /* eq:vgcm:7 eq:vgcm:8 */
    brc_lanes inv = 1 / m->d;
    for (int k = 0; k < 3; k++) {
        m->n[k] = xb[k] * inv; /* eq:vgcm:6 */
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
        v[k] = dt * (vb[k] - va[k] - half[k]); /* eq:vgcm:11 at the reference point */
    m->du[VGCM_OPEN] = brc_lanes_dot(v, nm);   /* eq:vgcm:12 */
    m->du[VGCM_S] = brc_lanes_dot(v, sm);      /* eq:vgcm:13 */
    m->du[VGCM_T] = brc_lanes_dot(v, tm);
    m->du[VGCM_TWIST] = brc_lanes_dot(wb, nm);
    m->du[VGCM_BEND_S] = brc_lanes_dot(wb, sm);
    m->du[VGCM_BEND_T] = brc_lanes_dot(wb, tm);
}

/* Opening and slips of the affine field u at the places (s, t). */
VGCM_INLINE void vgcm_motion_at(brc_wide at[3], const brc_wide u[VGCM_N_MOTION], brc_wide s,
                                brc_wide t)
{
    at[0] = u[VGCM_OPEN] - u[VGCM_BEND_T] * s + u[VGCM_BEND_S] * t; /* eq:vgcm:9 eq:vgcm:11 */
    at[1] = u[VGCM_S] - u[VGCM_TWIST] * t;
    at[2] = u[VGCM_T] + u[VGCM_TWIST] * s;
}

/* Adds the points' normal forces (tension positive) and shear forces on b, the parts of
 * eq:vgcm:10, to the generalised force. */
VGCM_INLINE void vgcm_force_add(brc_wide sum[VGCM_N_MOTION], brc_wide fn, brc_wide fs, brc_wide ft,
                                brc_wide s, brc_wide t)
{
    sum[VGCM_OPEN] += fn; /* eq:vgcm:20 */
    sum[VGCM_S] += fs;
    sum[VGCM_T] += ft;
    sum[VGCM_TWIST] += s * ft - t * fs; /* eq:vgcm:21 */
    sum[VGCM_BEND_S] += t * fn;
    sum[VGCM_BEND_T] -= s * fn;
}

/* Generalised force of elastic points that follow the affine field u. */
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

/* Generalised force of points at rest under the field u, from their sums. */
VGCM_INLINE void vgcm_force_held(brc_lanes sum[VGCM_N_MOTION], brc_lanes kn, brc_lanes ks,
                                 const brc_lanes held[VGCM_N_HELD],
                                 const brc_lanes u[VGCM_N_MOTION])
{
    brc_lanes open = kn * u[VGCM_OPEN], bs = kn * u[VGCM_BEND_S], bt = kn * u[VGCM_BEND_T];
    brc_lanes us = u[VGCM_S], ut = u[VGCM_T], twist = u[VGCM_TWIST];
    brc_lanes area = held[VGCM_HELD_A], as = held[VGCM_HELD_A_S], at = held[VGCM_HELD_A_T];
    sum[VGCM_OPEN] = held[VGCM_A] * open - held[VGCM_A_S] * bt + held[VGCM_A_T] * bs;
    sum[VGCM_BEND_S] = held[VGCM_A_T] * open - held[VGCM_A_ST] * bt + held[VGCM_A_TT] * bs;
    sum[VGCM_BEND_T] = held[VGCM_A_SS] * bt - held[VGCM_A_S] * open - held[VGCM_A_ST] * bs;
    sum[VGCM_S] = ks * (held[VGCM_HELD_SLIP_S] + at * twist - area * us);
    sum[VGCM_T] = ks * (held[VGCM_HELD_SLIP_T] - as * twist - area * ut);
    sum[VGCM_TWIST] =
        ks * (held[VGCM_HELD_SLIP_TWIST] + at * us - as * ut - held[VGCM_HELD_POLAR] * twist);
}

/* Work that the motion u does against the generalised force: what the contact takes up. */
VGCM_INLINE brc_lanes vgcm_force_work(const brc_lanes f[VGCM_N_MOTION],
                                      const brc_lanes u[VGCM_N_MOTION])
{
    return f[VGCM_OPEN] * u[VGCM_OPEN] + f[VGCM_BEND_S] * u[VGCM_BEND_S] +
           f[VGCM_BEND_T] * u[VGCM_BEND_T] - f[VGCM_S] * u[VGCM_S] - f[VGCM_T] * u[VGCM_T] -
           f[VGCM_TWIST] * u[VGCM_TWIST];
}

/* Forces on b and moments about both centres of the generalised forces. */
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

/* The same into rows i to i + 3. */
VGCM_INLINE void vgcm_force_apply(struct brc_contacts *c, size_t i, const struct vgcm_motion *m,
                                  const brc_lanes sum[VGCM_N_MOTION])
{
    brc_lanes f[3], ta[3], tb[3];
    vgcm_force_of(f, ta, tb, m, sum);
    brc_lanes_put3(c->f + i, f);
    brc_lanes_put3(c->ta + i, ta);
    brc_lanes_put3(c->tb + i, tb);
}

#endif
