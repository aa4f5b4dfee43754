/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks: start, end and reductions. No MPI name appears here; comm_mpi.c is the only file with
 * mpi.h. One process without mpirun is the common case. */
#ifndef BRC_COMM_H
#define BRC_COMM_H

#include "error.h"

int brc_comm_start(struct brc_context *ctx);
void brc_comm_end(void);
int brc_comm_rank(void);
int brc_comm_size(void);
/* Sums the partial results of all ranks in rank order; every rank gets the same bits. */
int brc_comm_sum(struct brc_context *ctx, double *values, int n);

#endif
