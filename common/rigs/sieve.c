/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fragments of engine/fragments.h as a table, for a file and for results. By the mass of whole
 * cells and the sphere of their volume: a real sieve sorts by the middle one of three widths, which
 * for fragments of a few grains would be the grains' own. Called when results are asked for. */
#include "common/rigs/sieve.h"

#include "common/engine/fragments.h"
#include "common/engine/sim.h"

#include <math.h>

#define BRC_OWNER struct brc_sieve
static const struct brc_field fields[] = {BRC_SIEVE_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* From the smallest fragment on, so that the sums are of what passes. */
static void fill(struct brc_sieve *s, const struct brc_fragments *f, const double *mass)
{
    for (size_t i = 0; i < f->n_grains; i++)
        s->mass[f->of[i]] += mass[i];
    for (size_t k = f->n; k-- > 0;) {
        s->grains[k] = f->size[k];
        s->n_pieces += f->size[k] >= BRC_PIECE_GRAINS;
        s->diameter[k] = cbrt(6 * f->volume[k] / BRC_PI);
        s->passing[k] = s->whole += s->mass[k];
    }
    for (size_t k = 0; k < f->n; k++)
        s->passing[k] /= s->whole;
}

int brc_sieve_make(const struct brc_sim *sim, struct brc_sieve *out)
{
    struct brc_fieldset set = BRC_FIELDSET(fields, struct brc_sieve);
    struct brc_fragments f;
    *out = (struct brc_sieve){0};
    brc_table_init(&out->table, "fragments", set, out);
    int code = brc_fragments_find(sim->ctx, sim, &f);
    if (code == 0)
        code = brc_table_resize(sim->ctx, &out->table, f.n);
    if (code == 0)
        fill(out, &f, sim->bodies.true_mass);
    brc_fragments_free(&f);
    return code;
}

void brc_sieve_free(struct brc_sieve *s)
{
    brc_table_free(&s->table);
}
