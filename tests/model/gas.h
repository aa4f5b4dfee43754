/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gas of loose grains in a box: contacts of every kind come and go for as long as one likes. */
#ifndef BRC_TESTS_GAS_H
#define BRC_TESTS_GAS_H

#include "tests/fixture.h"

enum { GAS_N = 12 };

/* Twelve loose boxes of about 1 cm (spheres of 5 mm inside them for vgcm), thrown at random; the
 * cells as they lie at the start go to cell[GAS_N], unless NULL, and are then the caller's. */
void gas_build(struct fixture *f, struct brc_convex *cell, const struct brc_model *model,
               const char *settings, const char *run);
/* Walls without contact: a centre that leaves turns back. */
void gas_reflect(struct fixture *f);

#endif
