/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How four points of a list touch: vertices and edges. */
#ifndef POLY_TOUCHES_H
#define POLY_TOUCHES_H

#include "polyhedra/poly.h"

/* --- vectors of lanes ------------------------------------------------------------------------- */

BRC_LANES_INLINE brc_lanes gather(const double *column, const int32_t i[BRC_LANES])
{
    return (brc_lanes){column[i[0]], column[i[1]], column[i[2]], column[i[3]]};
}

BRC_LANES_INLINE void set(brc_lanes r[3], brc_lanes x, brc_lanes y, brc_lanes z)
{
    r[0] = x;
    r[1] = y;
    r[2] = z;
}

BRC_LANES_INLINE void add(brc_lanes r[3], const brc_lanes a[3], const brc_lanes b[3])
{
    set(r, a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}

BRC_LANES_INLINE void sub(brc_lanes r[3], const brc_lanes a[3], const brc_lanes b[3])
{
    set(r, a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

BRC_LANES_INLINE void scale(brc_lanes r[3], const brc_lanes a[3], brc_lanes s)
{
    set(r, a[0] * s, a[1] * s, a[2] * s);
}

/* r += s a */
BRC_LANES_INLINE void axpy(brc_lanes r[3], brc_lanes s, const brc_lanes a[3])
{
    set(r, r[0] + s * a[0], r[1] + s * a[1], r[2] + s * a[2]);
}

BRC_LANES_INLINE void mask(brc_lanes r[3], brc_mask m, const brc_lanes a[3])
{
    set(r, brc_lanes_where(m, a[0]), brc_lanes_where(m, a[1]), brc_lanes_where(m, a[2]));
}

/* Where a > 0. */
BRC_LANES_INLINE brc_mask positive(brc_lanes a)
{
    return brc_lanes_less(brc_lanes_all(0), a);
}

/* What memset would do, by stores of lanes: compilers must not see that it is 0, lest they call it.
 */
BRC_LANES_INLINE void clear(brc_lanes *x, size_t size)
{
    double none = 0;
    __asm__("" : "+x"(none));
    for (size_t i = 0; i < size / sizeof *x; i++)
        x[i] = brc_lanes_all(none);
}

/* --- touches ---------------------------------------------------------------------------------- */

BRC_LANES_INLINE void full_weight(struct poly_touches *t)
{
    t->fades = (brc_mask){0};
    t->weight = brc_lanes_all(1);
    for (int k = 0; k < 3; k++)
        t->g[k] = t->c[k] = brc_lanes_all(0);
}

/* Touches that are apart: no weight; delta is what they say of the gap. */
BRC_LANES_INLINE void hide_apart(struct poly_touches *t, brc_mask touches)
{
    t->weight = brc_lanes_where(touches, t->weight);
    mask(t->n, touches, t->n);
    mask(t->x, touches, t->x);
    mask(t->g, touches, t->g);
    mask(t->c, touches, t->c);
}

/* poly_smooth; slope is its derivative. */
BRC_LANES_INLINE brc_lanes smooth(brc_lanes x, brc_lanes *slope)
{
    x = brc_lanes_min(brc_lanes_max(x, brc_lanes_all(0)), brc_lanes_all(1));
    *slope = 6 * x * (1 - x);
    return x * x * (3 - 2 * x);
}

/* Distance s and outward normal n of v from planes. */
BRC_LANES_INLINE void foot_on_plane(brc_lanes *s, brc_lanes n[3], const struct poly_block *block,
                                    const brc_lanes v[3], const int32_t *const item[])
{
    const double *plane[BRC_LANES];
    brc_lanes p[BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++)
        plane[k] = block->st->plane[item[k][POLY_ITEM_PLACE]];
    brc_lanes_gather4(p, plane);
    set(n, p[0], p[1], p[2]);
    *s = brc_lanes_dot(n, v) - p[3];
}

/* Distance s and outward normal n of v from edges or vertices. */
BRC_LANES_INLINE void foot_on_edge(brc_lanes *s, brc_lanes n[3], const struct poly_block *block,
                                   const brc_lanes v[3], const int32_t *const item[])
{
    double(*world)[3] = block->st->world;
    int32_t i[2][BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++) {
        i[0][k] = item[k][POLY_ITEM_PLACE];
        i[1][k] = item[k][POLY_ITEM_PLACE + 1];
    }
    brc_lanes p[3], along[3];
    brc_lanes_gather3(p, world, i[0]);
    brc_lanes_gather3(along, world, i[1]);
    sub(along, along, p);
    sub(n, v, p);
    brc_lanes length2 = brc_lanes_dot(along, along);
    brc_lanes part = brc_lanes_where(positive(length2), brc_lanes_dot(n, along) / length2);
    axpy(n, -part, along);
    *s = brc_lanes_sqrt(brc_lanes_dot(n, n));
    scale(n, n, 1 / *s);
}

/* Number of vertex i of the other core that may lower the weight, or -1. */
BRC_LANES_INLINE int32_t near_vertex(const int32_t *item, int32_t i)
{
    const int32_t *near = item + POLY_ITEM_NEAR;
    if (i >= item[POLY_ITEM_LIST] >> POLY_NEAR_SHIFT)
        return -1;
    return item[POLY_ITEM_LIST] & POLY_IN_TURN ? near[0] + i : near[i];
}

/* poly_weigh_vertex */
BRC_LANES_INLINE void weigh_vertex(struct poly_touches *t, const struct poly_block *block,
                                   const brc_lanes v[3], brc_lanes sign,
                                   const int32_t *const item[], int32_t n_near)
{
    const double rest2 = block->rest * block->rest, per2 = 1 / (block->ell * block->ell);
    brc_lanes product = brc_lanes_all(1), total[3], arm[3];
    clear(total, sizeof total);
    for (int32_t i = 0; i < n_near; i++) {
        int32_t u[BRC_LANES];
        brc_mask is_near;
        brc_lanes r[3], slope;
        for (int k = 0; k < BRC_LANES; k++) {
            u[k] = near_vertex(item[k], i);
            is_near[k] = u[k] < 0 ? 0 : -1;
            u[k] = u[k] < 0 ? item[k][POLY_ITEM_VERTEX] : u[k];
        }
        brc_lanes_gather3(r, block->st->world, u);
        sub(r, v, r);
        brc_lanes far = (brc_lanes_dot(r, r) - rest2) * per2;
        brc_lanes s = smooth(brc_lanes_pick(is_near, far, brc_lanes_all(1)), &slope);
        for (int k = 0; k < 3; k++)
            total[k] = total[k] * s + product * (r[k] * (2 * per2 * slope));
        product *= s;
    }
    t->weight = 0.5 + 0.5 * product;
    scale(t->g, total, 0.5 * sign);
    sub(arm, v, t->x);
    brc_lanes_cross(t->c, arm, t->g);
}

BRC_LANES_INLINE void touch_vertices(struct poly_touches *t, const struct poly_block *block,
                                     const struct poly_task *task, const bool flat)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const int32_t *item[BRC_LANES];
    int32_t vertex[BRC_LANES], n_near = 0;
    brc_lanes v[3], s, out[3], sign;
    for (int k = 0; k < BRC_LANES; k++) {
        item[k] = points->item[task[k].point];
        vertex[k] = item[k][POLY_ITEM_VERTEX];
        sign[k] = item[k][POLY_ITEM_LIST] & POLY_OF_A ? -1 : 1;
        n_near = item[k][POLY_ITEM_LIST] >> POLY_NEAR_SHIFT > n_near
                     ? item[k][POLY_ITEM_LIST] >> POLY_NEAR_SHIFT
                     : n_near;
    }
    brc_lanes_gather3(v, block->st->world, vertex);
    if (flat)
        foot_on_plane(&s, out, block, v, item);
    else
        foot_on_edge(&s, out, block, v, item);
    t->delta = t->lasts = block->rest - s; /* eq:gt12:5 */
    scale(t->n, out, sign);                /* eq:gt12:3 */
    for (int k = 0; k < 3; k++)
        t->x[k] = v[k] - 0.5 * s * out[k];
    full_weight(t);
    if (n_near > 0)
        weigh_vertex(t, block, v, sign, item, n_near);
    hide_apart(t, brc_lanes_less(s, brc_lanes_all(block->rest))); /* eq:gt12:2 */
}

/* poly_foot_weight */
BRC_LANES_INLINE brc_lanes foot_weight(brc_lanes t, brc_lanes length, double per_ell,
                                       brc_lanes *slope)
{
    brc_lanes s0, s1, w0 = smooth(t * per_ell, &s0), w1 = smooth((length - t) * per_ell, &s1);
    *slope = (s0 * w1 - w0 * s1) * per_ell;
    return w0 * w1;
}

/* Four edge pairs, as struct poly_lines and struct poly_crossing; ra and rb are r . a and r . b
 * with the unit directions a and b, r2 is r . r. */
struct crossings {
    brc_lanes m[3], per_m, rm; /* of edges as they are; per_m: 1 / m . m */
    brc_lanes a[3], b[3], c, sin2, per_sin2, ta, tb, la, lb, ra, rb, r2;
};

/* poly_cross_lines and poly_cross_edges; returns where both feet are inside edges that cross. */
BRC_LANES_INLINE brc_mask cross_lines(struct crossings *x, brc_lanes p[4][3])
{
    brc_lanes r[3];
    sub(x->a, p[1], p[0]);
    sub(x->b, p[3], p[2]);
    sub(r, p[2], p[0]);
    brc_lanes_cross(x->m, x->a, x->b);
    brc_lanes la2 = brc_lanes_dot(x->a, x->a), lb2 = brc_lanes_dot(x->b, x->b),
              m2 = brc_lanes_dot(x->m, x->m);
    brc_lanes c = brc_lanes_dot(x->a, x->b), ra = brc_lanes_dot(r, x->a),
              rb = brc_lanes_dot(r, x->b);
    brc_lanes ta = ra * lb2 - c * rb, tb = c * ra - rb * la2;
    brc_mask inside = brc_lanes_less(POLY_PARALLEL * la2 * lb2, m2) & positive(ta) &
                      brc_lanes_less(ta, m2) & positive(tb) & brc_lanes_less(tb, m2);
    x->rm = brc_lanes_dot(r, x->m);
    x->r2 = brc_lanes_dot(r, r);
    x->la = brc_lanes_sqrt(la2);
    x->lb = brc_lanes_sqrt(lb2);
    brc_lanes per = 1 / (x->la * x->lb), per_a = per * x->lb, per_b = per * x->la, per_m = 1 / m2;
    x->per_m = per_m;
    scale(x->a, x->a, per_a);
    scale(x->b, x->b, per_b);
    x->c = c * per;
    x->sin2 = m2 * (per * per);
    x->per_sin2 = la2 * lb2 * per_m;
    x->ta = ta * per_m * x->la;
    x->tb = tb * per_m * x->lb;
    x->ra = ra * per_a;
    x->rb = rb * per_b;
    return inside;
}

BRC_LANES_INLINE brc_lanes clamp(brc_lanes x, brc_lanes high)
{
    return brc_lanes_min(brc_lanes_max(x, brc_lanes_all(0)), high);
}

/* The path that may bring the foot of the common perpendicular on an edge to its end, at u along it
 * with sign pointing out, which the foot is beyond. With unit directions a (out of this end) and b
 * (of the other edge), and r from the end to a point of the other edge, the foot is beyond the end
 * while r . out > 0, where out = a - (a . b) b. A relative path of the bodies by s, which turns
 * them by at most s / reach, changes r by at most s and out by at most s / reach. ru and rt are
 * products of both directions with the vector from the edge's start to that of the other one. */
BRC_LANES_INLINE brc_lanes path_to_end(const struct crossings *x, brc_lanes u, double sign,
                                       brc_lanes ru, brc_lanes rt, brc_lanes length,
                                       brc_lanes reach, double skin)
{
    brc_lanes t = clamp(u * x->c - rt, length), along = ru + t * x->c - u;
    brc_lanes out = sign * (along - x->c * (rt + t - u * x->c));
    brc_lanes far2 = x->r2 + t * t + u * u + 2 * (t * rt - u * ru - t * u * x->c);
    brc_lanes far = brc_lanes_sqrt(brc_lanes_max(far2, brc_lanes_all(0)));
    return out / (brc_lanes_sqrt(x->sin2) + (far + skin) / reach);
}

/* Distance of the closed edges. */
BRC_LANES_INLINE brc_lanes gap_of_edges(const struct crossings *x)
{
    brc_lanes s = clamp(x->ta, x->la), t = clamp(s * x->c - x->rb, x->lb);
    s = clamp(t * x->c + x->ra, x->la);
    brc_lanes gap2 = x->r2 + s * s + t * t + 2 * (t * x->rb - s * x->ra - s * t * x->c);
    return brc_lanes_sqrt(brc_lanes_max(gap2, brc_lanes_all(0)));
}

/* Relative path that may bring both feet inside their edges. */
BRC_LANES_INLINE brc_lanes path_to_inside(const struct crossings *x, brc_lanes reach, double skin)
{
    const brc_lanes none = brc_lanes_all(0);
    brc_lanes path = path_to_end(x, none, -1, x->ra, x->rb, x->lb, reach, skin);
    path = brc_lanes_max(path, path_to_end(x, x->la, 1, x->ra, x->rb, x->lb, reach, skin));
    path = brc_lanes_max(path, path_to_end(x, none, -1, -x->rb, -x->ra, x->la, reach, skin));
    return brc_lanes_max(path, path_to_end(x, x->lb, 1, -x->rb, -x->ra, x->la, reach, skin));
}

/* Relative path for which both feet surely stay inside their edges. By a shift of s a foot moves by
 * s / sin, by a turn of s / reach by the distance over sin^2 times that; twice as much while the
 * sine changes by a quarter at most. */
BRC_LANES_INLINE brc_lanes path_inside(const struct crossings *x, brc_lanes reach, brc_lanes d)
{
    brc_lanes sine = brc_lanes_sqrt(x->sin2);
    brc_lanes far =
        brc_lanes_min(brc_lanes_min(x->ta, x->la - x->ta), brc_lanes_min(x->tb, x->lb - x->tb));
    brc_lanes path = 0.5 * far * reach * x->sin2 / (sine * reach + brc_lanes_abs(d));
    return brc_lanes_min(path, 0.25 * sine * reach);
}

/* poly_crossing_weight */
BRC_LANES_INLINE void weigh_crossing(struct poly_touches *t, const struct crossings *x, double ell,
                                     brc_lanes d)
{
    const double per_ell = 1 / ell, per_skew = 1 / POLY_SKEW;
    brc_lanes da, db, dp, bn[3], ba[3], gn[3], per = x->per_sin2;
    brc_lanes wa = foot_weight(x->ta, x->la, per_ell, &da);
    brc_lanes wb = foot_weight(x->tb, x->lb, per_ell, &db);
    brc_lanes wp = smooth(x->sin2 * per_skew, &dp);
    brc_lanes by_a = da * wb * wp, by_b = wa * db * wp, by_angle = wa * wb * dp * per_skew;
    t->weight = wa * wb * wp;
    brc_lanes_cross(bn, x->b, t->n);
    brc_lanes_cross(ba, x->b, x->a);
    for (int i = 0; i < 3; i++) {
        t->g[i] = (by_a * (x->a[i] - x->c * x->b[i]) + by_b * (x->c * x->a[i] - x->b[i])) * per;
        t->c[i] = -(d * per * (x->c * by_a + by_b) * bn[i] + 2 * x->c * by_angle * ba[i]);
    }
    brc_lanes_cross(gn, t->n, t->g);
    axpy(t->c, 0.5 * d, gn);
}

/* poly_cross_lines, poly_cross_edges and poly_touch_crossing; side is +1 or -1 where it is known,
 * else 0, and is known afterwards. Where the edges are apart, -delta is the path that they are free
 * for. */
BRC_LANES_INLINE brc_mask touch_lines(struct poly_touches *t, const struct poly_block *block,
                                      brc_lanes p[4][3], brc_lanes *side, brc_lanes reach,
                                      const bool merged)
{
    struct crossings x;
    brc_mask inside = cross_lines(&x, p);
    brc_lanes root_m = brc_lanes_sqrt(x.per_m), d = x.rm * root_m;
    brc_mask touches = inside & brc_lanes_less(brc_lanes_abs(d), brc_lanes_all(block->rest));
    brc_lanes met = brc_lanes_pick(positive(-d), brc_lanes_all(-1), brc_lanes_all(1));
    *side = brc_lanes_pick(positive(brc_lanes_abs(*side)), *side, met);
    d *= *side;
    scale(t->n, x.m, root_m * *side); /* eq:gt12:3 */
    t->delta = block->rest - d;       /* eq:gt12:5 */
    t->lasts = merged ? t->delta : brc_lanes_min(t->delta, path_inside(&x, reach, d));
    for (int k = 0; k < 3; k++)
        t->x[k] = p[0][k] + x.ta * x.a[k] + 0.5 * d * t->n[k];
    full_weight(t);
    if (merged)
        weigh_crossing(t, &x, block->ell, d);
    touches &= positive(t->weight);
    if (brc_lanes_any(~touches)) {
        brc_lanes free = path_to_inside(&x, reach, block->skin);
        brc_lanes path = brc_lanes_max(gap_of_edges(&x) - block->rest, free);
        t->delta = brc_lanes_pick(touches, t->delta, -path);
        if (merged)
            t->fades = positive(free);
    }
    return touches;
}

BRC_LANES_INLINE void touch_edges(struct poly_touches *t, const struct poly_block *block,
                                  const struct poly_task *task, const bool merged)
{
    struct poly_points *points = block->sim->pairs.point_columns;
    int32_t end[4][BRC_LANES], *item[BRC_LANES];
    brc_lanes p[4][3], side, reach;
    for (int k = 0; k < BRC_LANES; k++) {
        item[k] = points->item[task[k].point];
        side[k] = item[k][POLY_ITEM_SIDE];
        reach[k] = poly_item_reach(item[k]);
        for (int j = 0; j < 4; j++)
            end[j][k] = item[k][POLY_ITEM_END + j];
    }
    for (int j = 0; j < 4; j++)
        brc_lanes_gather3(p[j], block->st->world, end[j]);
    hide_apart(t, touch_lines(t, block, p, &side, reach, merged));
    for (int32_t k = 0; k < BRC_LANES; k++) {
        if (item[k][POLY_ITEM_SIDE] != 0)
            continue;
        item[k][POLY_ITEM_SIDE] = side[k] < 0 ? -1 : 1;
        points->active[task[k].point] = side[k] < 0 ? 2 : 1;
    }
}

#endif
