/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/output/columns.h"

#include "common/base/text_file.h"
#include "common/output/h5.h"
#include "common/output/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int brc_columns_add(struct brc_context *ctx, struct brc_columns *c, const char *name,
                    const char *unit, bool is_text)
{
    struct brc_column new = {.name = name, .unit = unit};
    if (c->n == c->cap) {
        size_t cap = c->cap ? 2 * c->cap : 32;
        struct brc_column *more = brc_pool_alloc(ctx, c->pool, cap, sizeof *more);
        if (!more)
            return BRC_ERR_MEMORY;
        if (c->n > 0)
            memcpy(more, c->column, c->n * sizeof *more);
        c->column = more;
        c->cap = cap;
    }
    if (is_text)
        new.text = brc_pool_alloc(ctx, c->pool, c->n_rows, sizeof *new.text);
    else
        new.number = brc_pool_alloc(ctx, c->pool, c->n_rows, sizeof *new.number);
    if (!new.text && !new.number)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; is_text && i < c->n_rows; i++)
        new.text[i] = "";
    c->column[c->n++] = new;
    return 0;
}

struct brc_column *brc_columns_last(const struct brc_columns *c)
{
    return &c->column[c->n - 1];
}

static void put_cell(FILE *out, const struct brc_column *column, size_t row)
{
    if (column->text)
        brc_output_cell(out, column->text[row]);
    else if (isfinite(column->number[row]))
        fprintf(out, "%.17g", column->number[row]);
}

int brc_columns_csv(struct brc_context *ctx, const struct brc_columns *c, const char *dir,
                    const char *file)
{
    struct brc_text_file f;
    char name[160];
    BRC_TRY(brc_text_file_begin(ctx, &f, dir, file));
    for (size_t i = 0; i < c->n; i++) {
        const struct brc_column *k = &c->column[i];
        snprintf(name, sizeof name, *k->unit ? "%s [%s]" : "%s", k->name, k->unit);
        fputs(i ? "," : "", f.out);
        brc_output_cell(f.out, name);
    }
    fputc('\n', f.out);
    for (size_t row = 0; row < c->n_rows; row++)
        for (size_t i = 0; i < c->n; i++) {
            put_cell(f.out, &c->column[i], row);
            fputc(i + 1 < c->n ? ',' : '\n', f.out);
        }
    return brc_text_file_end(ctx, &f);
}

/* A slash would make a group of the column. */
static int put_column(const struct brc_h5_file *f, const struct brc_columns *c,
                      const struct brc_column *k)
{
    char path[256];
    size_t n = (size_t)snprintf(path, sizeof path, "%s/", c->name);
    snprintf(path + n, sizeof path - n, "%s", k->name);
    for (char *at = path + n; *at; at++)
        if (*at == '/')
            *at = '_';
    if (k->text)
        return brc_h5_put_texts(f, path, k->text, c->n_rows);
    const struct brc_h5_array a = {.name = path,
                                   .type = BRC_F64,
                                   .rows = c->n_rows,
                                   .width = 1,
                                   .is_flat = true,
                                   .unit = *k->unit ? k->unit : "1"};
    return brc_h5_put_array(f, &a, k->number, true);
}

static int put_tables(const struct brc_h5_file *f, const struct brc_columns *const *table, int n)
{
    for (int i = 0; i < n; i++) {
        BRC_TRY(brc_h5_put_group(f, table[i]->name));
        for (size_t k = 0; k < table[i]->n; k++)
            BRC_TRY(put_column(f, table[i], &table[i]->column[k]));
    }
    return 0;
}

int brc_columns_h5(struct brc_context *ctx, const struct brc_columns *const *table, int n,
                   const char *dir, const char *file)
{
    char path[BRC_PATH_SIZE];
    struct brc_h5_file f;
    BRC_TRY(brc_folder_path(ctx, dir, file, path));
    BRC_TRY(brc_h5_create(ctx, path, &brc_checksum_tables, &f));
    return brc_h5_finish(&f, put_tables(&f, table, n));
}
