/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rate of a test: fixed, or adaptive: fast while the specimen is elastic, slow while it breaks.
 * It reads strain, force, kinetic energy and unbalanced ratio of the rig and gives the rate; it
 * moves no platen. Tests call it once a step from `drive`. */
#ifndef BRC_LOADING_H
#define BRC_LOADING_H

#include "common/engine/rig.h"

/* Shared keys of tests that are loaded so. */
#define BRC_LOADING_KEYS "loading rate target rate_min rate_max strain_max stop_drop "

/* Judges the keys of loading together. */
int brc_loading_check(struct brc_context *ctx, const struct brc_test_params *test);
/* The rate at which a test starts [1/s]: its own, or the automatic one. */
double brc_loading_start_rate(const struct brc_test_params *test);
/* One step at the present rate: the strain grows, the unbalanced ratio is measured now and then,
 * and the rate changes, with the mean velocities that go along with it. */
void brc_loading_step(struct brc_sim *sim);
/* Platen strain in the present stage, growing. Tests of one stage have no other. */
double brc_loading_strain(const struct brc_rig *rig);
/* The next stage begins, at the rate of a test's start: onset of damage, peak and strain are its
 * own. sense: +1 where the platen strain grows in it, -1 where it falls. */
void brc_loading_begin_stage(struct brc_sim *sim, double sense);
/* The load has fallen to stop_drop of the stage's peak. */
bool brc_loading_fallen(const struct brc_sim *sim);
/* "test.strain_max" or "test.stop_drop", when the present stage has come so far; NULL before. */
const char *brc_loading_end(const struct brc_sim *sim);
/* Steps until strain_max at the rate of the loading's present stage, for "time left, at most":
 * HUGE_VAL while adaptive loading has not met damage, as all hangs on where it begins, and without
 * platens. It falls from then on; brakes for avalanches are left out. */
double brc_loading_steps_left(const struct brc_sim *sim);

#endif
