/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh for programs that draw: points, cells of one kind, and a table of values of the cells. */
#ifndef BRC_MESH_H
#define BRC_MESH_H

#include "common/base/table.h"

enum brc_mesh_kind { BRC_MESH_LINES = 3, BRC_MESH_POLYGONS = 7 }; /* VTK's cell types */

struct brc_mesh {
    enum brc_mesh_kind kind;
    size_t n_points, cap_points, n_ids, cap_ids, n_cells, cap_ends;
    double (*point)[3];     /* [n_points] m */
    int64_t *id;            /* [n_ids] points of the cells, one cell after the other */
    int64_t *end;           /* [n_cells] where a cell ends in id */
    struct brc_table cells; /* values, a row a cell; the owner struct is the caller's */
};

void brc_mesh_init(struct brc_mesh *m, enum brc_mesh_kind kind);
/* The table of values is freed, too. */
void brc_mesh_free(struct brc_mesh *m);
/* Adds a point and gives its number. */
int brc_mesh_point(struct brc_context *ctx, struct brc_mesh *m, const double x[3], int64_t *number);
/* Adds a point number to the cell that is being made; ends it. */
int brc_mesh_id(struct brc_context *ctx, struct brc_mesh *m, int64_t point);
int brc_mesh_end_cell(struct brc_context *ctx, struct brc_mesh *m);

#endif
