/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each simulation is built once in the parent and dropped, so that what one model refuses is told
 * before any folder is touched. The first real failure counts; an interruption is the user's wish.
 */
#include "common/runs/compare.h"

#include "common/base/text_file.h"
#include "common/runs/child.h"
#include "common/output/plot.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_RUNS = BRC_PROGRESS_MAX_RUNS };

struct compare {
    struct brc_context *ctx;
    const struct brc_run_options *options;
    int n;
    /* by model */
    struct brc_run_options run[MAX_RUNS];
    const char *name[MAX_RUNS];
    char dir[MAX_RUNS][BRC_PATH_SIZE];
    struct brc_outcome outcome[MAX_RUNS];
};

/* ---- the models ---------------------------------------------------------------------------- */

/* A model that has not begun before starts, whatever the others do. */
static int choose_models(struct compare *c)
{
    const struct brc_model *model[MAX_RUNS];
    BRC_TRY(brc_case_models(c->ctx, c->options->run_case, model, MAX_RUNS, &c->n));
    for (int i = 0; i < c->n; i++) {
        c->name[i] = model[i]->name;
        c->outcome[i].code = BRC_ERR_NOT_BEGUN; /* stays so when a signal comes first */
        BRC_TRY(brc_folder_path(c->ctx, c->options->dir, c->name[i], c->dir[i]));
        c->run[i] = *c->options;
        c->run[i].model = model[i];
        c->run[i].dir = c->dir[i];
        c->run[i].is_resumed = c->options->is_resumed && brc_run_has_begun(c->dir[i]);
    }
    return 0;
}

/* A model that refuses the case does so here, before the others have run for hours. */
static int try_models(const struct compare *c)
{
    for (int i = 0; i < c->n; i++) {
        struct brc_sim sim;
        const struct brc_run_options *o = &c->run[i];
        BRC_TRY(brc_case_sim(c->ctx, o->run_case, o->model, o->specimen, &sim));
        brc_sim_free(&sim);
    }
    return 0;
}

/* ---- the runs ------------------------------------------------------------------------------ */

static const char *name_of(const void *user, int i)
{
    const struct compare *c = user;
    return c->name[i];
}

static int run_model(struct brc_context *ctx, const void *user, int i,
                     struct brc_progress *progress, struct brc_summary *out)
{
    const struct compare *c = user;
    struct brc_run_options options = c->run[i];
    options.progress = progress;
    return brc_run(ctx, &options, out);
}

/* Kept, and judged when all have ended: a model that fails leaves the others their results. */
static int keep_outcome(struct brc_context *ctx, void *user, int i,
                        const struct brc_outcome *outcome)
{
    (void)ctx;
    ((struct compare *)user)->outcome[i] = *outcome;
    return 0;
}

/* As many at a time as there are processors, each with its line of progress. */
static int run_all(struct compare *c)
{
    struct brc_progress progress;
    const struct brc_queue queue = {.n = c->n,
                                    .at_once = brc_queue_at_once(),
                                    .user = c,
                                    .progress = &progress,
                                    .name = name_of,
                                    .act = run_model,
                                    .end = keep_outcome};
    brc_progress_begin(&progress, stderr, c->name, c->n, c->ctx->quiet);
    int code = brc_queue_run(c->ctx, &queue);
    brc_progress_end(&progress);
    return code;
}

/* The user's wish, whether it came before the first step or after it. */
static bool is_interrupt(int code)
{
    return code == BRC_ERR_INTERRUPTED || code == BRC_ERR_NOT_BEGUN;
}

/* Tells of which models there is a state to go on from: those that have begun now or before. */
static int fail_interrupted(struct compare *c)
{
    char begun[BRC_NAMES_SIZE] = "";
    for (int i = 0; i < c->n; i++)
        if (c->run[i].is_resumed || c->outcome[i].code != BRC_ERR_NOT_BEGUN)
            brc_names_add(begun, sizeof begun, c->name[i]);
    if (!*begun)
        BRC_FAIL(c->ctx, BRC_ERR_NOT_BEGUN,
                 "interrupted before the first step; nothing was saved in %s", c->options->dir);
    BRC_FAIL(c->ctx, BRC_ERR_INTERRUPTED, "interrupted; saved in %s: %s", c->options->dir, begun);
}

