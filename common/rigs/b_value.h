/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The b-value of the law of Gutenberg and Richter, log10 N(>= M) = a - b M, by maximum likelihood.
 */
#ifndef BRC_B_VALUE_H
#define BRC_B_VALUE_H

#include <stddef.h>

struct brc_b_value {
    double b, error;     /* and its standard error */
    double completeness; /* least magnitude that is taken */
    size_t n;            /* events from there on */
};

/* Magnitudes that such a fit needs; their law is known to a fifth then. */
enum { BRC_B_VALUE_LEAST = 25 };

/* Of n magnitudes, which are sorted. NULL, or why there is none: static. */
const char *brc_b_value_fit(double *magnitude, size_t n, struct brc_b_value *out);

#endif
