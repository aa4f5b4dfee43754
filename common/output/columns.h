/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables whose columns are known only as the program runs, numbers and texts side by side, to CSV
 * and HDF5 alike. For what is gathered from many runs; tables of one run are declared (table.h). */
#ifndef BRC_COLUMNS_H
#define BRC_COLUMNS_H

#include "common/base/pool.h"

struct brc_columns {
    const char *name; /* of the table: its group in HDF5 */
    struct brc_pool *pool;
    size_t n_rows, n, cap;
    struct brc_column {
        const char *name, *unit; /* unit "": a pure number that needs none; a text */
        double *number;          /* [n_rows]; NULL: texts. NAN: nothing there */
        const char **text;
    } * column;
};

/* Column i of n_rows zeros, or of texts "", is added; names and units must outlive the table.
 * BRC_ERR_MEMORY. All memory is the pool's. */
int brc_columns_add(struct brc_context *ctx, struct brc_columns *c, const char *name,
                    const char *unit, bool is_text);
/* The last column. */
struct brc_column *brc_columns_last(const struct brc_columns *c);
/* dir/file: a header with the units in brackets, numbers of 17 digits, nothing where a number is
 * none. */
int brc_columns_csv(struct brc_context *ctx, const struct brc_columns *c, const char *dir,
                    const char *file);
/* dir/file: a group a table, in which each column is a dataset with its unit. */
int brc_columns_h5(struct brc_context *ctx, const struct brc_columns *const *table, int n,
                   const char *dir, const char *file);

#endif
