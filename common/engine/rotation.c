/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Free rotation by symmetric splitting into rotations about the principal axes, each of which is
 * exact: the angular momentum in space is kept to round-off, whatever the step. The order of the
 * axes, 1-2-3-2-1, was the best one on the torque-free top (tests/converge/test_top.c). */
#include "common/engine/rotation.h"

#include "common/geometry/vec.h"

/* Turns q and the body-frame angular momentum by the free rotation about one principal axis. Sine
 * and cosine of the whole angle come from those of the half one, which the quaternion needs anyway.
 */
static void rotate_axis(double q[4], double lb[3], int axis, double inertia, double dt)
{
    int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double half[4], phi[3] = {dt * lb[axis] / inertia, 0, 0}, lj = lb[j];
    brc_quat_from_rotation(half, phi);
    double c = half[0], s = half[1], cos_phi = 1 - 2 * s * s, sin_phi = 2 * s * c;
    lb[j] = cos_phi * lj + sin_phi * lb[k];
    lb[k] = cos_phi * lb[k] - sin_phi * lj;
    double q0 = q[0], qj = q[1 + j];
    q[0] = c * q0 - s * q[1 + axis];
    q[1 + axis] = c * q[1 + axis] + s * q0;
    q[1 + j] = c * qj + s * q[1 + k];
    q[1 + k] = c * q[1 + k] - s * qj;
}

void brc_rotation_normalise(double q[4])
{
    double s = 1 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] *= s;
}

void brc_rotation_spin(double w[3], const double q[4], const double l[3], const double inertia[3])
{
    double m[3][3], lb[3];
    brc_quat_matrix(m, q);
    brc_mat_mul_t(lb, m, l);
    for (int k = 0; k < 3; k++)
        lb[k] /= inertia[k];
    brc_mat_mul(w, m, lb);
}

void brc_rotation_free(double q[4], double w[3], const double l[3], const double inertia[3],
                       double dt)
{
    double m[3][3], lb[3];
    brc_quat_matrix(m, q);
    brc_mat_mul_t(lb, m, l);
    rotate_axis(q, lb, 0, inertia[0], dt / 2);
    rotate_axis(q, lb, 1, inertia[1], dt / 2);
    rotate_axis(q, lb, 2, inertia[2], dt);
    rotate_axis(q, lb, 1, inertia[1], dt / 2);
    rotate_axis(q, lb, 0, inertia[0], dt / 2);
    brc_rotation_normalise(q);
    brc_rotation_spin(w, q, l, inertia);
}

/* No splitting, and w stays as it is without a moment. */
void brc_rotation_turn(double q[4], const double w[3], double dt)
{
    double phi[3], turn[4], old[4] = {q[0], q[1], q[2], q[3]};
    brc_scale(phi, w, dt);
    brc_quat_from_rotation(turn, phi);
    brc_quat_mul(q, turn, old);
    brc_rotation_normalise(q);
}
