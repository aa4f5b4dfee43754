/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of sums.c, compiled for each instruction set by the files that include this one. */
#ifndef BRC_SUMS_KERNELS_H
#define BRC_SUMS_KERNELS_H

#include "common/base/lanes.h"
#include "common/parallel/sums.h"

/* Digits of a double, and the largest exponent for which sigma and sums of the multiples, both
 * 2^count times a term and more, stay finite. */
enum { TERM_BITS = 53, LARGEST_EXPONENT = 960 };

/* The last n terms, fewer than lanes; zeros behind them change neither the largest nor the sum. */
static inline brc_lanes rest_of(const double *x, size_t n)
{
    brc_lanes rest = brc_lanes_all(0);
    for (size_t i = 0; i < n; i++)
        rest[i] = x[i];
    return rest;
}

/* The largest size of a term, NAN where one is not finite. */
static double largest(const double *x, size_t n)
{
    brc_lanes rest = rest_of(x + n - n % BRC_LANES, n % BRC_LANES);
    brc_lanes most = brc_lanes_abs(rest), wrong = 0 * rest;
    for (size_t i = 0; i + BRC_LANES <= n; i += BRC_LANES) {
        brc_lanes a = brc_lanes_at(x + i);
        most = brc_lanes_max(brc_lanes_abs(a), most);
        wrong += 0 * a; /* not 0 where a term is not finite: comparisons pass over these */
    }
    double all = fmax(fmax(most[0], most[1]), fmax(most[2], most[3]));
    return brc_lanes_sum(wrong) == 0 ? all : NAN;
}

/* Adds four terms, each cut by either sigma. Adding 1.5 times a power of two and taking it away
 * again rounds to a multiple of its last digit; 1.5, so that negative terms do not change the
 * exponent. Compilers must not simplify it: no -ffast-math. */
static inline void add_cut(brc_lanes sum[2], brc_lanes a, const double sigma[2])
{
    brc_lanes cut = (a + sigma[0]) - sigma[0];
    sum[0] += cut;
    sum[1] += ((a - cut) + sigma[1]) - sigma[1];
}

static double sum_exact(const double *x, size_t n, size_t of)
{
    double most = largest(x, n);
    int exponent, count;
    if (!(most > 0))
        return most;
    frexp(most, &exponent);    /* |x| < 2^exponent */
    frexp((double)of, &count); /* of < 2^count */
    if (exponent > LARGEST_EXPONENT)
        return NAN;
    /* x + sigma is rounded to multiples of 2^(exponent + count - 52), of which n add up to less
     * than 2^53; the rest is at most half of that multiple, and so on */
    double sigma[2] = {ldexp(1.5, exponent + count),
                       ldexp(1.5, exponent + count - TERM_BITS + count)};
    brc_lanes sum[2] = {brc_lanes_all(0), brc_lanes_all(0)};
    for (size_t i = 0; i + BRC_LANES <= n; i += BRC_LANES)
        add_cut(sum, brc_lanes_at(x + i), sigma);
    add_cut(sum, rest_of(x + n - n % BRC_LANES, n % BRC_LANES), sigma);
    return brc_lanes_sum(sum[0]) + brc_lanes_sum(sum[1]);
}

#endif
