/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables: arrays that are declared once, in a field list, from which allocation, free, reordering,
 * hash, comparison, HDF5 output and restart are generated.
 *
 * A field list is an X-macro with two row kinds; a third, RENAMED, is for a field that files know
 * by an older name, as formats do not change with the code:
 *
 *     #define LAW_POINT_FIELDS(SCALAR, VECTOR)                                      \
 *         SCALAR(double, un, BRC_STATE, "m", "normal opening, positive apart")      \
 *         VECTOR(double, fs, 3, BRC_STATE, "N", "shear force on b")
 *     struct law_points { LAW_POINT_FIELDS(BRC_COLUMN, BRC_COLUMN3) };
 *     #define BRC_OWNER struct law_points
 *     static const struct brc_field law_point_fields[] = {
 *         LAW_POINT_FIELDS(BRC_FIELD, BRC_FIELD3)
 *     };
 *     #undef BRC_OWNER
 *
 * The list exists as the program is compiled, so that loops read plain members of a struct, with
 * their types, and pay nothing for the table. A register that is filled as the program runs would
 * cost a look-up by name, and a misspelt name would be found late.
 */
#ifndef BRC_TABLE_H
#define BRC_TABLE_H

#include "common/base/error.h"

enum brc_type { BRC_F64, BRC_I32, BRC_U8, BRC_I64 };

enum brc_field_flags {
    BRC_STATE = 1,  /* part of the state: saved, hashed, compared */
    BRC_SCRATCH = 2 /* derived anew at each step: neither saved nor hashed */
};

struct brc_field {
    const char *name; /* in files and tables */
    enum brc_type type;
    int width; /* values a row */
    unsigned flags;
    const char *unit;
    const char *meaning;
    size_t offset; /* of the column pointer in the owner struct */
};

#define BRC_TYPE_OF(type) \
    _Generic((type)0, double : BRC_F64, int32_t : BRC_I32, uint8_t : BRC_U8, int64_t : BRC_I64)
/* struct members: a column of scalars, a column of rows of n values */
#define BRC_COLUMN(type, name, flags, unit, meaning)                       type *name;
#define BRC_COLUMN3(type, name, n, flags, unit, meaning)                   type(*name)[n];
#define BRC_COLUMN_RENAMED(type, name, in_files, flags, unit, meaning)     type *name;
#define BRC_COLUMN3_RENAMED(type, name, in_files, n, flags, unit, meaning) type(*name)[n];
/* descriptors; BRC_OWNER must name the struct while they are expanded */
#define BRC_FIELD(type, name, flags, unit, meaning) \
    {#name, BRC_TYPE_OF(type), 1, flags, unit, meaning, offsetof(BRC_OWNER, name)},
#define BRC_FIELD3(type, name, n, flags, unit, meaning) \
    {#name, BRC_TYPE_OF(type), n, flags, unit, meaning, offsetof(BRC_OWNER, name)},

#define BRC_FIELD_RENAMED(type, name, in_files, flags, unit, meaning) \
    {#in_files, BRC_TYPE_OF(type), 1, flags, unit, meaning, offsetof(BRC_OWNER, name)},
#define BRC_FIELD3_RENAMED(type, name, in_files, n, flags, unit, meaning) \
    {#in_files, BRC_TYPE_OF(type), n, flags, unit, meaning, offsetof(BRC_OWNER, name)},

/* A field list with the size of its owner struct; all zero for "no fields". */
struct brc_fieldset {
    const struct brc_field *fields;
    int n;
    size_t owner_size;
};
#define BRC_FIELDSET(list, owner)                                    \
    {                                                                \
        (list), (int)(sizeof(list) / sizeof(list)[0]), sizeof(owner) \
    }

struct brc_table {
    const char *name; /* group name in output files */
    struct brc_fieldset set;
    void *columns;     /* the owner struct: column pointers at the fields' offsets */
    size_t n, cap;     /* rows in use, rows allocated; cap never falls */
    void *block;       /* memory of all columns */
    uint64_t left_out; /* bits of the fields that hold nothing here: neither saved nor hashed */
};

/* Binds a table to a caller-owned struct of column pointers (all NULL). */
void brc_table_init(struct brc_table *t, const char *name, struct brc_fieldset set, void *columns);
/* Fields that hold nothing in this table, whose set of fields serves others, too: names with a
 * space between them; names that the table lacks are passed over, as is NULL. */
void brc_table_leave_out(struct brc_table *t, const char *names);
/* Whether a field is part of the state here. */
bool brc_table_saves(const struct brc_table *t, int field);
/* Sets the row count; new rows are zero; capacity grows by doubling. Columns are 64-byte aligned,
 * hold a multiple of 4 rows (what is past the last row may be read and written), and may move. */
int brc_table_resize(struct brc_context *ctx, struct brc_table *t, size_t n);
#define BRC_NEW_ROW ((size_t)-1)
/* Row i becomes the old row from[i]; BRC_NEW_ROW gives a zero row. */
int brc_table_gather(struct brc_context *ctx, struct brc_table *t, const size_t *from, size_t n);
/* Rows [to, to + n) become copies of [from, from + n), which may overlap them; and rows of zeros,
 * up to the capacity. The row count stays. */
void brc_table_copy(struct brc_table *t, size_t to, size_t from, size_t n);
void brc_table_clear(struct brc_table *t, size_t first, size_t n);
/* Frees the columns; a half-built or zeroed table is accepted. */
void brc_table_free(struct brc_table *t);

/* Column i as bytes, and the size of one of its rows. */
void *brc_table_column(const struct brc_table *t, int field);
/* Value k of a column as a number: exact, as no count of a run comes near 2^53. */
double brc_table_number(const struct brc_table *t, int field, size_t k);
size_t brc_field_size(const struct brc_field *f);
size_t brc_type_size(enum brc_type type);

/* 64-bit hash (FNV-1a over 8-byte words) of all BRC_STATE columns, chained from seed. It tells
 * whether two states are the same bits and is part of file formats, so it must not change. It is no
 * guard against intent. */
uint64_t brc_table_hash(const struct brc_table *t, uint64_t seed);
uint64_t brc_hash_bytes(const void *data, size_t n, uint64_t seed);
#define BRC_HASH_SEED UINT64_C(0xcbf29ce484222325)

#endif
