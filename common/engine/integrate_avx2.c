/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_loops.h for AVX2. */
#pragma GCC target("avx2")
#include "common/engine/integrate_loops.h"

const struct brc_integrate_loops brc_integrate_avx2 = {drift, kick};
