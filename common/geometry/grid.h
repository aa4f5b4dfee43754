/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Broad phase: pairs of bodies whose bounding spheres come within a skin, sorted by (low, high).
 * Cells are hashed, so memory is bounded by the number of bodies wherever they are. Called by the
 * neighbour search of a run, by packing, and by whatever looks for points that nearly coincide;
 * knows spheres only. Limit: the cell is that of the largest body, so that many small
 * ones beside a few large ones fill it; a tree would serve these better. */
#ifndef BRC_GRID_H
#define BRC_GRID_H

#include "common/base/error.h"

/* Sorted pairs (low, high) of bodies whose bounding spheres come within the skin of each other. */
struct brc_neighbours {
    size_t n, cap;
    size_t enough; /* pairs after which the search ends with a body; 0: it goes on to the last */
    int32_t (*pair)[2];
};

int brc_neighbours_add(struct brc_context *ctx, struct brc_neighbours *c, size_t a, size_t b);
void brc_neighbours_free(struct brc_neighbours *c);
/* Pairs with |x_i - x_j| < radius_i + radius_j + skin. radius NULL: points, of which most are much
 * farther apart than the skin. Memory in out is used again. */
int brc_grid_pairs(struct brc_context *ctx, const double (*x)[3], const double *radius, size_t n,
                   double skin, struct brc_neighbours *out);
/* Points that nearly coincide become one. to[i] is i for those that take part: in ascending order,
 * each that is still its own becomes that of the others within the skin that are. */
int brc_grid_join(struct brc_context *ctx, const double (*x)[3], size_t n, double skin,
                  int32_t *to);

#endif
