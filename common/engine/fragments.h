/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fragments: grains that bonds hold together. A bond holds while it is intact and has at least half
 * of its tensile strength left: one that softens is all but gone before its last point is. They are
 * numbered by volume, the largest first, and by their lowest grain where volumes are equal. */
#ifndef BRC_FRAGMENTS_H
#define BRC_FRAGMENTS_H

#include "common/engine/contacts.h"

struct brc_sim;

struct brc_fragments {
    size_t n, n_grains;
    int32_t *of;    /* [n_grains] fragment of a grain */
    double *volume; /* [n] m3 */
    int32_t *size;  /* [n] grains */
};

/* Part of its tensile strength that a bond must have left to hold. */
#define BRC_FRAGMENT_STRENGTH 0.5

/* Of a simulation as it is now. Freed by brc_fragments_free, also after a failure. */
int brc_fragments_find(struct brc_context *ctx, const struct brc_sim *sim,
                       struct brc_fragments *out);
/* volume: of the n_grains grains; pairs: between them; holds: of each pair. Freed like the other.
 */
int brc_fragments_connect(struct brc_context *ctx, size_t n_grains, const double *volume,
                          const struct brc_contacts *pairs, const uint8_t *holds,
                          struct brc_fragments *out);
void brc_fragments_free(struct brc_fragments *f);

#endif
