/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of sums_kernels.inc.h for AVX2. */
#pragma GCC target("avx2")

#include "common/parallel/sums_kernels.inc.h"

double brc_sum_exact_avx2(const double *x, size_t n, size_t of)
{
    return sum_exact(x, n, of);
}
