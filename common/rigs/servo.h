/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pair of platens held at a force: they move as one body of a scaled mass, pushed by the force
 * that is asked for and held by the specimen's. */
#ifndef BRC_SERVO_H
#define BRC_SERVO_H

#include "common/engine/rig.h"

/* Velocity of platens first and first + 1, which face each other, for the step to come: they take
 * up `force` [N] each on average, > 0 pushing. *mass [kg] is state of the test: it only grows.
 * Once a step, between the forces and the kick. */
void brc_servo_push(struct brc_sim *sim, int first, double force, double *mass);

#endif
