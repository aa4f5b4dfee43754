/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of the bodies, and where a point of one is now. Their motion is in integrate.c. */
#include "common/engine/bodies.h"

#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_bodies
static const struct brc_field body_fields[] = {
    BRC_BODY_FIELDS(BRC_FIELD, BRC_FIELD3, BRC_FIELD_RENAMED)};
#undef BRC_OWNER

int brc_bodies_create(struct brc_context *ctx, struct brc_bodies *b, size_t n_grains,
                      size_t n_platens, struct brc_fieldset model)
{
    memset(b, 0, sizeof *b);
    struct brc_fieldset common = BRC_FIELDSET(body_fields, struct brc_bodies);
    brc_table_init(&b->table, "bodies", common, b);
    b->model_columns = brc_alloc(ctx, 1, model.owner_size);
    if (!b->model_columns)
        return BRC_ERR_MEMORY;
    brc_table_init(&b->model, "bodies_model", model, b->model_columns);
    b->n = n_grains + n_platens;
    b->n_grains = n_grains;
    BRC_TRY(brc_table_resize(ctx, &b->table, b->n));
    BRC_TRY(brc_table_resize(ctx, &b->model, b->n));
    for (size_t i = 0; i < b->n; i++)
        b->q[i][0] = b->q0[i][0] = 1;
    return 0;
}

void brc_bodies_free(struct brc_bodies *b)
{
    brc_table_free(&b->table);
    brc_table_free(&b->model);
    free(b->model_columns);
    memset(b, 0, sizeof *b);
}

/* From the start by the whole rotation since, so that no error of single steps adds up in drawn
 * meshes. */
void brc_bodies_carry(const struct brc_bodies *b, size_t body, const double p[3], double now[3])
{
    double arm[3], local[3], m[3][3], m0[3][3];
    brc_quat_matrix(m, b->q[body]);
    brc_quat_matrix(m0, b->q0[body]);
    brc_sub(arm, p, b->x0[body]);
    brc_mat_mul_t(local, m0, arm);
    brc_mat_mul(arm, m, local);
    brc_add(now, b->x[body], arm);
}
