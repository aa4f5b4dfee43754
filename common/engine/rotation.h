/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Free rotation of one body. The integrator calls it for grains with unequal moments of inertia; it
 * knows no forces and no simulation. */
#ifndef BRC_ROTATION_H
#define BRC_ROTATION_H

/* By dt: q and w from the angular momentum l (space, kept); axis order 1-2-3-2-1, second order, of
 * NO_SQUISH type. */
void brc_rotation_free(double q[4], double w[3], const double l[3], const double inertia[3],
                       double dt);
/* w = R I^-1 R^T l */
void brc_rotation_spin(double w[3], const double q[4], const double l[3], const double inertia[3]);
void brc_rotation_normalise(double q[4]);
/* By w dt exactly: the way of equal moments, and of what only follows a spin. */
void brc_rotation_turn(double q[4], const double w[3], double dt);

#endif
