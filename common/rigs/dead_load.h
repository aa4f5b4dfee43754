/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dead load on a flat end of the specimen: forces on named grains, whatever they do. */
#ifndef BRC_DEAD_LOAD_H
#define BRC_DEAD_LOAD_H

#include "common/rigs/end_face.h"

struct brc_dead_load;

/* The load acts along `direction` (unit), spread over the end's facets by their area, each at its
 * centroid as its grain carries it. is_followed: the direction turns with the end as a whole.
 * To be called when grains have their places. NULL in *out on failure. */
int brc_dead_load_create(struct brc_sim *sim, struct brc_end end, const double direction[3],
                         bool is_followed, struct brc_dead_load **out);
void brc_dead_load_free(void *load);
/* Adds the forces and moments of a load [N] to the grains', and their work over the step to the
 * ledger. Once a step, between the forces and the kick. */
void brc_dead_load_apply(struct brc_sim *sim, struct brc_dead_load *load, double newtons);
/* After a saved state has been read: the forces of that load in it, whose work over the next step
 * is still to be booked. */
void brc_dead_load_restore(struct brc_sim *sim, struct brc_dead_load *load, double newtons);
/* Mean way of the loaded facets along the load's first direction [m]: what its work is done over.
 */
double brc_dead_load_way(const struct brc_sim *sim, const struct brc_dead_load *load);
/* How far the end has turned in the plane of axis and load [rad], towards the load. */
double brc_dead_load_turn(const struct brc_sim *sim, const struct brc_dead_load *load);

#endif
