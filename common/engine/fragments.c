/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Connected parts of the specimen by union-find over the bonds that hold: nearly linear in the
 * bonds, without the lists of neighbours that a search through the graph would need. Called by runs
 * and frames, never by a step. */
#include "common/engine/fragments.h"

#include "common/base/disjoint.h"
#include "common/engine/sim.h"

#include <stdlib.h>
#include <string.h>

/* A fragment while they are put in order; its root is its lowest grain. */
struct entry {
    double volume;
    int32_t root, size;
};

/* By grain where volumes are equal: else equal grains of a grid would be numbered by qsort's whim.
 */
static int by_volume(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->volume != q->volume)
        return p->volume > q->volume ? -1 : 1;
    return p->root < q->root ? -1 : p->root > q->root;
}

/* Fills out->of, which holds parents, and the rest from the sorted entries. */
static void number(struct brc_fragments *out, const double *volume, struct entry *entry)
{
    int32_t *parent = out->of;
    size_t n = 0;
    for (size_t i = 0; i < out->n_grains; i++)
        parent[i] = brc_disjoint_root(parent, (int32_t)i);
    /* a root comes before its grains: size counts them, root finds the entry */
    for (size_t i = 0; i < out->n_grains; i++) {
        if (parent[i] == (int32_t)i) {
            out->size[i] = (int32_t)n;
            entry[n++] = (struct entry){.root = (int32_t)i};
        }
        struct entry *e = &entry[out->size[parent[i]]];
        e->volume += volume[i];
        e->size++;
    }
    qsort(entry, n, sizeof *entry, by_volume);
    for (size_t k = 0; k < n; k++)
        out->size[entry[k].root] = (int32_t)k;
    for (size_t i = 0; i < out->n_grains; i++)
        out->of[i] = out->size[parent[i]];
    for (size_t k = 0; k < n; k++) {
        out->volume[k] = entry[k].volume;
        out->size[k] = entry[k].size;
    }
    out->n = n;
}

int brc_fragments_connect(struct brc_context *ctx, size_t n_grains, const double *volume,
                          const struct brc_contacts *pairs, const uint8_t *holds,
                          struct brc_fragments *out)
{
    struct entry *entry = brc_alloc(ctx, n_grains, sizeof *entry);
    *out = (struct brc_fragments){.n_grains = n_grains,
                                  .of = brc_alloc(ctx, n_grains, sizeof *out->of),
                                  .volume = brc_alloc(ctx, n_grains, sizeof *out->volume),
                                  .size = brc_alloc(ctx, n_grains, sizeof *out->size)};
    int code = entry && out->of && out->volume && out->size ? 0 : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < n_grains; i++)
        out->of[i] = (int32_t)i;
    for (size_t i = 0; code == 0 && i < pairs->n; i++)
        if (holds[i])
            brc_disjoint_join(out->of, pairs->a[i], pairs->b[i]);
    if (code == 0)
        number(out, volume, entry);
    free(entry);
    return code;
}

int brc_fragments_find(struct brc_context *ctx, const struct brc_sim *sim,
                       struct brc_fragments *out)
{
    const struct brc_contacts *c = &sim->pairs;
    double (*left)(const struct brc_sim *, const void *, size_t) = sim->model.strength_left;
    uint8_t *holds = brc_alloc(ctx, c->n, sizeof *holds);
    *out = (struct brc_fragments){0};
    if (!holds)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < c->n; i++)
        holds[i] = c->status[i] == BRC_INTACT &&
                   (!left || left(sim, sim->state, i) >= BRC_FRAGMENT_STRENGTH);
    int code = brc_fragments_connect(ctx, sim->bodies.n_grains, sim->specimen->facets.volume, c,
                                     holds, out);
    free(holds);
    return code;
}

void brc_fragments_free(struct brc_fragments *f)
{
    free(f->of);
    free(f->volume);
    free(f->size);
    memset(f, 0, sizeof *f);
}
