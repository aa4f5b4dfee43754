/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rank 0 looks for answers of its helper and of the other ranks in turn, with short sleeps: a run
 * takes seconds at least, and a rank that waits for messages in MPI would keep its processor busy.
 */
#define _DEFAULT_SOURCE /* for usleep; NOLINT(bugprone-reserved-identifier) */
#include "common/runs/ranks.h"

#include "common/base/signals.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LOOK_MS = 20 };

/* ---- bytes --------------------------------------------------------------------------------- */

static bool put(int pipe, const void *bytes, size_t n)
{
    for (const char *at = bytes; n > 0;) {
        ssize_t done = write(pipe, at, n);
        if (done < 0 && errno != EINTR)
            return false;
        at += done > 0 ? done : 0;
        n -= done > 0 ? (size_t)done : 0;
    }
    return true;
}

static bool get(int pipe, void *bytes, size_t n)
{
    for (char *at = bytes; n > 0;) {
        ssize_t done = read(pipe, at, n);
        if (done == 0 || (done < 0 && errno != EINTR))
            return false;
        at += done > 0 ? done : 0;
        n -= done > 0 ? (size_t)done : 0;
    }
    return true;
}

/* ---- helper -------------------------------------------------------------------------------- */

/* Until the rank closes its end, or is gone. */
static void serve_rank(int orders, int answers, brc_ranks_act *act, void *user)
{
    struct brc_order order;
    while (get(orders, &order, sizeof order)) {
        char *answer = act(user, &order);
        size_t n = answer ? strlen(answer) : 0;
        bool is_good = answer && put(answers, &n, sizeof n) && put(answers, answer, n);
        free(answer);
        if (!is_good)
            break;
    }
    _exit(0);
}

