/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The springs of four feature contacts side by side: normal, tangential and viscous force (eqs 4,
 * 8-10), their energy and stiffness. The loops over pairs and platens call these; knows the
 * geometry of a contact and the motion of its bodies at it, not where either comes from. */
#ifndef POLY_CONTACT_H
#define POLY_CONTACT_H

#include "polyhedra/geometry.h"

/* What the contacts of grains share. */
struct poly_spring_law {
    double kn, kt; /* N/m */
    double stiff;  /* N/m, the larger one of those that act */
    double limit;  /* largest tangential displacement per overlap: mu kn / kt */
};

/* Pair stiffness of two feature stiffnesses: harmonic, equal for equal grains. 0 for grains without
 * stiffness, where the mean would be 0/0. */
static inline double poly_pair_stiffness(double a, double b)
{
    return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

/* Force on b and its moment about the centre of a. */
struct poly_wrench4 {
    brc_lanes f[3], m[3];
};

/* What four contacts add to the sums of their pairs (POLY_SUM_NORMAL and so on). */
struct poly_sums4 {
    struct poly_wrench4 normal, shear;
    brc_lanes k[3], stored, slid;
    struct poly_wrench4 viscous;
    brc_lanes none;
};

/* Springs of four contacts, as POLY_SPRING has them. */
struct poly_springs4 {
    brc_lanes xi[3], weight, n[3], none;
};

BRC_LANES_INLINE void poly_force_at(struct poly_wrench4 *w, const brc_lanes f[3],
                                    const brc_lanes arm[3])
{
    poly_set3(w->f, f[0], f[1], f[2]);
    brc_lanes_cross(w->m, arm, f);
}

/* Elastic normal force, with the gradient part under `merged`. Both parts are the gradient of the
 * energy w K delta^2 / 2, by delta and by w, so that no closed path gains or loses by them. */
BRC_LANES_INLINE void poly_normal_force(struct poly_wrench4 *w, const struct poly_geometry4 *t,
                                        double kn, const brc_lanes arm[3])
{
    brc_lanes f[3], grade = -0.5 * kn * t->delta * t->delta;
    poly_scale3(f, t->n, kn * t->weight * t->delta); /* eq:gt12:4 */
    poly_axpy3(f, grade, t->g);
    poly_force_at(w, f, arm);
    poly_axpy3(w->m, grade, t->c);
}

/* Old tangential displacement turned with the contact frame: tilt from the old to the new normal,
 * then twirl by the angle 2 t about it. The length is kept. Without the twirl the direction of
 * friction would stay behind in a pair that turns about its normal. */
BRC_LANES_INLINE void poly_turn_spring(brc_lanes xi[3], const brc_lanes n_old[3],
                                       const brc_lanes n[3], brc_lanes t)
{
    brc_lanes r[3], a[3], c = brc_lanes_dot(n_old, n), t2 = 1 + t * t, tilt = 1 + c;
    /* One division for both turns. The twirl by its half tangent keeps lengths to round-off at
     * any angle and needs no sine. */
    brc_lanes both = 1 / (t2 * tilt), per = both * tilt;
    brc_lanes_cross(r, n_old, n);
    brc_lanes along = brc_lanes_dot(r, xi) * (both * t2);
    brc_lanes_cross(a, r, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = c * xi[i] + a[i] + along * r[i];
    brc_lanes_cross(a, n, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = ((2 - t2) * xi[i] + 2 * t * a[i]) * per;
}

/* Adds the tangential part of du to xi and caps it: what is left over has slipped. Returns where it
 * has. Stored capped, so that a contact that turns back sticks at once. */
BRC_LANES_INLINE brc_mask poly_slide_spring(brc_lanes xi[3], const brc_lanes n[3],
                                            const brc_lanes du[3], brc_lanes limit)
{
    poly_add3(xi, xi, du); /* eq:gt12:9 */
    /* Projected after the sum: the turn leaves xi in the plane to round-off only, and that would
     * add up. */
    poly_axpy3(xi, -brc_lanes_dot(xi, n), n);
    brc_lanes xi2 = brc_lanes_dot(xi, xi);
    brc_mask slips = brc_lanes_less(limit * limit, xi2);
    brc_lanes cap = brc_lanes_pick(slips, limit / brc_lanes_sqrt(xi2), brc_lanes_all(1));
    poly_scale3(xi, xi, cap);
    return slips;
}

/* What a contact wants to know of the motion of its bodies in the step. */
struct poly_slip4 {
    brc_lanes du[3]; /* m, displacement of b relative to a at the contact */
    brc_lanes twirl; /* half the mean turn of both about the normal */
    brc_lanes limit; /* struct poly_spring_law */
};

/* Tangential springs: xi and the normals of the last step become those of now; old is the weight
 * that they had, where they touch now. What a spring loses or gains by a change of weight alone
 * counts as slip. */
BRC_LANES_INLINE brc_mask poly_shear_force(struct poly_springs4 *p, struct poly_sums4 *s,
                                           const struct poly_geometry4 *t,
                                           const struct poly_slip4 *slip, double kt,
                                           const brc_lanes arm[3], brc_lanes old, const bool ledger)
{
    brc_lanes xi[3], before[3], f[3];
    const brc_lanes *du = slip->du;
    brc_mask touches = poly_positive(t->weight);
    poly_set3(xi, p->xi[0], p->xi[1], p->xi[2]);
    poly_turn_spring(xi, p->n, t->n, slip->twirl);
    /* What did not touch in the last step begins without a displacement, whatever its memory has
     * from before. */
    poly_mask3(xi, poly_positive(old), xi);
    poly_set3(before, xi[0], xi[1], xi[2]);
    brc_mask slips = poly_slide_spring(xi, t->n, du, slip->limit * t->delta);
    poly_mask3(xi, touches, xi);
    poly_scale3(f, xi, -kt * t->weight); /* eq:gt12:8 */
    poly_force_at(&s->shear, f, arm);
    for (int k = 0; k < 3; k++) {
        p->xi[k] = brc_lanes_pick(touches, xi[k], p->xi[k]);
        p->n[k] = brc_lanes_pick(touches, t->n[k], p->n[k]);
    }
    if (!ledger)
        return slips;
    brc_lanes part[3], along = brc_lanes_dot(du, t->n);
    for (int k = 0; k < 3; k++)
        part[k] = (old * before[k] + t->weight * xi[k]);
    brc_lanes work = brc_lanes_dot(part, du) - along * brc_lanes_dot(part, t->n);
    s->slid = 0.5 * kt * work;
    s->stored =
        0.5 * kt * (t->weight * brc_lanes_dot(xi, xi) - old * brc_lanes_dot(before, before));
    return slips;
}

/* Viscous force on b for the velocity u of b relative to a. The normal part never turns the normal
 * force into a pull. The bound is the elastic force itself, so that both together are 0 at
 * least. */
BRC_LANES_INLINE void poly_viscous_force(brc_lanes f[3], const struct poly_geometry4 *t, double kn,
                                         brc_lanes gn, brc_lanes gt, const brc_lanes u[3])
{
    brc_lanes vn = brc_lanes_dot(u, t->n), across = t->weight * gt;
    brc_lanes normal =
        brc_lanes_max(-t->weight * gn * vn, -kn * t->weight * t->delta); /* eq:gt12:10 */
    for (int i = 0; i < 3; i++)
        f[i] = normal * t->n[i] - across * (u[i] - vn * t->n[i]);
}

/* Stiffness of four springs: A of df = -A d, columns a[j], for a shift d of b at the contact. With
 * the energy w kn delta^2 / 2 and the slope g of w, the normal force gives
 * w kn n n - kn delta (n g + g n); a tangential spring that sticks w kt (1 - n n) + kt xi g; one
 * that slips along t has no stiffness in that direction, and -mu kn w t n by its cap. q is what a
 * change of weight does. */
BRC_LANES_INLINE void poly_spring_stiffness(brc_lanes a[3][3], brc_lanes q[3],
                                            const struct poly_spring_law *law,
                                            const struct poly_geometry4 *t, const brc_lanes xi[3],
                                            brc_mask slips, const bool friction)
{
    const brc_lanes kn = law->kn * t->weight, none = brc_lanes_all(0);
    const brc_lanes kt = friction ? law->kt * t->weight : none;
    brc_lanes push = law->kn * t->delta, slide[3] = {none, none, none};
    brc_lanes size2 = brc_lanes_where(slips, brc_lanes_dot(xi, xi));
    brc_lanes per = brc_lanes_where(poly_positive(size2), 1 / size2);
    for (int i = 0; i < 3; i++) {
        q[i] = -push * t->n[i];
        if (friction)
            q[i] += law->kt * xi[i];
    }
    if (friction)
        poly_scale3(slide, xi, kt * per);
    brc_lanes cap = law->limit * brc_lanes_sqrt(size2); /* mu kn w = kt w limit */
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            a[j][i] = (kn - kt) * t->n[i] * t->n[j] + q[i] * t->g[j] - push * t->g[i] * t->n[j];
            if (friction)
                a[j][i] -= slide[i] * (xi[j] + cap * t->n[j]);
            if (i == j)
                a[j][i] += kt;
        }
}

#endif
