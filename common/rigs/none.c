/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No test: the specimen is left to itself, and to gravity. */
#include "common/engine/sim.h"
#include "common/rigs/curve.h"

#include <math.h>

/* An area without end makes all stresses 0, so that the curve needs no case of its own. */
static int place(struct brc_sim *sim)
{
    sim->rig.axis = 2;
    sim->rig.sense = 1;
    sim->rig.section = HUGE_VAL; /* nothing is loaded: all stresses are 0 */
    return 0;
}

static int drive(struct brc_sim *sim)
{
    (void)sim;
    return 0;
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    (void)sim, (void)out;
}

const struct brc_rig_type brc_rig_none = {.name = "none",
                                          .meaning = "no platens",
                                          .physics = 1,
                                          .keys = "sample_steps",
                                          .sides = BRC_CORE_SIDES,
                                          .place = place,
                                          .drive = drive,
                                          .measure = brc_curve_sample,
                                          .results = results};
