/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distances of features: vertex to face, vertex to core, edge to edge (eq 1). Points are in the
 * body frame of the core that owns the face; edges in any common frame. No length or angle is
 * compared with an absolute number: results scale with the sample. */
#ifndef POLY_DISTANCE_H
#define POLY_DISTANCE_H

#include "shape.h"

#include "common/geometry/vec.h"

/* Edges count as parallel when the squared sine of their angle is below this. */
#define POLY_PARALLEL 1e-12

/* fmin and fmax are calls; these are instructions. */
static inline double poly_least(double a, double b)
{
    return a < b ? a : b;
}

static inline double poly_most(double a, double b)
{
    return a > b ? a : b;
}

/* The place on a core that is closest to a point. A place is named by a code: 4 x index + kind. */
enum poly_place { POLY_ON_FACE, POLY_ON_EDGE, POLY_ON_VERTEX };

struct poly_foot {
    double s;    /* distance, negative inside the core */
    double n[3]; /* unit, from the core to the point: gradient of s */
    int32_t place;
};

static inline int32_t poly_place(int32_t index, enum poly_place kind)
{
    return 4 * index + (int32_t)kind;
}

static inline double poly_height(const struct poly_face *f, const double p[3])
{
    return brc_dot(f->n, p) - f->d;
}

/* Side of the face that the foot of p is farthest outside of; -1 when it is strictly inside. */
static inline int32_t poly_outside(const struct poly_core *c, const struct poly_face *f,
                                   const double p[3])
{
    int32_t worst = -1;
    double most = 0;
    for (int32_t k = f->first; k < f->first + f->n_sides; k++) {
        double out = brc_dot(c->side[k].m, p) - c->side[k].off;
        if (out >= most) {
            most = out;
            worst = k;
        }
    }
    return worst;
}

/* True when the foot of p on the plane of the face is strictly inside the face. */
static inline bool poly_above(const struct poly_core *c, const struct poly_face *f,
                              const double p[3])
{
    const struct poly_side *side = c->side + f->first;
    for (int32_t k = 0; k < f->n_sides; k++)
        if (brc_dot(side[k].m, p) >= side[k].off)
            return false;
    return true;
}

/* Face whose plane p is highest above; inside the core this is the nearest face. */
static inline int32_t poly_highest(const struct poly_core *c, const double p[3], double *height)
{
    int32_t best = 0;
    double most = poly_height(&c->face[0], p);
    for (int32_t f = 1; f < c->n_faces; f++) {
        double h = poly_height(&c->face[f], p);
        if (h > most) {
            most = h;
            best = f;
        }
    }
    *height = most;
    return best;
}

static inline void poly_foot_face(struct poly_foot *r, const struct poly_core *c, int32_t f,
                                  double height)
{
    r->s = height;
    brc_copy(r->n, c->face[f].n);
    r->place = poly_place(f, POLY_ON_FACE);
}

/* Foot at a point x of the core's surface; on the surface itself the given normal stands in. */
static inline void poly_foot_point(struct poly_foot *r, const double p[3], const double x[3],
                                   const double stand_in[3], int32_t place)
{
    brc_sub(r->n, p, x);
    r->s = brc_normalise(r->n, r->n);
    if (r->s == 0)
        brc_copy(r->n, stand_in);
    r->place = place;
}

/* Foot of p on the line of an edge, in parts of it from its first end; along is the whole edge. */
static inline double poly_along_edge(const struct poly_core *c, int32_t edge, const double p[3],
                                     double along[3])
{
    const double *v0 = c->vertex[c->end[edge][0]];
    double r[3];
    brc_sub(along, c->vertex[c->end[edge][1]], v0);
    brc_sub(r, p, v0);
    return brc_dot(r, along) / brc_norm2(along);
}

/* Distance of p to a closed edge, whose closest point goes to x. */
static inline double poly_to_edge(const struct poly_core *c, int32_t edge, const double p[3],
                                  double x[3])
{
    double along[3], r[3], t = poly_along_edge(c, edge, p, along);
    brc_copy(x, c->vertex[c->end[edge][0]]);
    brc_axpy(x, poly_least(poly_most(t, 0), 1), along);
    brc_sub(r, p, x);
    return brc_norm(r);
}

/* Closest point of the core to p by trying every edge: where the walk does not settle. */
static inline void poly_foot_search(struct poly_foot *r, const struct poly_core *c,
                                    const double p[3])
{
    double best = HUGE_VAL;
    poly_foot_face(r, c, 0, best);
    for (int32_t f = 0; f < c->n_faces; f++) {
        double h = poly_height(&c->face[f], p);
        if (h >= 0 && h < best && poly_above(c, &c->face[f], p)) {
            best = h;
            poly_foot_face(r, c, f, h);
        }
    }
    for (int32_t e = 0; e < c->n_edges; e++) {
        double x[3], d = poly_to_edge(c, e, p, x);
        if (d < best) {
            best = d;
            poly_foot_point(r, p, x, c->face[c->edge[e].face[0]].n, poly_place(e, POLY_ON_EDGE));
        }
    }
}

