/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One half of the integrator: which loops run, and what the ledger gets of them. The loops over
 * bodies, compiled for each instruction set, are in integrate_kernels.inc.h. Called by sim.c alone.
 */
#include "common/engine/integrate.h"

#include "common/engine/rotation.h"
#include "common/engine/sim.h"
#include "common/parallel/sums.h"

/* Orientations, in the order of the bodies; before their spin is read for anything else. */
static void drift_orientations(struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        const double *inertia = b->inertia[i];
        /* exactly, not nearly: scaled moments are set equal, and those of a general grain never are
         * by chance */
        if (inertia[0] == inertia[1] && inertia[1] == inertia[2])
            brc_rotation_turn(b->q[i], b->w[i], sim->dt);
        else
            brc_rotation_free(b->q[i], b->w[i], b->l[i], inertia, sim->dt);
    }
}

static const struct brc_integrate_loops *loops_of(const struct brc_sim *sim)
{
    return brc_simd_of(sim->run.simd) == BRC_SIMD_BASE ? &brc_integrate_base : &brc_integrate_avx2;
}

void brc_integrate_drift(struct brc_sim *sim)
{
    if (sim->model.flags & BRC_MODEL_ORIENTED)
        drift_orientations(sim);
    loops_of(sim)->drift(sim);
}

/* Sums over bodies are exact, as the kinetic energy feeds back into the rate of adaptive loading.
 * Work of damping over the half step after the kick is kept apart: it belongs to the next step,
 * which may not come. */
void brc_integrate_kick(struct brc_sim *sim, double dt)
{
    const struct brc_bodies *b = &sim->bodies;
    loops_of(sim)->kick(sim, dt);
    sim->ledger.kinetic = brc_sum_exact(b->terms, b->n_grains);
}
