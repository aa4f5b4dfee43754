/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_kernels.inc.h for any x86-64. */
#include "common/engine/integrate_kernels.inc.h"

const struct brc_integrate_loops brc_integrate_base = {brc_drift_loop, brc_kick_loop};
