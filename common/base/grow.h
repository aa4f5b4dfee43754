/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays that grow by doubling, so that adding an item costs the same on average however many there
 * are. For lists whose length is known only when they are complete, and for work space that is kept
 * from call to call; the owner keeps array and capacity, and frees the array. What has a known
 * length and one lifetime is a pool's (pool.h), and what is saved with a run is a table (table.h).
 */
#ifndef BRC_GROW_H
#define BRC_GROW_H

#include "common/base/error.h"

/* The block with room for need items, *cap updated; NULL after a failure (the old block stays).
 * What is new in it is not zeroed. It never shrinks: lists of a run keep about the same length. A
 * need of 0 still gives a block, so that callers may pass it to memcpy and qsort. */
static inline void *brc_grown(struct brc_context *ctx, void *block, size_t *cap, size_t need,
                              size_t size)
{
    if (block && need <= *cap)
        return block;
    size_t wanted = *cap > 16 ? *cap : 16;
    while (wanted < need)
        wanted *= 2;
    void *bigger = brc_realloc(ctx, block, wanted, size);
    if (bigger)
        *cap = wanted;
    return bigger;
}

/* Makes room in an array, or returns BRC_ERR_MEMORY from the calling function. A macro, since the
 * array may have any type: a function would take void **, through which a pointer of another type
 * must not be written. Arrays that share one capacity pass a copy of it, but for the last. */
#define BRC_GROW(ctx, array, cap, need)                                               \
    do {                                                                              \
        void *brc_block = brc_grown((ctx), (array), &(cap), (need), sizeof *(array)); \
        if (!brc_block)                                                               \
            return BRC_ERR_MEMORY;                                                    \
        (array) = brc_block;                                                          \
    } while (0)

#endif
