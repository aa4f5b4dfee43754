/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of `breccia converge`: errors of a setting against a reference over the same
 * specimens, and what the settings of a ladder cost for an error. Plain numbers, no runs. */
#ifndef BRC_CONVERGE_STATS_H
#define BRC_CONVERGE_STATS_H

#include "common/base/error.h"

/* Values of n specimens with a setting against those of the same specimens with another. All
 * relative to the mean of the latter. NAN where too few values are there. */
struct brc_converge_error {
    int n;            /* specimens that have both values */
    double mean;      /* mean difference: the error of the mean */
    double deviation; /* standard error of that mean; NAN for one specimen */
    double single;    /* root mean square of the differences: the error on one specimen */
};

/* A NAN is a value that is not there. */
struct brc_converge_error brc_converge_error(const double *value, const double *reference, int n);
/* Uncertainty of a reference, from what halving the loading and the step still changed (Richardson,
 * taken as first order: the whole of the change), and from the scatter of realisations of either
 * (the larger standard error over sqrt 2, since two settings scatter in a difference). */
double brc_converge_uncertainty(const struct brc_converge_error *loading,
                                const struct brc_converge_error *step);
/* NAN for none. The median puts the values out of order: it is found by partition, in place. */
double brc_converge_median(double *value, int n);
double brc_converge_mean(const double *value, int n);
/* Standard deviation over the mean; NAN for fewer than two. */
double brc_converge_scatter(const double *value, int n);

/* One setting of a ladder. */
struct brc_converge_rung {
    int ladder;      /* settings of one ladder share it */
    double fineness; /* larger: finer */
    double error;    /* relative, either sign; NAN: no value */
    double cost;
};

/* A rung is within an error when it and all finer rungs of its ladder are: a coarse one that is
 * right by chance does not count. */
bool brc_converge_is_within(const struct brc_converge_rung *rung, int n, int i, double error);
/* The cheapest rung within the error, -1 when there is none. */
int brc_converge_cheapest(const struct brc_converge_rung *rung, int n, double error);

/* Cost of an error on one ladder: between the last rung within it and the next coarser one by
 * straight lines in the logarithms. */
struct brc_converge_cost {
    double cost;   /* NAN: no rung is within */
    bool is_bound; /* the coarsest rung is within, too: the cost is at most this */
};
struct brc_converge_cost brc_converge_cost(const struct brc_converge_rung *rung, int n, int ladder,
                                           double error);

#endif
