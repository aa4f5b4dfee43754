/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disjoint sets of numbers by union-find: parent[i] = i at first. The lowest number is the root of
 * its set, whatever the order of the unions, so that what is numbered by roots is the same in each
 * run. Without ranks: halving the paths alone is as good as linear for what joins neighbours. */
#ifndef BRC_DISJOINT_H
#define BRC_DISJOINT_H

#include <stdint.h>

/* Lowest number of the set; paths are halved on the way. */
static inline int32_t brc_disjoint_root(int32_t *parent, int32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static inline void brc_disjoint_join(int32_t *parent, int32_t a, int32_t b)
{
    int32_t low = brc_disjoint_root(parent, a), high = brc_disjoint_root(parent, b);
    if (low < high)
        parent[high] = low;
    else
        parent[low] = high;
}

#endif
