/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A subdivision of space into convex cells while it is being made: facets with vertices that are
 * shared by all cells around them. Every decision (is this vertex outside, where is this edge cut,
 * which vertices are one) is taken once for a vertex or an edge, never once a cell, so that cells
 * cannot disagree about the polygon between them. Cells clipped one by one, as a Voronoi library
 * would give them, differ in their last digits, and matching their facets afterwards has no sound
 * tolerance.
 *
 * The way of a specimen: fill (add_vertex, add_facet), merge_vertices, clip by each plane of the
 * domain, merge_vertices, snap_to_planes, finish. After a failure a complex can only be freed. */
#ifndef BRC_CELL_COMPLEX_H
#define BRC_CELL_COMPLEX_H

#include "common/specimen/facets.h"

enum { BRC_FACE_INNER = -1, BRC_FACE_OPEN = -2 };

struct brc_cell_complex_facet {
    int32_t cell[2];  /* [1] = -1: the boundary, or a cell outside that is not kept */
    int32_t face;     /* domain plane id, BRC_FACE_INNER, BRC_FACE_OPEN towards a cell outside */
    int32_t n;        /* vertices; 0: removed */
    size_t first;     /* in loop */
    double normal[3]; /* unit, out of cell[0]; the loop turns counter-clockwise about it */
};

/* With n_cells set and else zero before the first use. */
struct brc_cell_complex {
    size_t n_cells;
    size_t n_vertices, cap_vertices;
    double (*vertex)[3];
    size_t n_facets, cap_facets;
    struct brc_cell_complex_facet *facet;
    size_t n_loop, cap_loop;
    int32_t *loop;
};

void brc_cell_complex_free(struct brc_cell_complex *c);
int brc_cell_complex_add_vertex(struct brc_context *ctx, struct brc_cell_complex *c,
                                const double x[3]);
/* Copies the facet and its loop; facet->first is set, a loop below 3 vertices is not added. The
 * loop must not be the complex's own memory, which may move. */
int brc_cell_complex_add_facet(struct brc_context *ctx, struct brc_cell_complex *c,
                               const struct brc_cell_complex_facet *facet, const int32_t *loop);
/* Gives facet f another loop of n vertices, which is not the complex's own memory: one that is no
 * longer takes the old one's place. */
int brc_cell_complex_set_loop(struct brc_context *ctx, struct brc_cell_complex *c, size_t f,
                              const int32_t *loop, int32_t n);
/* Removes what lies outside the half-space and closes the cells there by facets with the plane's
 * id. Vertices within tolerance count as on the plane. */
int brc_cell_complex_clip(struct brc_context *ctx, struct brc_cell_complex *c,
                          const struct brc_plane *plane, double tolerance);
/* Makes vertices within tolerance [m] one; removes facets narrower than tolerance, and the vertices
 * that are left in the middle of an edge. Facets that go have n = 0 and vertices that go are in no
 * loop; numbers stay, and finish leaves out what is not used. */
int brc_cell_complex_merge_vertices(struct brc_context *ctx, struct brc_cell_complex *c,
                                    double tolerance);
/* Sets is_empty[i] where cell i has no facet; returns the number of such cells. */
size_t brc_cell_complex_empty_cells(const struct brc_cell_complex *c, uint8_t *is_empty);
/* Moves boundary vertices exactly onto their planes, so that platens touch whole facets at once and
 * the volumes sum to that of the domain. */
int brc_cell_complex_snap_to_planes(struct brc_context *ctx, struct brc_cell_complex *c,
                                    const struct brc_convex *domain);
/* Sorts, measures and copies into the final form; the seeds are set already in out. Facets come in
 * the order that struct brc_facets states, whatever order they were made in. BRC_ERR_GEOMETRY: two
 * facets between the same cells, or a cell that is open. */
int brc_cell_complex_finish(struct brc_context *ctx, const struct brc_cell_complex *c,
                            struct brc_facets *out);

#endif
