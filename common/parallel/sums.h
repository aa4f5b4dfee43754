/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums of many terms that are the same to the last bit in whatever order the terms stand and
 * however they are shared out: what is stored, or feeds back into a run, must not depend on how
 * contacts are numbered or on the number of ranks.
 *
 * Each term is cut into multiples of two quanta, powers of two that the largest term and the number
 * of terms decide; sums of such multiples are exact, so their order does not matter. What is cut
 * off a term lies below 2^(2 b - 106) of the largest one for 2^b terms, 2^-66 for a million, where
 * a plain sum rounds 2^-53 of its partial sum away at every term.
 *
 * Rejected: fixed-point integers of 64 bits need a scale in advance, and overflow when a specimen
 * bursts; an accumulator over the whole range of doubles needs no look at the largest term, but
 * takes a term apart and has no lanes; adding in the order of global numbers ends with the first
 * rank that owns every other grain. Limit: terms of 2^960 and more give NAN, as no result of a
 * sound run is as large. */
#ifndef BRC_SUMS_H
#define BRC_SUMS_H

#include "common/base/error.h"

/* The sum of n of `of` terms, the others being 0; NAN where one is not finite. The quanta hang on
 * `of`, so that it counts the terms of the whole specimen, zeros included. */
double brc_sum_exact_of(const double *x, size_t n, size_t of);
/* Its loops for each instruction set. */
double brc_sum_exact_base(const double *x, size_t n, size_t of);
double brc_sum_exact_avx2(const double *x, size_t n, size_t of);

/* The sum of terms that are all given. */
static inline double brc_sum_exact(const double *x, size_t n)
{
    return brc_sum_exact_of(x, n, n);
}

#endif
