/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which feature pairs of two cores can touch within a skin: planes, and pairs of edges, are looked
 * at four at a time. Compiled for each instruction set by the files that include this one. Called
 * when the skin of a contact has been used up, and by tests. What is listed is decided by bounds
 * alone: a feature pair that is left out cannot touch within the skin, whatever the bodies do. */
#ifndef POLY_LISTING_KERNELS_H
#define POLY_LISTING_KERNELS_H

#include "polyhedra/pose_kernels.inc.h"

#include "common/base/grow.h"

#include <string.h>

/* One body of a pair as seen from the other. Both sides have the same form, so that vertices and
 * edges of either are found by one piece of code. */
struct poly_seen {
    const struct poly_core *own, *other;
    const double (*v)[3]; /* own vertices in space */
    const double *x;      /* the other's pose */
    const double (*r)[3];
    size_t stride;     /* the other's faces, up to whole lanes */
    double (*q)[3];    /* [n_vertices of own] in the other's frame */
    double *height;    /* [n_vertices][stride] above the other's planes; the last one is repeated */
    double *highest;   /* [n_vertices] the largest of them */
    int32_t *edge;     /* [n_near] edges that may come within reach of the other core */
    int32_t n_near;    /* then up to whole lanes */
    double *middle[3]; /* [n_near] of these edges, in space, and half their length */
    double *half;
};

static inline size_t poly_whole_lanes(int32_t n)
{
    return ((size_t)n + BRC_LANES - 1) / BRC_LANES * BRC_LANES;
}

/* --- vertices --------------------------------------------------------------------------------- */

/* Heights of the own vertices above the other's planes. Returns the largest gap along one of these
 * planes: a lower bound of the distance of the cores. */
/* All heights at once rather than one vertex at a time: the planes of a core are read once, four
 * side by side, and the same heights tell which vertices, faces and edges are near at all. */
BRC_LANES_INLINE double poly_measure_heights(struct poly_seen *s)
{
    const struct poly_face *face = s->other->face;
    int32_t n = s->own->n_vertices, last = s->other->n_faces - 1;
    brc_lanes gap = brc_lanes_all(-HUGE_VAL);
    for (int32_t v = 0; v < n; v++)
        poly_to_body(s->q[v], s->r, s->x, s->v[v]);
    for (int32_t f = 0; f <= last; f += BRC_LANES) {
        brc_lanes normal[3], d, lowest = brc_lanes_all(HUGE_VAL);
        const struct poly_face *at[BRC_LANES];
        for (int32_t k = 0; k < BRC_LANES; k++)
            at[k] = &face[f + k < last ? f + k : last];
        for (int k = 0; k < 3; k++)
            normal[k] = (brc_lanes){at[0]->n[k], at[1]->n[k], at[2]->n[k], at[3]->n[k]};
        d = (brc_lanes){at[0]->d, at[1]->d, at[2]->d, at[3]->d};
        for (int32_t v = 0; v < n; v++) {
            const double *q = s->q[v];
            brc_lanes h = normal[0] * q[0] + normal[1] * q[1] + normal[2] * q[2] - d;
            brc_lanes_put(s->height + (size_t)v * s->stride + f, h);
            lowest = brc_lanes_min(lowest, h);
        }
        gap = brc_lanes_max(gap, lowest);
    }
    for (int32_t v = 0; v < n; v++) {
        const double *height = s->height + (size_t)v * s->stride;
        brc_lanes high = brc_lanes_at(height);
        for (size_t f = BRC_LANES; f < s->stride; f += BRC_LANES)
            high = brc_lanes_max(high, brc_lanes_at(height + f));
        s->highest[v] = poly_most(poly_most(high[0], high[1]), poly_most(high[2], high[3]));
    }
    return poly_most(poly_most(gap[0], gap[1]), poly_most(gap[2], gap[3]));
}

static const int32_t poly_none_near[POLY_NEAR] = {POLY_NONE_NEAR, POLY_NONE_NEAR, POLY_NONE_NEAR,
                                                  POLY_NONE_NEAR};

