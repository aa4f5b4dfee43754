/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unconfined compression along z between two platens with friction. */
#include "common/engine/sim.h"
#include "common/rigs/elastic_moduli.h"
#include "common/rigs/two_platens.h"

static const struct brc_quantity quantities[] = {BRC_MODULI_QUANTITIES, BRC_PEAK_QUANTITIES};

static int check(struct brc_context *ctx, const struct brc_test_params *test, const void *own)
{
    (void)own;
    BRC_TRY(brc_two_platens_check(ctx, test));
    BRC_TRY(brc_loading_check(ctx, test));
    return brc_moduli_check(ctx, test);
}

static int place(struct brc_sim *sim)
{
    const struct brc_platen like = {.friction = sim->rig.params.friction};
    return brc_two_platens_place(sim, 2, 1, brc_two_platens_section(sim, 2), &like);
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    brc_moduli_results(sim, out);
    brc_curve_peak_results(sim, out + BRC_N_MODULI);
}

const struct brc_rig_type brc_rig_compression = {
    .name = "compression",
    .meaning = "unconfined compression along z",
    .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS BRC_MODULI_KEYS "friction",
    .quantities = quantities,
    .n_quantities = BRC_N_MODULI + BRC_N_PEAK_RESULTS,
    .n_platens = 2,
    .sides = BRC_CORE_SIDES,
    .check = check,
    .place = place,
    .drive = brc_two_platens_drive,
    .measure = brc_curve_sample,
    .results = results,
    .field = brc_two_platens_field};
