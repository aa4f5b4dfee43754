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

struct vgcm_motion {
    double n[3], s[3], t[3];  /* frame at the end of the step */
    double d;                 /* m, distance of the centres */
    double h;                 /* m, reference point from a along n */
    double du[VGCM_N_MOTION]; /* increments of the generalised displacement */
};

/* s1 is s, given with the normal n0, turned with the least rotation from n0 to n1 (tilt) and by phi
 * about n1 (twirl). */
static inline void vgcm_frame_turn(double s1[3], const double s[3], const double n0[3],
                                   const double n1[3], double phi)
{
    double tilted[3], q[3], sum[3];
    brc_add(sum, n0, n1);
    brc_copy(tilted, s);
    brc_axpy(tilted, -brc_dot(n1, s) / (1 + brc_dot(n0, n1)), sum);
    brc_cross(q, n1, tilted);
    brc_scale(s1, tilted, 1 - phi * phi / 2);
    brc_axpy(s1, phi - phi * phi * phi / 6, q);
    brc_scale(s1, s1, 1.5 - 0.5 * brc_norm2(s1)); /* keeps the length 1 to round-off */
}

/* Frame and increments of contact i over the step that has just been made. */
static inline void vgcm_motion_of(const struct brc_bodies *bodies, const struct brc_contacts *c,
                                  size_t i, double dt, struct vgcm_motion *m)
{
    const struct vgcm_contacts *f = vgcm_columns(c);
    size_t a = (size_t)c->a[i], b = (size_t)c->b[i];
    double branch[3], v[3], w[3], spin[3], arm[3], nm[3], sm[3], tm[3];
    brc_sub(branch, bodies->x[b], bodies->x[a]);
    m->d = brc_norm(branch);
    brc_scale(m->n, branch, 1 / m->d); /* eq:vgcm:6 */
    m->h = 0.5 * m->d + f->plane[i];   /* eq:vgcm:7 eq:vgcm:8 */
    brc_add(nm, f->n[i], m->n);
    brc_scale(nm, nm, 0.5);
    const double *wa = bodies->w[a], *wb = bodies->w[b];
    brc_add(spin, wa, wb);
    vgcm_frame_turn(m->s, f->s[i], f->n[i], m->n, 0.5 * dt * brc_dot(spin, nm)); /* eq:vgcm:18 */
    brc_cross(m->t, m->n, m->s);
    brc_add(sm, f->s[i], m->s);
    brc_scale(sm, sm, 0.5);
    brc_cross(tm, nm, sm);
    brc_sub(v, bodies->v[b], bodies->v[a]);
    brc_scale(arm, wb, m->d - m->h);
    brc_axpy(arm, m->h, wa);
    brc_cross(arm, arm, nm);
    brc_sub(v, v, arm); /* eq:vgcm:11 at the reference point */
    brc_sub(w, wb, wa);
    m->du[VGCM_OPEN] = dt * brc_dot(v, nm); /* eq:vgcm:12 */
    m->du[VGCM_S] = dt * brc_dot(v, sm);    /* eq:vgcm:13 */
    m->du[VGCM_T] = dt * brc_dot(v, tm);
    m->du[VGCM_TWIST] = dt * brc_dot(w, nm);
    m->du[VGCM_BEND_S] = dt * brc_dot(w, sm);
    m->du[VGCM_BEND_T] = dt * brc_dot(w, tm);
}

/* Opening and slip at the place (s, t) of the affine field u. */
static inline void vgcm_motion_at(double at[3], const double u[VGCM_N_MOTION], double s, double t)
{
    at[0] = u[VGCM_OPEN] - u[VGCM_BEND_T] * s + u[VGCM_BEND_S] * t; /* eq:vgcm:9 eq:vgcm:11 */
    at[1] = u[VGCM_S] - u[VGCM_TWIST] * t;
    at[2] = u[VGCM_T] + u[VGCM_TWIST] * s;
}

