/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Broad phase: pairs of bodies whose bounding spheres come within a skin, sorted by (low, high).
 * Cells are hashed, so memory is bounded by the number of bodies wherever they are. */
#ifndef BRC_GRID_H
#define BRC_GRID_H

#include "model.h"

void brc_candidates_free(struct brc_candidates *c);
/* Pairs with |x_i - x_j| < reach_i + reach_j + skin. Memory in out is reused. */
int brc_grid_pairs(struct brc_context *ctx, const double (*x)[3], const double *reach, size_t n,
                   double skin, struct brc_candidates *out);
/* Grain-platen pairs with (x - platen) . n < reach + skin; platen bodies follow the n grains. */
int brc_grid_platens(struct brc_context *ctx, const struct brc_sim *sim,
                     struct brc_candidates *out);

#endif
