/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Least squares on sigma_1, since sigma_3 is what a test sets and has no scatter of its own. The
 * line by a formula; Hoek and Brown's curve by Levenberg and Marquardt's method (GSL), from the
 * line through (sigma_1 - sigma_3)^2 that textbooks fit in its place: that one weighs the highest
 * peaks most. Errors of what follows from two values are those of the tangent. */
#include "calib/envelope.h"

#include "common/base/brc.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

enum { LEAST_PEAKS = 3, MOST_STEPS = 200 };
static const double CONVERGED = 1e-12;
/* sigma_3 must spread by this part of the largest sigma_1: a slope over what a servo misses, or
 * over rounding, would be noise with an interval that looks like a result. */
static const double SPREAD = 1e-3;

/* Two values and the covariance of their errors. */
struct pair {
    double value[2], cov[2][2];
};

/* Student's t and not 1.96: with 3 points the interval is 6 times as wide as that, and the width is
 * what a user decides by whether to run more tests. */
static struct calib_estimate estimate(double value, double variance, size_t n)
{
    double error = sqrt(fmax(variance, 0));
    double wide = error * gsl_cdf_tdist_Pinv(0.975, (double)(n - 2));
    return (struct calib_estimate){value, error, value - wide, value + wide};
}

/* Variance of a function of both with this gradient. */
static double variance(const struct pair *p, double by_0, double by_1)
{
    return by_0 * by_0 * p->cov[0][0] + 2 * by_0 * by_1 * p->cov[0][1] + by_1 * by_1 * p->cov[1][1];
}

/* What no fit can be made of, in words that say which runs are missing. */
static int check(struct brc_context *ctx, const struct calib_peak *peak, size_t n)
{
    double low = HUGE_VAL, high = -HUGE_VAL, largest = 0;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(peak[i].sigma_1) || !isfinite(peak[i].sigma_3))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "envelope: peak %zu is no number; leave out tests that "
                     "had no peak",
                     i + 1);
        low = fmin(low, peak[i].sigma_3);
        high = fmax(high, peak[i].sigma_3);
        largest = fmax(largest, fabs(peak[i].sigma_1));
    }
    if (n < LEAST_PEAKS)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "envelope: %zu points, it takes 3 at 2 confining stresses; add runs that have "
                 "passed a peak",
                 n);
    if (high - low <= SPREAD * largest)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "envelope: all %zu points are at one confining stress (sigma_3 = %.4g MPa), it "
                 "takes 2; add runs at another pressure",
                 n, 1e-6 * high);
    return 0;
}

/* Both coordinates over the scale, so that GSL sees numbers near 1; x, y: [n]. */
static double scale_of(const struct calib_peak *peak, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += fabs(peak[i].sigma_1) + fabs(peak[i].sigma_3);
    return sum > 0 ? sum / (double)n : 1;
}

/* The line has strength and slope; cohesion and angle follow, with the errors of both carried over
 * by the covariance: they are far from independent. */
int calib_mohr_coulomb_fit(struct brc_context *ctx, const struct calib_peak *peak, size_t n,
                           struct calib_mohr_coulomb *out)
{
    struct pair p;
    double left;
    BRC_TRY(check(ctx, peak, n));
    /* strides step over the other stress of each peak */
    gsl_fit_linear(&peak->sigma_3, 2, &peak->sigma_1, 2, n, &p.value[0], &p.value[1], &p.cov[0][0],
                   &p.cov[0][1], &p.cov[1][1], &left);
    double q = p.value[0], slope = p.value[1];
    if (!(q > 0 && slope >= 1))
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "envelope: the line has the strength %g Pa and the slope %g: no cohesion and angle "
            "belong to it (strength above 0, slope 1 or more)",
            q, slope);
    double root = sqrt(slope);
    out->strength = estimate(q, p.cov[0][0], n);
    out->slope = estimate(slope, p.cov[1][1], n);
    out->cohesion =
        estimate(q / (2 * root), variance(&p, 1 / (2 * root), -q / (4 * slope * root)), n);
    out->angle =
        estimate(asin((slope - 1) / (slope + 1)), variance(&p, 0, 1 / ((slope + 1) * root)), n);
    out->r2 = 1 - left / gsl_stats_tss(&peak->sigma_1, 2, n);
    out->scatter = sqrt(left / (double)(n - 2));
    return 0;
}

/* ---- Hoek and Brown ------------------------------------------------------------------------ */

/* In units of the scale. */
struct data {
    const struct calib_peak *peak;
    size_t n;
    double scale;
};

/* The root of the law; a step of the search may leave where it is real. */
static double root_of(double strength, double m, double sigma_3)
{
    /* eq:gt12:30, with A = m strength and B = strength */
    return sqrt(fmax(m * strength * sigma_3 + strength * strength, 1e-12));
}

/* Of sigma_1 itself, each point with the same weight: seeds scatter by about the same stress at low
 * and high pressure. */
