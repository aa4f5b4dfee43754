/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Direct tension along z: two platens hold the end grains. */
#include "common/engine/sim.h"
#include "common/rigs/elastic_moduli.h"
#include "common/rigs/two_platens.h"

/* A grip never fails, so that the rock does, and not the glue; held along the axis alone the ends
 * may still contract, and the stress there is that of the middle. */
static int place(struct brc_sim *sim)
{
    bool is_axial = sim->rig.params.grip == 0;
    const struct brc_platen like = {.bonding = is_axial ? BRC_BONDING_GRIP : BRC_BONDING_FULL};
    return brc_two_platens_place(sim, 2, -1, brc_two_platens_section(sim, 2), &like);
}

const struct brc_rig_type brc_rig_tension = {.name = "tension",
                                             .meaning = "direct tension along z",
                                             .physics = 1,
                                             .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS BRC_MODULI_KEYS
                                             "grip",
                                             BRC_CORE_RESULTS,
                                             BRC_TWO_PLATENS,
                                             .check = brc_two_platens_check,
                                             .place = place,
                                             .stresses = brc_two_platens_stresses};
