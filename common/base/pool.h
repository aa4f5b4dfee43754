/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory that is freed together: the arrays of one piece of work, whatever way it ends. A function
 * that takes its arrays from its caller's pool returns at the first failure and frees nothing; the
 * caller frees the pool once. For work before a run: arrays that live as long as a run are tables
 * (table.h), and what grows has its own capacity (grow.h). */
#ifndef BRC_POOL_H
#define BRC_POOL_H

#include "common/base/error.h"

/* Zero before the first use. */
struct brc_pool {
    void **block;
    size_t n, cap;
    bool is_failed; /* an allocation has failed: asked once where many arrays are made */
};

/* Zeroed, and at the same address until the pool is freed; NULL with BRC_ERR_MEMORY recorded. */
void *brc_pool_alloc(struct brc_context *ctx, struct brc_pool *pool, size_t count, size_t size);
/* The pool is as before its first use. */
void brc_pool_free(struct brc_pool *pool);

#endif
