/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masses of the quasi-static regime: scaled so that a step of 1 is stable. */
#ifndef BRC_MASS_SCALING_H
#define BRC_MASS_SCALING_H

#include "common/base/brc.h"

/* Sums of the contacts' k over the rows of a body: of k, and of k |r|^2. */
void brc_mass_scaling_stiffness(const struct brc_sim *sim, size_t body, double k[2]);
/* Quasi-static regime: masses and inertias grow to what the contacts' k needs for a step of 1
 * (eq:vgcm:26, eq:vgcm:27 with the bound K_t = 4 sum k). They never shrink, and momentum is kept;
 * the kinetic energy lost goes to the ledger. At the start and in the first step, in which the load
 * closes contacts, the velocities of the rig's field are kept instead, and what they need more of
 * belongs to the ledger's start. */
void brc_mass_scaling_update(struct brc_sim *sim);
/* The same at the start for grains that nothing holds yet: the mass that one spring of mean
 * stiffness needs, so that gravity moves them by about what it will press them into each other by a
 * step. Without any spring gravity is an error; else a mass of 1 does, as no force acts. */
int brc_mass_scaling_loose(struct brc_sim *sim);

#endif