/* One step of the walk from an edge: the next place, or the same when the foot is on this edge. */
static inline int32_t poly_walk_edge(struct poly_foot *r, const struct poly_core *c, int32_t index,
                                     const double p[3])
{
    const struct poly_edge *e = &c->edge[index];
    double along[3], x[3], t = poly_along_edge(c, index, p, along);
    if (t <= 0)
        return poly_place(c->end[index][0], POLY_ON_VERTEX);
    if (t >= 1)
        return poly_place(c->end[index][1], POLY_ON_VERTEX);
    for (int k = 0; k < 2; k++) {
        const struct poly_side *side = &c->side[e->side[k]];
        if (brc_dot(side->m, p) < side->off)
            return poly_place(e->face[k], POLY_ON_FACE);
    }
    brc_copy(x, c->vertex[c->end[index][0]]);
    brc_axpy(x, t, along);
    poly_foot_point(r, p, x, c->face[e->face[0]].n, poly_place(index, POLY_ON_EDGE));
    return r->place;
}

static inline int32_t poly_walk_vertex(struct poly_foot *r, const struct poly_core *c,
                                       int32_t index, const double p[3])
{
    double q[3], most = 0;
    int32_t next = -1;
    brc_sub(q, p, c->vertex[index]);
    for (int32_t k = c->star_first[index]; k < c->star_first[index + 1]; k++) {
        int32_t e = c->star[k];
        double along[3];
        brc_sub(along, c->vertex[c->end[e][0] + c->end[e][1] - index], c->vertex[index]);
        double t = brc_dot(q, along);
        if (t > most) {
            most = t;
            next = e;
        }
    }
    if (next >= 0)
        return poly_place(next, POLY_ON_EDGE);
    poly_foot_point(r, p, c->vertex[index],
                    c->face[c->edge[c->star[c->star_first[index]]].face[0]].n,
                    poly_place(index, POLY_ON_VERTEX));
    return r->place;
}

/* From a face: settled when p is above it; below its plane the highest face is the next. */
static inline int32_t poly_walk_face(struct poly_foot *r, const struct poly_core *c, int32_t index,
                                     const double p[3])
{
    double h = poly_height(&c->face[index], p);
    if (h < 0) {
        int32_t high = poly_highest(c, p, &h);
        if (h > 0 && high != index)
            return poly_place(high, POLY_ON_FACE);
        if (h <= 0) {
            poly_foot_face(r, c, high, h);
            return r->place;
        }
    }
    int32_t out = poly_outside(c, &c->face[index], p);
    if (out >= 0)
        return poly_place(c->link[out].edge, POLY_ON_EDGE);
    poly_foot_face(r, c, index, h);
    return r->place;
}

/* Signed distance of p to the core: a walk over neighbouring places from a remembered one. The
 * surface is convex, so where the walk settles is the closest place, wherever it began. */
static inline void poly_foot_walk(struct poly_foot *r, const struct poly_core *c, const double p[3],
                                  int32_t place)
{
    for (int tries = 0; tries < 32; tries++) {
        int32_t next = 0, index = place >> 2;
        r->place = -1;
        switch (place & 3) {
        case POLY_ON_FACE:
            next = poly_walk_face(r, c, index, p);
            break;
        case POLY_ON_EDGE:
            next = poly_walk_edge(r, c, index, p);
            break;
        default:
            next = poly_walk_vertex(r, c, index, p);
        }
        if (r->place >= 0)
            return;
        place = next;
    }
    double h;
    int32_t high = poly_highest(c, p, &h);
    if (h <= 0)
        poly_foot_face(r, c, high, h);
    else
        poly_foot_search(r, c, p);
}

/* Unsigned distance of p to a closed face (eq 1), from outside or inside. */
static inline void poly_foot_closed(struct poly_foot *r, const struct poly_core *c, int32_t index,
                                    const double p[3])
{
    const struct poly_face *f = &c->face[index];
    if (poly_outside(c, f, p) < 0) {
        double h = poly_height(f, p);
        poly_foot_face(r, c, index, fabs(h));
        if (h < 0)
            brc_scale(r->n, r->n, -1);
        return;
    }
    double best = HUGE_VAL, nearest[3] = {0, 0, 0};
    for (int32_t k = f->first; k < f->first + f->n_sides; k++) {
        double x[3], d = poly_to_edge(c, c->link[k].edge, p, x);
        if (d < best) {
            best = d;
            brc_copy(nearest, x);
        }
    }
    poly_foot_point(r, p, nearest, f->n, poly_place(index, POLY_ON_FACE));
}

