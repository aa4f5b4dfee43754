/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of contacts, sorted by (a, b), with ranges of points in a table of their own. Called by
 * models (rows and points) and by sim.c; what the fields mean is the models' affair.
 *
 * A row's points lie side by side, since loops go over them so, and all points lie in one table,
 * since they are saved and hashed as one. A range that grows moves to the end and leaves a hole;
 * holes are closed when they have become a fifth of the memory, as closing them at once would move
 * all points for each crack. */
#include "common/engine/contacts.h"

#include "common/base/invariant.h"
#include "common/engine/platens.h"

#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_contacts
static const struct brc_field contact_fields[] = {BRC_CONTACT_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* One table each for common fields, model fields and points. */
int brc_contacts_create(struct brc_context *ctx, struct brc_contacts *c, const char *name,
                        size_t n_bodies, struct brc_fieldset model, struct brc_fieldset points)
{
    memset(c, 0, sizeof *c);
    c->lanes = 1;
    struct brc_fieldset common = BRC_FIELDSET(contact_fields, struct brc_contacts);
    brc_table_init(&c->table, name, common, c);
    c->n_bodies = n_bodies;
    c->model_columns = brc_alloc(ctx, 1, model.owner_size);
    c->point_columns = brc_alloc(ctx, 1, points.owner_size);
    c->adjacent_first = brc_alloc(ctx, n_bodies + 1, sizeof *c->adjacent_first);
    if (!c->model_columns || !c->point_columns || !c->adjacent_first)
        return BRC_ERR_MEMORY;
    brc_table_init(&c->model, "model", model, c->model_columns);
    brc_table_init(&c->points, "points", points, c->point_columns);
    /* room for one row, so that no column is ever NULL */
    BRC_TRY(brc_table_resize(ctx, &c->table, 1));
    BRC_TRY(brc_table_resize(ctx, &c->model, 1));
    BRC_TRY(brc_table_resize(ctx, &c->points, 1));
    return brc_contacts_set(ctx, c, NULL, 0);
}

void brc_contacts_free(struct brc_contacts *c)
{
    brc_table_free(&c->table);
    brc_table_free(&c->model);
    brc_table_free(&c->points);
    free(c->model_columns);
    free(c->point_columns);
    free(c->adjacent_first);
    free(c->adjacent);
    memset(c, 0, sizeof *c);
}

/* Pairs in their order, as numbers. */
static int64_t key_of(int32_t a, int32_t b)
{
    return ((int64_t)a << 32) | b;
}

/* Rows of each body by counting; rows are sorted, so each list comes out ascending. */
static int build_adjacency(struct brc_context *ctx, struct brc_contacts *c)
{
    uint32_t *adjacent = brc_realloc(ctx, c->adjacent, 2 * c->n, sizeof *adjacent);
    if (!adjacent)
        return BRC_ERR_MEMORY;
    c->adjacent = adjacent;
    size_t *first = c->adjacent_first;
    memset(first, 0, (c->n_bodies + 1) * sizeof *first);
    for (size_t i = 0; i < c->n; i++) {
        first[c->a[i] + 1]++;
        first[c->b[i] + 1]++;
    }
    for (size_t b = 0; b < c->n_bodies; b++)
        first[b + 1] += first[b];
    for (size_t i = 0; i < c->n; i++) {
        adjacent[first[c->a[i]]++] = (uint32_t)(2 * i);
        adjacent[first[c->b[i]]++] = (uint32_t)(2 * i + 1);
    }
    for (size_t b = c->n_bodies; b > 0; b--)
        first[b] = first[b - 1];
    first[0] = 0;
    BRC_ASSERT(first[c->n_bodies] == 2 * c->n);
    return 0;
}

/* Points that a range of np takes up. */
static int32_t padded(int32_t np, int32_t lanes)
{
    return (np + lanes - 1) / lanes * lanes;
}

/* Both lists are sorted, so one pass finds what stays. Rows that stay are moved and not made anew:
 * their history (bond, friction, damage) is the state of the specimen. Most searches find what is
 * there already: then no table moves. */
int brc_contacts_set(struct brc_context *ctx, struct brc_contacts *c, const int32_t (*pair)[2],
                     size_t n)
{
    size_t *from = brc_alloc(ctx, n, sizeof *from);
    bool is_same = n == c->table.n;
    if (!from)
        return BRC_ERR_MEMORY;
    for (size_t i = 0, old = 0; i < n; i++) {
        int64_t key = key_of(pair[i][0], pair[i][1]);
        BRC_ASSERT(pair[i][0] >= 0 && pair[i][0] < pair[i][1]);
        BRC_ASSERT((size_t)pair[i][1] < c->n_bodies);
        BRC_ASSERT(i == 0 || key_of(pair[i - 1][0], pair[i - 1][1]) < key);
        while (old < c->n && key_of(c->a[old], c->b[old]) < key)
            old++;
        from[i] = old < c->n && key_of(c->a[old], c->b[old]) == key ? old : BRC_NEW_ROW;
        is_same = is_same && from[i] == i;
    }
    int code = is_same ? 0 : brc_table_gather(ctx, &c->table, from, n);
    if (code == 0 && !is_same)
        code = brc_table_gather(ctx, &c->model, from, n);
    for (size_t i = 0; code == 0 && i < n; i++) {
        if (from[i] != BRC_NEW_ROW)
            continue;
        c->a[i] = pair[i][0];
        c->b[i] = pair[i][1];
        c->facet[i] = -1;
    }
    free(from);
    BRC_TRY(code);
    if (!is_same) {
        c->n = n;
        c->k_version++;
        BRC_TRY(build_adjacency(ctx, c));
    }
    return brc_contacts_tidy(ctx, c);
}

int brc_contacts_merge(struct brc_context *ctx, struct brc_contacts *c,
                       const struct brc_neighbours *near, brc_contacts_stays *stays,
                       const void *user)
{
    int32_t(*pair)[2] = brc_alloc(ctx, near->n + c->n, sizeof *pair);
    if (!pair)
        return BRC_ERR_MEMORY;
    size_t n = 0, i = 0, k = 0;
    while (i < c->n || k < near->n) {
        int64_t own = i < c->n ? key_of(c->a[i], c->b[i]) : INT64_MAX;
        int64_t found = k < near->n ? key_of(near->pair[k][0], near->pair[k][1]) : INT64_MAX;
        bool is_there = own <= found, is_near = found <= own;
        pair[n][0] = is_there ? c->a[i] : near->pair[k][0];
        pair[n][1] = is_there ? c->b[i] : near->pair[k][1];
        n += stays(user, c, pair[n], is_there ? (int64_t)i : -1, is_near);
        i += is_there;
        k += is_near;
    }
    int code = brc_contacts_set(ctx, c, (const int32_t(*)[2])pair, n);
    free(pair);
    return code;
}

int brc_contacts_open(struct brc_context *ctx, struct brc_contacts *c,
                      const struct brc_facing *facet, size_t n)
{
    int32_t(*pair)[2] = brc_alloc(ctx, n, sizeof *pair);
    size_t n_pairs = 0;
    if (!pair)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && facet[i].cell == facet[i - 1].cell && facet[i].body == facet[i - 1].body)
            continue;
        pair[n_pairs][0] = facet[i].cell;
        pair[n_pairs++][1] = facet[i].body;
    }
    int code = brc_contacts_set(ctx, c, (const int32_t(*)[2])pair, n_pairs);
    free(pair);
    return code;
}

