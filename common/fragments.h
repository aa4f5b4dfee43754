/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fragments: grains that intact bonds connect. They are numbered by volume, the largest first, and
 * by their lowest grain where volumes are equal. */
#ifndef BRC_FRAGMENTS_H
#define BRC_FRAGMENTS_H

#include "contacts.h"

struct brc_fragments {
    size_t n, n_grains;
    int32_t *of;    /* [n_grains] fragment of a grain */
    double *volume; /* [n] m3 */
    int32_t *size;  /* [n] grains */
};

/* volume: of the n_grains grains; pairs: between them. Freed by brc_fragments_free, also after a
 * failure. */
int brc_fragments_find(struct brc_context *ctx, size_t n_grains, const double *volume,
                       const struct brc_contacts *pairs, struct brc_fragments *out);
void brc_fragments_free(struct brc_fragments *f);

#endif
