/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges of polygons that share their vertices by number: of one cell, of the domain, or of all
 * facets of a specimen. For the check that cells are closed, and for files that list edges. Knows
 * numbers only, no places. */
#ifndef BRC_EDGES_H
#define BRC_EDGES_H

#include "common/base/error.h"

/* A side of a polygon: one end of it is an edge, which other polygons may have, too. */
struct brc_side {
    int32_t low, high; /* vertices */
    int32_t face;
    int32_t is_rising; /* the polygon runs from low to high here */
    int32_t edge;
};

/* All sides, sorted by their first four members, so that those of an edge stand together. */
struct brc_edges {
    size_t n_sides, n, cap_sides, cap;
    struct brc_side *side; /* [n_sides] */
    size_t *first;         /* [n + 1] range of an edge in side */
};

/* Finds the edges of n_faces polygons: face f has the vertices loop[first[f]] to
 * loop[first[f + 1] - 1] in turn. e is zero before the first use; its memory is used again. */
int brc_edges_find(struct brc_context *ctx, struct brc_edges *e, size_t n_faces,
                   const size_t *first, const int32_t *loop);
void brc_edges_free(struct brc_edges *e);
/* Number of the edge between two vertices, -1 where they have none. */
int32_t brc_edges_number(const struct brc_edges *e, int32_t u, int32_t v);

#endif
