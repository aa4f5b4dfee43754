/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walks over the features of a core. A walk from the feature that a vertex had before, rather
 * than a search over all or GJK: between two looks a vertex hardly moves, so that it mostly ends
 * where it began, and it says which feature is the closest, which the laws and the bounds of
 * points.c want to know. Called by the making of lists and the literal evaluation, never by the
 * loop over contacts that are stable. */
#include "polyhedra/closest.h"

void poly_on_face(struct poly_closest *r, const struct poly_core *c, int32_t f, double height)
{
    r->s = height;
    brc_copy(r->n, c->face[f].n);
    r->feature = poly_feature_code(f, POLY_ON_FACE);
}

/* Where p is inside the core: at its nearest face. */
static bool find_inside(struct poly_closest *r, const struct poly_core *c, const double p[3])
{
    double h;
    int32_t nearest = poly_highest(c, p, &h);
    if (h <= 0)
        poly_on_face(r, c, nearest, h);
    return h <= 0;
}

/* Closest point x of the core's surface; on the surface itself the given normal stands in. Where p
 * is on the surface the direction to it is none, and the law would divide 0 by 0. */
static void on_point(struct poly_closest *r, const double p[3], const double x[3],
                     const double stand_in[3], int32_t feature)
{
    brc_sub(r->n, p, x);
    r->s = brc_normalise(r->n, r->n);
    if (r->s == 0)
        brc_copy(r->n, stand_in);
    r->feature = feature;
}

/* Distance of p to a closed edge, whose closest point goes to x. */
static double to_edge(const struct poly_core *c, int32_t edge, const double p[3], double x[3])
{
    double along[3], t = poly_along_edge(c, edge, p, along);
    brc_copy(x, c->vertex[c->end[edge][0]]);
    brc_axpy(x, poly_least(poly_most(t, 0), 1), along);
    return brc_distance(x, p);
}

/* The part of a closed edge that is closest to p: the edge, or one of its ends. */
static int32_t code_on_edge(const struct poly_core *c, int32_t edge, const double p[3])
{
    double along[3], t = poly_along_edge(c, edge, p, along);
    if (t <= 0 || t >= 1)
        return poly_feature_code(c->end[edge][t > 0], POLY_ON_VERTEX);
    return poly_feature_code(edge, POLY_ON_EDGE);
}

/* Faces count only from above, and strictly inside their sides: what is on an edge is left to
 * the edge, so that no two features claim the same point with different normals. */
void poly_closest_search(struct poly_closest *r, const struct poly_core *c, const double p[3])
{
    double best = HUGE_VAL;
    poly_on_face(r, c, 0, best);
    for (int32_t f = 0; f < c->n_faces; f++) {
        double h = poly_height(&c->face[f], p);
        if (h >= 0 && h < best && poly_outside(c, &c->face[f], p) < 0) {
            best = h;
            poly_on_face(r, c, f, h);
        }
    }
    for (int32_t e = 0; e < c->n_edges; e++) {
        double x[3], d = to_edge(c, e, p, x);
        if (d < best) {
            best = d;
            on_point(r, p, x, c->face[c->edge[e].face[0]].n, poly_feature_code(e, POLY_ON_EDGE));
        }
    }
}

/* One step of the walk from an edge: the next feature, or the same when it is this edge. Inside of
 * the side of either face, the closest point is on that face; outside of both it is on the edge, by
 * the definition of sides. */
static int32_t walk_edge(struct poly_closest *r, const struct poly_core *c, int32_t index,
                         const double p[3])
{
    const struct poly_edge *e = &c->edge[index];
    double along[3], x[3], t = poly_along_edge(c, index, p, along);
    if (t <= 0)
        return poly_feature_code(c->end[index][0], POLY_ON_VERTEX);
    if (t >= 1)
        return poly_feature_code(c->end[index][1], POLY_ON_VERTEX);
    for (int k = 0; k < 2; k++) {
        const struct poly_side *side = &c->side[e->side[k]];
        if (brc_dot(side->m, p) < side->off)
            return poly_feature_code(e->face[k], POLY_ON_FACE);
    }
    brc_copy(x, c->vertex[c->end[index][0]]);
    brc_axpy(x, t, along);
    on_point(r, p, x, c->face[e->face[0]].n, poly_feature_code(index, POLY_ON_EDGE));
    return r->feature;
}

