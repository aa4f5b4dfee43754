/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Feature pairs of two cores: which can touch (lists), and how they touch now. */
#ifndef POLY_FEATURES_H
#define POLY_FEATURES_H

#include "contact.h"

enum poly_rule { POLY_CLOSED, POLY_STRICT, POLY_MERGED };
enum poly_kind { POLY_VERTEX_A, POLY_VERTEX_B, POLY_EDGES };

enum { POLY_NEAR = 4, POLY_NONE_NEAR = -1, POLY_MANY_NEAR = -2 };

/* A feature pair. POLY_VERTEX_A: vertex i of a and face j of b (merged: the place of its foot on
 * b); POLY_VERTEX_B: face (place) i of a and vertex j of b; POLY_EDGES: edges i and j. */
struct poly_feature {
    double free; /* m, relative path of the bodies before the pair can touch */
    int32_t i, j;
    int32_t near[POLY_NEAR]; /* vertices of the other core that may lower a merged vertex's weight,
                                then POLY_NONE_NEAR; the first is POLY_MANY_NEAR: more than fit */
    uint8_t kind;
};

/* The place that a feature pair remembers. */
static inline int32_t *poly_remembered(struct poly_feature *f)
{
    return f->kind == POLY_VERTEX_B ? &f->i : &f->j;
}

struct poly_list {
    struct poly_feature *feature;
    size_t n, cap;
    double *work; /* work space of listing.h */
    int32_t *edge;
    size_t cap_work, cap_edge;
};

/* Two bodies in space. */
struct poly_pair {
    struct poly_core a, b;
    const double *xa, *xb;           /* centres */
    const double (*ra)[3], (*rb)[3]; /* rotation matrices, body to space */
    const double (*va)[3], (*vb)[3]; /* core vertices in space */
    double rest;                     /* m, R1 + R2: distance without overlap */
    double ell;                      /* m, smoothing length of `merged` */
    double reach;                    /* m, smaller one of the cores' radii about their centres */
};

void poly_list_free(struct poly_list *l);
int poly_list_add(struct brc_context *ctx, struct poly_list *l, const struct poly_feature *f);
/* Lists every feature pair whose closed distance is below rest + skin. *allowance is how far the
 * bodies may come nearer before another pair could touch. */
int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance);
/* Path of q before it can touch a face of the core c. */
double poly_path_to_face(const struct poly_core *c, int32_t face, const double q[3],
                         enum poly_rule rule, double rest);
/* Relative path of the bodies before a listed pair that is apart can touch; right for paths up to
 * `most`. Not for the vertices of `merged`, whose touch says it. */
double poly_free_path(const struct poly_pair *p, const struct poly_feature *f, enum poly_rule rule,
                      double most);

static inline void poly_to_body(double r[3], const double m[3][3], const double x[3],
                                const double v[3])
{
    double d[3];
    brc_sub(d, v, x);
    for (int k = 0; k < 3; k++)
        r[k] = m[0][k] * d[0] + m[1][k] * d[1] + m[2][k] * d[2];
}

static inline void poly_to_space(double r[3], const double m[3][3], const double v[3])
{
    for (int k = 0; k < 3; k++)
        r[k] = brc_dot(m[k], v);
}

/* Touch of a vertex v (in space) with the core c at x, rm. sign: +1 when the vertex belongs to b.
 */
static inline void poly_vertex_touch(struct poly_touch *t, const struct poly_foot *foot,
                                     const double rm[3][3], const double v[3], double sign,
                                     double rest)
{
    double out[3];
    poly_to_space(out, rm, foot->n);
    poly_touch_begin(t, rest - foot->s); /* eq:gt12:5 */
    brc_scale(t->n, out, sign);          /* eq:gt12:3 */
    for (int k = 0; k < 3; k++)
        t->x[k] = v[k] - 0.5 * foot->s * out[k];
}

/* Vertex against a face by the rules `strict` and `closed`. A vertex inside the core counts once,
 * at its nearest face, with a negative distance. */
static inline bool poly_foot_on_face(struct poly_foot *foot, const struct poly_core *c,
                                     int32_t face, const double q[3], const enum poly_rule rule,
                                     double rest)
{
    const struct poly_face *f = &c->face[face];
    double h = poly_height(f, q);
    if (h >= rest)
        return false;
    if (h < 0) {
        double highest;
        int32_t nearest = poly_highest(c, q, &highest);
        if (highest <= 0) {
            poly_foot_face(foot, c, nearest, highest);
            return nearest == face;
        }
    }
    if (poly_above(c, f, q)) {
        poly_foot_face(foot, c, face, h);
        if (h < 0) {
            foot->s = -h;
            brc_scale(foot->n, foot->n, -1);
        }
        return foot->s < rest;
    }
    if (rule == POLY_STRICT)
        return false;
    poly_foot_closed(foot, c, face, q);
    return foot->s < rest; /* eq:gt12:2 */
}

