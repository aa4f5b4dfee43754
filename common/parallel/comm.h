/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks: start, end and reductions. No MPI name appears here; comm_mpi.c is the only file with
 * mpi.h. One process without a launcher (mpirun, srun) is the common case; it never starts MPI. */
#ifndef BRC_COMM_H
#define BRC_COMM_H

#include "common/base/error.h"

/* Starts MPI where a launcher has started this process; else, and where MPI runs already, does
 * nothing. BRC_ERR_INTERNAL: MPI does not start, or was ended before. */
int brc_comm_start(struct brc_context *ctx);
/* Ends MPI where it runs. */
void brc_comm_end(void);
/* 0 of 1 while MPI does not run. */
int brc_comm_rank(void);
int brc_comm_size(void);
/* Sums the partial results of all ranks in rank order; every rank gets the same bits. */
int brc_comm_sum(struct brc_context *ctx, double *values, int n);

#endif
