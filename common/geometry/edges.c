/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorting rather than hashing: the numbers of edges follow from those of the vertices alone, and so
 * do the files that list them. */
#include "common/geometry/edges.h"

#include "common/base/grow.h"
#include "common/base/tuples.h"

#include <stdlib.h>

int brc_edges_find(struct brc_context *ctx, struct brc_edges *e, size_t n_faces,
                   const size_t *first, const int32_t *loop)
{
    e->n = e->n_sides = 0;
    BRC_GROW(ctx, e->side, e->cap_sides, first[n_faces]);
    BRC_GROW(ctx, e->first, e->cap, first[n_faces] + 1);
    for (size_t f = 0; f < n_faces; f++)
        for (size_t i = first[f]; i < first[f + 1]; i++) {
            int32_t u = loop[i], v = loop[i + 1 < first[f + 1] ? i + 1 : first[f]];
            e->side[e->n_sides++] =
                (struct brc_side){u < v ? u : v, u < v ? v : u, (int32_t)f, u < v, 0};
        }
    qsort(e->side, e->n_sides, sizeof *e->side, brc_tuple4_compare);
    for (size_t i = 0; i < e->n_sides; i++) {
        if (i == 0 || brc_tuple2_compare(&e->side[i], &e->side[i - 1]) != 0)
            e->first[e->n++] = i;
        e->side[i].edge = (int32_t)e->n - 1;
    }
    e->first[e->n] = e->n_sides;
    return 0;
}

void brc_edges_free(struct brc_edges *e)
{
    free(e->side);
    free(e->first);
}

int32_t brc_edges_number(const struct brc_edges *e, int32_t u, int32_t v)
{
    const struct brc_side key = {.low = u < v ? u : v, .high = u < v ? v : u};
    const struct brc_side *side =
        bsearch(&key, e->side, e->n_sides, sizeof key, brc_tuple2_compare);
    return side ? side->edge : -1;
}
