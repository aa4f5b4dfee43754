/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is said when a simulation has become unstable: step, time, the first body, its contact and
 * what to change. */
#ifndef BRC_BLOWUP_H
#define BRC_BLOWUP_H

#include "common/engine/sim.h"

/* Path of a body in one step, in skins, that no stable simulation makes. */
enum { BRC_BLOWUP_SKINS = 4 };

/* After the drift: a body has moved by more than that, or by no number. Always fails. */
int brc_blowup_path(const struct brc_sim *sim);
/* After the kick: the kinetic energy is no number. Always fails. */
int brc_blowup_number(const struct brc_sim *sim);
/* Between steps: fails when the kinetic energy is a thousand times what the ledger knows that the
 * sample had at the start and was given since. For simulations whose velocities nobody else sets.
 * Without the ledger nothing is known. */
int brc_blowup_energy(struct brc_sim *sim);

#endif