/* The first failure counts; an interruption counts less than a failure. Runs whose energy does not
 * add up have results to show. */
static int check_outcomes(struct compare *c)
{
    bool is_stopped = false;
    for (int i = 0; i < c->n; i++) {
        const struct brc_outcome *o = &c->outcome[i];
        is_stopped = is_stopped || is_interrupt(o->code);
        if (o->code != 0 && o->code != BRC_ERR_ENERGY && !is_interrupt(o->code))
            BRC_FAIL(c->ctx, o->code, "%s: %s", c->name[i], o->message);
    }
    return is_stopped ? fail_interrupted(c) : 0;
}

/* ---- results ------------------------------------------------------------------------------- */

/* To the terminal first: the table is there even when the folder has no room for it. */
static int write_table(struct compare *c)
{
    const struct brc_summary *summary[MAX_RUNS];
    struct brc_text_file file;
    for (int i = 0; i < c->n; i++)
        summary[i] = &c->outcome[i].summary;
    brc_compare_table(stdout, summary, c->n);
    fflush(stdout);
    BRC_TRY(brc_text_file_begin(c->ctx, &file, c->options->dir, "compare.txt"));
    brc_compare_table(file.out, summary, c->n);
    return brc_text_file_end(c->ctx, &file);
}

/* From the files of the runs, by names relative to the folder: nothing is computed anew, and the
 * folder can be moved with its pictures. */
static int draw(struct compare *c)
{
    const struct brc_case *run_case = c->options->run_case;
    struct brc_plot_runs runs = {.title = run_case->file.head.title,
                                 .view = brc_rigs_at(run_case->test.kind)->view,
                                 .n = c->n};
    for (int i = 0; i < c->n; i++)
        runs.label[i] = runs.folder[i] = c->name[i];
    return run_case->output.plots ? brc_plot_draw(c->ctx, c->options->dir, &runs, &run_case->output)
                                  : 0;
}

/* Tables and pictures of the folder itself (gnuplot.log only grows); a comparison that goes on
 * replaces its own, which it can have written only when one of its models has begun. */
static int check_folders(const struct compare *c)
{
    static const char *const names[] = {"compare.txt", "curves.gp", "curves.png", "cracks.gp",
                                        "cracks.png"};
    bool may_replace = c->options->is_forced;
    for (int i = 0; i < c->n; i++) {
        may_replace = may_replace || c->run[i].is_resumed;
        BRC_TRY(brc_run_check_folder(c->ctx, &c->run[i]));
    }
    return brc_run_check_own(c->ctx, c->options, names, sizeof names / sizeof names[0],
                             may_replace);
}

/* All that can be refused comes before a folder is made. */
static int run(struct compare *c)
{
    BRC_TRY(choose_models(c));
    BRC_TRY(check_folders(c));
    BRC_TRY(try_models(c));
    BRC_TRY(brc_folder_make(c->ctx, c->options->dir));
    BRC_TRY(run_all(c));
    BRC_TRY(check_outcomes(c));
    BRC_TRY(write_table(c));
    BRC_TRY(draw(c));
    for (int i = 0; i < c->n; i++) /* last, when all results are there to be looked at */
        if (c->outcome[i].code == BRC_ERR_ENERGY)
            BRC_FAIL(c->ctx, BRC_ERR_ENERGY, "%s", c->outcome[i].message);
    return 0;
}

int brc_compare(struct brc_context *ctx, const struct brc_run_options *options)
{
    struct compare *c = brc_alloc(ctx, 1, sizeof *c);
    if (!c)
        return BRC_ERR_MEMORY;
    c->ctx = ctx;
    c->options = options;
    int code = run(c);
    free(c);
    return code;
}
