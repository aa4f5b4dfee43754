/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes rather than threads: a model that crashes, or a library that keeps state of the
 * process, leaves the other runs alone, and each run has its own processor time. Outcomes come by
 * memory that both processes share: a pipe would have to be read while the child still writes, as
 * an outcome may be longer than a pipe holds. */
#define _DEFAULT_SOURCE /* for MAP_ANONYMOUS; NOLINT(bugprone-reserved-identifier) */
#include "common/runs/child.h"

#include "common/base/signals.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_SLOTS = BRC_QUEUE_MAX };
enum { STOP_MS = 300 }; /* between two looks for a signal */

/* A place for a run in progress. */
struct slot {
    pid_t process;
    int run;                     /* its number */
    int pipe;                    /* of reports; -1: nothing runs here, and poll passes over it */
    struct brc_outcome *outcome; /* shared with the child */
};

struct pool {
    struct brc_context *ctx;
    const struct brc_queue *queue;
    int n_running;
    int code; /* the first failure: nothing is started any more, and no outcome is taken */
    struct slot slot[MAX_SLOTS];
};

static int fail(const struct pool *p, int run, const char *what)
{
    const struct brc_queue *q = p->queue;
    BRC_FAIL(p->ctx, BRC_ERR_IO, "%s of %s: %s", what, q->name(q->user, run), strerror(errno));
}

/* The child's whole life. It never returns. */
static void live(const struct pool *p, struct slot *s)
{
    struct brc_context ctx = {.quiet = p->ctx->quiet};
    struct brc_progress progress;
    for (int k = 0; k < MAX_SLOTS; k++)
        if (p->slot[k].pipe >= 0 && &p->slot[k] != s)
            close(p->slot[k].pipe); /* of the others */
    brc_progress_begin_pipe(&progress, s->pipe);
    *s->outcome = (struct brc_outcome){0};
    s->outcome->code = p->queue->act(&ctx, p->queue->user, s->run, &progress, &s->outcome->summary);
    memcpy(s->outcome->message, ctx.message, sizeof ctx.message);
    _exit(0);
}

/* In a free slot; the caller knows that there is one. The parent keeps the reading end of the pipe
 * alone: with the other one open it would never see its end, by which it knows that the child has
 * gone. */
static int start(struct pool *p, int run)
{
    int reports[2];
    struct slot *s = p->slot;
    while (s->pipe >= 0)
        s++;
    if (pipe(reports) != 0)
        return fail(p, run, "cannot start a run");
    fflush(NULL); /* else the child would write again what is in the buffers */
    pid_t process = fork();
    if (process < 0)
        return fail(p, run, "cannot start a run");
    bool is_child = process == 0;
    close(reports[is_child ? 0 : 1]);
    s->process = process;
    s->run = run;
    s->pipe = reports[is_child ? 1 : 0];
    if (is_child)
        live(p, s);
    p->n_running++;
    return 0;
}

/* The child has closed its pipe: waits for its exit and takes the outcome. One that crashes has
 * left none, or a part of one. */
static int end(struct pool *p, struct slot *s)
{
    const struct brc_queue *q = p->queue;
    struct brc_outcome *o = s->outcome;
    int status;
    close(s->pipe);
    s->pipe = -1;
    p->n_running--;
    while (waitpid(s->process, &status, 0) < 0)
        if (errno != EINTR)
            return fail(p, s->run, "lost the run");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        *o = (struct brc_outcome){.code = BRC_ERR_INTERNAL,
                                  .message = "its process ended without a result"};
        if (WIFSIGNALED(status))
            snprintf(o->message, sizeof o->message, "its process was ended by signal %d",
                     WTERMSIG(status));
    }
    return p->code ? 0 : q->end(p->ctx, q->user, s->run, o);
}

/* Takes one report; false at the end of the pipe. A report is shorter than what a pipe takes in one
 * piece, so none arrives in parts. */
static bool read_report(const struct pool *p, const struct slot *s)
{
    struct brc_progress_report report;
    ssize_t n;
    do
        n = read(s->pipe, &report, sizeof report);
    while (n < 0 && errno == EINTR);
    if (n != (ssize_t)sizeof report)
        return false;
    if (p->queue->progress)
        brc_progress_update(p->queue->progress, s->run, &report);
    return true;
}

/* Waits a little for reports, and for runs that end. */
static int listen(struct pool *p)
{
    struct pollfd ready[MAX_SLOTS];
    for (int k = 0; k < MAX_SLOTS; k++)
        ready[k] = (struct pollfd){.fd = p->slot[k].pipe, .events = POLLIN};
    int n_ready = poll(ready, MAX_SLOTS, STOP_MS);
    if (n_ready < 0 && errno != EINTR)
        BRC_FAIL(p->ctx, BRC_ERR_IO, "lost the runs: %s", strerror(errno));
    for (int k = 0; k < MAX_SLOTS; k++)
        if (p->slot[k].pipe >= 0 && (p->code != 0 || brc_signals_held()))
            kill(p->slot[k].process, SIGTERM);
    for (int k = 0; k < MAX_SLOTS; k++)
        if (n_ready > 0 && ready[k].revents != 0 && !read_report(p, &p->slot[k]))
            BRC_TRY(end(p, &p->slot[k]));
    return 0;
}

/* The first failure counts; after a second one not even waiting works, and what runs is left. */
static int run_all(struct pool *p)
{
    for (int next = 0;;) {
        bool may_start = p->code == 0 && next < p->queue->n && !brc_signals_held();
        int code;
        if (may_start && p->n_running < p->queue->at_once)
            code = start(p, next++);
        else if (p->n_running > 0)
            code = listen(p);
        else
            return p->code;
        if (code != 0 && p->code != 0)
            return p->code;
        p->code = p->code ? p->code : code;
    }
}

/* One piece of shared memory for all slots, which the children inherit by the fork. */
int brc_queue_run(struct brc_context *ctx, const struct brc_queue *queue)
{
    struct pool p = {.ctx = ctx, .queue = queue};
    size_t size = MAX_SLOTS * sizeof(struct brc_outcome);
    struct brc_outcome *outcomes =
        mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (outcomes == MAP_FAILED)
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "no memory for the outcomes of runs: %s", strerror(errno));
    for (int k = 0; k < MAX_SLOTS; k++)
        p.slot[k] = (struct slot){.pipe = -1, .outcome = &outcomes[k]};
    int code = run_all(&p);
    munmap(outcomes, size);
    return code;
}

int brc_queue_at_once(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > MAX_SLOTS ? MAX_SLOTS : (int)n;
}
