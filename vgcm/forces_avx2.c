/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h and platens.h for AVX2. */
#pragma GCC target("avx2")
#include "vgcm/forces.h"
#include "vgcm/platens.h"

const struct vgcm_loops vgcm_loops_avx2 = VGCM_LOOPS;
