/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of feature lists: one list is made over and over again for all contacts, so it grows
 * and never shrinks. */
#include "polyhedra/feature_list.h"

#include "common/base/grow.h"

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
    BRC_GROW(ctx, l->feature, l->cap, l->n + 1);
    l->feature[l->n++] = *f;
    return 0;
}
