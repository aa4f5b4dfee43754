/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of feature lists: one list is made over and over again for all contacts, so it grows
 * and never shrinks. */
#include "polyhedra/feature_list.h"

#include <stdlib.h>
#include <string.h>

void poly_list_free(struct poly_list *l)
{
    free(l->feature);
    free(l->work);
    free(l->edge);
    memset(l, 0, sizeof *l);
}

int poly_list_add(struct brc_context *ctx, struct poly_list *l, const struct poly_feature *f)
{
    if (l->n == l->cap) {
        size_t cap = l->cap > 0 ? 2 * l->cap : 64;
        struct poly_feature *grown = brc_realloc(ctx, l->feature, cap, sizeof *grown);
        if (grown == NULL)
            return BRC_ERR_MEMORY;
        l->feature = grown;
        l->cap = cap;
    }
    l->feature[l->n++] = *f;
    return 0;
}
