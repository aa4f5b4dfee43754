/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a test does to single grains from outside, where no platen does it: a pressure, a dead load.
 * Called between the forces and the kick of a step. */
#ifndef BRC_OUTSIDE_H
#define BRC_OUTSIDE_H

#include "common/engine/rig.h"

/* Turns a grain by its spin where the model reads no orientations and leaves them as they are: a
 * force is then carried to where it acts now. Once a step, before places are read. */
void brc_outside_turn(const struct brc_sim *sim, int32_t grain);
/* Adds a force [N] and a moment about the centre [N m] to the grain's. Returns their work over the
 * step, by the trapezoid rule of ledger.h with those of the step before, `last`, which they then
 * are. */
double brc_outside_push(const struct brc_sim *sim, int32_t grain, const double now[6],
                        double last[6]);

#endif