/* Vertex v of the own core and a face or closest feature of the other. */
static int poly_list_add_vertex(struct brc_context *ctx, struct poly_list *l, bool of_b, int32_t v,
                                int32_t feature, const int32_t near[POLY_NEAR], double gap)
{
    struct poly_feature f = {.free = gap,
                             .i = of_b ? feature : v,
                             .j = of_b ? v : feature,
                             .kind = of_b ? POLY_VERTEX_B : POLY_VERTEX_A};
    memcpy(f.near, near, sizeof f.near);
    return poly_list_add(ctx, l, &f);
}

/* Faces of the other core within reach of a vertex; all of them when it is inside. The faces that
 * count follow from the rule, so that they are listed by the path to them, not by the plain
 * distance. */
static int poly_list_faces(struct brc_context *ctx, struct poly_list *l, const struct poly_seen *s,
                           bool of_b, int32_t v, const struct poly_pair *p, enum poly_rule rule,
                           double skin)
{
    for (int32_t f = 0; f < s->other->n_faces; f++) {
        if (fabs(s->height[(size_t)v * s->stride + (size_t)f]) >= p->contact_distance + skin &&
            s->highest[v] > 0)
            continue;
        double path =
            poly_path_to_face(s->other, f, s->q[v], rule == POLY_STRICT, p->contact_distance);
        if (path < skin)
            BRC_TRY(poly_list_add_vertex(ctx, l, of_b, v, f, poly_none_near, path));
    }
    return 0;
}

/* Vertices of the other core (q: of the own one in its frame) that may come within the range where
 * they lower the weight. The range takes in the skin: the list must hold for as long as the contact
 * does without a new one. */
static void poly_near_vertices(int32_t near[POLY_NEAR], const struct poly_core *other,
                               const double q[3], double range)
{
    int32_t n = 0;
    memcpy(near, poly_none_near, sizeof poly_none_near);
    for (int32_t u = 0; u < other->n_vertices; u += BRC_LANES) {
        int32_t at = (int32_t)poly_whole_four((size_t)u, (size_t)other->n_vertices);
        brc_lanes r[3];
        brc_lanes_at3(r, other->vertex + at);
        for (int k = 0; k < 3; k++)
            r[k] = q[k] - r[k];
        brc_mask is_near = brc_lanes_less(brc_lanes_dot(r, r), brc_lanes_all(range * range));
        for (int32_t k = u - at; brc_lanes_any(is_near) && k < BRC_LANES; k++) {
            if (!is_near[k])
                continue;
            if (n < POLY_NEAR)
                near[n] = at + k;
            n++;
        }
    }
    if (n > POLY_NEAR)
        near[0] = POLY_MANY_NEAR;
}

/* The face of the other core whose plane vertex v is highest above. It must be one of them, as the
 * largest height is one of these, to the last bit. */
static int32_t poly_highest_face(const struct poly_seen *s, int32_t v)
{
    const double *height = s->height + (size_t)v * s->stride;
    int32_t f = 0;
    while (height[f] < s->highest[v])
        f++;
    return f;
}

static int poly_list_vertices(struct brc_context *ctx, struct poly_list *l,
                              const struct poly_seen *s, const struct poly_pair *p,
                              enum poly_rule rule, double skin)
{
    bool of_b = s->own == &p->b;
    double range = sqrt(p->contact_distance * p->contact_distance + p->fade * p->fade) + skin;
    for (int32_t v = 0; v < s->own->n_vertices; v++) {
        if (s->highest[v] >= p->contact_distance + skin)
            continue;
        if (rule != POLY_MERGED) {
            BRC_TRY(poly_list_faces(ctx, l, s, of_b, v, p, rule, skin));
            continue;
        }
        struct poly_closest at;
        poly_closest_walk(&at, s->other, s->q[v],
                          poly_feature_code(poly_highest_face(s, v), POLY_ON_FACE));
        if (at.s >= p->contact_distance + skin)
            continue;
        int32_t near[POLY_NEAR];
        poly_near_vertices(near, s->other, s->q[v], range);
        BRC_TRY(
            poly_list_add_vertex(ctx, l, of_b, v, at.feature, near, at.s - p->contact_distance));
    }
    return 0;
}

/* --- edges ------------------------------------------------------------------------------------ */