int brc_ranks_begin(struct brc_context *ctx, struct brc_ranks *r, brc_ranks_act *act, void *user)
{
    int orders[2], answers[2];
    *r = (struct brc_ranks){.ctx = ctx, .to = -1, .from = -1};
    if (pipe(orders) != 0 || pipe(answers) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a helper: %s", strerror(errno));
    fflush(NULL);
    r->helper = fork();
    if (r->helper < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start a helper: %s", strerror(errno));
    bool is_helper = r->helper == 0;
    close(orders[is_helper ? 1 : 0]);
    close(answers[is_helper ? 0 : 1]);
    if (is_helper)
        serve_rank(orders[0], answers[1], act, user);
    r->to = orders[1];
    r->from = answers[0];
    BRC_TRY(brc_comm_start(ctx, &r->comm));
    ctx->comm = NULL; /* nothing else of this process takes part in it */
    return 0;
}

static int order_helper(const struct brc_ranks *r, const struct brc_order *order)
{
    if (!put(r->to, order, sizeof *order))
        BRC_FAIL(r->ctx, BRC_ERR_INTERNAL, "the helper of rank %d is gone", r->comm.rank);
    return 0;
}

/* The answer of the helper; NULL where there is none yet. Signals are passed on while it works, as
 * launchers send them to ranks alone. */
static int hear_helper(const struct brc_ranks *r, int wait_ms, char **answer, size_t *n)
{
    struct pollfd ready = {.fd = r->from, .events = POLLIN};
    *answer = NULL;
    if (brc_signals_held())
        kill(r->helper, SIGTERM);
    if (poll(&ready, 1, wait_ms) <= 0)
        return 0;
    if (!get(r->from, n, sizeof *n))
        BRC_FAIL(r->ctx, BRC_ERR_INTERNAL, "the helper of rank %d is gone", r->comm.rank);
    *answer = brc_alloc(r->ctx, *n + 1, 1);
    if (!*answer)
        return BRC_ERR_MEMORY;
    if (!get(r->from, *answer, *n))
        BRC_FAIL(r->ctx, BRC_ERR_INTERNAL, "the helper of rank %d is gone", r->comm.rank);
    return 0;
}

/* ---- ranks beside 0 ------------------------------------------------------------------------ */

static int wait_helper(const struct brc_ranks *r, char **answer, size_t *n)
{
    do
        BRC_TRY(hear_helper(r, 10 * LOOK_MS, answer, n));
    while (!*answer);
    return 0;
}

/* An order without bytes is the end. */
int brc_ranks_serve(struct brc_ranks *r)
{
    for (;;) {
        char *text;
        size_t n;
        int from;
        BRC_TRY(r->comm.receive(r->ctx, &r->comm, &from, &text, &n));
        if (!text) {
            usleep(1000 * LOOK_MS);
            continue;
        }
        struct brc_order order;
        bool is_end = n != sizeof order;
        if (!is_end)
            memcpy(&order, text, sizeof order);
        free(text);
        if (is_end)
            return 0;
        BRC_TRY(order_helper(r, &order));
        BRC_TRY(wait_helper(r, &text, &n));
        int code = r->comm.send(r->ctx, &r->comm, 0, text, n);
        free(text);
        BRC_TRY(code);
    }
}

/* ---- rank 0 -------------------------------------------------------------------------------- */

struct hand_out {
    struct brc_ranks *r;
    const struct brc_ranks_queue *queue;
    int *run; /* of each rank, -1: it waits */
    int next, n_running;
    int code; /* the first failure: nothing is handed out any more */
};

static int give(struct hand_out *h, int rank)
{
    struct brc_order order;
    h->queue->order(h->queue->user, h->next, &order);
    h->run[rank] = h->next++;
    h->n_running++;
    return rank == 0 ? order_helper(h->r, &order)
                     : h->r->comm.send(h->r->ctx, &h->r->comm, rank, &order, sizeof order);
}

static int take(struct hand_out *h, int rank, char *answer)
{
    int run = h->run[rank];
    h->run[rank] = -1;
    h->n_running--;
    int code = h->code ? 0 : h->queue->end(h->r->ctx, h->queue->user, run, answer);
    free(answer);
    return code;
}

static int look(struct hand_out *h)
{
    char *answer;
    size_t n;
    int from;
    BRC_TRY(hear_helper(h->r, h->run[0] >= 0 ? LOOK_MS : 0, &answer, &n));
    if (answer)
        BRC_TRY(take(h, 0, answer));
    else if (h->run[0] < 0)
        usleep(1000 * LOOK_MS);
    for (;;) {
        BRC_TRY(h->r->comm.receive(h->r->ctx, &h->r->comm, &from, &answer, &n));
        if (!answer)
            return 0;
        BRC_TRY(take(h, from, answer));
    }
}

static int hand_out(struct hand_out *h)
{
    for (;;) {
        for (int rank = 0; rank < h->r->comm.size; rank++)
            if (h->run[rank] < 0 && h->next < h->queue->n && h->code == 0 && !brc_signals_held())
                h->code = give(h, rank);
        if (h->n_running == 0)
            return h->code;
        int code = look(h);
        if (code != 0 && h->code != 0)
            return h->code;
        h->code = h->code ? h->code : code;
    }
}

int brc_ranks_run(struct brc_ranks *r, const struct brc_ranks_queue *queue)
{
    struct hand_out h = {.r = r, .queue = queue};
    h.run = brc_alloc(r->ctx, (size_t)r->comm.size, sizeof *h.run);
    if (!h.run)
        return BRC_ERR_MEMORY;
    for (int rank = 0; rank < r->comm.size; rank++)
        h.run[rank] = -1;
    int code = hand_out(&h);
    free(h.run);
    return code;
}

void brc_ranks_end(struct brc_ranks *r)
{
    struct brc_context quiet = BRC_CONTEXT_INIT;
    for (int rank = 1; r->comm.rank == 0 && rank < r->comm.size; rank++)
        r->comm.send(&quiet, &r->comm, rank, "", 0);
    close(r->to);
    close(r->from);
    if (r->helper > 0)
        waitpid(r->helper, NULL, 0);
}