/* The lines of two edges p0 + s a and q0 + t b, s and t in [0, 1] on the edges; no division yet. */
struct poly_lines {
    double a[3], b[3], r[3]; /* r = q0 - p0 */
    double m[3], m2;         /* a x b */
    double c;                /* a . b */
    double la2, lb2;         /* squared lengths */
    double s, t;             /* feet of the common perpendicular, times m2 */
};

/* False when the edges are parallel (relative test). */
static inline bool poly_cross_lines(struct poly_lines *x, const double p0[3], const double p1[3],
                                    const double q0[3], const double q1[3])
{
    brc_sub(x->a, p1, p0);
    brc_sub(x->b, q1, q0);
    brc_sub(x->r, q0, p0);
    x->la2 = brc_norm2(x->a);
    x->lb2 = brc_norm2(x->b);
    brc_cross(x->m, x->a, x->b);
    x->m2 = brc_norm2(x->m);
    x->c = brc_dot(x->a, x->b);
    double ra = brc_dot(x->r, x->a), rb = brc_dot(x->r, x->b);
    x->s = ra * x->lb2 - x->c * rb;
    x->t = x->c * ra - rb * x->la2;
    return x->m2 > POLY_PARALLEL * x->la2 * x->lb2;
}

/* True when both feet are strictly inside their edges. */
static inline bool poly_feet_inside(const struct poly_lines *x)
{
    return x->s > 0 && x->s < x->m2 && x->t > 0 && x->t < x->m2;
}

/* Two edges that cross: the closest points of their lines. */
struct poly_crossing {
    double a[3], b[3]; /* unit directions */
    double c, sin2;    /* cosine, squared sine of the angle */
    double ta, tb;     /* m, feet along the edges */
    double la, lb;     /* m, lengths */
    double cross[3];   /* unit a x b */
    double d;          /* m, from line a to line b along cross */
};

static inline void poly_cross_edges(struct poly_crossing *x, const struct poly_lines *l)
{
    x->la = sqrt(l->la2);
    x->lb = sqrt(l->lb2);
    double per_a = 1 / x->la, per_b = 1 / x->lb, per_m = 1 / l->m2;
    brc_scale(x->a, l->a, per_a);
    brc_scale(x->b, l->b, per_b);
    x->c = l->c * per_a * per_b;
    x->sin2 = l->m2 * (per_a * per_a) * (per_b * per_b);
    x->ta = l->s * per_m * x->la;
    x->tb = l->t * per_m * x->lb;
    brc_scale(x->cross, l->m, sqrt(per_m));
    x->d = brc_dot(l->r, x->cross);
}

static inline double poly_clamp(double t, double high)
{
    return poly_least(poly_most(t, 0), high);
}

/* Feet of the closest points of two closed edges (eq 1), in [0, 1]. Parallel edges: the middle of
 * the part where they face each other. */
static inline void poly_closed_feet(const struct poly_lines *x, bool parallel, double *s, double *t)
{
    double ra = brc_dot(x->r, x->a), rb = brc_dot(x->r, x->b);
    if (parallel) {
        double low = ra / x->la2, part = sqrt(x->lb2 / x->la2),
               high = low + (x->c > 0 ? part : -part);
        double from = poly_clamp(poly_least(low, high), 1),
               to = poly_clamp(poly_most(low, high), 1);
        *s = (from + to) / 2;
        *t = poly_clamp((*s - low) / (high - low), 1);
        return;
    }
    *s = poly_clamp(x->s / x->m2, 1);
    *t = (*s * x->c - rb) / x->lb2;
    if (*t < 0 || *t > 1) {
        *t = poly_clamp(*t, 1);
        *s = poly_clamp((*t * x->c + ra) / x->la2, 1);
    }
}

/* Vector between the closest points of two closed edges (eq 1); returns its length. */
static inline double poly_between_edges(double r[3], double *s, const struct poly_lines *x,
                                        bool parallel)
{
    double t;
    poly_closed_feet(x, parallel, s, &t);
    for (int i = 0; i < 3; i++)
        r[i] = x->r[i] + t * x->b[i] - *s * x->a[i];
    return brc_norm(r); /* eq:gt12:1 */
}

/* Distance of two closed edges. */
static inline double poly_edge_distance(const double p0[3], const double p1[3], const double q0[3],
                                        const double q1[3])
{
    struct poly_lines x;
    double r[3], s;
    bool parallel = !poly_cross_lines(&x, p0, p1, q0, q1);
    return poly_between_edges(r, &s, &x, parallel);
}

#endif
