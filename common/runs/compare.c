/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each simulation is built once in the parent and dropped, so that what one model refuses is told
 * before any folder is touched. The first real failure counts; an interruption is the user's wish.
 */
#include "common/runs/compare.h"

#include "common/base/signals.h"
#include "common/base/text_file.h"
#include "common/runs/child.h"
#include "common/output/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_RUNS = BRC_PROGRESS_MAX_RUNS };

struct compare;

/* One model's run. */
struct model_run {
    const struct compare *compare;
    const struct brc_model *model;
    char dir[BRC_PATH_SIZE];
};

struct compare {
    struct brc_context *ctx;
    const struct brc_compare_options *options;
    struct brc_progress progress;
    int n, n_started;
    struct model_run run[MAX_RUNS];
    struct brc_child child[MAX_RUNS];
};

/* ---- the models ---------------------------------------------------------------------------- */

static int add_model(struct compare *c, const struct brc_model *model)
{
    struct model_run *run = &c->run[c->n];
    run->compare = c;
    run->model = model;
    snprintf(c->child[c->n].name, sizeof c->child[c->n].name, "%s", model->name);
    c->n++;
    return brc_folder_path(c->ctx, c->options->dir, model->name, run->dir);
}

static int choose_models(struct compare *c)
{
    const struct brc_model *model[MAX_RUNS];
    int n;
    BRC_TRY(brc_case_models(c->ctx, c->options->run_case, model, MAX_RUNS, &n));
    brc_children_init(c->child, n);
    for (int i = 0; i < n; i++)
        BRC_TRY(add_model(c, model[i]));
    return 0;
}

/* Builds each simulation once and drops it, so that what one model refuses ends all before any
 * folder is touched. */
static int try_models(const struct compare *c)
{
    const struct brc_case *run_case = c->options->run_case;
    for (int i = 0; i < c->n; i++) {
        struct brc_sim sim;
        const struct brc_model *model = c->run[i].model;
        struct brc_test test = brc_case_test(run_case);
        BRC_TRY(brc_sim_create(c->ctx, &sim, model, brc_case_params(run_case, model),
                               c->options->specimen, &test, &run_case->run));
        brc_sim_free(&sim);
    }
    return 0;
}

/* ---- children ------------------------------------------------------------------------------ */

static int run_model(struct brc_context *ctx, const void *user, struct brc_progress *progress,
                     struct brc_summary *out)
{
    const struct model_run *run = user;
    const struct brc_compare_options *o = run->compare->options;
    const struct brc_run_options options = {
        .run_case = o->run_case,
        .model = run->model,
        .specimen = o->specimen,
        .dir = run->dir,
        .is_resumed = o->is_resumed && brc_run_has_begun(run->dir),
        .is_forced = o->is_forced,
        .progress = progress,
    };
    return brc_run(ctx, &options, out);
}

static int run_all(struct compare *c)
{
    int at_once = brc_children_at_once(), n_running;
    while ((n_running = brc_children_running(c->child, c->n)) > 0 || c->n_started < c->n) {
        bool may_start = c->n_started < c->n && !brc_signals_held();
        if (may_start && n_running < at_once) {
            int i = c->n_started++;
            const struct brc_child_work work = {run_model, &c->run[i]};
            BRC_TRY(brc_children_start(c->ctx, c->child, c->n, i, &work));
        } else if (n_running > 0) {
            BRC_TRY(brc_children_listen(c->ctx, c->child, c->n, &c->progress));
        } else {
            break;
        }
    }
    return 0;
}

static bool is_interrupt(const struct brc_child *child)
{
    return child->outcome.code == BRC_ERR_INTERRUPTED || child->outcome.code == BRC_ERR_NOT_BEGUN;
}

/* Tells of which models there is a state to go on from: those that have begun now or before. */
static int fail_interrupted(struct compare *c)
{
    char begun[BRC_NAMES_SIZE] = "";
    for (int i = 0; i < c->n; i++) {
        bool was_begun = c->options->is_resumed && brc_run_has_begun(c->run[i].dir);
        bool has_ended = i < c->n_started && c->child[i].outcome.code != BRC_ERR_NOT_BEGUN;
        if (was_begun || has_ended)
            brc_names_add(begun, sizeof begun, c->child[i].name);
    }
    if (!*begun)
        BRC_FAIL(c->ctx, BRC_ERR_NOT_BEGUN,
                 "interrupted before the first step; nothing was saved in %s", c->options->dir);
    BRC_FAIL(c->ctx, BRC_ERR_INTERRUPTED, "interrupted; saved in %s: %s", c->options->dir, begun);
}

