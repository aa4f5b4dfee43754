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
/* Free rotation of one body by dt: q and w from the angular momentum l (space, kept); axis order
 * 1-2-3-2-1, second order. */
void brc_integrate_rotate(double q[4], double w[3], const double l[3], const double inertia[3],
                          double dt);
/* w = R I^-1 R^T l */
void brc_integrate_spin(double w[3], const double q[4], const double l[3], const double inertia[3]);
/* Sums of the contacts' k over the rows of a body: of k, and of k |r|^2. */
void brc_integrate_stiffness(const struct brc_sim *sim, size_t body, double k[2]);
/* Quasi-static regime: masses and inertias grow to what the contacts' k needs for a step of 1
 * (eq:vgcm:26, eq:vgcm:27 with the bound K_t = 4 sum k). They never shrink, and momentum is kept;
 * the kinetic energy lost goes to the ledger. At the start and in the first step, in which the load
 * closes contacts, the velocities of the rig's field are kept instead, and what they need more of
 * belongs to the ledger's start. */
void brc_integrate_scale_masses(struct brc_sim *sim);
/* The same at the start for grains that nothing holds yet: the mass that one spring of mean
 * stiffness needs, so that gravity moves them by about what it will press them into each other by a
 * step. Without any spring gravity is an error; else a mass of 1 does, as no force acts. */
int brc_integrate_loose_masses(struct brc_sim *sim);

/* The loops over bodies for each instruction set: the same bits. */
struct brc_integrate_loops {
    void (*drift)(struct brc_sim *sim); /* without orientations */
    void (*kick)(struct brc_sim *sim, double dt);
};
extern const struct brc_integrate_loops brc_integrate_base, brc_integrate_avx2;

#endif