/* Where the projection of p on no edge is positive, p is in the cone of the vertex and the walk
 * ends. Which of the others it leaves by does not matter for where it ends: the surface is convex.
 */
static int32_t walk_vertex(struct poly_closest *r, const struct poly_core *c, int32_t index,
                           const double p[3])
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
        return poly_feature_code(next, POLY_ON_EDGE);
    on_point(r, p, c->vertex[index], c->face[c->edge[c->star[c->star_first[index]]].face[0]].n,
             poly_feature_code(index, POLY_ON_VERTEX));
    return r->feature;
}

/* From a face: settled when p is above it; below its plane the highest face is the next. */
static int32_t walk_face(struct poly_closest *r, const struct poly_core *c, int32_t index,
                         const double p[3])
{
    double h = poly_height(&c->face[index], p);
    if (h < 0) {
        int32_t high = poly_highest(c, p, &h);
        if (h > 0 && high != index)
            return poly_feature_code(high, POLY_ON_FACE);
        if (h <= 0) {
            poly_on_face(r, c, high, h);
            return r->feature;
        }
    }
    int32_t out = poly_outside(c, &c->face[index], p);
    if (out >= 0)
        return poly_feature_code(c->link[out].edge, POLY_ON_EDGE);
    poly_on_face(r, c, index, h);
    return r->feature;
}

void poly_closest_walk(struct poly_closest *r, const struct poly_core *c, const double p[3],
                       int32_t feature)
{
    /* The surface is convex, so a walk that ends is right. Round-off may make two neighbours
     * send each other the point for ever; then all edges are tried. */
    for (int tries = 0; tries < 32; tries++) {
        int32_t next = 0, index = feature >> 2;
        r->feature = -1;
        switch (feature & 3) {
        case POLY_ON_FACE:
            next = walk_face(r, c, index, p);
            break;
        case POLY_ON_EDGE:
            next = walk_edge(r, c, index, p);
            break;
        default:
            next = walk_vertex(r, c, index, p);
        }
        if (r->feature >= 0)
            return;
        feature = next;
    }
    if (!find_inside(r, c, p))
        poly_closest_search(r, c, p);
}

void poly_closest_on_face(struct poly_closest *r, const struct poly_core *c, int32_t index,
                          const double p[3])
{
    const struct poly_face *f = &c->face[index];
    if (poly_outside(c, f, p) < 0) {
        double h = poly_height(f, p);
        poly_on_face(r, c, index, fabs(h));
        if (h < 0)
            brc_scale(r->n, r->n, -1);
        return;
    }
    double best = HUGE_VAL, nearest[3] = {0, 0, 0};
    int32_t edge = 0;
    for (int32_t k = f->first; k < f->first + f->n_sides; k++) {
        double x[3], d;
        /* the closest point is on an edge that p is outside of */
        if (brc_dot(c->side[k].m, p) < c->side[k].off)
            continue;
        d = to_edge(c, c->link[k].edge, p, x);
        if (d < best) {
            best = d;
            edge = c->link[k].edge;
            brc_copy(nearest, x);
        }
    }
    on_point(r, p, nearest, f->n, code_on_edge(c, edge, p));
}

/* A vertex that has gone through the core is below many faces. If each pushed it, the force would
 * jump by their number as it enters; the nearest one alone pushes it out. */
bool poly_closest_of_rule(struct poly_closest *r, const struct poly_core *c, int32_t face,
                          const double p[3], bool is_strict, double contact_distance)
{
    const struct poly_face *f = &c->face[face];
    double h = poly_height(f, p);
    if (is_strict && h >= contact_distance)
        return false;
    if (h < 0 && find_inside(r, c, p))
        return r->feature == poly_feature_code(face, POLY_ON_FACE);
    if (is_strict && poly_outside(c, f, p) >= 0)
        return false;
    poly_closest_on_face(r, c, face, p);
    return true;
}

