/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Geometry of four feature contacts side by side: distance, normal, overlap (eqs 1-3, 5) and the
 * weights of the `merged` rule. The loops have four contacts of whatever pairs; who has one alone
 * (features.c, platen_geometry.h) gives it to all lanes and reads one. Knows neither grains nor
 * lists. */
#ifndef POLY_GEOMETRY_H
#define POLY_GEOMETRY_H

#include "polyhedra/lanes3.h"

/* Weight of crossing edges: full from this squared sine on (5.7 degrees). Below it the ends of the
 * parallel part carry the load, which are vertices (README.md). */
#define POLY_SKEW 0.01
/* How far the closest points of crossing edges of `closed` may move along them, in radii R, while
 * their springs are linear. */
#define POLY_PLACE 0.1
/* Edges count as parallel when the squared sine of their angle is below this. Relative, so that
 * results scale with the sample. */
#define POLY_PARALLEL 1e-12

/* Which feature pairs are springs: README.md. */
enum poly_rule { POLY_CLOSED, POLY_STRICT, POLY_MERGED };

/* Lengths that all contacts of grains share [m]. */
struct poly_lengths {
    double contact_distance; /* of the cores, R1 + R2: no overlap */
    double fade;             /* over which weights of `merged` change */
    double skin;             /* of the feature lists */
};

/* Four contacts. Where nothing touches all is zero but for delta, and -delta is a relative path of
 * the bodies that cannot bring them in touch. Where they fade, they can but touch with a weight
 * that grows from 0: edges, by their ends. Those that touch do so for a path of valid_path at
 * least, as long as the closest point of a vertex stays on its feature. One struct for vertices and
 * edges, so that forces need not know which they have. */
struct poly_geometry4 {
    brc_lanes n[3];   /* unit, from a to b */
    brc_lanes x[3];   /* middle between the two closest points */
    brc_lanes delta;  /* m, overlap R1 + R2 - distance, positive in contact */
    brc_lanes weight; /* of the spring, (0, 1]; 1 except under `merged` */
    brc_lanes g[3];   /* 1/m, gradient part: force on b is -K delta^2 / 2 times this, at x */
    brc_lanes c[3];   /* 1, its couple on b in the same measure */
    brc_lanes valid_path;
    brc_mask fades;
};

/* One of them. */
struct poly_geometry {
    double n[3], x[3], delta, weight, g[3], c[3];
};

/* Lane k. */
BRC_LANES_INLINE void poly_geometry_lane(struct poly_geometry *one, const struct poly_geometry4 *t,
                                         int k)
{
    poly_lane3(one->n, t->n, k);
    poly_lane3(one->x, t->x, k);
    poly_lane3(one->g, t->g, k);
    poly_lane3(one->c, t->c, k);
    one->delta = t->delta[k];
    one->weight = t->weight[k];
}

/* Overlap and normal for the distance s of the closest points, that on b being s out from that on a
 * with sign 1, the other way round with -1. Returns where they touch. Signed, so that what has
 * passed a plane is still pushed out the way it came in. */
BRC_LANES_INLINE brc_mask poly_overlap(struct poly_geometry4 *t, brc_lanes s,
                                       const brc_lanes out[3], brc_lanes sign,
                                       double contact_distance)
{
    t->delta = contact_distance - s;                           /* eq:gt12:5 */
    poly_scale3(t->n, out, sign);                              /* eq:gt12:3 */
    return brc_lanes_less(s, brc_lanes_all(contact_distance)); /* eq:gt12:2 */
}

/* What `closed` and `strict` have always, and the others where nothing lowers it. */
BRC_LANES_INLINE void poly_full_weight(struct poly_geometry4 *t)
{
    t->fades = (brc_mask){0};
    t->weight = brc_lanes_all(1);
    for (int k = 0; k < 3; k++)
        t->g[k] = t->c[k] = brc_lanes_all(0);
}

/* By masks, not by branches: of four contacts one mostly touches, and zeros may be added to a
 * sum. */
BRC_LANES_INLINE void poly_hide_apart(struct poly_geometry4 *t, brc_mask touches)
{
    t->weight = brc_lanes_where(touches, t->weight);
    poly_mask3(t->n, touches, t->n);
    poly_mask3(t->x, touches, t->x);
    poly_mask3(t->g, touches, t->g);
    poly_mask3(t->c, touches, t->c);
}

/* Rises from 0 at x <= 0 to 1 at x >= 1 with continuous slope. A slope that jumped would make the
 * force jump, which is minus the gradient of the energy, the weight included. */
