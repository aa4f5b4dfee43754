/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strength envelopes through the peaks of several confined tests: Mohr and Coulomb's line, Hoek and
 * Brown's curve of intact rock. */
#ifndef CALIB_ENVELOPE_H
#define CALIB_ENVELOPE_H

#include "common/base/error.h"

/* Principal stresses at a peak, compression positive [Pa]. */
struct calib_peak {
    double sigma_3, sigma_1;
};

/* A value, its standard error, and the interval that holds the true one in 95 of 100 sets of tests
 * (Student's t of n - 2 degrees of freedom). */
struct calib_estimate {
    double value, error, low, high;
};

/* sigma_1 = strength + slope sigma_3, slope = (1 + sin phi) / (1 - sin phi), strength = 2 c
 * sqrt(slope). */
struct calib_mohr_coulomb {
    struct calib_estimate strength, slope; /* Pa, 1 */
    struct calib_estimate cohesion, angle; /* Pa, rad */
    double r2, scatter;                    /* scatter: of sigma_1 about the line [Pa] */
};

/* sigma_1 = sigma_3 + sqrt(m strength sigma_3 + strength^2): a = 1/2, s = 1. */
struct calib_hoek_brown {
    struct calib_estimate strength, m; /* Pa, 1; strength is B of eq 30 of gt12 */
    struct calib_estimate a;           /* m strength: A of it [Pa] */
    double tension;                    /* Pa, positive: direct tension, where sigma_1 is 0 */
    double r2, scatter;
};

/* At least 3 peaks, whose sigma_3 spread by 0.1 % of the largest sigma_1 or more; tension is
 * negative. */
int calib_mohr_coulomb_fit(struct brc_context *ctx, const struct calib_peak *peak, size_t n,
                           struct calib_mohr_coulomb *out);
int calib_hoek_brown_fit(struct brc_context *ctx, const struct calib_peak *peak, size_t n,
                         struct calib_hoek_brown *out);

#endif
