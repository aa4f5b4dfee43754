/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces_kernels.inc.h and platens_kernels.inc.h for any x86-64. */
#include "vgcm/forces_kernels.inc.h"
#include "vgcm/platens_kernels.inc.h"

const struct vgcm_loops vgcm_loops_base = VGCM_LOOPS;
