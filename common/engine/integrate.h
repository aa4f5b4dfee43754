/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one time integrator: velocity Verlet in its leapfrog form (velocities at half steps);
 * rotation of grains with unequal moments by the symmetric axis splitting of NO_SQUISH type. */
#ifndef BRC_INTEGRATE_H
#define BRC_INTEGRATE_H

#include "common/base/brc.h"

/* x_n -> x_n+1 with the velocities of the half step; orientation where the model reads it. */
void brc_integrate_drift(struct brc_sim *sim);
/* v_n-1/2 -> v_n+1/2 over dt from the forces of step n, local damping and gravity included; sets
 * the kinetic energy m v- . v+ / 2 of the ledger. */
void brc_integrate_kick(struct brc_sim *sim, double dt);
/* The loops over bodies for each instruction set: the same bits. */
struct brc_integrate_loops {
    void (*drift)(struct brc_sim *sim); /* without orientations */
    void (*kick)(struct brc_sim *sim, double dt);
};
extern const struct brc_integrate_loops brc_integrate_base, brc_integrate_avx2;

#endif
