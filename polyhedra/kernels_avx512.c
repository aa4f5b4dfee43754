/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels of kernels.inc.h for AVX-512, in lanes of four. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "polyhedra/kernels.inc.h"

struct poly_kernels poly_kernels_avx512(const struct brc_sim *sim)
{
    return poly_choose_kernels(sim);
}
