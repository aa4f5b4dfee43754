/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cores: the eroded convex polyhedra whose points, rounded by the radius R, are the grains.
 * Vertices, edges, faces and constant half-planes in the body frame (principal axes, origin at the
 * centre of mass of the whole cell). Indices of features are local to the body. erode.c makes them
 * once, at the start; who looks at features reads them. They may not know where a grain is: a core
 * is constant for the whole run, and all that moves is made of it at each step (pose.c). */
#ifndef POLY_SHAPE_H
#define POLY_SHAPE_H

#include "common/geometry/convex.h"

/* What every step reads is kept apart from what only lists and walks read: it must stay in cache.
 */

/* A directed side of a face: a point whose closest point on the face's plane is inside it has m . x
 * < off. Half-planes rather than corners: whether a point is over a face, and by how much it is
 * outside, is a product and a comparison for each side. */
struct poly_side {
    double m[3]; /* unit, in the plane of the face, outward */
    double off;
};

/* The side begins at vertex v (and ends where the next one begins). */
struct poly_link {
    int32_t v, edge;
};

struct poly_face {
    double n[3];            /* unit, outward */
    double d;               /* plane n . x = d */
    int32_t first, n_sides; /* range of sides */
};

/* Outside both of its sides is where a point has its closest point on the edge or at its ends: what
 * a walk asks (closest.c). */
struct poly_edge {
    int32_t side[2]; /* the sides of the two faces that meet */
    int32_t face[2];
};

/* One core, as seen by the distance functions. */
struct poly_core {
    const double (*vertex)[3];
    const int32_t (*end)[2]; /* vertices of each edge */
    const struct poly_edge *edge;
    const struct poly_face *face;
    const struct poly_side *side;
    const struct poly_link *link; /* of each side */
    const int32_t *star_first;    /* [n_vertices + 1] range in star */
    const int32_t *star;          /* edges at a vertex */
    int32_t n_vertices, n_edges, n_faces;
};

/* The cores of all grains, one after the other. Arrays of features of all grains rather than a
 * block for each grain: vertices and planes of all cores go to space in one pass through memory,
 * and the number of a feature in its array is a name for it that needs no grain (items,
 * batch.h). */
struct poly_shapes {
    size_t n;
    struct poly_first {
        size_t vertex, edge, face, side;
    } * first; /* [n + 1] where the features of a body begin */
    double (*vertex)[3];
    int32_t (*end)[2];
    struct poly_edge *edge;
    struct poly_face *face;
    struct poly_side *side;
    struct poly_link *link;
    int32_t *star_first; /* vertices of a body plus one, from first.vertex + body */
    int32_t *star;       /* from 2 first.edge */
    size_t cap[9];       /* of these arrays, in their order */
};

void poly_shapes_free(struct poly_shapes *s);
/* Adds one core, given in the body frame. Its normals are those of its planes: erosion knows them
 * from the planes that it has moved, where the vertices of a small face would give them the
 * round-off of its edges over their lengths. A solid that is not a closed convex polyhedron is an
 * error that names the body. Nothing of it is kept then, as the counts have not been raised. */
int poly_shapes_add(struct brc_context *ctx, struct poly_shapes *s, const struct brc_convex *solid);

/* Principal moments, and the orientation (principal axes to space) of an inertia tensor. Moments
 * ascend, and the axes are right-handed. Where two moments are equal any axes in their plane do. */
int poly_principal(struct brc_context *ctx, const double inertia[3][3], double moment[3],
                   double q[4]);

static inline struct poly_core poly_core_of(const struct poly_shapes *s, size_t body)
{
    const struct poly_first *at = &s->first[body], *end = at + 1;
    struct poly_core c = {(const double(*)[3])(s->vertex + at->vertex),
                          (const int32_t(*)[2])(s->end + at->edge),
                          s->edge + at->edge,
                          s->face + at->face,
                          s->side + at->side,
                          s->link + at->side,
                          s->star_first + at->vertex + body,
                          s->star + 2 * at->edge,
                          (int32_t)(end->vertex - at->vertex),
                          (int32_t)(end->edge - at->edge),
                          (int32_t)(end->face - at->face)};
    return c;
}

#endif
