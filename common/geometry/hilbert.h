/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order along the Hilbert curve: neighbours in the order are neighbours in space. Grains are
 * numbered so once, as a specimen is made, and loops over contacts then find both grains in the
 * cache; they are not numbered anew later, as numbers are names in files. */
#ifndef BRC_HILBERT_H
#define BRC_HILBERT_H

#include "common/base/error.h"

/* order[i] is the point that comes i-th; ties keep their order. The curve fills the points' cube
 * with 2^21 steps an edge. */
int brc_hilbert_order(struct brc_context *ctx, double (*x)[3], size_t n, size_t *order);

#endif
