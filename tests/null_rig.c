/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The do-nothing test: copy this file to begin one, see docs/add-a-test.md. */
#include "common/engine/sim.h"
#include "common/rigs/curve.h"

static int null_place(struct brc_sim *sim)
{
    sim->rig.section = 1;
    return 0;
}

static int null_drive(struct brc_sim *sim)
{
    (void)sim;
    return 0;
}

static void null_results(const struct brc_sim *sim, struct brc_measured *out)
{
    (void)sim, (void)out;
}

const struct brc_rig_type brc_rig_null = {.name = "null",
                                          .meaning = "nothing is done",
                                          .keys = "sample_steps",
                                          .place = null_place,
                                          .drive = null_drive,
                                          .measure = brc_curve_sample,
                                          .results = null_results};
