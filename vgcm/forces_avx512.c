/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h and platens.h for AVX-512, 32 bytes wide. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "vgcm/forces.h"
#include "vgcm/platens.h"

const struct vgcm_loops vgcm_loops_avx512 = VGCM_LOOPS;