/* Gradient parts of a vertex spring: its weight falls towards the vertices u of the other core. */
static inline void poly_weigh_vertex(struct poly_touch *t, const double v[3], const double (*u)[3],
                                     int32_t n, const int32_t near[POLY_NEAR], double sign,
                                     const struct poly_pair *p)
{
    if (near[0] == POLY_NONE_NEAR)
        return;
    double grad[3], arm[3], found[POLY_NEAR][3];
    if (near[0] != POLY_MANY_NEAR) {
        n = 0;
        while (n < POLY_NEAR && near[n] != POLY_NONE_NEAR) {
            brc_copy(found[n], u[near[n]]);
            n++;
        }
        u = (const double(*)[3])found;
    }
    t->weight = poly_vertex_weight(v, u, n, p->rest * p->rest, p->ell * p->ell, grad);
    t->graded = t->weight < 1;
    if (!t->graded)
        return;
    brc_scale(t->g, grad, sign);
    brc_sub(arm, v, t->x);
    brc_cross(t->c, arm, t->g);
}

/* How far q may move before its foot leaves its place, 0 or less inside the core. */
double poly_foot_margin(const struct poly_core *c, const struct poly_foot *foot, const double q[3]);
/* Finds the foot of q, from a remembered place on; returns how far q may move before the foot
 * leaves its place, 0 inside the core. */
double poly_find_foot(struct poly_foot *foot, const struct poly_core *c, const double q[3],
                      int32_t place);

/* Distance of q to the core at a place that its foot has for sure. */
static inline void poly_foot_known(struct poly_foot *foot, const struct poly_core *c, int32_t place,
                                   const double q[3])
{
    int32_t index = place >> 2;
    if ((place & 3) == POLY_ON_FACE) {
        poly_foot_face(foot, c, index, poly_height(&c->face[index], q));
        return;
    }
    double x[3], along[3];
    brc_copy(x, c->vertex[index]);
    if ((place & 3) == POLY_ON_EDGE) {
        double t = poly_along_edge(c, index, q, along);
        brc_copy(x, c->vertex[c->end[index][0]]);
        brc_axpy(x, t, along);
    }
    poly_foot_point(foot, q, x, foot->n, place);
}

/* Vertex v (in space) of one body against the core c of the other by `closed` and `strict`. *margin
 * is how far the vertex may move before its foot leaves the face: > 0 on entry says that it is
 * inside for sure. */
static inline bool poly_touch_face(struct poly_touch *t, const struct poly_pair *p, const bool of_b,
                                   int32_t vertex, int32_t face, double *margin,
                                   const enum poly_rule rule)
{
    const struct poly_core *c = of_b ? &p->a : &p->b;
    const double(*rm)[3] = of_b ? p->ra : p->rb;
    const double *v = of_b ? p->vb[vertex] : p->va[vertex];
    double q[3];
    struct poly_foot foot;
    poly_to_body(q, rm, of_b ? p->xa : p->xb, v);
    t->delta = 0;
    if (*margin > 0) {
        poly_foot_face(&foot, c, face, poly_height(&c->face[face], q));
        if (foot.s >= p->rest)
            return false;
    } else {
        if (!poly_foot_on_face(&foot, c, face, q, rule, p->rest))
            return false;
        if (rule == POLY_STRICT && poly_height(&c->face[face], q) > 0)
            *margin = poly_foot_margin(c, &foot, q);
    }
    poly_vertex_touch(t, &foot, rm, v, of_b ? 1 : -1, p->rest);
    return true;
}

/* By `merged`: *place is the remembered place, which is updated; near is the vertex of the other
 * core that may lower the weight. *margin is how far the vertex may move before the place changes:
 * > 0 on entry says that the place is sure, otherwise it is found. */
