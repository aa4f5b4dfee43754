/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cores: the eroded convex polyhedra whose points, rounded by the radius R, are the grains.
 * Vertices, edges, faces and constant half-planes in the body frame (principal axes, origin at the
 * centre of mass of the whole cell). Indices of features are local to the body. erode.c makes them
 * once, at the start; who looks at features reads them. They may not know where a grain is: a core
 * is constant for the whole run, and all that moves is made of it at each step (pose.c). */
#ifndef POLY_SHAPE_H
#define POLY_SHAPE_H

#include "common/base/error.h"

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
    size_t *vertex_first, *edge_first, *face_first, *side_first; /* [n + 1] */
    double (*vertex)[3];
    int32_t (*end)[2];
    struct poly_edge *edge;
    struct poly_face *face;
    struct poly_side *side;
    struct poly_link *link;
    int32_t *star_first; /* vertices of a body plus one, from vertex_first + body */
    int32_t *star;       /* from 2 edge_first */
    size_t cap[12];      /* of these arrays, in their order */
};

/* A polyhedron to add: faces as loops of vertex numbers in either sense. Erosion knows its normals
 * from the planes that it has moved. From the vertices of a small face they would have the
 * round-off of its edges over their lengths. */
struct poly_solid {
    size_t n_vertices;
    const double (*vertex)[3]; /* body frame */
    size_t n_faces;
    const size_t *first; /* [n_faces + 1] */
    const int32_t *loop;
    const double (*normal)[3]; /* outward unit normals; NULL: from the vertices */
};

void poly_shapes_free(struct poly_shapes *s);
/* Adds one core; a solid that is not a closed convex polyhedron is an error that names the body.
 * Nothing of it is kept then, as the counts have not been raised. */
int poly_shapes_add(struct brc_context *ctx, struct poly_shapes *s, const struct poly_solid *solid);

/* Largest distance of a vertex from the body's centre. */
double poly_shapes_reach(const struct poly_shapes *s, size_t body);

/* Principal moments, and the orientation (principal axes to space) of an inertia tensor. Moments
 * ascend, and the axes are right-handed. Where two moments are equal any axes in their plane do. */
int poly_principal(struct brc_context *ctx, const double inertia[3][3], double moment[3],
                   double q[4]);

static inline struct poly_core poly_core_of(const struct poly_shapes *s, size_t body)
{
    size_t v = s->vertex_first[body], e = s->edge_first[body], f = s->face_first[body];
    struct poly_core c = {(const double(*)[3])(s->vertex + v),
                          (const int32_t(*)[2])(s->end + e),
                          s->edge + e,
                          s->face + f,
                          s->side + s->side_first[body],
                          s->link + s->side_first[body],
                          s->star_first + v + body,
                          s->star + 2 * e,
                          (int32_t)(s->vertex_first[body + 1] - v),
                          (int32_t)(s->edge_first[body + 1] - e),
                          (int32_t)(s->face_first[body + 1] - f)};
    return c;
}

#endif
