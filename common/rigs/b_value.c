/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Maximum likelihood (Aki 1965), as a line through the counts of bins weighs the few large events
 * too much. Magnitudes of a simulation have no bins, so there is no correction for their width
 * (Utsu 1966). The law holds above some magnitude only, which is found as by Clauset, Shalizi and
 * Newman (2009): the one above which the law's distribution is nearest to that of the events. */
#include "common/rigs/b_value.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_sort.h>

/* Beginnings that are tried: the fit changes little between neighbours among thousands. */
enum { TRIES = 200 };

static const char few[] = "fewer than 25 acoustic events",
                  alike[] = "acoustic events of one magnitude have no b-value";

/* Rate of the exponential law of n sorted magnitudes; 0 where they are all alike. The first has set
 * the beginning, so n - 1 of them tell of the law. */
static double rate_of(const double *m, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += m[i] - m[0];
    return sum > 0 ? (double)(n - 1) / sum : 0;
}

/* Largest distance of the two distributions, on both sides of each step (Kolmogorov, Smirnov). */
static double distance(const double *m, size_t n, double rate)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        double law = -expm1(-rate * (m[i] - m[0]));
        largest = fmax(largest, fabs(law - (double)i / (double)n));
        largest = fmax(largest, fabs(law - (double)(i + 1) / (double)n));
    }
    return largest;
}

const char *brc_b_value_fit(double *magnitude, size_t n, struct brc_b_value *out)
{
    double nearest = HUGE_VAL;
    if (n < BRC_B_VALUE_LEAST)
        return few;
    gsl_sort(magnitude, 1, n);
    size_t stride = (n - BRC_B_VALUE_LEAST) / TRIES + 1;
    for (size_t i = 0; i + BRC_B_VALUE_LEAST <= n; i += stride) {
        const double *m = magnitude + i;
        double rate = rate_of(m, n - i);
        double far = rate > 0 ? distance(m, n - i, rate) : HUGE_VAL;
        if (far < nearest) {
            nearest = far;
            *out = (struct brc_b_value){.b = rate / M_LN10, .completeness = m[0], .n = n - i};
        }
    }
    if (!(nearest < HUGE_VAL))
        return alike;
    out->error = out->b / sqrt((double)(out->n - 1));
    return NULL;
}
