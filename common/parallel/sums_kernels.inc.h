/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of sums.c, compiled for each instruction set by the files that include this one. */
#ifndef BRC_SUMS_KERNELS_H
#define BRC_SUMS_KERNELS_H

#include "common/base/lanes.h"
#include "common/parallel/sums.h"

enum { TERM_BITS = 53, LARGEST_EXPONENT = 960 };

static double largest(const double *x, size_t n)
{
    brc_lanes most = brc_lanes_all(0), wrong = brc_lanes_all(0);
    size_t i = 0;
    for (; i + BRC_LANES <= n; i += BRC_LANES) {
        brc_lanes a = brc_lanes_at(x + i);
        most = brc_lanes_max(brc_lanes_abs(a), most);
        wrong += 0 * a; /* not 0 where a term is not finite: comparisons pass over these */
    }
    double of_rest = 0, rest_wrong = 0;
    for (; i < n; i++) {
        of_rest = fmax(of_rest, fabs(x[i]));
        rest_wrong += 0 * x[i];
    }
    of_rest = fmax(of_rest, fmax(fmax(most[0], most[1]), fmax(most[2], most[3])));
    return rest_wrong == 0 && brc_lanes_sum(wrong) == 0 ? of_rest : NAN;
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
    brc_lanes high = brc_lanes_all(0), low = brc_lanes_all(0);
    size_t i = 0;
    for (; i + BRC_LANES <= n; i += BRC_LANES) {
        brc_lanes a = brc_lanes_at(x + i), cut = (a + sigma[0]) - sigma[0];
        high += cut;
        low += ((a - cut) + sigma[1]) - sigma[1];
    }
    double sum = brc_lanes_sum(high), rest = brc_lanes_sum(low);
    for (; i < n; i++) {
        double cut = (x[i] + sigma[0]) - sigma[0];
        sum += cut;
        rest += ((x[i] - cut) + sigma[1]) - sigma[1];
    }
    return sum + rest;
}

#endif
