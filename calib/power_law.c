/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Likelihoods by Hurwitz's zeta function; minima, random numbers and zeta are GSL's. */
#include "calib/power_law.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sf_zeta.h>
#include <math.h>
#include <stdlib.h>

/* A tail has this many counts or more, and a tenth of all: in a smaller one any law looks like a
 * power law, and the search for x_min would settle there. x_min is looked for among this many of
 * the smallest values. */
enum { LEAST_TAIL = 25, PART_OF_ALL = 10, MOST_X_MIN = 30, MOST_STEPS = 200 };
static const double LEAST = 1.01, MOST = 8; /* exponents */

/* The counts from x_min on, x[0] to x[n - 1], sorted. */
struct tail {
    const long *x;
    size_t n;
    double sum_log;
};

static int in_order(const void *a, const void *b)
{
    long p = *(const long *)a, q = *(const long *)b;
    return (p > q) - (p < q);
}

static struct tail tail_of(const long *x, size_t n)
{
    struct tail t = {x, n, 0};
    for (size_t i = 0; i < n; i++)
        t.sum_log += log((double)x[i]);
    return t;
}

static double minus_likelihood(double exponent, void *user)
{
    const struct tail *t = user;
    return (double)t->n * log(gsl_sf_hzeta(exponent, (double)t->x[0])) + exponent * t->sum_log;
}

/* By Brent's method; at an end of the range that end is returned, as of a tail of equal counts. */
static double best_exponent(struct tail *t)
{
    gsl_function f = {minus_likelihood, t};
    gsl_min_fminimizer *m = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    double low = LEAST, high = MOST,
           start = 1 + (double)t->n / (t->sum_log - (double)t->n * log((double)t->x[0] - 0.5));
    start = fmin(fmax(start, LEAST + 0.01), MOST - 0.01);
    if (!m || gsl_min_fminimizer_set(m, &f, start, low, high) != GSL_SUCCESS) {
        gsl_min_fminimizer_free(m);
        return minus_likelihood(LEAST, t) < minus_likelihood(MOST, t) ? LEAST : MOST;
    }
    for (int i = 0; i < MOST_STEPS && high - low > 1e-7; i++) {
        gsl_min_fminimizer_iterate(m);
        low = gsl_min_fminimizer_x_lower(m);
        high = gsl_min_fminimizer_x_upper(m);
    }
    start = gsl_min_fminimizer_x_minimum(m);
    gsl_min_fminimizer_free(m);
    return start;
}

/* Largest difference of the two distributions, at the counts that are there. */
static double distance_of(const struct tail *t, double exponent)
{
    double all = gsl_sf_hzeta(exponent, (double)t->x[0]), most = 0;
    for (size_t i = 0; i < t->n;) {
        size_t end = i;
        while (end < t->n && t->x[end] == t->x[i])
            end++;
        double law = 1 - gsl_sf_hzeta(exponent, (double)t->x[i] + 1) / all;
        most = fmax(most, fabs((double)end / (double)t->n - law));
        i = end;
    }
    return most;
}

/* x_min by the least distance; x is sorted. */
static void fit(const long *x, size_t n, struct calib_power_law *out)
{
    out->distance = HUGE_VAL;
    for (size_t i = 0, tried = 0;
         i + LEAST_TAIL <= n && PART_OF_ALL * (n - i) >= n && tried < MOST_X_MIN; tried++) {
        struct tail t = tail_of(x + i, n - i);
        size_t next = i;
        while (next < n && x[next] == x[i])
            next++;
        if (next == n)
            break; /* equal counts have no exponent */
        double exponent = best_exponent(&t), distance = distance_of(&t, exponent);
        /* at an end of the range the likelihood still grows: the tail falls faster than any law */
        bool is_inside = exponent > LEAST + 0.01 && exponent < MOST - 0.01;
        if (is_inside && distance < out->distance) {
            out->distance = distance;
            out->exponent = exponent;
            out->x_min = x[i];
            out->n_tail = n - i;
        }
        i = next;
    }
}

/* From the curvature of the likelihood. */
static double error_of(struct tail *t, double exponent)
{
    const double h = 1e-3;
    double curvature = (minus_likelihood(exponent + h, t) - 2 * minus_likelihood(exponent, t) +
                        minus_likelihood(exponent - h, t)) /
                       (h * h);
    return curvature > 0 ? 1 / sqrt(curvature) : NAN;
}

/* ---- goodness: samples of the law, with the counts below x_min as they are ------------------ */

/* A count of the law: the smallest with at most `u` of the law beyond it, by doubling and halving.
 */
