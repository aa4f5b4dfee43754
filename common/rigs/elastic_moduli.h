/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic moduli: least squares over the rows of the curve between two parts of the peak. */
#ifndef BRC_ELASTIC_MODULI_H
#define BRC_ELASTIC_MODULI_H

#include "common/engine/rig.h"

/* Shared keys that moduli use. */
#define BRC_MODULI_KEYS "modulus_low modulus_high "
/* What is measured, to stand in a test's list. */
#define BRC_MODULI_QUANTITIES                                \
    {"E", "Pa", "Young's modulus by the gauge strain"},      \
        {"nu", "1", "Poisson's ratio by the gauge strains"}, \
    {                                                        \
        "E_platen", "Pa", "modulus by the platen strain"     \
    }
enum { BRC_N_MODULI = 3 };

int brc_moduli_check(struct brc_context *ctx, const struct brc_test_params *test);
/* The values of BRC_MODULI_QUANTITIES. */
void brc_moduli_results(const struct brc_sim *sim, struct brc_measured *out);

#endif