int brc_contacts_points(struct brc_context *ctx, struct brc_contacts *c, size_t i, int32_t np)
{
    size_t start = (size_t)c->p0[i], kept = (size_t)c->np[i];
    BRC_ASSERT(i < c->n && np >= 0 && c->np[i] <= c->pcap[i]);
    if (np > c->pcap[i]) {
        size_t old = start;
        int32_t reserved = padded(np, c->lanes);
        start = c->points.n;
        BRC_TRY(brc_table_resize(ctx, &c->points, start + (size_t)reserved));
        brc_table_copy(&c->points, start, old, kept);
        c->p0[i] = (int32_t)start;
        c->pcap[i] = reserved;
    } else if ((size_t)np > kept) {
        brc_table_clear(&c->points, start + kept, (size_t)np - kept);
    }
    c->np[i] = np;
    return 0;
}

/* Among the rows of body a: they are few, and nobody asks within a step. */
int64_t brc_contacts_find(const struct brc_contacts *c, int32_t a, int32_t b)
{
    for (size_t k = c->adjacent_first[a]; k < c->adjacent_first[a + 1]; k++)
        if (c->b[c->adjacent[k] / 2] == b)
            return c->adjacent[k] / 2;
    return -1;
}

int brc_contacts_pack(struct brc_context *ctx, struct brc_contacts *c, int32_t lanes)
{
    size_t total = 0, k = 0;
    for (size_t i = 0; i < c->n; i++)
        total += (size_t)padded(c->np[i], lanes);
    size_t *from = brc_alloc(ctx, total, sizeof *from);
    if (!from)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < c->n; i++) {
        int32_t start = (int32_t)k, reserved = padded(c->np[i], lanes);
        for (int32_t j = 0; j < reserved; j++)
            from[k++] = j < c->np[i] ? (size_t)(c->p0[i] + j) : BRC_NEW_ROW;
        c->p0[i] = start;
        c->pcap[i] = reserved;
    }
    int code = brc_table_gather(ctx, &c->points, from, total);
    free(from);
    return code;
}

int brc_contacts_compact(struct brc_context *ctx, struct brc_contacts *c)
{
    return brc_contacts_pack(ctx, c, c->lanes);
}

/* Files hold packed ranges and no places in memory, so both follow from the numbers of points. A
 * file whose tables contradict each other is bad input, whatever its checksum says. */
int brc_contacts_restore(struct brc_context *ctx, struct brc_contacts *c)
{
    c->n = c->table.n;
    int32_t p = 0;
    for (size_t i = 0; i < c->n; i++) {
        c->p0[i] = p;
        c->pcap[i] = c->np[i];
        p += c->np[i];
    }
    if ((size_t)p != c->points.n || c->model.n != c->n)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "saved contacts do not fit together: %zu points, %d expected",
                 c->points.n, p);
    return build_adjacency(ctx, c);
}

int brc_contacts_tidy(struct brc_context *ctx, struct brc_contacts *c)
{
    size_t used = 0;
    for (size_t i = 0; i < c->n; i++)
        used += (size_t)padded(c->np[i], c->lanes);
    return 4 * c->points.n > 5 * used + 64 ? brc_contacts_compact(ctx, c) : 0;
}

/* Row by row over the points, so that neither holes nor padding count: a state must have the hash
 * of its like that was saved, packed and read again. */
uint64_t brc_contacts_hash(const struct brc_contacts *c, uint64_t seed)
{
    uint64_t hash = brc_table_hash(&c->table, seed);
    hash = brc_table_hash(&c->model, hash);
    for (int f = 0; f < c->points.set.n; f++) {
        const struct brc_field *field = &c->points.set.fields[f];
        size_t size = brc_field_size(field);
        const char *column = brc_table_column(&c->points, f);
        for (size_t i = 0; brc_table_saves(&c->points, f) && i < c->n; i++)
            hash = brc_hash_bytes(column + (size_t)c->p0[i] * size, (size_t)c->np[i] * size, hash);
    }
    return hash;
}
