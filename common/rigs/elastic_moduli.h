/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic moduli: least squares over the rows of the curve between two parts of the peak, and
 * how well they fit. */
#ifndef BRC_ELASTIC_MODULI_H
#define BRC_ELASTIC_MODULI_H

#include "common/rigs/curve.h"

/* Shared keys that moduli use. */
#define BRC_MODULI_KEYS "modulus_low modulus_high "
/* The same for all loads along a core's axis: moduli and how well lines fit them, then the peak. */
#define BRC_CORE_QUANTITIES                                                  \
    {"E", "Pa", "Young's modulus by the gauge strain"},                      \
        {"nu", "1", "Poisson's ratio by the gauge strains"},                 \
        {"E_platen", "Pa", "modulus by the platen strain"},                  \
        {"E_r2", "1", "part of the variance of the stress that E explains"}, \
        {"nu_r2", "1", "part of that of the lateral strain that nu explains"}, BRC_PEAK_QUANTITIES
enum { BRC_N_MODULI = 5, BRC_N_CORE_RESULTS = BRC_N_MODULI + BRC_N_PEAK_RESULTS };
extern const struct brc_quantity brc_core_quantities[BRC_N_CORE_RESULTS];
void brc_core_results(const struct brc_sim *sim, struct brc_measured *out);
/* To stand in a test's table. */
#define BRC_CORE_RESULTS                                                   \
    .quantities = brc_core_quantities, .n_quantities = BRC_N_CORE_RESULTS, \
    .results = brc_core_results, .sides = BRC_CORE_SIDES

/* Rows of the curve between modulus_low and modulus_high of the peak: [*first, *end). */
void brc_moduli_rows(const struct brc_rig *rig, size_t *first, size_t *end);
/* A straight line through n points. */
struct brc_line {
    double slope;
    double
        r2; /* part of the variance of y that it explains; 1 where all points are at one height */
    double varies; /* standard deviation of y */
};
struct brc_line brc_line_fit(const double *x, const double *y, size_t n);
/* The keys of the moduli together. */
int brc_moduli_check(struct brc_context *ctx, const struct brc_test_params *test);

#endif