static inline bool poly_touch_core(struct poly_touch *t, const struct poly_pair *p, const bool of_b,
                                   int32_t vertex, int32_t *place, const int32_t near[POLY_NEAR],
                                   double *margin)
{
    const struct poly_core *c = of_b ? &p->a : &p->b;
    const double(*rm)[3] = of_b ? p->ra : p->rb;
    const double *v = of_b ? p->vb[vertex] : p->va[vertex];
    double q[3];
    struct poly_foot foot = {.s = 0};
    poly_to_body(q, rm, of_b ? p->xa : p->xb, v);
    if (*margin > 0) {
        poly_foot_known(&foot, c, *place, q);
    } else {
        *margin = poly_find_foot(&foot, c, q, *place);
        *place = foot.place;
    }
    t->delta = p->rest - foot.s;
    if (foot.s >= p->rest)
        return false;
    double sign = of_b ? 1 : -1;
    poly_vertex_touch(t, &foot, rm, v, sign, p->rest);
    poly_weigh_vertex(t, v, of_b ? p->va : p->vb, c->n_vertices, near, sign, p);
    return true;
}

/* Edges that cross with inside feet. The side on which they met stays in *active (1 or 2), so that
 * edges that have passed through each other are still pushed back; 0 and 3 know no side. */
static inline bool poly_touch_crossing(struct poly_touch *t, const struct poly_pair *p,
                                       const struct poly_lines *lines, const double p0[3],
                                       uint8_t *active, const enum poly_rule rule)
{
    double rm = brc_dot(lines->r, lines->m);
    if (!poly_feet_inside(lines))
        return false;
    if (rm * rm >= p->rest * p->rest * lines->m2) {
        t->delta = p->rest - fabs(rm) / sqrt(lines->m2);
        return false;
    }
    struct poly_crossing x;
    poly_cross_edges(&x, lines);
    bool has_side = *active == 1 || *active == 2, flipped = has_side ? *active == 2 : x.d < 0;
    double sign = flipped ? -1 : 1, d = sign * x.d;
    *active = flipped ? 2 : 1;
    brc_scale(t->n, x.cross, sign);   /* eq:gt12:3 */
    poly_touch_begin(t, p->rest - d); /* eq:gt12:5 */
    for (int k = 0; k < 3; k++)
        t->x[k] = p0[k] + x.ta * x.a[k] + 0.5 * d * t->n[k];
    if (rule == POLY_MERGED)
        poly_crossing_weight(t, &x, p->ell, d);
    return t->weight > 0;
}

/* Closed edges by eq 1, where a foot is at an end. */
static inline bool poly_touch_closed_edges(struct poly_touch *t, const struct poly_pair *p,
                                           const struct poly_lines *lines, bool parallel,
                                           const double p0[3])
{
    double r[3], s, d = poly_between_edges(r, &s, lines, parallel);
    if (d >= p->rest || d == 0)
        return false;
    brc_scale(t->n, r, 1 / d);
    poly_touch_begin(t, p->rest - d);
    for (int k = 0; k < 3; k++)
        t->x[k] = p0[k] + s * lines->a[k] + 0.5 * r[k];
    return true;
}

static inline bool poly_touch_edges(struct poly_touch *t, const struct poly_pair *p, int32_t i,
                                    int32_t j, uint8_t *active, const enum poly_rule rule)
{
    t->delta = 0;
    const int32_t *ea = p->a.end[i], *eb = p->b.end[j];
    const double *p0 = p->va[ea[0]];
    struct poly_lines lines;
    bool crossing = poly_cross_lines(&lines, p0, p->va[ea[1]], p->vb[eb[0]], p->vb[eb[1]]);
    if (crossing && poly_touch_crossing(t, p, &lines, p0, active, rule))
        return true;
    bool touches = rule == POLY_CLOSED && poly_touch_closed_edges(t, p, &lines, !crossing, p0);
    *active = touches ? 3 : 0;
    return touches;
}

/* How a listed feature pair touches now; *active is its side (0 when apart), and the remembered
 * place may be updated. When apart, -delta is a lower bound of the gap, and nothing else is set.
 * *margin: as for poly_touch_core. */
static inline bool poly_touch_again(struct poly_touch *t, const struct poly_pair *p,
                                    const struct poly_feature *f, int32_t *place, uint8_t *active,
                                    double *margin, const enum poly_rule rule)
{
    if (f->kind == POLY_EDGES)
        return poly_touch_edges(t, p, f->i, f->j, active, rule);
    bool of_b = f->kind == POLY_VERTEX_B;
    int32_t vertex = of_b ? f->j : f->i;
    *active = rule == POLY_MERGED ? poly_touch_core(t, p, of_b, vertex, place, f->near, margin)
                                  : poly_touch_face(t, p, of_b, vertex, *place, margin, rule);
    return *active;
}

static inline bool poly_touch(struct poly_touch *t, const struct poly_pair *p,
                              const struct poly_feature *f, int32_t *place, uint8_t *active,
                              const enum poly_rule rule)
{
    double margin = 0;
    return poly_touch_again(t, p, f, place, active, &margin, rule);
}

#endif
