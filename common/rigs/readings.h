/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is read off every test, whatever it is: cracks, acoustic events, fragments. */
#ifndef BRC_READINGS_H
#define BRC_READINGS_H

#include "common/engine/events.h"
#include "common/engine/rig.h"

/* The numbers of broken contacts by mode, then what follows from log, curve and bonds. */
enum { BRC_N_READINGS = BRC_N_MODES + 18 };
extern const struct brc_quantity brc_readings_quantities[BRC_N_READINGS];
/* Their values so far, in that order: NAN with a note where there is none. Takes a part of a second
 * for a run of 1e5 breaks. A failure for want of memory is in the context, and in the notes. */
void brc_readings(const struct brc_sim *sim, struct brc_measured out[BRC_N_READINGS]);

#endif
