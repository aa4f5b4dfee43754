/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one time integrator: velocity Verlet in its leapfrog form (velocities at half steps);
 * rotation of grains with unequal moments by the symmetric axis splitting of NO_SQUISH type. */
#ifndef BRC_INTEGRATE_H
#define BRC_INTEGRATE_H

#include "brc.h"

/* v_n-1/2 -> v_n+1/2 and x_n -> x_n+1 from the forces of step n, local damping included. */
void brc_integrate_step(struct brc_sim *sim);
/* Free rotation of one body by dt: q and w from the angular momentum l (space), second order,
 * |l| kept to round-off. */
void brc_integrate_rotate(double q[4], double w[3], const double l[3], const double inertia[3],
                          double dt);
/* Quasi-static regime: scaled masses and inertias from the contacts' k (eqs 26-27 of vgcm, with the
 * bound of docs/physics). Momentum never grows by it; lost kinetic energy goes to the ledger. */
void brc_integrate_scale_masses(struct brc_sim *sim);

#endif
