/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A queue of runs in forked processes, some side by side: each sends reports of its progress and
 * leaves an outcome. `compare` and `converge` use it; it knows no model and no case. The runs do
 * without MPI, which does not survive a fork; start none before. */
#ifndef BRC_CHILD_H
#define BRC_CHILD_H

#include "common/output/output.h"
#include "common/base/progress.h"

/* What a run leaves for the parent. The summary may point to constant texts, which lie at the same
 * place in both processes, and to nothing else. */
struct brc_outcome {
    int code;
    char message[BRC_MESSAGE_SIZE];
    struct brc_summary summary;
};

enum { BRC_QUEUE_MAX = 256 };
struct brc_queue {
    int n, at_once; /* runs, and how many of them at a time: BRC_QUEUE_MAX at most */
    void *user;
    struct brc_progress *progress; /* gets the reports, run i those of line i; NULL: nobody does;
                                    * else n is at most BRC_PROGRESS_MAX_RUNS */
    /* What a failure to start run i calls it. */
    const char *(*name)(const void *user, int i);
    /* Does run i. Called in a process of its own: nothing but *out and the message comes back. */
    int (*act)(struct brc_context *ctx, const void *user, int i, struct brc_progress *progress,
               struct brc_summary *out);
    /* Takes the outcome of run i. Called in the parent, as soon as the run has ended. */
    int (*end)(struct brc_context *ctx, void *user, int i, const struct brc_outcome *outcome);
};

/* Does all runs, in the order of their numbers. After a failure of `end`, or of starting a run, no
 * run is started; those in progress get SIGTERM, are waited for, and their outcomes are dropped. A
 * signal that the parent holds is passed on, and ends the queue in the same way, but for the
 * outcomes, which are taken: the caller sees by them which runs were left out. */
int brc_queue_run(struct brc_context *ctx, const struct brc_queue *queue);
/* How many runs the machine can do at a time: one a processor that is online. */
int brc_queue_at_once(void);

#endif
