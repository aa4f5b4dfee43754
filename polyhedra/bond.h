/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bond law of four pairs of faces that were one facet (eqs 11-15). Total displacements of
 * material points carried by both bodies, so that rigid motion of a pair gives no force, whatever
 * the angle. The loop has four contacts side by side (motion_kernels.inc.h); who has one alone
 * gives it to all lanes (bond_of_contact.c). */
#ifndef POLY_BOND_H
#define POLY_BOND_H

#include "polyhedra/lanes3.h"

/* Constants of four bonds. Without a bond they are 0 and the law gives 0: no kernel branches on the
 * status of a contact. */
struct poly_bonds4 {
    brc_lanes kn, kt; /* N/m: modulus x area / strain length; 0 where there is no bond */
    brc_lanes ktheta; /* N m: 0 without torsion */
    brc_lanes length; /* m, strain length */
    double eps_th;
    double theta_th; /* HUGE_VAL: no limit */
};

/* Where the two halves are now, in axes of space. */
struct poly_bond_pose4 {
    brc_lanes pa[3], pb[3]; /* material points on a and b, from the centre of a */
    brc_lanes arm[3];       /* where the forces act: midpoint of both, or the grain's on a platen */
    brc_lanes n[3];         /* mean normal, from a to b */
    brc_lanes twist;        /* rad, turn of b relative to a about n; 0 without torsion */
};

struct poly_bond_state4 {
    brc_lanes f[3];    /* N, force on b at the place; a gets the opposite */
    brc_lanes m;       /* N m, moment on b along n; a gets the opposite */
    brc_lanes opening; /* m, positive apart */
    brc_lanes term[3]; /* of eq 15: tension, shear, torsion */
    brc_lanes energy;  /* J, stored */
};

/* Mean normal of the two faces, whose outward normals are na and nb. That of b points the other
 * way, so that their difference is along the mean of both, seen from a. */
BRC_LANES_INLINE void poly_mean_normal(brc_lanes n[3], const brc_lanes na[3], const brc_lanes nb[3])
{
    poly_sub3(n, na, nb);
    poly_scale3(n, n, 1 / brc_lanes_sqrt(brc_lanes_dot(n, n)));
}

/* Both halves pull at the midpoint of their material points, so that force and moment balance
 * though these have come apart. */
BRC_LANES_INLINE void poly_arm_of_pair(struct poly_bond_pose4 *pose)
{
    for (int k = 0; k < 3; k++)
        pose->arm[k] = 0.5 * (pose->pa[k] + pose->pb[k]);
}

/* Turn about n of two tangents that were one at the start; 0 where the mask is not set. */
BRC_LANES_INLINE brc_lanes poly_twist(const brc_lanes n[3], const brc_lanes ta[3],
                                      const brc_lanes tb[3], brc_mask intact)
{
    brc_lanes c[3];
    brc_lanes_cross(c, ta, tb);
    brc_lanes x = brc_lanes_dot(ta, tb) - brc_lanes_dot(ta, n) * brc_lanes_dot(tb, n);
    brc_lanes y = brc_lanes_where(intact, brc_lanes_dot(c, n));
    x = brc_lanes_pick(intact, x, brc_lanes_all(1));
    /* the series of the arc tangent: what it leaves out is below t^10 / 11 */
    /* Bonds break at some hundredths of a radian, so a call of atan2 for each of four lanes
     * would be spent on nothing; it is left for bonds that do not break. */
    brc_lanes t = y / x, t2 = t * t;
    brc_lanes angle = t * (1 - t2 * (1.0 / 3 - t2 * (1.0 / 5 - t2 * (1.0 / 7 - t2 * (1.0 / 9)))));
    brc_mask small = poly_positive(x) & brc_lanes_less(brc_lanes_abs(t), brc_lanes_all(0.03));
    if (brc_lanes_any(~small))
        for (int k = 0; k < BRC_LANES; k++)
            angle[k] = small[k] ? angle[k] : atan2(y[k], x[k]);
    return angle;
}

BRC_LANES_INLINE void poly_bond_law(struct poly_bond_state4 *r, const struct poly_bonds4 *bond,
                                    const struct poly_bond_pose4 *pose)
{
    brc_lanes u[3], ut[3];
    const brc_lanes *n = pose->n;
    poly_sub3(u, pose->pb, pose->pa);
    brc_lanes un = brc_lanes_dot(u, n);
    poly_set3(ut, u[0] - un * n[0], u[1] - un * n[1], u[2] - un * n[2]);
    brc_lanes open = brc_lanes_max(un, brc_lanes_all(0)); /* eq:gt12:12 */
    r->opening = un;
    for (int k = 0; k < 3; k++) {
        r->f[k] = -bond->kn * open * n[k]; /* eq:gt12:11 */
        r->f[k] -= bond->kt * ut[k];       /* eq:gt12:13 */
    }
    brc_lanes limit = bond->length * bond->eps_th;
    brc_lanes slip = brc_lanes_sqrt(brc_lanes_dot(ut, ut));
    r->m = -bond->ktheta * pose->twist; /* eq:gt12:14 */
    r->term[0] = open / limit;
    r->term[1] = slip / limit;
    r->term[2] = brc_lanes_abs(pose->twist) / bond->theta_th;
    r->energy = 0.5 * (bond->kn * open * open + bond->kt * slip * slip +
                       bond->ktheta * pose->twist * pose->twist);
}

/* The bond breaks where this is above 1. Tension has the ramp of eq 12 here, too, so that
 * compression breaks no bond. */
BRC_LANES_INLINE brc_lanes poly_bond_use(const struct poly_bond_state4 *r)
{
    return r->term[0] + r->term[1] + r->term[2]; /* eq:gt12:15 */
}

#endif