static long draw(double exponent, long x_min, double u)
{
    double all = gsl_sf_hzeta(exponent, (double)x_min);
    long low = x_min, high = x_min;
    while (gsl_sf_hzeta(exponent, (double)high + 1) / all > u && high < 1L << 40)
        high *= 2;
    while (low < high) {
        long middle = low + (high - low) / 2;
        if (gsl_sf_hzeta(exponent, (double)middle + 1) / all > u)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int goodness(struct brc_context *ctx, const long *x, size_t n, int resamples,
                    struct calib_power_law *law)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    long *sample = brc_alloc(ctx, n, sizeof *sample);
    size_t below = n - law->n_tail, farther = 0;
    int code = random && sample ? 0 : BRC_ERR_MEMORY;
    if (code == 0)
        gsl_rng_set(random, 1);
    for (int k = 0; code == 0 && k < resamples; k++) {
        struct calib_power_law of_sample;
        for (size_t i = 0; i < n; i++) {
            size_t at = gsl_rng_uniform_int(random, n);
            sample[i] = at < below ? x[gsl_rng_uniform_int(random, below)]
                                   : draw(law->exponent, law->x_min, gsl_rng_uniform(random));
        }
        qsort(sample, n, sizeof *sample, in_order);
        fit(sample, n, &of_sample);
        farther += of_sample.distance >= law->distance;
    }
    if (resamples > 0)
        law->p = (double)farther / resamples;
    free(sample);
    if (random)
        gsl_rng_free(random);
    return code;
}

/* ---- the rival: a lognormal, made discrete and cut off at x_min ------------------------------ */

/* Log of the probability of x, or -1e3 where there is hardly any. */
static double log_lognormal(double x, double x_min, double mu, double sigma)
{
    double low = (log(x - 0.5) - mu) / sigma, high = (log(x + 0.5) - mu) / sigma;
    double first = (log(x_min - 0.5) - mu) / sigma;
    /* the upper tail on both sides where it is the smaller one: no difference of ones */
    double part = low > 0 ? gsl_cdf_ugaussian_Q(low) - gsl_cdf_ugaussian_Q(high)
                          : gsl_cdf_ugaussian_P(high) - gsl_cdf_ugaussian_P(low);
    double all = gsl_cdf_ugaussian_Q(first);
    return part > 0 && all > 0 ? log(part / all) : -1e3;
}

static double minus_lognormal(const gsl_vector *v, void *user)
{
    const struct tail *t = user;
    double sum = 0, sigma = exp(gsl_vector_get(v, 1));
    for (size_t i = 0; i < t->n; i++)
        sum -= log_lognormal((double)t->x[i], (double)t->x[0], gsl_vector_get(v, 0), sigma);
    return sum;
}

/* Best mu and sigma, by the simplex of Nelder and Mead. */
static int fit_lognormal(struct brc_context *ctx, struct tail *t, double best[2])
{
    gsl_multimin_function f = {minus_lognormal, 2, t};
    gsl_vector *at = gsl_vector_alloc(2), *step = gsl_vector_alloc(2);
    gsl_multimin_fminimizer *m =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, 2);
    bool has_room = at && step && m;
    if (has_room) {
        gsl_vector_set(at, 0, t->sum_log / (double)t->n);
        gsl_vector_set(at, 1, 0);
        gsl_vector_set_all(step, 0.5);
        gsl_multimin_fminimizer_set(m, &f, at, step);
        for (int i = 0; i < 5 * MOST_STEPS && gsl_multimin_fminimizer_size(m) > 1e-5; i++)
            if (gsl_multimin_fminimizer_iterate(m) != GSL_SUCCESS)
                break;
        best[0] = gsl_vector_get(m->x, 0);
        best[1] = exp(gsl_vector_get(m->x, 1));
    }
    gsl_vector_free(at);
    gsl_vector_free(step);
    gsl_multimin_fminimizer_free(m);
    if (!has_room)
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory for a fit of %zu counts", t->n);
    return 0;
}

/* Vuong's test of the two. */
static int compare(struct brc_context *ctx, struct tail *t, struct calib_power_law *law)
{
    double best[2], all = log(gsl_sf_hzeta(law->exponent, (double)law->x_min)), sum = 0,
                    squares = 0;
    BRC_TRY(fit_lognormal(ctx, t, best));
    for (size_t i = 0; i < t->n; i++) {
        double x = (double)t->x[i];
        double d =
            -law->exponent * log(x) - all - log_lognormal(x, (double)law->x_min, best[0], best[1]);
        sum += d;
        squares += d * d;
    }
    double n = (double)t->n, variance = squares / n - (sum / n) * (sum / n);
    law->ratio = sum;
    law->ratio_p = variance > 0 ? erfc(fabs(sum) / sqrt(2 * n * variance)) : 1;
    return 0;
}

int calib_power_law_fit(struct brc_context *ctx, long *x, size_t n, int resamples,
                        struct calib_power_law *out)
{
    *out = (struct calib_power_law){.p = NAN};
    qsort(x, n, sizeof *x, in_order);
    if (n < LEAST_TAIL || x[0] == x[n - 1])
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%zu counts of %s: a power law takes %d of 2 values", n,
                 n && x[0] != x[n - 1] ? "several values" : "one value", LEAST_TAIL);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    fit(x, n, out);
    if (out->n_tail == 0) {
        gsl_set_error_handler(handler);
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%zu counts fall faster than any power law, or not at all", n);
    }
    struct tail tail = tail_of(x + n - out->n_tail, out->n_tail);
    out->error = error_of(&tail, out->exponent);
    int code = compare(ctx, &tail, out);
    if (code == 0)
        code = goodness(ctx, x, n, resamples, out);
    gsl_set_error_handler(handler);
    return code;
}