BRC_LANES_INLINE brc_lanes poly_smooth(brc_lanes x, brc_lanes *slope)
{
    x = brc_lanes_min(brc_lanes_max(x, brc_lanes_all(0)), brc_lanes_all(1));
    *slope = 6 * x * (1 - x);
    return x * x * (3 - 2 * x);
}

/* --- vertices --------------------------------------------------------------------------------- */

/* Four vertices v at distance s from the other core, whose outward normal there is out; sign: 1
 * where the vertex belongs to b, else -1. Returns where they touch; the weight is full. */
BRC_LANES_INLINE brc_mask poly_vertex_geometry(struct poly_geometry4 *t, const brc_lanes v[3],
                                               brc_lanes s, const brc_lanes out[3], brc_lanes sign,
                                               double contact_distance)
{
    brc_mask touches = poly_overlap(t, s, out, sign, contact_distance);
    t->valid_path = t->delta;
    for (int k = 0; k < 3; k++)
        t->x[k] = v[k] - 0.5 * s * out[k];
    poly_full_weight(t);
    return touches;
}

/* How far vertices of the other core lower the weight of a vertex: the product of their factors,
 * and its gradient. */
struct poly_fading {
    brc_lanes product, gradient[3];
};

BRC_LANES_INLINE void poly_fading_begin(struct poly_fading *f)
{
    f->product = brc_lanes_all(1);
    poly_clear(f->gradient, sizeof f->gradient);
}

/* One more vertex of the other core, from which v is at r; nothing where it is not near. Its factor
 * is 0 where the two overlap by themselves, 1 from sqrt(5) R on. Product and gradient grow together
 * by the rule for products, in the order of the vertices. */
BRC_LANES_INLINE void poly_fading_add(struct poly_fading *f, const brc_lanes r[3], brc_mask is_near,
                                      const struct poly_lengths *len)
{
    const double range2 = len->contact_distance * len->contact_distance;
    const double per2 = 1 / (len->fade * len->fade);
    brc_lanes slope, far = (brc_lanes_dot(r, r) - range2) * per2;
    brc_lanes s = poly_smooth(brc_lanes_pick(is_near, far, brc_lanes_all(1)), &slope);
    for (int k = 0; k < 3; k++)
        f->gradient[k] = f->gradient[k] * s + f->product * (r[k] * (2 * per2 * slope));
    f->product *= s;
}

/* Weight of the springs of vertices v, from 1/2 where a vertex of the other core overlaps it (and
 * has the other half) to 1. */
BRC_LANES_INLINE void poly_weigh_vertex(struct poly_geometry4 *t, const brc_lanes v[3],
                                        brc_lanes sign, const struct poly_fading *f)
{
    brc_lanes arm[3];
    t->weight = 0.5 + 0.5 * f->product;
    poly_scale3(t->g, f->gradient, 0.5 * sign);
    poly_sub3(arm, v, t->x);
    brc_lanes_cross(t->c, arm, t->g);
}

/* --- edges ------------------------------------------------------------------------------------ */

/* Four pairs of edges, p0 + s a and q0 + t b, with what their common perpendicular has to say. */
struct poly_crossings {
    brc_lanes m[3], per_m, rm;   /* a x b of edges as they are, 1 / m . m, r . m */
    brc_lanes r[3], r2;          /* from p0 to q0, r . r */
    brc_lanes a[3], b[3];        /* unit directions */
    brc_lanes c, sin2, per_sin2; /* cosine, squared sine of the angle */
    brc_lanes ta, tb, la, lb;    /* m, closest points of the lines along the edges; lengths */
    brc_lanes ra, rb;            /* r . a, r . b */
    brc_mask skew;               /* not parallel */
};

/* Returns where both closest points of the lines are strictly inside edges that are not parallel.
 */
