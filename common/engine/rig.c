/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of a test: parameters, curve, and the columns and scalars that its type declares. The
 * engine calls it; what a test does with them is in common/rigs. The type's columns and scalars are
 * tables like all others, so saving, hashing and CSV files need no line for a new test. */
#include "common/engine/rig.h"

#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_curve
static const struct brc_field curve_fields[] = {BRC_CURVE_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* A copy, since the case may be gone while the simulation runs. */
static int copy_own(struct brc_context *ctx, struct brc_rig *rig, const void *own)
{
    size_t size = rig->type->params.owner_size;
    rig->own = brc_alloc(ctx, 1, size);
    if (!rig->own)
        return BRC_ERR_MEMORY;
    if (size > 0 && own)
        memcpy(rig->own, own, size);
    return 0;
}

/* A table that is wrong is a mistake in the source, but found here, as tests are written by others,
 * too: before any work, with a message, in every build. */
int brc_rig_check(struct brc_context *ctx, const struct brc_test *test)
{
    const struct brc_rig_type *t = test->type;
    if (!t->place || !t->drive || !t->measure || !t->results)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "test %s lacks a required operation", t->name);
    if (t->n_platens > BRC_MAX_PLATENS || t->n_quantities > BRC_MAX_QUANTITIES)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "test %s: %d platens and %d quantities, %d and %d at most",
                 t->name, t->n_platens, t->n_quantities, BRC_MAX_PLATENS, BRC_MAX_QUANTITIES);
    return t->check ? t->check(ctx, test->params, test->own) : 0;
}

int brc_rig_create(struct brc_context *ctx, struct brc_rig *rig, const struct brc_test *test)
{
    struct brc_fieldset set = BRC_FIELDSET(curve_fields, struct brc_curve);
    *rig = (struct brc_rig){.type = test->type,
                            .params = *test->params,
                            .n_platens = test->type->n_platens,
                            .stage_sense = 1};
    brc_table_init(&rig->curve.table, "curve", set, &rig->curve);
    BRC_TRY(copy_own(ctx, rig, test->own));
    rig->curve.own_columns = brc_alloc(ctx, 1, rig->type->columns.owner_size);
    rig->own_scalars = brc_alloc(ctx, 1, rig->type->state.owner_size);
    if (!rig->curve.own_columns || !rig->own_scalars)
        return BRC_ERR_MEMORY;
    brc_table_init(&rig->curve.own, "test", rig->type->columns, rig->curve.own_columns);
    brc_table_init(&rig->own_state, "test", rig->type->state, rig->own_scalars);
    return brc_table_resize(ctx, &rig->own_state, 1);
}

void brc_rig_free(struct brc_rig *rig)
{
    if (rig->type && rig->type->free)
        rig->type->free(rig->memory);
    brc_table_free(&rig->curve.table);
    brc_table_free(&rig->curve.own);
    brc_table_free(&rig->own_state);
    free(rig->curve.own_columns);
    free(rig->own_scalars);
    free(rig->own);
}

int brc_rig_add_row(struct brc_context *ctx, struct brc_rig *rig, size_t *row)
{
    *row = rig->curve.table.n;
    BRC_TRY(brc_table_resize(ctx, &rig->curve.table, *row + 1));
    return brc_table_resize(ctx, &rig->curve.own, *row + 1);
}
