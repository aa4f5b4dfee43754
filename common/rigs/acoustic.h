/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Acoustic events: breaks that are near in time and place are one event, as an array of sensors
 * would hear it. */
#ifndef BRC_ACOUSTIC_H
#define BRC_ACOUSTIC_H

#include "common/engine/events.h"

struct brc_sim;

#define BRC_ACOUSTIC_FIELDS(SCALAR, VECTOR)                                                       \
    SCALAR(int64_t, first_step, BRC_STATE, "1", "step of the first break")                        \
    SCALAR(int64_t, last_step, BRC_STATE, "1", "step of the last break")                          \
    SCALAR(double, strain, BRC_STATE, "1", "platen strain of the curve's row of the first break") \
    SCALAR(double, stress, BRC_STATE, "Pa", "stress of that row")                                 \
    SCALAR(int64_t, breaks, BRC_STATE, "1", "breaks")                                             \
    SCALAR(int64_t, tension, BRC_STATE, "1", "of these in tension")                               \
    VECTOR(double, x, 3, BRC_STATE, "m", "place: mean of the breaks, by area")                    \
    SCALAR(double, area, BRC_STATE, "m2", "area that broke")                                      \
    SCALAR(double, energy, BRC_STATE, "J", "energy dissipated by the breaks")                     \
    SCALAR(double, magnitude, BRC_STATE, "1", "2/3 log10(energy in J) - 3.2")                     \
    VECTOR(double, moment, 6, BRC_STATE, "N m", "moment tensor xx, yy, zz, yz, xz, xy; + opens")  \
    SCALAR(double, scalar_moment, BRC_STATE, "N m", "root of half the sum of its squares")        \
    SCALAR(double, moment_magnitude, BRC_STATE, "1", "2/3 log10(scalar moment in N m) - 6.07")    \
    SCALAR(double, r, BRC_STATE, "%", "R: above 30 opens, -30 to 30 shears, below -30 falls in")

/* In the order of their first breaks. */
struct brc_acoustic {
    BRC_ACOUSTIC_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
};

/* Of all breaks so far, by test.acoustic_steps and test.acoustic_radii. Freed by brc_acoustic_free,
 * also after a failure. */
int brc_acoustic_find(const struct brc_sim *sim, struct brc_acoustic *out);
void brc_acoustic_free(struct brc_acoustic *a);
/* of[i]: number of the event of break i, by their first breaks; *n_events: how many there are. The
 * steps ascend. Breaks belong together when they are at most `steps` and `reach` [m] apart, or
 * joined by a chain of such. */
int brc_acoustic_cluster(struct brc_context *ctx, const int64_t *step, double (*x)[3], size_t n,
                         int64_t steps, double reach, int32_t *of, size_t *n_events);
/* R of a moment tensor in per cent, 100 tr / (|tr| + sum of the sizes of the deviatoric part's
 * eigenvalues) (Feignier and Young 1992); NAN of one that is zero or is none. */
double brc_acoustic_r(const double moment[6]);

#endif