/* The first failure counts; an interruption counts less than a failure. Runs whose energy does not
 * add up have results to show. */
static int check_outcomes(struct compare *c)
{
    const struct brc_child *worst = NULL;
    for (int i = 0; i < c->n; i++) {
        const struct brc_child *child = &c->child[i];
        if (child->outcome.code == 0 || child->outcome.code == BRC_ERR_ENERGY)
            continue;
        if (!worst || (is_interrupt(worst) && !is_interrupt(child)))
            worst = child;
    }
    if (worst && !is_interrupt(worst))
        BRC_FAIL(c->ctx, worst->outcome.code, "%s: %s", worst->name, worst->outcome.message);
    return worst || c->n_started < c->n ? fail_interrupted(c) : 0;
}

static int check_energy(const struct compare *c)
{
    for (int i = 0; i < c->n; i++)
        if (c->child[i].outcome.code == BRC_ERR_ENERGY)
            BRC_FAIL(c->ctx, BRC_ERR_ENERGY, "%s", c->child[i].outcome.message);
    return 0;
}

/* ---- results ------------------------------------------------------------------------------- */

static int write_table(struct compare *c)
{
    const struct brc_summary *summary[MAX_RUNS];
    struct brc_text_file file;
    for (int i = 0; i < c->n; i++)
        summary[i] = &c->child[i].outcome.summary;
    brc_compare_table(stdout, summary, c->n);
    fflush(stdout);
    BRC_TRY(brc_text_file_begin(c->ctx, &file, c->options->dir, "compare.txt"));
    brc_compare_table(file.out, summary, c->n);
    return brc_text_file_end(c->ctx, &file);
}

static int draw(struct compare *c)
{
    const struct brc_case *run_case = c->options->run_case;
    struct brc_plot_runs runs = {.title = run_case->file.head.title,
                                 .view = brc_rigs_at(run_case->test.kind)->view,
                                 .n = c->n};
    for (int i = 0; i < c->n; i++)
        runs.label[i] = runs.folder[i] = c->run[i].model->name;
    return run_case->output.plots ? brc_plot_draw(c->ctx, c->options->dir, &runs, &run_case->output)
                                  : 0;
}

/* Tables and pictures of the folder itself (gnuplot.log only grows); a comparison that goes on
 * replaces its own. */
static int check_folders(const struct compare *c)
{
    static const char *const names[] = {"compare.txt", "curves.gp", "curves.png", "cracks.gp",
                                        "cracks.png"};
    const struct brc_compare_options *o = c->options;
    bool has_begun = false;
    for (int i = 0; i < c->n; i++) {
        bool is_resumed = o->is_resumed && brc_run_has_begun(c->run[i].dir);
        has_begun |= is_resumed;
        BRC_TRY(brc_run_check_folder(c->ctx, c->run[i].dir, o->run_case, is_resumed, o->is_forced));
    }
    return brc_run_check_own(c->ctx, o->dir, o->run_case, names, sizeof names / sizeof names[0],
                             has_begun || o->is_forced);
}

int brc_compare(struct brc_context *ctx, const struct brc_compare_options *options)
{
    struct compare *c = brc_alloc(ctx, 1, sizeof *c);
    const char *label[MAX_RUNS];
    if (!c)
        return BRC_ERR_MEMORY;
    c->ctx = ctx;
    c->options = options;
    int code = choose_models(c);
    for (int i = 0; i < c->n; i++)
        label[i] = c->run[i].model->name;
    if (code == 0)
        code = check_folders(c);
    if (code == 0)
        code = try_models(c);
    if (code == 0)
        code = brc_folder_make(ctx, options->dir);
    if (code == 0) {
        brc_progress_begin(&c->progress, stderr, label, c->n, options->is_quiet);
        code = run_all(c);
        brc_progress_end(&c->progress);
    }
    if (code != 0)
        brc_children_stop(c->child, c->n);
    if (code == 0)
        code = check_outcomes(c);
    if (code == 0)
        code = write_table(c);
    if (code == 0)
        code = draw(c);
    if (code == 0)
        code = check_energy(c);
    free(c);
    return code;
}
