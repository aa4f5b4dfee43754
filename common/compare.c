/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "compare.h"

#include "comm.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_SIZE = 4096, MAX_RUNS = BRC_PROGRESS_MAX_RUNS };
enum { STOP_MS = 300 }; /* between two looks for a signal */

/* What a child leaves for its parent. */
struct outcome {
    int code;
    char message[1024];
    struct brc_summary summary;
};

struct child {
    const struct brc_model *model;
    char dir[PATH_SIZE];
    pid_t process; /* 0: not started */
    int pipe;      /* reports; -1: none */
    FILE *result;  /* an outcome */
    struct outcome outcome;
};

struct compare {
    struct brc_context *ctx;
    const struct brc_compare_order *order;
    struct brc_progress progress;
    int n, n_started, n_running;
    struct child child[MAX_RUNS];
};

/* ---- the models ---------------------------------------------------------------------------- */

static int add_model(struct compare *c, const struct brc_model *model)
{
    struct child *child = &c->child[c->n];
    if (c->n == MAX_RUNS)
        BRC_FAIL(c->ctx, BRC_ERR_INPUT, "more than %d models to compare; name fewer in 'models'",
                 MAX_RUNS);
    child->model = model;
    child->pipe = -1;
    if (snprintf(child->dir, PATH_SIZE, "%s/%s", c->order->dir, model->name) >= PATH_SIZE)
        BRC_FAIL(c->ctx, BRC_ERR_INPUT, "the path %.80s... is too long", c->order->dir);
    c->n++;
    return 0;
}

static int choose_models(struct compare *c)
{
    const struct brc_case *file = &c->order->job->file;
    const struct brc_model *model;
    for (size_t i = 0; i < file->n_models; i++) {
        BRC_TRY(brc_job_model(c->ctx, file->models[i], &model));
        BRC_TRY(add_model(c, model));
    }
    for (int i = 0; file->n_models == 0 && i < brc_registry_count(); i++)
        BRC_TRY(add_model(c, brc_registry_at(i)));
    return 0;
}

/* Builds each simulation once and drops it, so that what one model refuses ends all before any
 * folder is touched. */
static int try_models(const struct compare *c)
{
    const struct brc_job *job = c->order->job;
    for (int i = 0; i < c->n; i++) {
        struct brc_sim sim;
        const struct brc_model *model = c->child[i].model;
        BRC_TRY(brc_sim_create(c->ctx, &sim, model, brc_job_params(job, model), c->order->specimen,
                               &job->test, &job->run));
        brc_sim_free(&sim);
    }
    return 0;
}

/* ---- children ------------------------------------------------------------------------------ */

/* The child's whole life. It never returns; the parent reads the outcome. */
static void run_child(const struct compare *c, const struct child *child)
{
    struct brc_context ctx = {.quiet = c->ctx->quiet};
    struct brc_progress progress;
    struct outcome outcome = {0};
    brc_progress_begin_pipe(&progress, child->pipe);
    const struct brc_run_order order = {
        .job = c->order->job,
        .model = child->model,
        .specimen = c->order->specimen,
        .dir = child->dir,
        .is_resumed = c->order->is_resumed && brc_run_has_begun(child->dir),
        .is_forced = c->order->is_forced,
        .progress = &progress,
    };
    outcome.code = brc_comm_start(&ctx);
    if (outcome.code == 0)
        outcome.code = brc_run(&ctx, &order, &outcome.summary);
    memcpy(outcome.message, ctx.message, sizeof outcome.message);
    bool is_told =
        fwrite(&outcome, sizeof outcome, 1, child->result) == 1 && fflush(child->result) == 0;
    brc_comm_end();
    _exit(is_told ? 0 : 1);
}

static int start_child(struct compare *c, struct child *child)
{
    int ends[2];
    child->result = tmpfile();
    if (!child->result || pipe(ends) != 0)
        BRC_FAIL(c->ctx, BRC_ERR_IO, "cannot start a run of %s: %s", child->model->name,
                 strerror(errno));
    fflush(NULL);
    child->process = fork();
    if (child->process < 0)
        BRC_FAIL(c->ctx, BRC_ERR_IO, "cannot start a run of %s: %s", child->model->name,
                 strerror(errno));
    if (child->process == 0) {
        close(ends[0]);
        for (int i = 0; i < c->n; i++)
            if (c->child[i].pipe >= 0)
                close(c->child[i].pipe);
        child->pipe = ends[1];
        run_child(c, child);
    }
    close(ends[1]);
    child->pipe = ends[0];
    c->n_running++;
    return 0;
}

/* The child has closed its pipe: takes its exit and its outcome. */
static int end_child(struct compare *c, struct child *child)
{
    int status;
    close(child->pipe);
    child->pipe = -1;
    while (waitpid(child->process, &status, 0) < 0)
        if (errno != EINTR)
            BRC_FAIL(c->ctx, BRC_ERR_IO, "lost the run of %s: %s", child->model->name,
                     strerror(errno));
    c->n_running--;
    rewind(child->result);
    bool is_told = WIFEXITED(status) && WEXITSTATUS(status) == 0 &&
                   fread(&child->outcome, sizeof child->outcome, 1, child->result) == 1;
    fclose(child->result);
    child->result = NULL;
    if (is_told)
        return 0;
    child->outcome = (struct outcome){.code = BRC_ERR_INTERNAL};
    if (WIFSIGNALED(status))
        snprintf(child->outcome.message, sizeof child->outcome.message,
                 "its process was ended by signal %d", WTERMSIG(status));
    else
        snprintf(child->outcome.message, sizeof child->outcome.message,
                 "its process ended without a result");
    return 0;
}