static int residuals(const gsl_vector *x, void *user, gsl_vector *f)
{
    const struct data *d = user;
    for (size_t i = 0; i < d->n; i++) {
        double low = d->peak[i].sigma_3 / d->scale, high = d->peak[i].sigma_1 / d->scale;
        gsl_vector_set(f, i, low + root_of(gsl_vector_get(x, 0), gsl_vector_get(x, 1), low) - high);
    }
    return GSL_SUCCESS;
}

static int slopes(const gsl_vector *x, void *user, gsl_matrix *j)
{
    const struct data *d = user;
    double strength = gsl_vector_get(x, 0), m = gsl_vector_get(x, 1);
    for (size_t i = 0; i < d->n; i++) {
        double low = d->peak[i].sigma_3 / d->scale, root = root_of(strength, m, low);
        gsl_matrix_set(j, i, 0, (m * low + 2 * strength) / (2 * root));
        gsl_matrix_set(j, i, 1, strength * low / (2 * root));
    }
    return GSL_SUCCESS;
}

/* The line through (sigma_1 - sigma_3)^2; where it has no root, the mean peak and a granite's m. */
static void begin(const struct data *d, double x[2])
{
    double n = (double)d->n, s = 0, q = 0, ss = 0, sq = 0;
    for (size_t i = 0; i < d->n; i++) {
        double low = d->peak[i].sigma_3 / d->scale, dif = d->peak[i].sigma_1 / d->scale - low;
        s += low / n;
        q += dif * dif / n;
        ss += low * low / n;
        sq += low * dif * dif / n;
    }
    double slope = (sq - s * q) / (ss - s * s), square = q - slope * s;
    x[0] = square > 0 ? sqrt(square) : sqrt(q);
    x[1] = square > 0 && slope > 0 ? slope / x[0] : 10;
}

/* Trust region, as the root bends where the search may come to its end; a Jacobian by hand, since
 * the one by differences would lose half of the digits that the test of exact peaks asks for. */
static int search(struct brc_context *ctx, struct data *d, gsl_multifit_nlinear_workspace *w,
                  struct pair *p, double *left)
{
    double x[2], cov[4];
    int info;
    gsl_multifit_nlinear_fdf fdf = {.f = residuals, .df = slopes, .n = d->n, .p = 2, .params = d};
    begin(d, x);
    gsl_vector_view start = gsl_vector_view_array(x, 2);
    gsl_matrix_view covariance = gsl_matrix_view_array(cov, 2, 2);
    gsl_multifit_nlinear_init(&start.vector, &fdf, w);
    int status =
        gsl_multifit_nlinear_driver(MOST_STEPS, CONVERGED, CONVERGED, 0, NULL, NULL, &info, w);
    /* no progress: at the last digit of an exact fit */
    if (status != GSL_SUCCESS && status != GSL_ENOPROG)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "envelope: no curve of Hoek and Brown fits: %s",
                 gsl_strerror(status));
    gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(w), 0, &covariance.matrix);
    *left = pow(gsl_blas_dnrm2(gsl_multifit_nlinear_residual(w)), 2);
    for (int i = 0; i < 2; i++) {
        p->value[i] = gsl_vector_get(gsl_multifit_nlinear_position(w), (size_t)i);
        for (int k = 0; k < 2; k++)
            p->cov[i][k] = cov[2 * i + k] * *left / (double)(d->n - 2);
    }
    return 0;
}

/* Strength and m are free, s and a are those of intact rock: with three or four pressures, which is
 * what people run, more values would fit the noise. */
int calib_hoek_brown_fit(struct brc_context *ctx, const struct calib_peak *peak, size_t n,
                         struct calib_hoek_brown *out)
{
    BRC_TRY(check(ctx, peak, n));
    struct pair p;
    struct data d = {peak, n, scale_of(peak, n)};
    double left;
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *w = brc_alloc_check(
        ctx, gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, n, 2), n, sizeof *w);
    if (!w)
        return BRC_ERR_MEMORY;
    int code = search(ctx, &d, w, &p, &left);
    gsl_multifit_nlinear_free(w);
    BRC_TRY(code);
    double q = p.value[0], m = p.value[1], s = d.scale;
    if (!(q > 0 && m > 0))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "envelope: the curve has the strength %g Pa and m = %g, which must be above 0: "
                 "the peaks do not rise with sigma_3",
                 q * s, m);
    out->strength = estimate(q * s, p.cov[0][0] * s * s, n);
    out->m = estimate(m, p.cov[1][1], n);
    out->a = estimate(m * q * s, variance(&p, m, q) * s * s, n);
    out->tension = q * s * (sqrt(m * m + 4) - m) / 2;
    out->r2 = 1 - left * s * s / gsl_stats_tss(&peak->sigma_1, 2, n);
    out->scatter = s * sqrt(left / (double)(n - 2));
    return 0;
}
