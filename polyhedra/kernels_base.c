/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels of kernels.inc.h for any x86-64. */
#include "polyhedra/kernels.inc.h"

struct poly_kernels poly_kernels_base(const struct brc_sim *sim)
{
    return poly_choose_kernels(sim);
}
