/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs in forked processes, side by side: each sends reports of its progress and leaves an outcome.
 * They do without MPI, which does not survive a fork; start none before. */
#ifndef BRC_CHILD_H
#define BRC_CHILD_H

#include "common/output/output.h"
#include "common/base/progress.h"

#include <sys/types.h>

/* What a child leaves for its parent; plain data. */
struct brc_outcome {
    int code;
    char message[BRC_MESSAGE_SIZE];
    struct brc_summary summary;
};

struct brc_child {
    char name[64]; /* for messages */
    pid_t process;
    int pipe;   /* of reports; -1: it does not run */
    int result; /* pipe of its outcome, which follows the last report */
    struct brc_outcome outcome;
};

/* Work of a child, in its own process. */
struct brc_child_work {
    int (*act)(struct brc_context *ctx, const void *user, struct brc_progress *progress,
               struct brc_summary *out);
    const void *user;
};

/* n children that do not run yet. */
void brc_children_init(struct brc_child *child, int n);
/* Starts number i of n, which does not run, with the work. */
int brc_children_start(struct brc_context *ctx, struct brc_child *child, int n, int i,
                       const struct brc_child_work *work);
int brc_children_running(const struct brc_child *child, int n);
/* Waits a little for reports, which go to the lines of progress (NULL: nowhere), and takes the
 * outcomes of children that have ended. A signal that the parent holds is passed on. */
int brc_children_listen(struct brc_context *ctx, struct brc_child *child, int n,
                        struct brc_progress *progress);
void brc_children_stop(const struct brc_child *child, int n);
/* How many runs the machine can do at a time. */
int brc_children_at_once(void);

#endif
