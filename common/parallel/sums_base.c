/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of sums_kernels.inc.h for any x86-64. */
#include "common/parallel/sums_kernels.inc.h"

double brc_sum_exact_base(const double *x, size_t n, size_t of)
{
    return sum_exact(x, n, of);
}
