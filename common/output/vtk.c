/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's own layout of HDF5 (VTKHDF) rather than XML files: one file a frame, the same checksum as
 * states, and no second library. */
#include "common/output/vtk.h"

#include "common/output/h5.h"
#include "common/output/output.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 256 };

/* A list of one number a row. */
static int put_list(const struct brc_h5_file *f, const char *name, enum brc_type type, size_t n,
                    const void *data)
{
    const struct brc_h5_array a = {
        .name = name, .type = type, .rows = n, .width = 1, .is_flat = true};
    return brc_h5_put_array(f, &a, data, true);
}

/* VTKHDF has its counts as arrays of one number, not as attributes: with several parts of a mesh
 * each would have one. */
static int put_number(const struct brc_h5_file *f, const char *name, size_t n)
{
    const int64_t value = (int64_t)n;
    return put_list(f, name, BRC_I64, 1, &value);
}

/* n rows of a table from `first` on, as arrays of a group; scalars are flat, as VTK wants them. */
static int put_table(const struct brc_h5_file *f, const char *group, const struct brc_table *t,
                     size_t first, size_t n)
{
    char name[NAME_SIZE];
    BRC_TRY(brc_h5_put_group(f, group));
    for (int i = 0; i < t->set.n; i++) {
        const struct brc_field *field = &t->set.fields[i];
        const struct brc_h5_array a = {.name = name,
                                       .type = field->type,
                                       .rows = n,
                                       .width = field->width,
                                       .is_flat = field->width == 1,
                                       .unit = field->unit,
                                       .meaning = field->meaning,
                                       .row = t->name};
        snprintf(name, sizeof name, "%s/%s", group, field->name);
        const char *column = brc_table_column(t, i);
        BRC_TRY(brc_h5_put_array(f, &a, column + first * brc_field_size(field), true));
    }
    return 0;
}

/* Connectivity, and where each cell begins in it; types are all the same. VTK wants one more offset
 * than there are cells, also where there are none. */
static int put_cells(const struct brc_h5_file *f, const struct brc_mesh *m)
{
    int64_t *begin = brc_alloc(f->ctx, m->n_cells + 1, sizeof *begin);
    uint8_t *type = brc_alloc(f->ctx, m->n_cells + 1, sizeof *type);
    int code = begin && type ? 0 : BRC_ERR_MEMORY;
    if (code == 0 && m->n_cells > 0) {
        memcpy(begin + 1, m->end, m->n_cells * sizeof *begin);
        memset(type, (int)m->kind, m->n_cells);
    }
    if (code == 0)
        code = put_list(f, "VTKHDF/Connectivity", BRC_I64, m->n_ids, m->id);
    if (code == 0)
        code = put_list(f, "VTKHDF/Offsets", BRC_I64, m->n_cells + 1, begin);
    if (code == 0)
        code = put_list(f, "VTKHDF/Types", BRC_U8, m->n_cells, type);
    free(begin);
    free(type);
    return code;
}

/* Names, shapes and types are those of VTKHDF 1.0, by which alone VTK finds the parts of a mesh. */
static int put_mesh(const struct brc_h5_file *f, const struct brc_mesh *m,
                    const struct brc_table *whole, size_t row)
{
    static const int64_t version[2] = {1, 0};
    const struct brc_h5_array points = {.name = "VTKHDF/Points",
                                        .type = BRC_F64,
                                        .rows = m->n_points,
                                        .width = 3,
                                        .unit = "m",
                                        .meaning = "places now",
                                        .row = "points"};
    BRC_TRY(brc_h5_put_group(f, "VTKHDF"));
    BRC_TRY(brc_h5_put_pair(f, "VTKHDF", "Version", version));
    BRC_TRY(brc_h5_put_label(f, "VTKHDF", "Type", "UnstructuredGrid"));
    BRC_TRY(put_number(f, "VTKHDF/NumberOfPoints", m->n_points));
    BRC_TRY(put_number(f, "VTKHDF/NumberOfCells", m->n_cells));
    BRC_TRY(put_number(f, "VTKHDF/NumberOfConnectivityIds", m->n_ids));
    BRC_TRY(brc_h5_put_array(f, &points, m->point, true));
    BRC_TRY(put_cells(f, m));
    BRC_TRY(put_table(f, "VTKHDF/CellData", &m->cells, 0, m->cells.n));
    return put_table(f, "VTKHDF/FieldData", whole, row, 1);
}

int brc_vtk_save(struct brc_context *ctx, const char *path, const struct brc_mesh *m,
                 const struct brc_table *whole, size_t row, const struct brc_h5_text *texts,
                 int n_texts)
{
    struct brc_h5_file f;
    BRC_TRY(brc_h5_create(ctx, path, &brc_checksum_frame, &f));
    int code = put_mesh(&f, m, whole, row);
    if (code == 0)
        code = brc_h5_put_provenance(&f, texts, n_texts);
    return brc_h5_finish(&f, code);
}

/* Named by step, not counted: frames come and go, and a counted name would change its content. */
void brc_vtk_name(char *name, size_t size, const char *prefix, int64_t step)
{
    snprintf(name, size, "%s_%05" PRId64 ".hdf", prefix, step);
}
