/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The collision law of one feature contact (eqs 3-5, 8-10) and the weights of the `merged` rule. */
#ifndef POLY_CONTACT_H
#define POLY_CONTACT_H

#include "distance.h"

/* Weight of crossing edges: full from this squared sine on (5.7 degrees). */
#define POLY_SKEW 0.01

/* A feature contact: geometry from the distance functions, in space. */
struct poly_touch {
    double n[3];   /* unit, from a to b (eq 3) */
    double x[3];   /* middle between the two closest points */
    double delta;  /* m, overlap R1 + R2 - distance, positive in contact */
    double weight; /* of the spring, (0, 1]; 1 except under `merged` */
    double g[3];   /* 1/m, gradient part: force on b is -K delta^2 / 2 times this, at x */
    double c[3];   /* 1, its couple on b in the same measure */
    bool graded;   /* g and c are not zero */
};

/* A full spring with an overlap; normal and place follow. */
static inline void poly_touch_begin(struct poly_touch *t, double delta)
{
    t->delta = delta;
    t->weight = 1;
    t->graded = false;
    brc_set(t->g, 0, 0, 0);
    brc_set(t->c, 0, 0, 0);
}

/* Pair stiffness of two feature stiffnesses: harmonic, equal for equal grains. */
static inline double poly_pair_stiffness(double a, double b)
{
    return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

/* Rises from 0 at x <= 0 to 1 at x >= 1 with continuous slope, which goes to *slope. */
static inline double poly_smooth(double x, double *slope)
{
    *slope = 0;
    if (x <= 0)
        return 0;
    if (x >= 1)
        return 1;
    *slope = 6 * x * (1 - x);
    return x * x * (3 - 2 * x);
}

/* Factor of the weight of a vertex at v by one vertex u of the other core: 0 where the two overlap
 * by themselves, 1 from sqrt(5) R on. rest2 = (2 R)^2, ell2 = R^2. */
static inline double poly_vertex_factor(const double v[3], const double u[3], double rest2,
                                        double ell2, double grad[3])
{
    double r[3], slope;
    brc_sub(r, v, u);
    double s = poly_smooth((brc_norm2(r) - rest2) / ell2, &slope);
    brc_scale(grad, r, 2 * slope / ell2);
    return s;
}

/* Weight of the spring of vertex v, from 1/2 where a vertex of the other core overlaps it (and has
 * the other half) to 1; grad is its gradient. */
static inline double poly_vertex_weight(const double v[3], const double (*u)[3], int32_t n,
                                        double rest2, double ell2, double grad[3])
{
    double product = 1, total[3] = {0, 0, 0};
    for (int32_t i = 0; i < n; i++) {
        double r[3], g[3];
        brc_sub(r, v, u[i]);
        if (brc_norm2(r) >= rest2 + ell2)
            continue;
        double s = poly_vertex_factor(v, u[i], rest2, ell2, g);
        for (int k = 0; k < 3; k++)
            total[k] = total[k] * s + product * g[k];
        product *= s;
    }
    brc_scale(grad, total, 0.5);
    return 0.5 + 0.5 * product;
}

/* Weight of a foot at t on an edge: 0 at its ends, full from ell inside; with its slope. */
static inline double poly_foot_weight(double t, double length, double ell, double *slope)
{
    double s0, s1;
    double w0 = poly_smooth(t / ell, &s0), w1 = poly_smooth((length - t) / ell, &s1);
    *slope = (s0 * w1 - w0 * s1) / ell;
    return w0 * w1;
}

/* Weight of a crossing edge pair with inside feet, and the gradient parts g and c of its touch.
 * n points from edge a to edge b with gap d; see README.md for the derivation. */
static inline void poly_crossing_weight(struct poly_touch *t, const struct poly_crossing *x,
                                        double ell, double d)
{
    double da, db, dp;
    double wa = poly_foot_weight(x->ta, x->la, ell, &da),
           wb = poly_foot_weight(x->tb, x->lb, ell, &db);
    double wp = poly_smooth(x->sin2 / POLY_SKEW, &dp);
    double by_a = da * wb * wp, by_b = wa * db * wp, by_angle = wa * wb * dp / POLY_SKEW;
    t->weight = wa * wb * wp;
    t->graded = by_a != 0 || by_b != 0 || by_angle != 0;
    if (!t->graded)
        return;
    double bn[3], ba[3], gn[3], scale = 1 / x->sin2;
    brc_cross(bn, x->b, t->n);
    brc_cross(ba, x->b, x->a);
    for (int i = 0; i < 3; i++) {
        t->g[i] = (by_a * (x->a[i] - x->c * x->b[i]) + by_b * (x->c * x->a[i] - x->b[i])) * scale;
        t->c[i] = -(d * scale * (x->c * by_a + by_b) * bn[i] + 2 * x->c * by_angle * ba[i]);
    }
    /* from the foot on b to the middle */
    brc_cross(gn, t->n, t->g);
    brc_axpy(t->c, d / 2, gn);
}

/* Old tangential displacement turned with the contact frame: tilt from the old to the new normal,
 * then twirl by the angle about it. The length is kept. */
static inline void poly_turn(double xi[3], const double n_old[3], const double n[3], double twirl)
{
    double r[3], a[3], t = twirl / 2, scale = 1 / (1 + t * t);
    brc_cross(r, n_old, n);
    double c = brc_dot(n_old, n), along = brc_dot(r, xi) / (1 + c);
    brc_cross(a, r, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = c * xi[i] + a[i] + along * r[i];
    brc_cross(a, n, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = ((1 - t * t) * xi[i] + 2 * t * a[i]) * scale;
}

/* Adds the tangential part of du to xi and caps it (eqs 8-9): what is left over has slipped. */
static inline void poly_slide(double xi[3], const double n[3], const double du[3], double limit)
{
    for (int i = 0; i < 3; i++)
        xi[i] += du[i]; /* eq:gt12:9 */
    brc_axpy(xi, -brc_dot(xi, n), n);
    double xi2 = brc_norm2(xi);
    if (xi2 > limit * limit)
        brc_scale(xi, xi, limit / sqrt(xi2)); /* eq:gt12:8 */
}

/* Viscous force on b (eq 10) for the velocity v of b relative to a. The normal part never turns the
 * normal force fn into a pull. */
static inline void poly_viscous(double f[3], const double n[3], const double v[3], double gn,
                                double gt, double fn)
{
    double vn = brc_dot(v, n);
    double normal = poly_most(-gn * vn, -fn); /* eq:gt12:10 */
    for (int i = 0; i < 3; i++)
        f[i] = normal * n[i] - gt * (v[i] - vn * n[i]);
}

#endif
