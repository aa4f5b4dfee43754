/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces_kernels.inc.h and platens_kernels.inc.h for AVX2. */
#pragma GCC target("avx2")
#include "vgcm/forces_kernels.inc.h"
#include "vgcm/platens_kernels.inc.h"

const struct vgcm_loops vgcm_loops_avx2 = VGCM_LOOPS;
