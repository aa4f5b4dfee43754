/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One block of the heap an array rather than parts of larger blocks: memory checkers then see each
 * array's ends, and the arrays are few and large. glibc's obstacks would do, but end the program
 * where memory is short. */
#include "common/base/pool.h"

#include "common/base/grow.h"

#include <stdlib.h>

void *brc_pool_alloc(struct brc_context *ctx, struct brc_pool *pool, size_t count, size_t size)
{
    void **block = brc_grown(ctx, pool->block, &pool->cap, pool->n + 1, sizeof *block);
    void *array = block ? brc_alloc(ctx, count, size) : NULL;
    pool->block = block ? block : pool->block;
    pool->is_failed = pool->is_failed || !array;
    if (array)
        block[pool->n++] = array;
    return array;
}

void brc_pool_free(struct brc_pool *pool)
{
    while (pool->n > 0)
        free(pool->block[--pool->n]);
    free(pool->block);
    *pool = (struct brc_pool){0};
}
