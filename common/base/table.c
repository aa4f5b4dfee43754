/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One block holds all columns of a table, and large blocks ask for large pages. Rejected: columns
 * that begin at different places modulo 4096, so as not to compete for lines of the cache. That
 * gave vgcm 3 to 5 % and cost polyhedra 3 to 8 % (bench_vgcm, bench_polyhedra). Rows are a multiple
 * of four, so that vector loops need no remainder.
 *
 * One array for each field rather than one struct for each row: a loop reads few of the fields, and
 * those of four rows at once. Knows nothing of what fields mean; which are state, scratch or left
 * out stands in their list. */
#define _DEFAULT_SOURCE /* for madvise; NOLINT(bugprone-reserved-identifier) */
#include "common/base/table.h"

#include "common/base/invariant.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum {
    ALIGNMENT = 64,
    ROWS = 4,            /* capacity is a multiple of it */
    LARGE_PAGE = 1 << 21 /* blocks of at least this size ask for pages of it */
};

size_t brc_type_size(enum brc_type type)
{
    static const size_t size[] = {[BRC_F64] = 8, [BRC_I32] = 4, [BRC_U8] = 1, [BRC_I64] = 8};
    return size[type];
}

size_t brc_field_size(const struct brc_field *f)
{
    return brc_type_size(f->type) * (size_t)f->width;
}

static void **column_slot(const struct brc_table *t, int field)
{
    return (void **)((char *)t->columns + t->set.fields[field].offset);
}

void *brc_table_column(const struct brc_table *t, int field)
{
    BRC_ASSERT(field >= 0 && field < t->set.n && t->n <= t->cap);
    return *column_slot(t, field);
}

double brc_table_number(const struct brc_table *t, int field, size_t k)
{
    const void *column = brc_table_column(t, field);
    switch (t->set.fields[field].type) {
    case BRC_F64:
        return ((const double *)column)[k];
    case BRC_I64:
        return (double)((const int64_t *)column)[k];
    case BRC_I32:
        return ((const int32_t *)column)[k];
    case BRC_U8:
        return ((const uint8_t *)column)[k];
    }
    return 0;
}

void brc_table_init(struct brc_table *t, const char *name, struct brc_fieldset set, void *columns)
{
    *t = (struct brc_table){.name = name, .set = set, .columns = columns};
}

