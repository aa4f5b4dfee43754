/* SPDX-License-Identifier: GPL-3.0-or-later */
/* 3-vectors and quaternions (scalar first, body to space). Static inline, no state. Output
 * arguments come first and may alias inputs unless said otherwise.
 *
 * Plain arrays rather than a struct of x, y, z: columns of tables, HDF5 and loops over axes have
 * them in this form, and no conversion stands between. Products are added from left to right and
 * never fused (-ffp-contract=off), as restarts and other machines must give the same bits. */
#ifndef BRC_VEC_H
#define BRC_VEC_H

#include <math.h>
#include <stddef.h>

static inline void brc_set(double r[3], double x, double y, double z)
{
    r[0] = x;
    r[1] = y;
    r[2] = z;
}

static inline void brc_copy(double r[3], const double a[3])
{
    brc_set(r, a[0], a[1], a[2]);
}

static inline void brc_add(double r[3], const double a[3], const double b[3])
{
    brc_set(r, a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}

static inline void brc_sub(double r[3], const double a[3], const double b[3])
{
    brc_set(r, a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

static inline void brc_scale(double r[3], const double a[3], double s)
{
    brc_set(r, a[0] * s, a[1] * s, a[2] * s);
}

/* r += s a */
static inline void brc_axpy(double r[3], double s, const double a[3])
{
    brc_set(r, r[0] + s * a[0], r[1] + s * a[1], r[2] + s * a[2]);
}

static inline double brc_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void brc_cross(double r[3], const double a[3], const double b[3])
{
    brc_set(r, a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

static inline double brc_norm2(const double a[3])
{
    return brc_dot(a, a);
}

static inline double brc_norm(const double a[3])
{
    return sqrt(brc_dot(a, a));
}

static inline double brc_distance(const double a[3], const double b[3])
{
    double r[3];
    brc_sub(r, b, a);
    return brc_norm(r);
}

/* r = a / |a|, returns |a|; a zero vector stays zero. */
static inline double brc_normalise(double r[3], const double a[3])
{
    double length = brc_norm(a);
    brc_scale(r, a, length > 0 ? 1 / length : 0);
    return length;
}

/* Two unit vectors s, t with s x t = n, for a unit vector n. s is normal to the axis that n is
 * least along, so that the cross product is never near zero. */
static inline void brc_frame(double s[3], double t[3], const double n[3])
{
    double e[3] = {0, 0, 0};
    int k = fabs(n[0]) < fabs(n[1]) ? 0 : 1;
    if (fabs(n[2]) < fabs(n[k]))
        k = 2;
    e[k] = 1;
    brc_cross(s, e, n);
    brc_normalise(s, s);
    brc_cross(t, n, s);
}

/* Quaternion product r = a b; r must not alias. */
static inline void brc_quat_mul(double r[4], const double a[4], const double b[4])
{
    r[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    r[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    r[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    r[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

/* Rotation matrix (row major, body to space) of a unit quaternion. */
static inline void brc_quat_matrix(double m[3][3], const double q[4])
{
    double w = q[0], x = q[1], y = q[2], z = q[3];
    brc_set(m[0], 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y));
    brc_set(m[1], 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x));
    brc_set(m[2], 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y));
}

/* r = m a (body to space); r must not alias a. */
static inline void brc_mat_mul(double r[3], double m[3][3], const double a[3])
{
    brc_set(r, brc_dot(m[0], a), brc_dot(m[1], a), brc_dot(m[2], a));
}

/* r = m^T a (space to body); r must not alias a. */
static inline void brc_mat_mul_t(double r[3], double m[3][3], const double a[3])
{
    brc_set(r, m[0][0] * a[0] + m[1][0] * a[1] + m[2][0] * a[2],
            m[0][1] * a[0] + m[1][1] * a[1] + m[2][1] * a[2],
            m[0][2] * a[0] + m[1][2] * a[1] + m[2][2] * a[2]);
}

/* Unit quaternion of a rotation by |phi| about phi. The turns of a step are small: their series are
 * exact to round-off. */
static inline void brc_quat_from_rotation(double q[4], const double phi[3])
{
    double h2 = 0.25 * brc_norm2(phi), s;
    if (h2 < 1e-3) {
        s = 0.5 - h2 * (1.0 / 12 - h2 * (1.0 / 240 - h2 * (1.0 / 10080 - h2 * (1.0 / 725760))));
        q[0] = 1 - h2 * (1.0 / 2 - h2 * (1.0 / 24 - h2 * (1.0 / 720 - h2 * (1.0 / 40320))));
    } else {
        double h = sqrt(h2);
        s = 0.5 * sin(h) / h;
        q[0] = cos(h);
    }
    q[1] = s * phi[0];
    q[2] = s * phi[1];
    q[3] = s * phi[2];
}

/* The smallest box that holds n points; without any, low lies above high. */
static inline void brc_box_of(double low[3], double high[3], double (*x)[3], size_t n)
{
    brc_set(low, HUGE_VAL, HUGE_VAL, HUGE_VAL);
    brc_set(high, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL);
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], x[i][k]);
            high[k] = fmax(high[k], x[i][k]);
        }
}

/* Velocity of the point at arm r on a body that moves with v and spins with w. */
static inline void brc_point_velocity(double u[3], const double v[3], const double w[3],
                                      const double r[3])
{
    double c[3];
    brc_cross(c, w, r);
    brc_add(u, v, c);
}

#endif
