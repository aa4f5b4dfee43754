/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_kernels.inc.h for AVX-512, 32 bytes wide. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "common/engine/integrate_kernels.inc.h"

const struct brc_integrate_loops brc_integrate_avx512 = {brc_drift_loop, brc_kick_loop};
