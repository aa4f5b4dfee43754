/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hashed grid: memory goes with the bodies, not with the volume, so that fragments may fly. Pairs
 * come out sorted by body, whatever the order in the buckets, as sums follow their order. */
#include "common/geometry/grid.h"

#include "common/base/grow.h"
#include "common/base/pool.h"
#include "common/base/tuples.h"
#include "common/geometry/vec.h"

#include <stdlib.h>

/* Cells of points in skins: few points then lie near the border of their cell, and most look into
 * theirs alone. */
static const double point_cells = 64;

struct grid {
    const double (*x)[3];
    const double *radius; /* NULL: points */
    size_t n;
    double skin, largest; /* m; largest of the radii */
    double cell;          /* edge, m */
    size_t n_buckets;     /* a power of two */
    uint32_t *first;      /* [n_buckets + 1] */
    uint32_t *body;       /* [n] bodies of each bucket, ascending */
    int64_t (*at)[3];     /* [n] cell of each body */
};

void brc_neighbours_free(struct brc_neighbours *c)
{
    free(c->pair);
    *c = (struct brc_neighbours){0};
}

int brc_neighbours_add(struct brc_context *ctx, struct brc_neighbours *c, size_t a, size_t b)
{
    BRC_GROW(ctx, c->pair, c->cap, c->n + 1);
    c->pair[c->n][0] = (int32_t)a;
    c->pair[c->n++][1] = (int32_t)b;
    return 0;
}

/* The factors are odd numbers with no pattern in their bits, so that neighbouring cells get buckets
 * far apart. Which ones does not show in any result, since pairs are sorted. */
static size_t bucket_of(const struct grid *g, const int64_t at[3])
{
    uint64_t h = (uint64_t)at[0] * UINT64_C(0x9e3779b97f4a7c15) ^
                 (uint64_t)at[1] * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                 (uint64_t)at[2] * UINT64_C(0x165667b19e3779f9);
    return (size_t)(h ^ h >> 31) & (g->n_buckets - 1);
}

static double radius_of(const struct grid *g, size_t i)
{
    return g->radius ? g->radius[i] : 0;
}

/* Twice as many buckets as bodies or more, so that few hold bodies of two cells. Bodies of a bucket
 * stand side by side in one array: lists of pointers would fetch a cache line for each body. */
static int grid_make(struct brc_context *ctx, struct grid *g, struct brc_pool *pool)
{
    for (size_t i = 0; i < g->n; i++)
        g->largest = fmax(g->largest, radius_of(g, i));
    g->cell = g->radius ? 2 * g->largest + g->skin : point_cells * g->skin;
    g->n_buckets = 16;
    while (g->n_buckets < 2 * g->n)
        g->n_buckets *= 2;
    g->first = brc_pool_alloc(ctx, pool, g->n_buckets + 1, sizeof *g->first);
    g->body = brc_pool_alloc(ctx, pool, g->n, sizeof *g->body);
    g->at = brc_pool_alloc(ctx, pool, g->n, sizeof *g->at);
    if (pool->is_failed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < g->n; i++) {
        for (int k = 0; k < 3; k++)
            g->at[i][k] = (int64_t)floor(g->x[i][k] / g->cell);
        g->first[bucket_of(g, g->at[i])]++;
    }
    /* counts become ends, and filling from the last body on turns ends into starts */
    for (size_t b = 0; b < g->n_buckets; b++)
        g->first[b + 1] += g->first[b];
    for (size_t i = g->n; i-- > 0;)
        g->body[--g->first[bucket_of(g, g->at[i])]] = (uint32_t)i;
    return 0;
}

/* Appends the pairs (i, j > i) of body i with those of one cell. Other cells may share its bucket.
 */
static int list_cell(struct brc_context *ctx, const struct grid *g, const int64_t at[3], size_t i,
                     struct brc_neighbours *out)
{
    size_t bucket = bucket_of(g, at);
    for (uint32_t k = g->first[bucket]; k < g->first[bucket + 1]; k++) {
        size_t j = g->body[k];
        if (j <= i || g->at[j][0] != at[0] || g->at[j][1] != at[1] || g->at[j][2] != at[2])
            continue;
        double d[3], limit = radius_of(g, i) + radius_of(g, j) + g->skin;
        brc_sub(d, g->x[j], g->x[i]);
        if (brc_norm2(d) < limit * limit)
            BRC_TRY(brc_neighbours_add(ctx, out, i, j));
    }
    return 0;
}

/* The pairs of body i, ascending in j. */
static int list_body(struct brc_context *ctx, const struct grid *g, size_t i,
                     struct brc_neighbours *out)
{
    size_t start = out->n;
    int64_t low[3], high[3], at[3];
    double reach = radius_of(g, i) + g->largest + g->skin;
    for (int k = 0; k < 3; k++) {
        low[k] = (int64_t)floor((g->x[i][k] - reach) / g->cell);
        high[k] = (int64_t)floor((g->x[i][k] + reach) / g->cell);
    }
    for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
                BRC_TRY(list_cell(ctx, g, at, i, out));
    if (out->n > start)
        qsort(out->pair + start, out->n - start, sizeof *out->pair, brc_tuple2_compare);
    return 0;
}

int brc_grid_pairs(struct brc_context *ctx, const double (*x)[3], const double *radius, size_t n,
                   double skin, struct brc_neighbours *out)
{
    struct brc_pool pool = {0};
    struct grid g = {.x = x, .radius = radius, .n = n, .skin = skin};
    out->n = 0;
    if (n < 2)
        return 0;
    int code = grid_make(ctx, &g, &pool);
    for (size_t i = 0; code == 0 && i < n && (out->enough == 0 || out->n < out->enough); i++)
        code = list_body(ctx, &g, i, out);
    brc_pool_free(&pool);
    return code;
}

/* Pairs are listed for one point at a time, and not for points that have joined another: n points
 * at one place have n * n / 2 pairs, which no memory holds. */
int brc_grid_join(struct brc_context *ctx, const double (*x)[3], size_t n, double skin, int32_t *to)
{
    struct brc_pool pool = {0};
    struct brc_neighbours near = {0};
    struct grid g = {.x = x, .n = n, .skin = skin};
    int code = grid_make(ctx, &g, &pool);
    for (size_t i = 0; code == 0 && i < n; i++) {
        near.n = 0;
        if (to[i] == (int32_t)i)
            code = list_body(ctx, &g, i, &near);
        for (size_t k = 0; k < near.n; k++) {
            int32_t high = near.pair[k][1];
            to[high] = to[high] == high ? (int32_t)i : to[high];
        }
    }
    brc_neighbours_free(&near);
    brc_pool_free(&pool);
    return code;
}
