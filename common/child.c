/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "child.h"

#include "run.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { STOP_MS = 300 }; /* between two looks for a signal */

void brc_children_init(struct brc_child *child, int n)
{
    for (int i = 0; i < n; i++)
        child[i] = (struct brc_child){.pipe = -1};
}

/* The child's whole life. It never returns; the parent reads the outcome. */
static void live(const struct brc_context *parent, const struct brc_child *child,
                 const struct brc_child_work *work)
{
    struct brc_context ctx = {.quiet = parent->quiet};
    struct brc_progress progress;
    struct brc_outcome outcome = {0};
    brc_progress_begin_pipe(&progress, child->pipe);
    outcome.code = work->act(&ctx, work->user, &progress, &outcome.summary);
    memcpy(outcome.message, ctx.message, sizeof outcome.message);
    bool is_told =
        fwrite(&outcome, sizeof outcome, 1, child->result) == 1 && fflush(child->result) == 0;
    _exit(is_told ? 0 : 1);
}

int brc_children_start(struct brc_context *ctx, struct brc_child *child, int n, int i,
                       const struct brc_child_work *work)
{
    struct brc_child *c = &child[i];
    int ends[2];
    c->result = tmpfile();
    if (!c->result || pipe(ends) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a run of %s: %s", c->name, strerror(errno));
    fflush(NULL);
    c->process = fork();
    if (c->process < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a run of %s: %s", c->name, strerror(errno));
    if (c->process == 0) {
        close(ends[0]);
        for (int k = 0; k < n; k++)
            if (child[k].pipe >= 0)
                close(child[k].pipe);
        c->pipe = ends[1];
        live(ctx, c, work);
    }
    close(ends[1]);
    c->pipe = ends[0];
    return 0;
}

int brc_children_running(const struct brc_child *child, int n)
{
    int running = 0;
    for (int i = 0; i < n; i++)
        running += child[i].pipe >= 0;
    return running;
}

/* The child has closed its pipe: takes its exit and its outcome. */
static int end_child(struct brc_context *ctx, struct brc_child *c)
{
    int status;
    close(c->pipe);
    c->pipe = -1;
    while (waitpid(c->process, &status, 0) < 0)
        if (errno != EINTR)
            BRC_FAIL(ctx, BRC_ERR_IO, "lost the run of %s: %s", c->name, strerror(errno));
    rewind(c->result);
    bool is_told = WIFEXITED(status) && WEXITSTATUS(status) == 0 &&
                   fread(&c->outcome, sizeof c->outcome, 1, c->result) == 1;
    fclose(c->result);
    c->result = NULL;
    if (is_told)
        return 0;
    c->outcome = (struct brc_outcome){.code = BRC_ERR_INTERNAL};
    if (WIFSIGNALED(status))
        snprintf(c->outcome.message, sizeof c->outcome.message,
                 "its process was ended by signal %d", WTERMSIG(status));
    else
        snprintf(c->outcome.message, sizeof c->outcome.message,
                 "its process ended without a result");
    return 0;
}

void brc_children_stop(const struct brc_child *child, int n)
{
    for (int i = 0; i < n; i++)
        if (child[i].pipe >= 0)
            kill(child[i].process, SIGTERM);
}

/* Takes one report; false at the end of the pipe. */
static bool read_report(const struct brc_child *c, int i, struct brc_progress *progress)
{
    struct brc_progress_report report;
    ssize_t n;
    do
        n = read(c->pipe, &report, sizeof report);
    while (n < 0 && errno == EINTR);
    if (n != (ssize_t)sizeof report)
        return false;
    if (progress)
        brc_progress_update(progress, i, &report);
    return true;
}

int brc_children_listen(struct brc_context *ctx, struct brc_child *child, int n,
                        struct brc_progress *progress)
{
    struct pollfd ready[BRC_PROGRESS_MAX_RUNS];
    int index[BRC_PROGRESS_MAX_RUNS], n_ready = 0;
    for (int i = 0; i < n; i++) {
        if (child[i].pipe < 0)
            continue;
        ready[n_ready] = (struct pollfd){.fd = child[i].pipe, .events = POLLIN};
        index[n_ready++] = i;
    }
    int code = poll(ready, (nfds_t)n_ready, STOP_MS);
    if (code < 0 && errno != EINTR)
        BRC_FAIL(ctx, BRC_ERR_IO, "lost the runs: %s", strerror(errno));
    if (brc_run_is_stopped())
        brc_children_stop(child, n);
    for (int k = 0; k < n_ready && code >= 0; k++)
        if (ready[k].revents != 0 && !read_report(&child[index[k]], index[k], progress))
            BRC_TRY(end_child(ctx, &child[index[k]]));
    return 0;
}

int brc_children_at_once(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > BRC_PROGRESS_MAX_RUNS ? BRC_PROGRESS_MAX_RUNS : (int)n;
}
