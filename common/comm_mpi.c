/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "comm.h"

#include <mpi.h>
#include <stdlib.h>

/* One process without mpirun needs neither the helper daemon of a singleton nor a search for
 * network hardware; both together cost 0.3 s. What the user has set stays. */
static int comm_prepare_single(struct brc_context *ctx)
{
    static const char *const setting[][2] = {
        {"OMPI_MCA_ess_singleton_isolated", "1"},
        {"OMPI_MCA_pml", "ob1"},
        {"OMPI_MCA_btl", "self"},
    };
    if (getenv("OMPI_COMM_WORLD_SIZE") != NULL || getenv("PMIX_RANK") != NULL)
        return 0;
    for (size_t i = 0; i < sizeof setting / sizeof setting[0]; i++)
        if (setenv(setting[i][0], setting[i][1], 0) != 0)
            BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory while setting %s", setting[i][0]);
    return 0;
}

static bool comm_is_up(void)
{
    int is_started = 0, is_ended = 0;
    MPI_Initialized(&is_started);
    MPI_Finalized(&is_ended);
    return is_started && !is_ended;
}

int brc_comm_start(struct brc_context *ctx)
{
    int is_ended = 0;
    MPI_Finalized(&is_ended);
    if (is_ended)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI was ended; it cannot start again in this process");
    if (!comm_is_up()) {
        BRC_TRY(comm_prepare_single(ctx));
        if (MPI_Init(NULL, NULL) != MPI_SUCCESS)
            BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI did not start");
    }
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    return 0;
}

void brc_comm_end(void)
{
    if (comm_is_up())
        MPI_Finalize();
}

int brc_comm_rank(void)
{
    int rank = 0;
    if (comm_is_up())
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int brc_comm_size(void)
{
    int size = 1;
    if (comm_is_up())
        MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

int brc_comm_sum(struct brc_context *ctx, double *values, int n)
{
    int size = brc_comm_size();
    if (size == 1 || n == 0)
        return 0;
    double *part = brc_alloc(ctx, (size_t)size * (size_t)n, sizeof *part);
    if (part == NULL)
        return BRC_ERR_MEMORY;
    int code = MPI_Allgather(values, n, MPI_DOUBLE, part, n, MPI_DOUBLE, MPI_COMM_WORLD);
    for (int i = 0; i < n && code == MPI_SUCCESS; i++) {
        values[i] = part[i];
        for (int rank = 1; rank < size; rank++)
            values[i] += part[(size_t)rank * (size_t)n + (size_t)i];
    }
    free(part);
    if (code != MPI_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI could not exchange %d sums (code %d)", n, code);
    return 0;
}
