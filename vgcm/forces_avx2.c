/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h for AVX2. */
#pragma GCC target("avx2")
#include "vgcm/forces.h"

void (*const vgcm_forces_avx2[VGCM_N_LOOPS])(struct brc_sim *,
                                             const struct vgcm_law *) = VGCM_FORCES_LOOPS;