/* Adds a point's normal force (tension positive) and shear force on b to the generalised force. */
static inline void vgcm_force_add(double sum[VGCM_N_MOTION], double fn, double fs, double ft,
                                  const double at[2])
{
    sum[VGCM_OPEN] += fn; /* eq:vgcm:20 */
    sum[VGCM_S] += fs;
    sum[VGCM_T] += ft;
    sum[VGCM_TWIST] += at[0] * ft - at[1] * fs; /* eq:vgcm:21 */
    sum[VGCM_BEND_S] += at[1] * fn;
    sum[VGCM_BEND_T] -= at[0] * fn;
}

/* Generalised force of elastic points that follow the affine field u. */
static inline void vgcm_force_affine(double sum[VGCM_N_MOTION], double kn, double ks,
                                     const double moment[VGCM_N_MOMENTS],
                                     const double u[VGCM_N_MOTION])
{
    double open = kn * u[VGCM_OPEN], bs = kn * u[VGCM_BEND_S], bt = kn * u[VGCM_BEND_T];
    double us = ks * u[VGCM_S], ut = ks * u[VGCM_T], twist = ks * u[VGCM_TWIST];
    const double *m = moment;
    sum[VGCM_OPEN] = m[VGCM_A] * open - m[VGCM_A_S] * bt + m[VGCM_A_T] * bs;
    sum[VGCM_BEND_S] = m[VGCM_A_T] * open - m[VGCM_A_ST] * bt + m[VGCM_A_TT] * bs;
    sum[VGCM_BEND_T] = -m[VGCM_A_S] * open + m[VGCM_A_SS] * bt - m[VGCM_A_ST] * bs;
    sum[VGCM_S] = m[VGCM_A_T] * twist - m[VGCM_A] * us;
    sum[VGCM_T] = -m[VGCM_A_S] * twist - m[VGCM_A] * ut;
    sum[VGCM_TWIST] = m[VGCM_A_T] * us - m[VGCM_A_S] * ut - (m[VGCM_A_SS] + m[VGCM_A_TT]) * twist;
}

/* Work that the motion u does against the generalised force: what the contact takes up. */
static inline double vgcm_force_work(const double f[VGCM_N_MOTION], const double u[VGCM_N_MOTION])
{
    return f[VGCM_OPEN] * u[VGCM_OPEN] + f[VGCM_BEND_S] * u[VGCM_BEND_S] +
           f[VGCM_BEND_T] * u[VGCM_BEND_T] - f[VGCM_S] * u[VGCM_S] - f[VGCM_T] * u[VGCM_T] -
           f[VGCM_TWIST] * u[VGCM_TWIST];
}

/* Force on b and moments about both centres, into row i. */
static inline void vgcm_force_apply(struct brc_contacts *c, size_t i, const struct vgcm_motion *m,
                                    const double sum[VGCM_N_MOTION])
{
    double h = m->h, g = m->d - m->h, twist = sum[VGCM_TWIST];
    double as = sum[VGCM_BEND_S] + h * sum[VGCM_T], at = sum[VGCM_BEND_T] - h * sum[VGCM_S];
    double bs = -sum[VGCM_BEND_S] + g * sum[VGCM_T], bt = -sum[VGCM_BEND_T] - g * sum[VGCM_S];
    for (int k = 0; k < 3; k++) {
        c->f[i][k] = -sum[VGCM_OPEN] * m->n[k] + sum[VGCM_S] * m->s[k] +
                     sum[VGCM_T] * m->t[k];                           /* eq:vgcm:19 */
        c->ta[i][k] = -twist * m->n[k] + as * m->s[k] + at * m->t[k]; /* eq:vgcm:24 */
        c->tb[i][k] = twist * m->n[k] + bs * m->s[k] + bt * m->t[k];  /* eq:vgcm:25 */
    }
}

#endif