static size_t round_up(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

/* One block for all columns of cap rows, and where in it each begins. Half of
 * the address space is refused as a size, so that sums of offsets cannot overflow. */
static void *allocate(struct brc_context *ctx, const struct brc_table *t, size_t cap,
                      size_t *offset)
{
    size_t bytes = 0, row_size = 0;
    void *block = NULL;
    for (int i = 0; i < t->set.n; i++)
        row_size += brc_field_size(&t->set.fields[i]);
    if (row_size == 0 || cap <= PTRDIFF_MAX / 2 / row_size) {
        for (int i = 0; i < t->set.n; i++) {
            offset[i] = round_up(bytes, ALIGNMENT);
            bytes = offset[i] + cap * brc_field_size(&t->set.fields[i]);
        }
        size_t unit = bytes < LARGE_PAGE ? ALIGNMENT : LARGE_PAGE;
        bytes = round_up(bytes > 0 ? bytes : 1, unit);
        block = aligned_alloc(unit, bytes);
        if (block && unit == LARGE_PAGE)
            (void)madvise(block, bytes, MADV_HUGEPAGE); /* a wish: pages may stay small */
    }
    return brc_alloc_check(ctx, block, cap, row_size);
}

/* Allocates new columns of cap rows, filled by from (see brc_table_gather) or by the old rows in
 * order when from is NULL; either all columns change or none. Rows past the last are zeroed up to
 * the next four, as lanes read them; those beyond are zeroed when they come into use. */
static int replace_columns(struct brc_context *ctx, struct brc_table *t, const size_t *from,
                           size_t n, size_t cap)
{
    size_t filled = round_up(n, ROWS);
    cap = round_up(cap, ROWS);
    BRC_ASSERT(filled <= cap && n <= cap);
    size_t *offset = brc_alloc(ctx, (size_t)t->set.n, sizeof *offset);
    char *block = offset ? allocate(ctx, t, cap, offset) : NULL;
    if (!block) {
        free(offset);
        return BRC_ERR_MEMORY;
    }
    for (int i = 0; i < t->set.n; i++) {
        size_t size = brc_field_size(&t->set.fields[i]);
        char *to = block + offset[i];
        const char *old = brc_table_column(t, i);
        size_t kept = from || t->n > n ? n : t->n;
        if (!from && kept > 0)
            memcpy(to, old, kept * size);
        for (size_t row = 0; from && row < n; row++) {
            if (from[row] == BRC_NEW_ROW)
                memset(to + row * size, 0, size);
            else {
                BRC_ASSERT(from[row] < t->n);
                memcpy(to + row * size, old + from[row] * size, size);
            }
        }
        memset(to + kept * size, 0, (filled - kept) * size);
    }
    for (int i = 0; i < t->set.n; i++)
        *column_slot(t, i) = block + offset[i];
    free(offset);
    free(t->block);
    t->block = block;
    t->n = n;
    t->cap = cap;
    return 0;
}

int brc_table_resize(struct brc_context *ctx, struct brc_table *t, size_t n)
{
    if (n > t->cap) {
        size_t cap = t->cap > 0 ? t->cap : 16;
        while (cap < n)
            cap = cap <= SIZE_MAX / 2 ? 2 * cap : n;
        return replace_columns(ctx, t, NULL, n, cap);
    }
    if (n > t->n)
        brc_table_clear(t, t->n, round_up(n, ROWS) - t->n);
    t->n = n;
    return 0;
}

void brc_table_copy(struct brc_table *t, size_t to, size_t from, size_t n)
{
    BRC_ASSERT(to + n <= t->n && from + n <= t->n);
    for (int i = 0; i < t->set.n; i++) {
        size_t size = brc_field_size(&t->set.fields[i]);
        char *column = brc_table_column(t, i);
        memmove(column + to * size, column + from * size, n * size);
    }
}

void brc_table_clear(struct brc_table *t, size_t first, size_t n)
{
    BRC_ASSERT(first + n <= t->cap);
    for (int i = 0; i < t->set.n; i++) {
        size_t size = brc_field_size(&t->set.fields[i]);
        memset((char *)brc_table_column(t, i) + first * size, 0, n * size);
    }
}

/* The rows that stay keep their order. */
static bool is_ascending(const size_t *from, size_t n)
{
    size_t least = 0;
    for (size_t row = 0; row < n; row++) {
        if (from[row] == BRC_NEW_ROW)
            continue;
        if (from[row] < least)
            return false;
        least = from[row] + 1;
    }
    return true;
}

/* Rows in ascending order move in the columns that are there: first those that move down, from the
 * first one on, then those that move up, from the last one on. So lists of contacts change: they
 * are made anew many times in a run, most rows stay where they are, and no second table is needed.
 */
static void gather_in_place(struct brc_table *t, const size_t *from, size_t n)
{
    for (int i = 0; i < t->set.n; i++) {
        size_t size = brc_field_size(&t->set.fields[i]);
        char *column = brc_table_column(t, i);
        for (size_t row = 0; row < n; row++)
            if (from[row] != BRC_NEW_ROW && from[row] > row)
                memcpy(column + row * size, column + from[row] * size, size);
        for (size_t row = n; row-- > 0;)
            if (from[row] < row) /* no new row is */
                memcpy(column + row * size, column + from[row] * size, size);
        for (size_t row = 0; row < n; row++)
            if (from[row] == BRC_NEW_ROW)
                memset(column + row * size, 0, size);
        memset(column + n * size, 0, (round_up(n, ROWS) - n) * size);
    }
    t->n = n;
}

int brc_table_gather(struct brc_context *ctx, struct brc_table *t, const size_t *from, size_t n)
{
    BRC_ASSERT(t->n <= t->cap);
    if (n <= t->cap && is_ascending(from, n)) {
        gather_in_place(t, from, n);
        return 0;
    }
    return replace_columns(ctx, t, from, n, n > t->cap ? n + n / 2 : t->cap);
}

void brc_table_free(struct brc_table *t)
{
    free(t->block);
    t->block = NULL;
    for (int i = 0; i < t->set.n; i++)
        *column_slot(t, i) = NULL;
    t->n = t->cap = 0;
}

/* By words of 8 bytes, as states are hashed often and a byte at a time takes eight times as many
 * steps. */
uint64_t brc_hash_bytes(const void *data, size_t n, uint64_t seed)
{
    const unsigned char *bytes = data;
    uint64_t hash = seed;
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        uint64_t word;
        memcpy(&word, bytes + i, 8);
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
        hash ^= hash >> 29; /* FNV alone never moves high bits down */
    }
    for (; i < n; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

/* Names are whole words of the list: "f" must not be found in "fs". */
static bool is_named(const char *names, const char *name)
{
    size_t size = strlen(name);
    for (const char *at = names; at && (at = strstr(at, name)); at += size) {
        bool begins = at == names || at[-1] == ' ';
        if (begins && (at[size] == ' ' || at[size] == '\0'))
            return true;
    }
    return false;
}

void brc_table_leave_out(struct brc_table *t, const char *names)
{
    for (int i = 0; i < t->set.n && i < 64; i++)
        if (is_named(names, t->set.fields[i].name))
            t->left_out |= UINT64_C(1) << i;
}

/* A mask of 64 bits: what is left out stands among the first 64 fields of its list. */
bool brc_table_saves(const struct brc_table *t, int field)
{
    bool is_left_out = field < 64 && (t->left_out >> field & 1);
    return (t->set.fields[field].flags & BRC_STATE) && !is_left_out;
}

uint64_t brc_table_hash(const struct brc_table *t, uint64_t seed)
{
    uint64_t hash = brc_hash_bytes(&t->n, sizeof t->n, seed);
    for (int i = 0; i < t->set.n; i++)
        if (brc_table_saves(t, i))
            hash = brc_hash_bytes(brc_table_column(t, i), t->n * brc_field_size(&t->set.fields[i]),
                                  hash);
    return hash;
}
