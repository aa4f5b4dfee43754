/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of forces.h and platens.h for any x86-64. */
#include "vgcm/forces.h"
#include "vgcm/platens.h"

const struct vgcm_loops vgcm_loops_base = VGCM_LOOPS;
