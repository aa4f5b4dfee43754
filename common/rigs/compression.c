/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unconfined compression along z between two platens with friction. */
#include "common/engine/sim.h"
#include "common/rigs/crack_stress.h"
#include "common/rigs/two_platens.h"

/* Friction and no bond: platens that hold the ends would make a cone of the rock below them, and
 * ends that slip freely are what the strength is defined by. */
static int place(struct brc_sim *sim)
{
    const struct brc_platen like = {.friction = sim->rig.params.friction};
    return brc_two_platens_place(sim, 2, 1, brc_two_platens_section(sim, 2), &like);
}

const struct brc_rig_type brc_rig_compression = {
    .name = "compression",
    .meaning = "unconfined compression along z",
    .physics = 1,
    .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS BRC_MODULI_KEYS "friction",
    BRC_COMPRESSION_RESULTS,
    BRC_TWO_PLATENS,
    .check = brc_two_platens_check_closing,
    .place = place,
    .stresses = brc_two_platens_stresses};
