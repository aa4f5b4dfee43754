/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The communicator: the ranks that share a run, and what they do together. It is an object in the
 * context, so that two runs in one process may have different ones, and a run in one process has
 * the serial one, which never touches MPI. No MPI name appears here; comm_mpi.c is the only file
 * with mpi.h but for the one of HDF5. */
#ifndef BRC_COMM_H
#define BRC_COMM_H

#include "common/base/error.h"

struct brc_comm {
    int rank, size;
    /* Sums the partial results of all ranks in rank order; every rank gets the same bits. */
    int (*sum)(struct brc_context *ctx, const struct brc_comm *comm, double *values, int n);
    /* Bytes to a rank; and those that wait, from any: *text, allocated with a 0 behind its n bytes,
     * to be freed by the caller, or NULL where none wait. NULL where there is one rank. */
    int (*send)(struct brc_context *ctx, const struct brc_comm *comm, int to, const void *bytes,
                size_t n);
    int (*receive)(struct brc_context *ctx, const struct brc_comm *comm, int *from, char **text,
                   size_t *n);
};

/* 0 of 1. */
extern const struct brc_comm brc_comm_serial;
/* The communicator of a context: the serial one where none has been set. */
static inline const struct brc_comm *brc_comm_of(const struct brc_context *ctx)
{
    return ctx->comm ? ctx->comm : &brc_comm_serial;
}

/* A launcher (mpirun, srun) has started this process. */
bool brc_comm_is_launched(void);
/* Starts MPI where a launcher (mpirun, srun) has started this process, and sets ctx->comm to all of
 * its ranks, in *comm, which must outlive the context; else does nothing. BRC_ERR_INTERNAL: MPI
 * does not start, or was ended before. */
int brc_comm_start(struct brc_context *ctx, struct brc_comm *comm);
/* Ends MPI where it runs. */
void brc_comm_end(void);

#endif