BRC_LANES_INLINE brc_mask poly_cross_edges(struct poly_crossings *x, brc_lanes p[4][3])
{
    poly_sub3(x->a, p[1], p[0]);
    poly_sub3(x->b, p[3], p[2]);
    poly_sub3(x->r, p[2], p[0]);
    brc_lanes_cross(x->m, x->a, x->b);
    brc_lanes la2 = brc_lanes_dot(x->a, x->a), lb2 = brc_lanes_dot(x->b, x->b),
              m2 = brc_lanes_dot(x->m, x->m);
    brc_lanes c = brc_lanes_dot(x->a, x->b), ra = brc_lanes_dot(x->r, x->a),
              rb = brc_lanes_dot(x->r, x->b);
    brc_lanes ta = ra * lb2 - c * rb, tb = c * ra - rb * la2;
    /* Compared as products, without a division: lengths of zero and parallel edges make no
     * exception, and results scale with the sample. */
    x->skew = brc_lanes_less(POLY_PARALLEL * la2 * lb2, m2);
    brc_mask inside = x->skew & poly_positive(ta) & brc_lanes_less(ta, m2) & poly_positive(tb) &
                      brc_lanes_less(tb, m2);
    x->rm = brc_lanes_dot(x->r, x->m);
    x->r2 = brc_lanes_dot(x->r, x->r);
    x->la = brc_lanes_sqrt(la2);
    x->lb = brc_lanes_sqrt(lb2);
    /* One division for both lengths: a division takes as long as four products of lanes. */
    brc_lanes per = 1 / (x->la * x->lb), per_a = per * x->lb, per_b = per * x->la, per_m = 1 / m2;
    x->per_m = per_m;
    poly_scale3(x->a, x->a, per_a);
    poly_scale3(x->b, x->b, per_b);
    x->c = c * per;
    x->sin2 = m2 * (per * per);
    x->per_sin2 = la2 * lb2 * per_m;
    x->ta = ta * per_m * x->la;
    x->tb = tb * per_m * x->lb;
    x->ra = ra * per_a;
    x->rb = rb * per_b;
    return inside;
}

BRC_LANES_INLINE brc_lanes poly_clamp(brc_lanes x, brc_lanes high)
{
    return brc_lanes_min(brc_lanes_max(x, brc_lanes_all(0)), high);
}

/* Closest points of the closed edges, s and t along them. The closest point on one line, cut to its
 * edge; then the closest to that on the other edge, cut; then the first once more. For two segments
 * that is the end of it. */
BRC_LANES_INLINE void poly_closest_on_edges(brc_lanes *s, brc_lanes *t,
                                            const struct poly_crossings *x)
{
    *s = poly_clamp(x->ta, x->la);
    *t = poly_clamp(*s * x->c - x->rb, x->lb);
    *s = poly_clamp(*t * x->c + x->ra, x->la);
}

/* From the point at s of the edges a to that at t of the edges b; returns their distance. */
BRC_LANES_INLINE brc_lanes poly_edge_distance(brc_lanes r[3], const struct poly_crossings *x,
                                              brc_lanes s, brc_lanes t)
{
    for (int k = 0; k < 3; k++)
        r[k] = x->r[k] + t * x->b[k] - s * x->a[k];
    return brc_lanes_sqrt(brc_lanes_dot(r, r)); /* eq:gt12:1 */
}

/* Of closed edges: a bound for every rule, as none has springs at a greater distance. */
BRC_LANES_INLINE brc_lanes poly_edge_gap(const struct poly_crossings *x, double contact_distance)
{
    brc_lanes s, t, r[3];
    poly_closest_on_edges(&s, &t, x);
    return poly_edge_distance(r, x, s, t) - contact_distance;
}

/* The path that may bring the closest point of the common perpendicular on an edge to its end, at u
 * along it with sign pointing out, which it is beyond. With unit directions a (out of this end) and
 * b (of the other edge), and r from the end to a point of the other edge, it is beyond the end
 * while r . out > 0, where out = a - (a . b) b. A relative path of the bodies by s, which turns
 * them by at most s / reach, changes r by at most s and out by at most s / reach. ru and rt are
 * products of both directions with the vector from the edge's start to that of the other one. */
BRC_LANES_INLINE brc_lanes poly_path_to_end(const struct poly_crossings *x, brc_lanes u,
                                            double sign, brc_lanes ru, brc_lanes rt,
                                            brc_lanes length, brc_lanes reach, double skin)
{
    brc_lanes t = poly_clamp(u * x->c - rt, length), along = ru + t * x->c - u;
    brc_lanes out = sign * (along - x->c * (rt + t - u * x->c));
    brc_lanes far2 = x->r2 + t * t + u * u + 2 * (t * rt - u * ru - t * u * x->c);
    brc_lanes far = brc_lanes_sqrt(brc_lanes_max(far2, brc_lanes_all(0)));
    return out / (brc_lanes_sqrt(x->sin2) + (far + skin) / reach);
}

/* Relative path that may bring both closest points inside their edges. The largest of the four
 * ends' bounds: as long as one of them holds, the pair cannot cross. */
BRC_LANES_INLINE brc_lanes poly_path_to_inside(const struct poly_crossings *x, brc_lanes reach,
                                               double skin)
{
    const brc_lanes none = brc_lanes_all(0);
    brc_lanes path = poly_path_to_end(x, none, -1, x->ra, x->rb, x->lb, reach, skin);
    path = brc_lanes_max(path, poly_path_to_end(x, x->la, 1, x->ra, x->rb, x->lb, reach, skin));
    path = brc_lanes_max(path, poly_path_to_end(x, none, -1, -x->rb, -x->ra, x->la, reach, skin));
    return brc_lanes_max(path, poly_path_to_end(x, x->lb, 1, -x->rb, -x->ra, x->la, reach, skin));
}

