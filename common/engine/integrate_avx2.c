/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_kernels.inc.h for AVX2. */
#pragma GCC target("avx2")
#include "common/engine/integrate_kernels.inc.h"

const struct brc_integrate_loops brc_integrate_avx2 = {brc_drift_loop, brc_kick_loop};
