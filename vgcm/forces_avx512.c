/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h for AVX-512, 32 bytes wide. */
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#include "vgcm/forces.h"

void (*const vgcm_forces_avx512[VGCM_N_LOOPS])(struct brc_sim *,
                                               const struct vgcm_law *) = VGCM_FORCES_LOOPS;
