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

/* Two contacts side by side: each operation below is done for both at once. */
typedef double vgcm_two __attribute__((vector_size(16)));

struct vgcm_motion {
    double n[3], s[3], t[3];  /* frame at the end of the step */
    double d;                 /* m, distance of the centres */
    double h;                 /* m, reference point from a along n */
    double du[VGCM_N_MOTION]; /* increments of the generalised displacement */
};

struct vgcm_motion_two {
    vgcm_two n[3], s[3], t[3], d, h, du[VGCM_N_MOTION];
};

VGCM_INLINE vgcm_two vgcm_two_of(double x, double y)
{
    return (vgcm_two){x, y};
}

VGCM_INLINE vgcm_two vgcm_two_dot(const vgcm_two a[3], const vgcm_two b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

VGCM_INLINE void vgcm_two_cross(vgcm_two r[3], const vgcm_two a[3], const vgcm_two b[3])
{
    vgcm_two x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    r[2] = a[0] * b[1] - a[1] * b[0];
    r[0] = x;
    r[1] = y;
}

/* Rows i and j of an array of 3-vectors. */
VGCM_INLINE void vgcm_two_load(vgcm_two r[3], double (*x)[3], size_t i, size_t j)
{
    for (int k = 0; k < 3; k++)
        r[k] = vgcm_two_of(x[i][k], x[j][k]);
}

VGCM_INLINE void vgcm_two_load6(vgcm_two r[6], double (*x)[6], size_t i, size_t j)
{
    for (int k = 0; k < 6; k++)
        r[k] = vgcm_two_of(x[i][k], x[j][k]);
}

VGCM_INLINE vgcm_two vgcm_two_abs(vgcm_two x)
{
    return vgcm_two_of(fabs(x[0]), fabs(x[1]));
}

/* s1 is s, given with the normal n0, turned with the least rotation from n0 to n1 (tilt) and by phi
 * about n1 (twirl). The length of s is kept at 1 to round-off. */
VGCM_INLINE void vgcm_frame_turn(vgcm_two s1[3], const vgcm_two s[3], const vgcm_two n0[3],
                                 const vgcm_two n1[3], vgcm_two phi)
{
    vgcm_two tilted[3], q[3], size = 1.5 - 0.5 * vgcm_two_dot(s, s);
    vgcm_two tilt = size * vgcm_two_dot(n1, s) / (1 + vgcm_two_dot(n0, n1));
    for (int k = 0; k < 3; k++)
        tilted[k] = size * s[k] - tilt * (n0[k] + n1[k]);
    vgcm_two_cross(q, n1, tilted);
    for (int k = 0; k < 3; k++)
        s1[k] = (1 - phi * phi / 2) * tilted[k] + (phi - phi * phi * phi / 6) * q[k];
}

/* Frames and increments of contacts i and j over the step that has just been made. */
VGCM_INLINE void vgcm_motion_of_two(const struct brc_bodies *bodies, const struct brc_contacts *c,
                                    size_t i, size_t j, double dt, struct vgcm_motion_two *m)
{
    const struct vgcm_contacts *f = vgcm_columns(c);
    size_t ai = (size_t)c->a[i], aj = (size_t)c->a[j];
    size_t bi = (size_t)c->b[i], bj = (size_t)c->b[j];
    vgcm_two xa[3], xb[3], va[3], vb[3], wa[3], wb[3], n0[3], s0[3], v[3], nm[3], sm[3], tm[3];
    vgcm_two_load(xa, bodies->x, ai, aj);
    vgcm_two_load(xb, bodies->x, bi, bj);
    vgcm_two_load(va, bodies->v, ai, aj);
    vgcm_two_load(vb, bodies->v, bi, bj);
    vgcm_two_load(wa, bodies->w, ai, aj);
    vgcm_two_load(wb, bodies->w, bi, bj);
    vgcm_two_load(n0, f->n, i, j);
    vgcm_two_load(s0, f->s, i, j);
    for (int k = 0; k < 3; k++)
        xb[k] -= xa[k];
    vgcm_two d2 = vgcm_two_dot(xb, xb), half[3];
    m->d = vgcm_two_of(sqrt(d2[0]), sqrt(d2[1]));
    m->h = 0.5 * m->d + vgcm_two_of(f->plane[i], f->plane[j]); /* eq:vgcm:7 eq:vgcm:8 */
    vgcm_two inv = 1 / m->d;
    for (int k = 0; k < 3; k++) {
        m->n[k] = xb[k] * inv; /* eq:vgcm:6 */
        nm[k] = 0.5 * (n0[k] + m->n[k]);
        half[k] = 0.5 * dt * (wa[k] + wb[k]);
    }
    vgcm_frame_turn(m->s, s0, n0, m->n, vgcm_two_dot(half, nm)); /* eq:vgcm:18 */
    vgcm_two_cross(m->t, m->n, m->s);
    for (int k = 0; k < 3; k++) {
        sm[k] = 0.5 * (s0[k] + m->s[k]);
        half[k] = m->h * wa[k] + (m->d - m->h) * wb[k];
        wb[k] = dt * (wb[k] - wa[k]);
    }
    vgcm_two_cross(tm, nm, sm);
    vgcm_two_cross(half, half, nm);
    for (int k = 0; k < 3; k++)
        v[k] = dt * (vb[k] - va[k] - half[k]); /* eq:vgcm:11 at the reference point */
    m->du[VGCM_OPEN] = vgcm_two_dot(v, nm);    /* eq:vgcm:12 */
    m->du[VGCM_S] = vgcm_two_dot(v, sm);       /* eq:vgcm:13 */
    m->du[VGCM_T] = vgcm_two_dot(v, tm);
    m->du[VGCM_TWIST] = vgcm_two_dot(wb, nm);
    m->du[VGCM_BEND_S] = vgcm_two_dot(wb, sm);
    m->du[VGCM_BEND_T] = vgcm_two_dot(wb, tm);
}

/* One of the two. */
VGCM_INLINE void vgcm_motion_pick(struct vgcm_motion *one, const struct vgcm_motion_two *m,
                                  int lane)
{
    for (int k = 0; k < 3; k++) {
        one->n[k] = m->n[k][lane];
        one->s[k] = m->s[k][lane];
        one->t[k] = m->t[k][lane];
    }
    one->d = m->d[lane];
    one->h = m->h[lane];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        one->du[k] = m->du[k][lane];
}

/* The same in both places. */
VGCM_INLINE void vgcm_motion_repeat(struct vgcm_motion_two *m, const struct vgcm_motion *one)
{
    for (int k = 0; k < 3; k++) {
        m->n[k] = vgcm_two_of(one->n[k], one->n[k]);
        m->s[k] = vgcm_two_of(one->s[k], one->s[k]);
        m->t[k] = vgcm_two_of(one->t[k], one->t[k]);
    }
    m->d = vgcm_two_of(one->d, one->d);
    m->h = vgcm_two_of(one->h, one->h);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        m->du[k] = vgcm_two_of(one->du[k], one->du[k]);
}

static inline void vgcm_motion_of(const struct brc_bodies *bodies, const struct brc_contacts *c,
                                  size_t i, double dt, struct vgcm_motion *m)
{
    struct vgcm_motion_two both;
    vgcm_motion_of_two(bodies, c, i, i, dt, &both);
    vgcm_motion_pick(m, &both, 0);
}

/* Opening and slip at the place (s, t) of the affine field u. */
VGCM_INLINE void vgcm_motion_at(double at[3], const double u[VGCM_N_MOTION], double s, double t)
{
    at[0] = u[VGCM_OPEN] - u[VGCM_BEND_T] * s + u[VGCM_BEND_S] * t; /* eq:vgcm:9 eq:vgcm:11 */
    at[1] = u[VGCM_S] - u[VGCM_TWIST] * t;
    at[2] = u[VGCM_T] + u[VGCM_TWIST] * s;
}

/* Adds a point's normal force (tension positive) and shear force on b, the parts of eq:vgcm:10, to
 * the generalised force. */
VGCM_INLINE void vgcm_force_add(double sum[VGCM_N_MOTION], double fn, double fs, double ft,
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
VGCM_INLINE void vgcm_force_affine(vgcm_two sum[VGCM_N_MOTION], vgcm_two kn, vgcm_two ks,
                                   const vgcm_two m[VGCM_N_MOMENTS],
                                   const vgcm_two u[VGCM_N_MOTION])
{
    vgcm_two open = kn * u[VGCM_OPEN], bs = kn * u[VGCM_BEND_S], bt = kn * u[VGCM_BEND_T];
    vgcm_two us = ks * u[VGCM_S], ut = ks * u[VGCM_T], twist = ks * u[VGCM_TWIST];
    sum[VGCM_OPEN] = m[VGCM_A] * open - m[VGCM_A_S] * bt + m[VGCM_A_T] * bs;
    sum[VGCM_BEND_S] = m[VGCM_A_T] * open - m[VGCM_A_ST] * bt + m[VGCM_A_TT] * bs;
    sum[VGCM_BEND_T] = m[VGCM_A_SS] * bt - m[VGCM_A_S] * open - m[VGCM_A_ST] * bs;
    sum[VGCM_S] = m[VGCM_A_T] * twist - m[VGCM_A] * us;
    sum[VGCM_T] = -m[VGCM_A_S] * twist - m[VGCM_A] * ut;
    sum[VGCM_TWIST] = m[VGCM_A_T] * us - m[VGCM_A_S] * ut - (m[VGCM_A_SS] + m[VGCM_A_TT]) * twist;
}

/* Work that the motion u does against the generalised force: what the contact takes up. */
VGCM_INLINE vgcm_two vgcm_two_work(const vgcm_two f[VGCM_N_MOTION], const vgcm_two u[VGCM_N_MOTION])
{
    return f[VGCM_OPEN] * u[VGCM_OPEN] + f[VGCM_BEND_S] * u[VGCM_BEND_S] +
           f[VGCM_BEND_T] * u[VGCM_BEND_T] - f[VGCM_S] * u[VGCM_S] - f[VGCM_T] * u[VGCM_T] -
           f[VGCM_TWIST] * u[VGCM_TWIST];
}

VGCM_INLINE double vgcm_force_work(const double f[VGCM_N_MOTION], const double u[VGCM_N_MOTION])
{
    return f[VGCM_OPEN] * u[VGCM_OPEN] + f[VGCM_BEND_S] * u[VGCM_BEND_S] +
           f[VGCM_BEND_T] * u[VGCM_BEND_T] - f[VGCM_S] * u[VGCM_S] - f[VGCM_T] * u[VGCM_T] -
           f[VGCM_TWIST] * u[VGCM_TWIST];
}

/* Forces on b and moments about both centres, into rows i and j. */
VGCM_INLINE void vgcm_force_apply_two(struct brc_contacts *c, size_t i, size_t j,
                                      const struct vgcm_motion_two *m,
                                      const vgcm_two sum[VGCM_N_MOTION])
{
    vgcm_two h = m->h, g = m->d - m->h, twist = sum[VGCM_TWIST];
    vgcm_two as = sum[VGCM_BEND_S] + h * sum[VGCM_T], at = sum[VGCM_BEND_T] - h * sum[VGCM_S];
    vgcm_two bs = g * sum[VGCM_T] - sum[VGCM_BEND_S], bt = -g * sum[VGCM_S] - sum[VGCM_BEND_T];
    for (int k = 0; k < 3; k++) {
        vgcm_two f = sum[VGCM_S] * m->s[k] + sum[VGCM_T] * m->t[k] -
                     sum[VGCM_OPEN] * m->n[k];                       /* eq:vgcm:19 */
        vgcm_two ta = as * m->s[k] + at * m->t[k] - twist * m->n[k]; /* eq:vgcm:24 */
        vgcm_two tb = bs * m->s[k] + bt * m->t[k] + twist * m->n[k]; /* eq:vgcm:25 */
        c->f[i][k] = f[0]; /* on b; a gets the opposite: eq:vgcm:22 eq:vgcm:23 */
        c->ta[i][k] = ta[0];
        c->tb[i][k] = tb[0];
        c->f[j][k] = f[1];
        c->ta[j][k] = ta[1];
        c->tb[j][k] = tb[1];
    }
}

static inline void vgcm_force_apply(struct brc_contacts *c, size_t i, const struct vgcm_motion *m,
                                    const double sum[VGCM_N_MOTION])
{
    struct vgcm_motion_two both;
    vgcm_two twice[VGCM_N_MOTION];
    vgcm_motion_repeat(&both, m);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        twice[k] = vgcm_two_of(sum[k], sum[k]);
    vgcm_force_apply_two(c, i, i, &both, twice);
}

#endif
