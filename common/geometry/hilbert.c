/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points are numbered along a Hilbert curve, so that neighbours in space are near in memory.
 * Morton's order is simpler and jumps across the whole box at every power of two. */
#include "common/geometry/hilbert.h"

#include "common/geometry/vec.h"

#include <stdlib.h>

/* Three coordinates of 21 bits fill a key of 63. */
enum { BITS = 21 };

struct entry {
    uint64_t key;
    size_t point;
};

/* Position on the curve of a lattice point (J. Skilling, AIP Conf. Proc. 707, 381, 2004). */
static uint64_t hilbert_key(uint32_t x[3])
{
    for (uint32_t q = UINT32_C(1) << (BITS - 1); q > 1; q >>= 1)
        for (int k = 0; k < 3; k++)
            if (x[k] & q) {
                x[0] ^= q - 1;
            } else {
                uint32_t t = (x[0] ^ x[k]) & (q - 1);
                x[0] ^= t;
                x[k] ^= t;
            }
    x[1] ^= x[0];
    x[2] ^= x[1];
    uint32_t t = 0;
    for (uint32_t q = UINT32_C(1) << (BITS - 1); q > 1; q >>= 1)
        if (x[2] & q)
            t ^= q - 1;
    uint64_t key = 0;
    for (int b = BITS - 1; b >= 0; b--)
        for (int k = 0; k < 3; k++)
            key = key << 1 | ((x[k] ^ t) >> b & 1);
    return key;
}

/* Points of one lattice cell keep their order, as qsort alone would not promise. */
static int by_key(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return p->point < q->point ? -1 : p->point > q->point;
}

/* One scale for all axes: in a stretched lattice, near points of the curve would be far apart along
 * the long side. */
int brc_hilbert_order(struct brc_context *ctx, double (*x)[3], size_t n, size_t *order)
{
    double low[3], high[3], edge = 0;
    struct entry *entries = brc_alloc(ctx, n, sizeof *entries);
    if (!entries)
        return BRC_ERR_MEMORY;
    brc_box_of(low, high, x, n);
    for (int k = 0; k < 3; k++)
        edge = fmax(edge, high[k] - low[k]);
    double scale = edge > 0 ? ((1 << BITS) - 1) / edge : 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t lattice[3];
        for (int k = 0; k < 3; k++)
            lattice[k] = (uint32_t)((x[i][k] - low[k]) * scale);
        entries[i] = (struct entry){hilbert_key(lattice), i};
    }
    qsort(entries, n, sizeof *entries, by_key);
    for (size_t i = 0; i < n; i++)
        order[i] = entries[i].point;
    free(entries);
    return 0;
}