/* An edge that lies beyond reach of one of the other's planes cannot touch. */
BRC_LANES_INLINE bool poly_edge_is_near(const struct poly_seen *s, const int32_t end[2],
                                        double reach)
{
    const double *h0 = s->height + (size_t)end[0] * s->stride;
    const double *h1 = s->height + (size_t)end[1] * s->stride;
    if (s->highest[end[0]] < reach || s->highest[end[1]] < reach)
        return true;
    brc_lanes highest = brc_lanes_all(-HUGE_VAL);
    for (size_t f = 0; f < s->stride; f += BRC_LANES)
        highest = brc_lanes_max(highest, brc_lanes_min(brc_lanes_at(h0 + f), brc_lanes_at(h1 + f)));
    return !brc_lanes_any(~brc_lanes_less(highest, brc_lanes_all(reach)));
}

/* Middles and half lengths make spheres about the edges, which sort out pairs before any closest
 * point is computed. */
BRC_LANES_INLINE void poly_find_edges(struct poly_seen *s, double reach)
{
    s->n_near = 0;
    for (int32_t e = 0; e < s->own->n_edges; e++) {
        const int32_t *end = s->own->end[e];
        if (!poly_edge_is_near(s, end, reach))
            continue;
        double along[3];
        int32_t n = s->n_near++;
        brc_sub(along, s->v[end[1]], s->v[end[0]]);
        s->edge[n] = e;
        s->half[n] = 0.5 * brc_norm(along);
        for (int k = 0; k < 3; k++)
            s->middle[k][n] = s->v[end[0]][k] + 0.5 * along[k];
    }
    for (int32_t n = s->n_near; n % BRC_LANES != 0; n++) {
        s->half[n] = -HUGE_VAL; /* near nothing */
        s->middle[0][n] = s->middle[1][n] = s->middle[2][n] = 0;
    }
}

/* Pairs of edges to look at. */
struct poly_edge_pairs {
    int32_t i[BRC_LANES], j[BRC_LANES], n;
};

/* One vertex each of four edges. */
BRC_LANES_INLINE void poly_gather_ends(brc_lanes r[3], const struct poly_core *c,
                                       const double (*v)[3], const int32_t edge[BRC_LANES], int end)
{
    const double *at[BRC_LANES];
    for (int i = 0; i < BRC_LANES; i++)
        at[i] = v[c->end[edge[i]][end]];
    for (int k = 0; k < 3; k++)
        r[k] = (brc_lanes){at[0][k], at[1][k], at[2][k], at[3][k]};
}

/* Relative paths before the edges can touch; right for paths up to skin. While a closest point is
 * beyond its edge by a path s out of the end, a relative path of the bodies by less than s cannot
 * bring it inside (poly_path_to_end). */
BRC_LANES_INLINE brc_lanes poly_paths_of_edges(const struct poly_pair *p,
                                               const struct poly_edge_pairs *at,
                                               enum poly_rule rule, double skin)
{
    struct poly_crossings x;
    brc_lanes ends[4][3];
    for (int k = 0; k < 2; k++) {
        poly_gather_ends(ends[k], &p->a, p->va, at->i, k);
        poly_gather_ends(ends[2 + k], &p->b, p->vb, at->j, k);
    }
    poly_cross_edges(&x, ends);
    brc_lanes path = poly_edge_gap(&x, p->contact_distance);
    if (rule == POLY_CLOSED)
        return path;
    return brc_lanes_max(path, poly_path_to_inside(&x, brc_lanes_all(p->reach), skin));
}

/* Lists those of the pairs that can touch within the skin. */
BRC_LANES_INLINE int poly_list_edge_pairs(struct brc_context *ctx, struct poly_list *l,
                                          struct poly_edge_pairs *at, const struct poly_pair *p,
                                          enum poly_rule rule, double skin)
{
    int32_t n = at->n;
    for (int32_t k = n; k < BRC_LANES; k++) {
        at->i[k] = at->i[0];
        at->j[k] = at->j[0];
    }
    brc_lanes path = poly_paths_of_edges(p, at, rule, skin);
    at->n = 0;
    for (int32_t k = 0; k < n; k++) {
        struct poly_feature f = {.free = path[k], .i = at->i[k], .j = at->j[k], .kind = POLY_EDGES};
        if (f.free < skin)
            BRC_TRY(poly_list_add(ctx, l, &f));
    }
    return 0;
}

