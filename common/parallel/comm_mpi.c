/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Called through the communicator alone, so that nothing else knows MPI. */
#include "common/parallel/comm.h"

#include <mpi.h>
#include <stdlib.h>

/* Only a launcher makes several ranks. Without one nothing needs MPI, and its start would depend on
 * what one process has no use for: a home folder, room for session files in the temporary folder,
 * network hardware; many starts at once fail now and then. So that there are several ranks is read
 * from what launchers tell each process (Open MPI; PMIx: prte, srun; PMI: MPICH, Intel, srun;
 * MVAPICH). A batch system's own variables (SLURM_*) stand in serial cases, too. */
bool brc_comm_is_launched(void)
{
    static const char *const mark[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK",
                                       "MV2_COMM_WORLD_SIZE"};
    for (size_t i = 0; i < sizeof mark / sizeof mark[0]; i++)
        if (getenv(mark[i]) != NULL)
            return true;
    return false;
}

static bool comm_is_up(void)
{
    int is_started = 0, is_ended = 0;
    MPI_Initialized(&is_started);
    MPI_Finalized(&is_ended);
    return is_started && !is_ended;
}

/* MPI_Allreduce would do, but may add in an order that changes with the number of ranks and with
 * the network; gathered, the parts are added in rank order by everyone. They are few. */
static int sum(struct brc_context *ctx, const struct brc_comm *comm, double *values, int n)
{
    size_t size = (size_t)comm->size;
    double *part = brc_alloc(ctx, size * (size_t)n, sizeof *part);
    if (part == NULL)
        return BRC_ERR_MEMORY;
    int code = MPI_Allgather(values, n, MPI_DOUBLE, part, n, MPI_DOUBLE, MPI_COMM_WORLD);
    for (int i = 0; i < n && code == MPI_SUCCESS; i++) {
        values[i] = part[i];
        for (size_t rank = 1; rank < size; rank++)
            values[i] += part[rank * (size_t)n + (size_t)i];
    }
    free(part);
    if (code != MPI_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI could not exchange %d sums (code %d)", n, code);
    return 0;
}

static int send_bytes(struct brc_context *ctx, const struct brc_comm *comm, int to,
                      const void *bytes, size_t n)
{
    (void)comm;
    int code = MPI_Send(bytes, (int)n, MPI_BYTE, to, 0, MPI_COMM_WORLD);
    if (code != MPI_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI could not send to rank %d (code %d)", to, code);
    return 0;
}

static int receive_bytes(struct brc_context *ctx, const struct brc_comm *comm, int *from,
                         char **text, size_t *n)
{
    MPI_Status status;
    int is_there = 0, size = 0;
    (void)comm;
    *text = NULL;
    int code = MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &is_there, &status);
    if (code == MPI_SUCCESS && !is_there)
        return 0;
    if (code == MPI_SUCCESS)
        code = MPI_Get_count(&status, MPI_BYTE, &size);
    *from = status.MPI_SOURCE;
    *n = (size_t)size;
    *text = brc_alloc(ctx, *n + 1, 1);
    if (*text && code == MPI_SUCCESS)
        code = MPI_Recv(*text, size, MPI_BYTE, *from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (code != MPI_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI could not receive (code %d)", code);
    return *text ? 0 : BRC_ERR_MEMORY;
}

int brc_comm_start(struct brc_context *ctx, struct brc_comm *comm)
{
    int is_ended = 0;
    if (!comm_is_up() && !brc_comm_is_launched())
        return 0;
    MPI_Finalized(&is_ended);
    if (is_ended)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI was ended; it cannot start again in this process");
    if (!comm_is_up() && MPI_Init(NULL, NULL) != MPI_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "MPI did not start");
    /* the default handler ends the program where an error could be told */
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    comm->sum = sum;
    comm->send = send_bytes;
    comm->receive = receive_bytes;
    MPI_Comm_rank(MPI_COMM_WORLD, &comm->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &comm->size);
    ctx->comm = comm;
    return 0;
}

void brc_comm_end(void)
{
    if (comm_is_up())
        MPI_Finalize();
}