/* The region of space that belongs to a feature is convex and bounded by planes, so the least
 * distance to one of them is a bound that holds in every direction. */
double poly_closest_margin(const struct poly_core *c, const struct poly_closest *at,
                           const double p[3])
{
    int32_t index = at->feature >> 2;
    double margin = at->s, along[3], d[3];
    if ((at->feature & 3) == POLY_ON_FACE) {
        const struct poly_face *f = &c->face[index];
        for (int32_t k = f->first; k < f->first + f->n_sides; k++)
            margin = poly_least(margin, c->side[k].off - brc_dot(c->side[k].m, p));
    } else if ((at->feature & 3) == POLY_ON_EDGE) {
        const struct poly_edge *e = &c->edge[index];
        double t = poly_along_edge(c, index, p, along), length = brc_norm(along);
        margin = poly_least(margin, poly_least(t, 1 - t) * length);
        for (int k = 0; k < 2; k++) {
            const struct poly_side *side = &c->side[e->side[k]];
            margin = poly_least(margin, brc_dot(side->m, p) - side->off);
        }
    } else {
        brc_sub(d, p, c->vertex[index]);
        for (int32_t k = c->star_first[index]; k < c->star_first[index + 1]; k++) {
            const int32_t *end = c->end[c->star[k]];
            brc_sub(along, c->vertex[end[0] + end[1] - index], c->vertex[index]);
            margin = poly_least(margin, -brc_dot(d, along) / brc_norm(along));
        }
    }
    return margin;
}

/* As above, by what of a feature's region is seen of one face: beyond an edge is where the side of
 * this face says so, the other face's does not count; of a vertex, two edges are the face's. The
 * highest plane stands for the core, inside which another rule holds. */
double poly_closest_margin_of_face(const struct poly_core *c, int32_t face,
                                   const struct poly_closest *at, const double p[3])
{
    const struct poly_face *f = &c->face[face];
    int32_t index = at->feature >> 2, kind = at->feature & 3;
    double margin, d[3], along[3];
    poly_highest(c, p, &margin);
    if (kind == POLY_ON_FACE)
        margin = poly_least(margin, poly_height(f, p));
    for (int32_t k = f->first; k < f->first + f->n_sides; k++) {
        int32_t edge = c->link[k].edge;
        const int32_t *end = c->end[edge];
        double beyond = brc_dot(c->side[k].m, p) - c->side[k].off;
        if (kind == POLY_ON_FACE) {
            margin = poly_least(margin, -beyond);
        } else if (kind == POLY_ON_EDGE && edge == index) {
            double t = poly_along_edge(c, edge, p, along), length = brc_norm(along);
            margin = poly_least(margin, poly_least(beyond, poly_least(t, 1 - t) * length));
        } else if (kind == POLY_ON_VERTEX && (end[0] == index || end[1] == index)) {
            brc_sub(along, c->vertex[end[0] + end[1] - index], c->vertex[index]);
            brc_sub(d, p, c->vertex[index]);
            margin = poly_least(margin, -brc_dot(d, along) / brc_norm(along));
        }
    }
    return margin;
}

/* Two bounds, and the larger one holds: the distance has to be used up, and under `strict` the
 * vertex has to come in over the side that it is farthest outside of. Inside the core it may touch
 * at once. */
double poly_path_to_face(const struct poly_core *c, int32_t face, const double q[3], bool is_strict,
                         double contact_distance)
{
    struct poly_closest at;
    if (find_inside(&at, c, q))
        return 0;
    poly_closest_on_face(&at, c, face, q);
    double path = at.s - contact_distance;
    int32_t out = is_strict ? poly_outside(c, &c->face[face], q) : -1;
    return out < 0 ? path : poly_most(path, brc_dot(c->side[out].m, q) - c->side[out].off);
}
