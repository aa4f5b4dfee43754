/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics on plain numbers; how they are meant is in docs/speed-and-error.md. At most some
 * hundred values. What is not there is NAN and passes through, so that a missing run shows as a
 * dash and not as a number. */
#include "common/runs/converge_stats.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>

enum { MAX_VALUES = 1024 };

double brc_converge_mean(const double *value, int n)
{
    return n > 0 ? gsl_stats_mean(value, 1, (size_t)n) : NAN;
}

/* Standard deviation of a sample. */
static double deviation(const double *value, int n)
{
    return n > 1 ? gsl_stats_sd(value, 1, (size_t)n) : NAN;
}

double brc_converge_scatter(const double *value, int n)
{
    return deviation(value, n) / fabs(brc_converge_mean(value, n));
}

double brc_converge_median(double *value, int n)
{
    return n > 0 ? gsl_stats_median(value, 1, (size_t)n) : NAN;
}

/* Over the specimens that have both values. Relative to the mean of the reference and not to each
 * value, so that a specimen with a small value does not count more than others. */
struct brc_converge_error brc_converge_error(const double *value, const double *reference, int n)
{
    double difference[MAX_VALUES], base = 0, squares = 0;
    struct brc_converge_error e = {.mean = NAN, .deviation = NAN, .single = NAN};
    for (int i = 0; i < n && e.n < MAX_VALUES; i++) {
        if (!isfinite(value[i]) || !isfinite(reference[i]))
            continue;
        difference[e.n++] = value[i] - reference[i];
        base += reference[i];
        squares += (value[i] - reference[i]) * (value[i] - reference[i]);
    }
    base = fabs(base) / e.n;
    if (e.n == 0 || base == 0)
        return e;
    e.mean = brc_converge_mean(difference, e.n) / base;
    e.deviation = deviation(difference, e.n) / sqrt(e.n) / base;
    e.single = sqrt(squares / e.n) / base;
    return e;
}

/* The three parts are independent, so their squares add up. Without scatter (one specimen) chance
 * is not known, and left out. */
double brc_converge_uncertainty(const struct brc_converge_error *loading,
                                const struct brc_converge_error *step)
{
    double chance = fmax(loading->deviation, step->deviation);
    double chance2 = isfinite(chance) ? chance * chance / 2 : 0;
    return sqrt(loading->mean * loading->mean + step->mean * step->mean + chance2);
}

/* A rung without a value is within nothing, and so is what is coarser than it. Written so that NAN
 * is not within. */
bool brc_converge_is_within(const struct brc_converge_rung *rung, int n, int i, double error)
{
    for (int k = 0; k < n; k++) {
        bool counts = rung[k].ladder == rung[i].ladder && rung[k].fineness >= rung[i].fineness;
        if (counts && !(fabs(rung[k].error) <= error))
            return false;
    }
    return true;
}

int brc_converge_cheapest(const struct brc_converge_rung *rung, int n, double error)
{
    int best = -1;
    for (int i = 0; i < n; i++)
        if (brc_converge_is_within(rung, n, i, error) &&
            (best < 0 || rung[i].cost < rung[best].cost))
            best = i;
    return best;
}

/* Between the coarsest rung within the error and the finest one that is not, by straight lines in
 * the logarithms, as the chart has them. */
struct brc_converge_cost brc_converge_cost(const struct brc_converge_rung *rung, int n, int ladder,
                                           double error)
{
    const struct brc_converge_rung *in = NULL, *out = NULL;
    for (int i = 0; i < n; i++) {
        if (rung[i].ladder != ladder)
            continue;
        if (brc_converge_is_within(rung, n, i, error)) {
            if (!in || rung[i].fineness < in->fineness)
                in = &rung[i];
        } else if (!out || rung[i].fineness > out->fineness) {
            out = &rung[i];
        }
    }
    if (!in)
        return (struct brc_converge_cost){.cost = NAN};
    if (!out)
        return (struct brc_converge_cost){.cost = in->cost, .is_bound = true};
    if (!isfinite(out->error) || in->error == 0)
        return (struct brc_converge_cost){.cost = in->cost};
    double part = log(error / fabs(in->error)) / log(fabs(out->error / in->error));
    return (struct brc_converge_cost){.cost = in->cost * pow(out->cost / in->cost, part)};
}