/* Relative path for which both closest points surely stay inside their edges, and move by less than
 * `most`. By a shift of s one moves by s / sin, by a turn of s / reach by the distance over sin^2
 * times that; twice as much while the sine changes by a quarter at most. */
BRC_LANES_INLINE brc_lanes poly_path_inside(const struct poly_crossings *x, brc_lanes reach,
                                            brc_lanes d, double most)
{
    brc_lanes sine = brc_lanes_sqrt(x->sin2);
    brc_lanes far =
        brc_lanes_min(brc_lanes_min(x->ta, x->la - x->ta), brc_lanes_min(x->tb, x->lb - x->tb));
    far = brc_lanes_min(far, brc_lanes_all(most));
    brc_lanes path = 0.5 * far * reach * x->sin2 / (sine * reach + brc_lanes_abs(d));
    return brc_lanes_min(path, 0.25 * sine * reach);
}

/* Weight of a point at t on an edge: 0 at its ends, full from the fade length inside. */
BRC_LANES_INLINE brc_lanes poly_edge_weight(brc_lanes t, brc_lanes length, double per_fade,
                                            brc_lanes *slope)
{
    brc_lanes s0, s1, w0 = poly_smooth(t * per_fade, &s0),
                      w1 = poly_smooth((length - t) * per_fade, &s1);
    *slope = (s0 * w1 - w0 * s1) * per_fade;
    return w0 * w1;
}

/* Weight of crossing edges with distance d along n, and the gradient parts g and c; see README.md
 * for the derivation. */
BRC_LANES_INLINE void poly_weigh_crossing(struct poly_geometry4 *t, const struct poly_crossings *x,
                                          double fade, brc_lanes d)
{
    const double per_fade = 1 / fade, per_skew = 1 / POLY_SKEW;
    brc_lanes da, db, dp, bn[3], ba[3], gn[3], per = x->per_sin2;
    brc_lanes wa = poly_edge_weight(x->ta, x->la, per_fade, &da);
    brc_lanes wb = poly_edge_weight(x->tb, x->lb, per_fade, &db);
    brc_lanes wp = poly_smooth(x->sin2 * per_skew, &dp);
    brc_lanes by_a = da * wb * wp, by_b = wa * db * wp, by_angle = wa * wb * dp * per_skew;
    t->weight = wa * wb * wp;
    brc_lanes_cross(bn, x->b, t->n);
    brc_lanes_cross(ba, x->b, x->a);
    for (int i = 0; i < 3; i++) {
        t->g[i] = (by_a * (x->a[i] - x->c * x->b[i]) + by_b * (x->c * x->a[i] - x->b[i])) * per;
        t->c[i] = -(d * per * (x->c * by_a + by_b) * bn[i] + 2 * x->c * by_angle * ba[i]);
    }
    /* from the closest point on b to the middle */
    brc_lanes_cross(gn, t->n, t->g);
    poly_axpy3(t->c, 0.5 * d, gn);
}

/* Edges that cross, with both closest points inside. Returns where they touch. A distance below
 * minus that of contact is no contact: edges so far past each other belong to other features. */
BRC_LANES_INLINE brc_mask poly_crossing_geometry(struct poly_geometry4 *t,
                                                 const struct poly_lengths *len,
                                                 const struct poly_crossings *x, brc_mask inside,
                                                 const brc_lanes p0[3], brc_lanes *side,
                                                 brc_lanes reach, const enum poly_rule rule)
{
    brc_lanes root_m = brc_lanes_sqrt(x->per_m), d = x->rm * root_m;
    brc_lanes met = brc_lanes_pick(poly_positive(-d), brc_lanes_all(-1), brc_lanes_all(1));
    *side = brc_lanes_pick(poly_positive(brc_lanes_abs(*side)), *side, met);
    d *= *side;
    brc_mask touches = inside & poly_overlap(t, d, x->m, root_m * *side, len->contact_distance) &
                       brc_lanes_less(brc_lanes_all(-len->contact_distance), d);
    const double most = rule == POLY_CLOSED ? POLY_PLACE * len->fade : HUGE_VAL;
    t->valid_path = t->delta;
    if (rule != POLY_MERGED)
        t->valid_path = brc_lanes_min(t->delta, poly_path_inside(x, reach, d, most));
    for (int k = 0; k < 3; k++)
        t->x[k] = p0[k] + x->ta * x->a[k] + 0.5 * d * t->n[k];
    poly_full_weight(t);
    if (rule == POLY_MERGED)
        poly_weigh_crossing(t, x, len->fade, d);
    return touches & poly_positive(t->weight);
}