/* Each edge of a against four of b; those whose spheres are near are collected until four pairs are
 * there, so that the costly part has no empty lanes. */
BRC_LANES_INLINE int poly_list_edges(struct brc_context *ctx, struct poly_list *l,
                                     const struct poly_seen sides[2], const struct poly_pair *p,
                                     enum poly_rule rule, double skin)
{
    struct poly_edge_pairs at = {.n = 0};
    const struct poly_seen *a = &sides[0], *b = &sides[1];
    for (int32_t i = 0; i < a->n_near; i++)
        for (int32_t j = 0; j < b->n_near; j += BRC_LANES) {
            brc_lanes d[3],
                range = brc_lanes_at(b->half + j) + (a->half[i] + p->contact_distance + skin);
            for (int k = 0; k < 3; k++)
                d[k] = brc_lanes_at(b->middle[k] + j) - a->middle[k][i];
            brc_mask near = brc_lanes_less(brc_lanes_dot(d, d), range * range) &
                            brc_lanes_less(brc_lanes_all(0), range);
            for (int32_t k = 0; brc_lanes_any(near) && k < BRC_LANES; k++) {
                if (!near[k])
                    continue;
                at.i[at.n] = a->edge[i];
                at.j[at.n++] = b->edge[j + k];
                if (at.n == BRC_LANES)
                    BRC_TRY(poly_list_edge_pairs(ctx, l, &at, p, rule, skin));
            }
        }
    return at.n > 0 ? poly_list_edge_pairs(ctx, l, &at, p, rule, skin) : 0;
}

/* --- pairs of bodies -------------------------------------------------------------------------- */

/* Takes room for a side from the list's work space, which begins at *next. One block for all
 * arrays, as their lengths are known before the first is filled. */
static void poly_lay_out(struct poly_seen *s, double **next, int32_t **edge)
{
    size_t n = (size_t)s->own->n_vertices, edges = poly_whole_lanes(s->own->n_edges);
    s->stride = poly_whole_lanes(s->other->n_faces);
    s->q = (double(*)[3]) * next;
    s->height = *next + 3 * n;
    s->highest = s->height + n * s->stride;
    s->half = s->highest + n;
    for (int k = 0; k < 3; k++)
        s->middle[k] = s->half + (size_t)(k + 1) * edges;
    *next = s->half + 4 * edges;
    s->edge = *edge;
    *edge += edges;
}

static int reserve(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p)
{
    size_t faces = poly_whole_lanes(p->a.n_faces) + poly_whole_lanes(p->b.n_faces);
    size_t edges = poly_whole_lanes(p->a.n_edges) + poly_whole_lanes(p->b.n_edges);
    size_t n = (size_t)(p->a.n_vertices + p->b.n_vertices) * (4 + faces) + 4 * edges;
    BRC_GROW(ctx, l->work, l->cap_work, n);
    BRC_GROW(ctx, l->edge, l->cap_edge, edges);
    return 0;
}

__attribute__((flatten)) static inline int
poly_list_all(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
              enum poly_rule rule, double skin, double *allowance)
{
    double reach = p->contact_distance + skin;
    l->n = 0;
    BRC_TRY(reserve(ctx, l, p));
    double *next = l->work;
    int32_t *edge = l->edge;
    struct poly_seen sides[2] = {
        {.own = &p->a, .other = &p->b, .v = p->va, .x = p->xb, .r = p->rb},
        {.own = &p->b, .other = &p->a, .v = p->vb, .x = p->xa, .r = p->ra}};
    poly_lay_out(&sides[0], &next, &edge);
    poly_lay_out(&sides[1], &next, &edge);
    double gap = poly_most(poly_measure_heights(&sides[0]), poly_measure_heights(&sides[1]));
    *allowance = poly_most(skin, gap - p->contact_distance);
    if (gap >= reach)
        return 0;
    for (int k = 0; k < 2; k++) {
        poly_find_edges(&sides[k], reach);
        BRC_TRY(poly_list_vertices(ctx, l, &sides[k], p, rule, skin));
    }
    return poly_list_edges(ctx, l, sides, p, rule, skin);
}

#endif
