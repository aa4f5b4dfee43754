/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a test's curve, and what is read off its peak. */
#ifndef BRC_CURVE_H
#define BRC_CURVE_H

#include "common/engine/rig.h"

/* Shared keys that a curve uses. */
#define BRC_CURVE_KEYS "gauge sample_steps plateau "
/* Quantities of the peak, to stand in a test's list. */
#define BRC_PEAK_QUANTITIES                                                                 \
    {"strength", "Pa", "largest stress, once the load has fallen from it"},                 \
        {"strain_at_peak", "1", "platen strain there"}, {"force_peak", "N", "force there"}, \
    {                                                                                       \
        "ci_broken", "Pa", "stress at 1 % of the area broken at the peak"                   \
    }
enum { BRC_N_PEAK_RESULTS = 4 };

/* How pictures of tests are drawn whose stress is a deviator. */
extern const struct brc_rig_view brc_curve_deviator_view;
/* To be called at the end of a step: a row every sample_steps, of means since the last one. */
int brc_curve_sample(struct brc_sim *sim);
/* The values of BRC_PEAK_QUANTITIES. */
void brc_curve_peak_results(const struct brc_sim *sim, struct brc_measured *out);
/* Why the largest load is no strength, NULL where it is. */
const char *brc_curve_why_no_peak(const struct brc_rig *rig);
/* Row of the peak; only where brc_curve_why_no_peak gives NULL, or a load that has not fallen. */
size_t brc_curve_peak_row(const struct brc_rig *rig);
/* The note of a load that has not fallen yet: moduli are measured all the same. */
extern const char brc_curve_no_peak[];
/* Largest unbalanced ratio of the rows up to the peak that carry a tenth of it or more. */
double brc_curve_unbalanced_max(const struct brc_sim *sim);

#endif