static void stop_children(const struct compare *c)
{
    for (int i = 0; i < c->n; i++)
        if (c->child[i].pipe >= 0)
            kill(c->child[i].process, SIGTERM);
}

/* Takes one report; false at the end of the pipe. */
static bool read_report(struct compare *c, int i)
{
    struct brc_progress_report report;
    ssize_t n;
    do
        n = read(c->child[i].pipe, &report, sizeof report);
    while (n < 0 && errno == EINTR);
    if (n != (ssize_t)sizeof report)
        return false;
    brc_progress_update(&c->progress, i, &report);
    return true;
}

/* Waits for reports of the children that run. */
static int listen(struct compare *c)
{
    struct pollfd ready[MAX_RUNS];
    int index[MAX_RUNS], n = 0;
    for (int i = 0; i < c->n; i++) {
        if (c->child[i].pipe < 0)
            continue;
        ready[n] = (struct pollfd){.fd = c->child[i].pipe, .events = POLLIN};
        index[n++] = i;
    }
    int n_ready = poll(ready, (nfds_t)n, STOP_MS);
    if (n_ready < 0 && errno != EINTR)
        BRC_FAIL(c->ctx, BRC_ERR_IO, "lost the runs: %s", strerror(errno));
    if (brc_run_is_stopped())
        stop_children(c);
    if (n_ready < 0)
        return 0;
    for (int k = 0; k < n; k++)
        if (ready[k].revents != 0 && !read_report(c, index[k]))
            BRC_TRY(end_child(c, &c->child[index[k]]));
    return 0;
}

static int run_all(struct compare *c)
{
    long n_processors = sysconf(_SC_NPROCESSORS_ONLN);
    int at_once = n_processors > 1 ? (int)n_processors : 1;
    while (c->n_started < c->n || c->n_running > 0) {
        bool may_start = c->n_started < c->n && !brc_run_is_stopped();
        if (may_start && c->n_running < at_once)
            BRC_TRY(start_child(c, &c->child[c->n_started++]));
        else if (c->n_running > 0)
            BRC_TRY(listen(c));
        else
            break;
    }
    return 0;
}

/* The first failure counts; an interruption counts less than a failure. */
static int judge(struct compare *c)
{
    const struct child *worst = NULL;
    for (int i = 0; i < c->n; i++) {
        const struct child *child = &c->child[i];
        if (child->outcome.code == 0)
            continue;
        if (!worst || (worst->outcome.code == BRC_ERR_INTERRUPTED &&
                       child->outcome.code != BRC_ERR_INTERRUPTED))
            worst = child;
    }
    if (worst && worst->outcome.code != BRC_ERR_INTERRUPTED)
        BRC_FAIL(c->ctx, worst->outcome.code, "%s: %.900s", worst->model->name,
                 worst->outcome.message);
    if (worst || c->n_started < c->n)
        BRC_FAIL(c->ctx, BRC_ERR_INTERRUPTED, "interrupted; the states are saved in %s",
                 c->order->dir);
    return 0;
}

/* ---- results ------------------------------------------------------------------------------- */

static int write_table(struct compare *c)
{
    const struct brc_summary *summary[MAX_RUNS];
    char path[PATH_SIZE], *text = NULL;
    size_t size = 0;
    for (int i = 0; i < c->n; i++)
        summary[i] = &c->child[i].outcome.summary;
    if (snprintf(path, sizeof path, "%s/compare.txt", c->order->dir) >= PATH_SIZE)
        BRC_FAIL(c->ctx, BRC_ERR_INPUT, "the path %.80s... is too long", c->order->dir);
    FILE *out = open_memstream(&text, &size);
    if (!out)
        BRC_FAIL(c->ctx, BRC_ERR_MEMORY, "out of memory for the table");
    brc_compare_table(out, summary, c->n);
    fclose(out);
    int code = brc_output_text(c->ctx, path, text);
    fputs(text, stdout);
    fflush(stdout);
    free(text);
    return code;
}

static int draw(struct compare *c)
{
    const struct brc_job *job = c->order->job;
    struct brc_plot_runs runs = {
        .title = job->file.head.title, .test = (enum brc_test)job->test.kind, .n = c->n};
    for (int i = 0; i < c->n; i++)
        runs.label[i] = runs.folder[i] = c->child[i].model->name;
    return job->output.plots ? brc_plot_draw(c->ctx, c->order->dir, &runs, &job->output) : 0;
}

int brc_compare(struct brc_context *ctx, const struct brc_compare_order *order)
{
    struct compare *c = brc_alloc(ctx, 1, sizeof *c);
    const char *label[MAX_RUNS];
    if (!c)
        return BRC_ERR_MEMORY;
    c->ctx = ctx;
    c->order = order;
    int code = choose_models(c);
    for (int i = 0; i < c->n && code == 0; i++) {
        bool is_resumed = order->is_resumed && brc_run_has_begun(c->child[i].dir);
        code = brc_run_check_folder(ctx, c->child[i].dir, is_resumed, order->is_forced);
        label[i] = c->child[i].model->name;
    }
    if (code == 0)
        code = try_models(c);
    if (code == 0)
        code = brc_run_make_folder(ctx, order->dir);
    if (code == 0) {
        brc_progress_begin(&c->progress, stderr, label, c->n, order->is_quiet);
        code = run_all(c);
        brc_progress_end(&c->progress);
    }
    if (code != 0)
        stop_children(c);
    if (code == 0)
        code = judge(c);
    if (code == 0)
        code = write_table(c);
    if (code == 0)
        code = draw(c);
    free(c);
    return code;
}
