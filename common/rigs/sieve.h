/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fragments as a sieve sorts them: mass against size. */
#ifndef BRC_SIEVE_H
#define BRC_SIEVE_H

#include "common/base/table.h"

struct brc_sim;

/* A fragment of fewer grains is dust: a grain by itself has no bond left to tell of. */
enum { BRC_PIECE_GRAINS = 2 };

#define BRC_SIEVE_FIELDS(SCALAR, VECTOR)                                             \
    SCALAR(int64_t, grains, BRC_STATE, "1", "grains of the fragment")                \
    SCALAR(double, mass, BRC_STATE, "kg", "its mass")                                \
    SCALAR(double, diameter, BRC_STATE, "m", "diameter of the sphere of its volume") \
    SCALAR(double, passing, BRC_STATE, "1", "part of the whole mass in fragments no larger than it")

/* One row a fragment, the largest first: row i is fragment i of fragments.h. */
struct brc_sieve {
    BRC_SIEVE_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
    double whole;    /* kg, mass of all */
    size_t n_pieces; /* fragments of BRC_PIECE_GRAINS or more */
};

/* Freed by brc_sieve_free, also after a failure. */
int brc_sieve_make(const struct brc_sim *sim, struct brc_sieve *out);
void brc_sieve_free(struct brc_sieve *s);

#endif
