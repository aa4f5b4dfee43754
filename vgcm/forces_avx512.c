/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces_kernels.inc.h and platens_kernels.inc.h for AVX-512, 32 bytes wide. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "vgcm/forces_kernels.inc.h"
#include "vgcm/platens_kernels.inc.h"

const struct vgcm_loops vgcm_loops_avx512 = VGCM_LOOPS;
