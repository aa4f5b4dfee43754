/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses at which cracks begin (CI) and join (CD) in compression along a core's axis, off the
 * gauge strains of the curve. */
#ifndef BRC_CRACK_STRESS_H
#define BRC_CRACK_STRESS_H

#include "common/rigs/elastic_moduli.h"

/* Rows of a curve up to its peak, compression positive. */
struct brc_strains {
    const double *stress, *axial, *lateral;
    size_t n;
};

enum { BRC_N_CRACK_STRESSES = 3 };
/* CI by lateral strain, CI by crack volumetric strain, CD: in the order of the quantities. E [Pa]
 * and nu are those of the elastic part. NAN with a note where a stress cannot be read. */
void brc_crack_stresses(const struct brc_strains *rows, double E, double nu,
                        struct brc_measured out[BRC_N_CRACK_STRESSES]);

/* Moduli, peak and these, to stand in the table of a test that compresses a core. */
#define BRC_COMPRESSION_QUANTITIES                                                                \
    BRC_CORE_QUANTITIES, {"ci_lateral", "Pa", "crack initiation by the lateral strain response"}, \
        {"ci_volumetric", "Pa", "crack initiation by crack volumetric strain"},                   \
    {                                                                                             \
        "cd", "Pa", "crack damage: the volumetric strain turns round"                             \
    }
enum { BRC_N_COMPRESSION_RESULTS = BRC_N_CORE_RESULTS + BRC_N_CRACK_STRESSES };
extern const struct brc_quantity brc_compression_quantities[BRC_N_COMPRESSION_RESULTS];
void brc_compression_results(const struct brc_sim *sim, struct brc_measured *out);
#define BRC_COMPRESSION_RESULTS                                                          \
    .quantities = brc_compression_quantities, .n_quantities = BRC_N_COMPRESSION_RESULTS, \
    .results = brc_compression_results, .sides = BRC_CORE_SIDES

#endif