/* Relative path for which the closest points of closed edges, which are not both inside, move
 * hardly farther than the bodies do. The distance is a convex function, so they do as long as one
 * of them is at an end; inside edges that are almost parallel they run from end to end on a path of
 * next to nothing. None for those that count as parallel, or may come to. */
BRC_LANES_INLINE brc_lanes poly_path_beyond(const struct poly_crossings *x, brc_lanes reach,
                                            double skin)
{
    brc_mask skew = brc_lanes_less(brc_lanes_all(4 * POLY_PARALLEL), x->sin2);
    brc_lanes path = poly_path_to_inside(x, reach, skin);
    return brc_lanes_where(skew, brc_lanes_min(path, 0.5 * brc_lanes_sqrt(x->sin2) * reach));
}

/* Edges of `closed`, wherever their closest points are; parallel ones touch in the middle of the
 * part where they face each other. */
BRC_LANES_INLINE brc_mask poly_closed_geometry(struct poly_geometry4 *t,
                                               const struct poly_lengths *len,
                                               const struct poly_crossings *x,
                                               const brc_lanes p0[3], brc_lanes reach)
{
    brc_lanes s, u, r[3], low = x->ra, high = x->ra + x->c * x->lb;
    poly_closest_on_edges(&s, &u, x);
    brc_lanes middle = 0.5 * (poly_clamp(brc_lanes_min(low, high), x->la) +
                              poly_clamp(brc_lanes_max(low, high), x->la));
    s = brc_lanes_pick(x->skew, s, middle);
    u = brc_lanes_pick(x->skew, u, poly_clamp(x->c * (middle - low), x->lb));
    brc_lanes d = poly_edge_distance(r, x, s, u);
    brc_mask touches = poly_overlap(t, d, r, 1 / d, len->contact_distance) & poly_positive(d);
    t->valid_path =
        brc_lanes_min(brc_lanes_min(t->delta, d), poly_path_beyond(x, reach, len->skin));
    for (int k = 0; k < 3; k++)
        t->x[k] = p0[k] + s * x->a[k] + 0.5 * r[k];
    poly_full_weight(t);
    return touches;
}

BRC_LANES_INLINE void poly_pick_geometry(struct poly_geometry4 *t, brc_mask m,
                                         const struct poly_geometry4 *other)
{
    t->delta = brc_lanes_pick(m, t->delta, other->delta);
    t->weight = brc_lanes_pick(m, t->weight, other->weight);
    t->valid_path = brc_lanes_pick(m, t->valid_path, other->valid_path);
    for (int k = 0; k < 3; k++) {
        t->n[k] = brc_lanes_pick(m, t->n[k], other->n[k]);
        t->x[k] = brc_lanes_pick(m, t->x[k], other->x[k]);
    }
}

/* Edges p[0] p[1] of a and p[2] p[3] of b. The side on which crossing ones met, +1 or -1, keeps
 * edges that have passed through each other pushed back; 0: not known, and known afterwards, but
 * for edges of `closed` that do not cross. Returns where they touch; elsewhere -delta is the path
 * that they are free for. */
BRC_LANES_INLINE brc_mask poly_edge_geometry(struct poly_geometry4 *t,
                                             const struct poly_lengths *len, brc_lanes p[4][3],
                                             brc_lanes *side, brc_lanes reach,
                                             const enum poly_rule rule)
{
    struct poly_crossings x;
    brc_mask inside = poly_cross_edges(&x, p);
    brc_mask touches = poly_crossing_geometry(t, len, &x, inside, p[0], side, reach, rule);
    /* Both for all lanes, as edges that cross inside and edges that do not may share a four. */
    if (rule == POLY_CLOSED) {
        struct poly_geometry4 closed;
        brc_mask touches_closed = poly_closed_geometry(&closed, len, &x, p[0], reach);
        poly_pick_geometry(t, touches, &closed);
        *side = brc_lanes_where(touches, *side);
        touches |= touches_closed;
    } else if (brc_lanes_any(~touches)) {
        brc_lanes free = poly_path_to_inside(&x, reach, len->skin);
        brc_lanes path = brc_lanes_max(poly_edge_gap(&x, len->contact_distance), free);
        t->delta = brc_lanes_pick(touches, t->delta, -path);
        if (rule == POLY_MERGED)
            t->fades = poly_positive(free);
    }
    poly_hide_apart(t, touches);
    return touches;
}

#endif
