/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes rather than threads: a model that crashes, or a library that keeps state of the
 * process, leaves the other runs alone, and each run has its own processor time. */
#include "common/runs/child.h"

#include "common/base/signals.h"

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

static bool write_whole(int file, const void *what, size_t size)
{
    for (const char *at = what; size > 0;) {
        ssize_t n = write(file, at, size);
        if (n < 0 && errno != EINTR)
            return false;
        at += n > 0 ? n : 0;
        size -= n > 0 ? (size_t)n : 0;
    }
    return true;
}

static bool read_whole(int file, void *what, size_t size)
{
    for (char *at = what; size > 0;) {
        ssize_t n = read(file, at, size);
        if (n == 0 || (n < 0 && errno != EINTR))
            return false;
        at += n > 0 ? n : 0;
        size -= n > 0 ? (size_t)n : 0;
    }
    return true;
}

/* The child's whole life. It never returns; the parent reads the outcome. The reports end first:
 * the parent then waits for the outcome, which may be longer than a pipe holds. */
static void live(const struct brc_context *parent, const struct brc_child *child,
                 const struct brc_child_work *work)
{
    struct brc_context ctx = {.quiet = parent->quiet};
    struct brc_progress progress;
    struct brc_outcome outcome = {0};
    brc_progress_begin_pipe(&progress, child->pipe);
    outcome.code = work->act(&ctx, work->user, &progress, &outcome.summary);
    memcpy(outcome.message, ctx.message, sizeof outcome.message);
    close(child->pipe);
    _exit(write_whole(child->result, &outcome, sizeof outcome) ? 0 : 1);
}

/* Those of the other children, in a new one. */
static void close_pipes(const struct brc_child *child, int n)
{
    for (int k = 0; k < n; k++)
        if (child[k].pipe >= 0) {
            close(child[k].pipe);
            close(child[k].result);
        }
}

int brc_children_start(struct brc_context *ctx, struct brc_child *child, int n, int i,
                       const struct brc_child_work *work)
{
    struct brc_child *c = &child[i];
    int reports[2], result[2];
    if (pipe(reports) != 0 || pipe(result) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a run of %s: %s", c->name, strerror(errno));
    fflush(NULL);
    c->process = fork();
    if (c->process < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a run of %s: %s", c->name, strerror(errno));
    if (c->process == 0) {
        close(reports[0]);
        close(result[0]);
        close_pipes(child, n);
        c->pipe = reports[1];
        c->result = result[1];
        live(ctx, c, work);
    }
    close(reports[1]);
    close(result[1]);
    c->pipe = reports[0];
    c->result = result[0];
    return 0;
}

int brc_children_running(const struct brc_child *child, int n)
{
    int running = 0;
    for (int i = 0; i < n; i++)
        running += child[i].pipe >= 0;
    return running;
}

/* The child has closed its pipe of reports: takes its outcome and its exit. */
static int end_child(struct brc_context *ctx, struct brc_child *c)
{
    int status;
    close(c->pipe);
    c->pipe = -1;
    bool is_told = read_whole(c->result, &c->outcome, sizeof c->outcome);
    close(c->result);
    while (waitpid(c->process, &status, 0) < 0)
        if (errno != EINTR)
            BRC_FAIL(ctx, BRC_ERR_IO, "lost the run of %s: %s", c->name, strerror(errno));
    if (is_told && WIFEXITED(status) && WEXITSTATUS(status) == 0)
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
    if (brc_signals_held())
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
