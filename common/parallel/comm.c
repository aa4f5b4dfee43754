/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One process: a sum over the ranks is what it is. */
#include "common/parallel/comm.h"

static int sum(struct brc_context *ctx, const struct brc_comm *comm, double *values, int n)
{
    (void)ctx, (void)comm, (void)values, (void)n;
    return 0;
}

const struct brc_comm brc_comm_serial = {.rank = 0, .size = 1, .sum = sum};
