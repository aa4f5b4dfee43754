/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The do-nothing model: copy this folder to begin a model, see docs/add-a-model.md. */
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

static int null_shape(struct brc_sim *sim, void *state)
{
    const struct brc_facets *facets = &sim->specimen->facets;
    struct brc_bodies *b = &sim->bodies;
    (void)state;
    for (size_t i = 0; i < facets->n_cells; i++) {
        brc_copy(b->x[i], facets->centre[i]);
        b->q[i][0] = 1;
        b->volume[i] = facets->volume[i];
        b->true_mass[i] = 1000 * b->volume[i];
        b->bounding_radius[i] = cbrt(b->volume[i]);
    }
    return 0;
}

static int null_bond(struct brc_sim *sim, void *state)
{
    (void)state;
    return brc_contacts_set(sim->ctx, &sim->pairs, NULL, 0);
}

static int null_pairs(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                      const struct brc_neighbours *platens)
{
    (void)sim, (void)state, (void)grains, (void)platens;
    return 0;
}

static void null_forces(struct brc_sim *sim, void *state)
{
    (void)sim, (void)state;
}

static void null_energy(const struct brc_sim *sim, const void *state,
                        double (*of_grain)[BRC_N_ACCOUNTS])
{
    (void)sim, (void)state, (void)of_grain;
}

static int null_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out)
{
    (void)sim, (void)state, (void)out;
    return 0;
}

const struct brc_model brc_model_null = {.name = "null",
                                         .citation = "none",
                                         .shape = null_shape,
                                         .bond = null_bond,
                                         .pairs = null_pairs,
                                         .forces = null_forces,
                                         .platens = null_forces,
                                         .energy = null_energy,
                                         .springs = null_springs};
