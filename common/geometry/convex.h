/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Convex polyhedra: made by clipping with half-spaces, measured, eroded. Used by the tessellation
 * (cells, domains) and by the polyhedra model (eroded cores). One body at a time: cells that must
 * agree about the polygons between them are cut together as a complex (specimen/cell_complex.h). By
 * clipping rather than by a hull of the dual points: labels of the planes survive, and what counts
 * as on a plane is decided here, once for each vertex. */
#ifndef BRC_CONVEX_H
#define BRC_CONVEX_H

#include "common/base/error.h"

/* Half-space n . x <= d [m] with unit normal n, and a label that survives clipping: the facet or
 * the part of the boundary that a face stems from. */
struct brc_plane {
    double n[3];
    double d;
    int32_t id;
};

/* A convex polyhedron: faces are vertex loops, counter-clockwise seen from outside. Zero before the
 * first use. All memory is owned and grows as needed, so one object can be reused for many cells.
 * After a failure it holds no valid body, but can be filled anew or freed. */
struct brc_convex {
    size_t n_vertices, cap_vertices;
    double (*vertex)[3];
    size_t n_faces, cap_faces;
    struct brc_plane *plane; /* [n_faces] outward plane of the face */
    size_t *first;           /* [n_faces + 1] range of the face in loop */
    int32_t *loop;
    size_t cap_loop;
    void *scratch; /* owned by convex.c */
};

void brc_convex_free(struct brc_convex *c);
/* Makes room; what the object holds stays. */
int brc_convex_reserve(struct brc_context *ctx, struct brc_convex *c, size_t vertices, size_t faces,
                       size_t loop);
/* Axis-parallel box; face ids 0..5 = -x +x -y +y -z +z. */
int brc_convex_box(struct brc_context *ctx, struct brc_convex *c, const double low[3],
                   const double high[3]);
/* Intersection of half-spaces inside a bounding box of the given half-width about centre; the
 * planes' ids are kept; an unbounded result is an error. Empty results have n_faces = 0. Vertices
 * nearer to a plane than rounding can tell count as on it; where that leaves no closed body, a
 * coarser distance is tried. */
int brc_convex_from_planes(struct brc_context *ctx, struct brc_convex *c,
                           const struct brc_plane *planes, size_t n, const double centre[3],
                           double half_width);
/* The same for a body of unknown place and size: it is found first, then made anew from nearby, so
 * that neither its distance from the origin nor its size costs digits. Planes that are equal within
 * the part `digits` of their distances, over the whole body, are one: the first stays. */
int brc_convex_enclosed(struct brc_context *ctx, struct brc_convex *c,
                        const struct brc_plane *planes, size_t n, double digits);
/* Where the origin should be moved to for work on a body of this size about `middle`: 0 where it is
 * near enough, else a place near the middle to which coordinates are moved, and back, exactly. */
void brc_convex_origin(const double middle[3], double reach, double origin[3]);
/* Moves planes, or a body with its planes. */
void brc_planes_shift(struct brc_plane *plane, size_t n, const double by[3]);
void brc_convex_shift(struct brc_convex *c, const double by[3]);
/* Keeps the part inside the half-space. Vertices within tolerance of the plane count as on it, so
 * that no face or edge shorter than about tolerance arises. Sets *changed when something was cut.
 */
int brc_convex_clip(struct brc_context *ctx, struct brc_convex *c, const struct brc_plane *plane,
                    double tolerance, bool *changed);
/* Position of the face with this id, n_faces when there is none. */
size_t brc_convex_face(const struct brc_convex *c, int32_t id);
/* Largest distance from a point to a vertex. */
double brc_convex_reach(const struct brc_convex *c, const double from[3]);

/* Volume [m3], centroid [m], and inertia tensor [m5] about the centroid for unit density (row
 * major). Summed about the mean of the vertices, as tetrahedra over a far origin would cancel. */
void brc_convex_mass(const struct brc_convex *c, double *volume, double centroid[3],
                     double inertia[3][3]);
/* Area [m2] and centroid [m] of a plane polygon given by its vertices in order; normal is a unit
 * vector. The area is negative where the loop turns clockwise about the normal: callers see by it
 * that a facet is inside out. */
double brc_polygon_area(double (*vertex)[3], const int32_t *loop, size_t n, const double normal[3],
                        double centroid[3]);

#endif
