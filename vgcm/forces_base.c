/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h for any x86-64. */
#include "vgcm/forces.h"

void (*const vgcm_forces_base[VGCM_N_LOOPS])(struct brc_sim *,
                                             const struct vgcm_law *) = VGCM_FORCES_LOOPS;
