/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A discrete power law of counts, p(x) = x^-exponent / zeta(exponent, x_min) from x_min on, as
 * Clauset, Shalizi and Newman fit and test it (SIAM Review 51, 2009; arXiv 0706.1062). */
#ifndef CALIB_POWER_LAW_H
#define CALIB_POWER_LAW_H

#include "common/base/error.h"

struct calib_power_law {
    double exponent, error; /* maximum likelihood, and its standard error */
    long x_min;             /* where the law begins: the least Kolmogorov-Smirnov distance */
    size_t n_tail;          /* counts from there on */
    double distance;        /* that distance */
    double
        p; /* part of samples of the law that are as far from it or farther; NAN: not asked for */
    /* Log likelihood of the law over that of a lognormal on the same tail: below 0 the lognormal is
     * the better one; with the p-value of Vuong's test that the sign is chance. */
    double ratio, ratio_p;
};

/* x: counts of 1 or more, n of them, sorted here. resamples: of the bootstrap for p; 0: none. It
 * has a seed of its own, so that the same counts give the same numbers. At least 25 counts of 2
 * values. */
int calib_power_law_fit(struct brc_context *ctx, long *x, size_t n, int resamples,
                        struct calib_power_law *out);

#endif
