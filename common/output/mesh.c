/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of a mesh; what it shows is filled in by frame_mesh.c. */
#include "common/output/mesh.h"

#include "common/base/grow.h"

#include <stdlib.h>
#include <string.h>

void brc_mesh_init(struct brc_mesh *m, enum brc_mesh_kind kind, const char *name,
                   struct brc_fieldset set, void *cells)
{
    *m = (struct brc_mesh){.kind = kind};
    brc_table_init(&m->cells, name, set, cells);
}

void brc_mesh_free(struct brc_mesh *m)
{
    free(m->point);
    free(m->id);
    free(m->end);
    brc_table_free(&m->cells);
    memset(m, 0, sizeof *m);
}

/* Points, corners and cells grow each by itself; the table of values follows once, when all cells
 * are there. */
int brc_mesh_corner(struct brc_context *ctx, struct brc_mesh *m, const double x[3], int64_t *number)
{
    if (*number < 0) {
        BRC_GROW(ctx, m->point, m->cap_points, m->n_points + 1);
        memcpy(m->point[m->n_points], x, sizeof *m->point);
        *number = (int64_t)m->n_points++;
    }
    BRC_GROW(ctx, m->id, m->cap_ids, m->n_ids + 1);
    m->id[m->n_ids++] = *number;
    return 0;
}

int brc_mesh_end_cell(struct brc_context *ctx, struct brc_mesh *m)
{
    BRC_GROW(ctx, m->end, m->cap_ends, m->n_cells + 1);
    m->end[m->n_cells++] = (int64_t)m->n_ids;
    return 0;
}
