/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_loops.h for AVX-512, 32 bytes wide. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "common/engine/integrate_loops.h"

const struct brc_integrate_loops brc_integrate_avx512 = {drift, kick};
