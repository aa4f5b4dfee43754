/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels of kernels.inc.h for AVX2. */
#pragma GCC target("avx2")
#include "polyhedra/kernels.inc.h"

struct poly_kernels poly_kernels_avx2(const struct brc_sim *sim)
{
    return poly_choose_kernels(sim);
}
