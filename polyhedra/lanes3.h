/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors of lanes: four vectors of space side by side. For the laws (geometry.h, contact.h,
 * bond.h) and the loops that use them; knows nothing of contacts. A vector is three lanes, one for
 * each component, rather than four numbers of one vector: sums and products of four contacts then
 * have no empty place and nothing to shuffle. */
#ifndef POLY_LANES3_H
#define POLY_LANES3_H

#include "common/base/lanes.h"

BRC_LANES_INLINE brc_lanes poly_gather(const double *column, const int32_t i[BRC_LANES])
{
    return (brc_lanes){column[i[0]], column[i[1]], column[i[2]], column[i[3]]};
}

BRC_LANES_INLINE void poly_set3(brc_lanes r[3], brc_lanes x, brc_lanes y, brc_lanes z)
{
    r[0] = x;
    r[1] = y;
    r[2] = z;
}

BRC_LANES_INLINE void poly_add3(brc_lanes r[3], const brc_lanes a[3], const brc_lanes b[3])
{
    poly_set3(r, a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}

BRC_LANES_INLINE void poly_sub3(brc_lanes r[3], const brc_lanes a[3], const brc_lanes b[3])
{
    poly_set3(r, a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

BRC_LANES_INLINE void poly_scale3(brc_lanes r[3], const brc_lanes a[3], brc_lanes s)
{
    poly_set3(r, a[0] * s, a[1] * s, a[2] * s);
}

/* r += s a */
BRC_LANES_INLINE void poly_axpy3(brc_lanes r[3], brc_lanes s, const brc_lanes a[3])
{
    poly_set3(r, r[0] + s * a[0], r[1] + s * a[1], r[2] + s * a[2]);
}

BRC_LANES_INLINE void poly_mask3(brc_lanes r[3], brc_mask m, const brc_lanes a[3])
{
    poly_set3(r, brc_lanes_where(m, a[0]), brc_lanes_where(m, a[1]), brc_lanes_where(m, a[2]));
}

/* Where a > 0. */
BRC_LANES_INLINE brc_mask poly_positive(brc_lanes a)
{
    return brc_lanes_less(brc_lanes_all(0), a);
}

/* What memset would do, by stores of lanes: compilers must not see that it is 0, lest they call it.
 */
BRC_LANES_INLINE void poly_clear(brc_lanes *x, size_t size)
{
    double none = 0;
    __asm__("" : "+x"(none));
    for (size_t i = 0; i < size / sizeof *x; i++)
        x[i] = brc_lanes_all(none);
}

/* The same vector in all lanes. */
BRC_LANES_INLINE void poly_all3(brc_lanes r[3], const double a[3])
{
    poly_set3(r, brc_lanes_all(a[0]), brc_lanes_all(a[1]), brc_lanes_all(a[2]));
}

/* The vector of lane k. */
BRC_LANES_INLINE void poly_lane3(double r[3], const brc_lanes a[3], int k)
{
    r[0] = a[0][k];
    r[1] = a[1][k];
    r[2] = a[2][k];
}

#endif
