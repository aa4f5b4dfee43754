/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A queue of runs over the ranks of a launcher: rank 0 hands out, every rank does one run at a
 * time. Runs live in processes that are forked from a helper, which is forked before MPI starts: a
 * process with MPI's threads and connections must not be forked, and a run that crashes takes no
 * rank with it. Orders and answers are plain bytes, as the memory of ranks has other addresses. */
#ifndef BRC_RANKS_H
#define BRC_RANKS_H

#include "common/parallel/comm.h"

#include <sys/types.h>

/* What rank 0 tells another rank to do; what the numbers mean is the caller's. */
struct brc_order {
    int64_t number[3];
};

struct brc_ranks {
    struct brc_context *ctx;
    struct brc_comm comm;
    pid_t helper;
    int to, from; /* pipes of the helper */
};

/* In the helper: does what is ordered and returns its answer, a text to be freed; NULL: none, the
 * helper ends. */
typedef char *brc_ranks_act(void *user, const struct brc_order *order);

/* Forks the helper, which never returns, then starts MPI. Call nothing of MPI before. */
int brc_ranks_begin(struct brc_context *ctx, struct brc_ranks *r, brc_ranks_act *act, void *user);
/* On ranks beside 0: does what rank 0 hands out, until its end. */
int brc_ranks_serve(struct brc_ranks *r);

struct brc_ranks_queue {
    int n;
    void *user;
    void (*order)(const void *user, int i, struct brc_order *out);
    /* Takes the answer to run i, on rank 0. */
    int (*end)(struct brc_context *ctx, void *user, int i, const char *answer);
};
/* On rank 0: all runs of the queue, as brc_queue_run does them, signals included. */
int brc_ranks_run(struct brc_ranks *r, const struct brc_ranks_queue *queue);
/* Ends the helper, and on rank 0 the other ranks. */
void brc_ranks_end(struct brc_ranks *r);

#endif
