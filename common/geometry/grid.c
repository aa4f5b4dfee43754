/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hashed grid: memory goes with the bodies, not with the volume, so that fragments may fly. Pairs
 * come out sorted by body, whatever the order in the buckets, as sums follow their order. */
#include "common/geometry/grid.h"

#include "common/base/grow.h"
#include "common/geometry/vec.h"

#include <stdlib.h>

struct grid {
    double cell;      /* edge, m */
    size_t n_buckets; /* a power of two */
    uint32_t *first;  /* [n_buckets + 1] */
    uint32_t *body;   /* [n] bodies of each bucket, ascending */
    int64_t (*at)[3]; /* [n] cell of each body */
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

static size_t bucket_of(const struct grid *g, const int64_t at[3])
{
    uint64_t h = (uint64_t)at[0] * UINT64_C(0x9e3779b97f4a7c15) ^
                 (uint64_t)at[1] * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                 (uint64_t)at[2] * UINT64_C(0x165667b19e3779f9);
    return (size_t)(h ^ h >> 31) & (g->n_buckets - 1);
}

static void grid_free(struct grid *g)
{
    free(g->first);
    free(g->body);
    free(g->at);
}

static int grid_fill(struct brc_context *ctx, struct grid *g, const double (*x)[3], size_t n)
{
    g->n_buckets = 16;
    while (g->n_buckets < 2 * n)
        g->n_buckets *= 2;
    g->first = brc_alloc(ctx, g->n_buckets + 1, sizeof *g->first);
    g->body = brc_alloc(ctx, n, sizeof *g->body);
    g->at = brc_alloc(ctx, n, sizeof *g->at);
    if (!g->first || !g->body || !g->at)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 3; k++)
            g->at[i][k] = (int64_t)floor(x[i][k] / g->cell);
        g->first[bucket_of(g, g->at[i]) + 1]++;
    }
    for (size_t b = 0; b < g->n_buckets; b++)
        g->first[b + 1] += g->first[b];
    for (size_t i = 0; i < n; i++)
        g->body[g->first[bucket_of(g, g->at[i])]++] = (uint32_t)i;
    for (size_t b = g->n_buckets; b > 0; b--)
        g->first[b] = g->first[b - 1];
    g->first[0] = 0;
    return 0;
}

static int compare_high(const void *p, const void *q)
{
    const int32_t *a = p, *b = q;
    return (a[1] > b[1]) - (a[1] < b[1]);
}

/* Appends the pairs (i, j > i) of body i, ascending in j. */
static int list_body(struct brc_context *ctx, const struct grid *g, const double (*x)[3],
                     const double *radius, double skin, size_t i, struct brc_neighbours *out)
{
    size_t start = out->n;
    for (int64_t c = 0; c < 27; c++) {
        const int64_t at[3] = {g->at[i][0] + c % 3 - 1, g->at[i][1] + c / 3 % 3 - 1,
                               g->at[i][2] + c / 9 - 1};
        size_t bucket = bucket_of(g, at);
        for (uint32_t k = g->first[bucket]; k < g->first[bucket + 1]; k++) {
            size_t j = g->body[k];
            if (j <= i || g->at[j][0] != at[0] || g->at[j][1] != at[1] || g->at[j][2] != at[2])
                continue;
            double d[3], limit = radius[i] + radius[j] + skin;
            brc_sub(d, x[j], x[i]);
            if (brc_norm2(d) < limit * limit)
                BRC_TRY(brc_neighbours_add(ctx, out, i, j));
        }
    }
    if (out->n > start)
        qsort(out->pair + start, out->n - start, sizeof *out->pair, compare_high);
    return 0;
}

int brc_grid_pairs(struct brc_context *ctx, const double (*x)[3], const double *radius, size_t n,
                   double skin, struct brc_neighbours *out)
{
    out->n = 0;
    if (n < 2)
        return 0;
    struct grid g = {0};
    for (size_t i = 0; i < n; i++)
        g.cell = fmax(g.cell, 2 * radius[i] + skin);
    int code = grid_fill(ctx, &g, x, n);
    for (size_t i = 0; code == 0 && i < n; i++)
        code = list_body(ctx, &g, x, radius, skin, i, out);
    grid_free(&g);
    return code;
}
