/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bond law: one pair of faces that were one facet (eqs 11-15). Total displacements of material
 * points carried by both bodies, so that rigid motion of a pair gives no force, whatever the angle.
 */
#ifndef POLY_BOND_H
#define POLY_BOND_H

#include "common/geometry/vec.h"

#include <stdbool.h>

/* Constants of one bond. */
struct poly_bond {
    double kn, kt; /* N/m: modulus x area / strain length */
    double ktheta; /* N m: 0 without torsion */
    double length; /* m, strain length */
    double eps_th;
    double theta_th; /* HUGE_VAL: no limit */
};

/* Where the two halves are now, in space. */
struct poly_bond_pose {
    double pa[3], pb[3]; /* material points on a and b */
    double na[3], nb[3]; /* outward normals of the two faces */
    double ta[3], tb[3]; /* tangents that were one at the start; unused without torsion */
};

struct poly_bond_result {
    double n[3];    /* mean normal, from a to b */
    double f[3];    /* N, force on b at the place; a gets the opposite */
    double m;       /* N m, moment on b along n; a gets the opposite */
    double x[3];    /* place: midpoint of the material points */
    double term[3]; /* of eq 15: tension, shear, torsion */
    double energy;  /* J, stored */
};

/* atan2(y, x), by its series where that is exact to round-off. */
static inline double poly_angle(double x, double y)
{
    double t = y / x;
    if (x > 0 && fabs(t) < 1e-3)
        return t * (1 - t * t * (1.0 / 3 - t * t / 5));
    return atan2(y, x);
}

/* Relative rotation about n of two tangents. */
static inline double poly_twist(const double n[3], const double ta[3], const double tb[3])
{
    double c[3];
    brc_cross(c, ta, tb);
    return poly_angle(brc_dot(ta, tb) - brc_dot(ta, n) * brc_dot(tb, n), brc_dot(c, n));
}

static inline void poly_bond_law(struct poly_bond_result *r, const struct poly_bond *bond,
                                 const struct poly_bond_pose *pose, const bool torsion)
{
    double u[3], ut[3];
    brc_sub(r->n, pose->na, pose->nb);
    brc_normalise(r->n, r->n);
    brc_sub(u, pose->pb, pose->pa);
    double un = brc_dot(u, r->n);
    brc_copy(ut, u);
    brc_axpy(ut, -un, r->n);
    double open = un > 0 ? un : 0; /* eq:gt12:12 */
    for (int i = 0; i < 3; i++) {
        r->f[i] = -bond->kn * open * r->n[i]; /* eq:gt12:11 */
        r->f[i] -= bond->kt * ut[i];          /* eq:gt12:13 */
        r->x[i] = 0.5 * (pose->pa[i] + pose->pb[i]);
    }
    double slip2 = brc_norm2(ut);
    r->energy = 0.5 * (bond->kn * open * open + bond->kt * slip2);
    r->term[0] = open / (bond->length * bond->eps_th); /* eq:gt12:15 */
    r->term[1] = sqrt(slip2) / (bond->length * bond->eps_th);
    r->term[2] = 0;
    r->m = 0;
    if (torsion) {
        double theta = poly_twist(r->n, pose->ta, pose->tb);
        r->m = -bond->ktheta * theta; /* eq:gt12:14 */
        r->energy += 0.5 * bond->ktheta * theta * theta;
        r->term[2] = fabs(theta) / bond->theta_th;
    }
}

static inline bool poly_bond_breaks(const struct poly_bond_result *r)
{
    return r->term[0] + r->term[1] + r->term[2] > 1; /* eq:gt12:15 */
}

/* 0 tension, 1 shear, 2 torsion: the largest term of eq 15. */
static inline int poly_bond_mode(const struct poly_bond_result *r)
{
    int mode = r->term[1] > r->term[0] ? 1 : 0;
    return r->term[2] > r->term[mode] ? 2 : mode;
}

#endif
