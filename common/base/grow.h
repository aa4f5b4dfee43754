/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays that grow by doubling. */
#ifndef BRC_GROW_H
#define BRC_GROW_H

#include "common/base/error.h"

/* The block with room for need items, *cap updated; NULL after a failure (the old block stays). */
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

/* Makes room in an array, or returns BRC_ERR_MEMORY from the calling function. */
#define BRC_GROW(ctx, array, cap, need)                                               \
    do {                                                                              \
        void *brc_block = brc_grown((ctx), (array), &(cap), (need), sizeof *(array)); \
        if (!brc_block)                                                               \
            return BRC_ERR_MEMORY;                                                    \
        (array) = brc_block;                                                          \
    } while (0)

#endif
