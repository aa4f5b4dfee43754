/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of integrate_loops.h for any x86-64. */
#include "common/engine/integrate_loops.h"

const struct brc_integrate_loops brc_integrate_base = {drift, kick};
