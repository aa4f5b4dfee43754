/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rotation of single vectors, for tests; the program turns many by one matrix. */
#ifndef BRC_TESTS_ROTATE_H
#define BRC_TESTS_ROTATE_H

#include "common/geometry/vec.h"

/* r = q a q* (body to space); r may be a. */
static inline void brc_quat_rotate(double r[3], const double q[4], const double a[3])
{
    double m[3][3], b[3] = {a[0], a[1], a[2]};
    brc_quat_matrix(m, q);
    brc_mat_mul(r, m, b);
}

#endif
