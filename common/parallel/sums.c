/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/parallel/sums.h"

#include "common/base/simd.h"

double brc_sum_exact_of(const double *x, size_t n, size_t of)
{
#ifdef BRC_FREE_SUMS /* what exact sums cost: a build for the bench alone */
    double plain = 0;
    (void)of;
    for (size_t i = 0; i < n; i++)
        plain += x[i];
    return plain;
#else
    /* the same bits with either, so that the machine may choose */
    return brc_simd_of(0) == BRC_SIMD_BASE ? brc_sum_exact_base(x, n, of)
                                           : brc_sum_exact_avx2(x, n, of);
#endif
}
