/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pressure on the specimen's sides that follows them as they deform, as a fluid behind a thin
 * jacket does. Forces of a fixed direction would make a specimen's rigid spin unstable: each turn
 * would have a moment that turns it further. */
#ifndef BRC_PRESSURE_H
#define BRC_PRESSURE_H

#include "common/engine/rig.h"

struct brc_pressure;

/* The sides: all boundary facets that face no platen of the test. Their vertices move with the mean
 * of the grains that share them. To be called when platens and grains have their places, in a test
 * that says has_sides. NULL in *out on failure. */
int brc_pressure_create(struct brc_sim *sim, struct brc_pressure **out);
void brc_pressure_free(void *pressure);
/* Adds the forces and moments of a pressure p [Pa] on the sides to the grains', and their work over
 * the step to the ledger. Once a step, between the forces and the kick. */
void brc_pressure_apply(struct brc_sim *sim, struct brc_pressure *s, double p);
/* After a saved state has been read, in which the pressure was p: the next step books its work. */
void brc_pressure_restore(struct brc_sim *sim, struct brc_pressure *s, double p);
/* Where the sides are now, and what a unit pressure on them does to each grain (side_area and
 * side_moment of the bodies). `apply` does it every few steps. */
void brc_pressure_find(struct brc_sim *sim, struct brc_pressure *s);
/* Area of the facets whose grains have left by more than a diameter, over that of all: what the
 * pressure acts on no more [1]. */
double brc_pressure_lost(const struct brc_sim *sim, const struct brc_pressure *s);

#endif
