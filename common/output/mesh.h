/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh for programs that draw: points, cells of one kind, and a table of values of the cells.
 * Filled by frame_mesh.c, written by vtk.c; knows nothing of simulations. Cells are made one corner
 * after the other, so that nobody has to count them before. */
#ifndef BRC_MESH_H
#define BRC_MESH_H

#include "common/base/table.h"

enum brc_mesh_kind { BRC_MESH_LINES = 3, BRC_MESH_POLYGONS = 7 }; /* VTK's cell types */

/* Owned and freed as a whole. Numbers of points are 64 bits wide, as VTK wants them in files. */
struct brc_mesh {
    enum brc_mesh_kind kind;
    size_t n_points, cap_points, n_ids, cap_ids, n_cells, cap_ends;
    double (*point)[3];     /* [n_points] m */
    int64_t *id;            /* [n_ids] points of the cells, one cell after the other */
    int64_t *end;           /* [n_cells] where a cell ends in id */
    struct brc_table cells; /* values, a row a cell; the owner struct is the caller's */
};

/* An empty mesh; cells is the zeroed struct of the set's columns, which lives as long. */
void brc_mesh_init(struct brc_mesh *m, enum brc_mesh_kind kind, const char *name,
                   struct brc_fieldset set, void *cells);
/* The table of values is freed, too. */
void brc_mesh_free(struct brc_mesh *m);
/* A corner of the cell that is being made: the point *number, or where that is below 0 a new one at
 * x, which gets its number. */
int brc_mesh_corner(struct brc_context *ctx, struct brc_mesh *m, const double x[3],
                    int64_t *number);
/* Ends the cell. The table of values is resized by the caller. */
int brc_mesh_end_cell(struct brc_context *ctx, struct brc_mesh *m);

#endif
