/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which runs are missing, where they run, and what becomes of their results. The record is written
 * as each run ends; a run is known by a hash of all its parameters, so that settings that are the
 * same run share it. A run that its setting has spoilt counts as done, without a value. */
#include "common/runs/converge.h"

#include "common/base/signals.h"
#include "common/base/text_file.h"
#include "common/runs/child.h"
#include "common/runs/converge_axes.h"
#include "common/runs/converge_plot.h"
#include "common/runs/converge_record.h"
#include "common/runs/converge_table.h"
#include "common/runs/run.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_JOBS = BRC_PROGRESS_MAX_RUNS };

/* A run that a child does. */
struct task {
    const struct brc_converge_options *options;
    struct brc_converge_model *model;
    struct brc_converge_setting *setting;
    int seed; /* number of the specimen */
    char dir[BRC_PATH_SIZE];
};

struct ladder {
    struct brc_context *ctx;
    struct brc_converge_study study;
    struct brc_converge_axes axes;
    struct brc_converge_record record;
    struct task task[MAX_JOBS];
    struct brc_child child[MAX_JOBS];
    size_t n_grains;      /* of the case's own specimen */
    int n_done, n_wanted; /* runs of the present phase */
    double weight_left;   /* their expected processor time, s */
};

/* ---- what can be refused ------------------------------------------------------------------- */

static int check_options(struct brc_context *ctx, const struct brc_converge_options *o)
{
    const struct brc_specimen_params *p = &o->run_case->specimen;
    bool is_given = p->grains == BRC_GRAINS_POINTS || p->grains == BRC_GRAINS_TESS;
    const struct brc_rig_type *rig = brc_rigs_at(o->run_case->test.kind);
    if (rig->n_quantities == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "test.kind %s has no loading, so there is nothing to converge",
                 rig->name);
    if (is_given && o->seeds > 1)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.grains of a file make one specimen, whatever the seed; use --seeds 1");
    if (p->seed > INT_MAX - o->seeds)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.seed %d is too large for %d specimens", p->seed,
                 o->seeds);
    return 0;
}

static int find_observable(struct brc_context *ctx, struct brc_converge_study *study)
{
    char all[BRC_NAMES_SIZE] = "";
    for (int i = 0; i < study->n_results; i++) {
        if (strcmp(study->results[i].name, study->options->observable) == 0) {
            study->observable = i;
            return 0;
        }
        brc_names_add(all, sizeof all, study->results[i].name);
    }
    BRC_FAIL(ctx, BRC_ERR_USAGE, "--observable: this test does not measure '%.60s'; there are: %s",
             study->options->observable, all);
}

/* Builds the model once and drops it: what it refuses ends all, and its rates are filled in. */
static int try_model(struct ladder *l, const struct brc_specimen *specimen,
                     struct brc_converge_model *m)
{
    const struct brc_case *run_case = l->study.options->run_case;
    struct brc_sim sim;
    struct brc_test test = brc_case_test(run_case);
    BRC_TRY(brc_sim_create(l->ctx, &sim, m->model, brc_case_params(run_case, m->model), specimen,
                           &test, &run_case->run));
    m->test = sim.rig.params;
    m->specimen = brc_facets_hash(&specimen->facets);
    l->study.n_results = brc_rigs_results(&sim, l->study.results);
    brc_sim_free(&sim);
    m->setting = brc_alloc(l->ctx, BRC_CONVERGE_MAX_SETTINGS, sizeof *m->setting);
    return m->setting ? 0 : BRC_ERR_MEMORY;
}

static int choose_models(struct ladder *l)
{
    const struct brc_converge_options *o = l->study.options;
    const struct brc_model *model[BRC_CONVERGE_MAX_MODELS];
    l->study.n_models = 1;
    if (o->model)
        BRC_TRY(brc_case_model(l->ctx, o->model, &model[0]));
    else
        BRC_TRY(brc_case_models(l->ctx, o->run_case, model, BRC_CONVERGE_MAX_MODELS,
                                &l->study.n_models));
    for (int i = 0; i < l->study.n_models; i++)
        l->study.model[i].model = model[i];
    return 0;
}

static int try_models(struct ladder *l)
{
    struct brc_specimen specimen = {0};
    struct brc_converge_study *study = &l->study;
    int code = brc_specimen_create(l->ctx, &study->options->run_case->specimen, &specimen);
    for (int i = 0; i < study->n_models && code == 0; i++)
        code = try_model(l, &specimen, &study->model[i]);
    l->n_grains = specimen.facets.n_cells;
    brc_specimen_free(&specimen);
    return code;
}

/* A ladder that goes on replaces its own tables: those beside a record that it can read. */
static int check_folder(const struct ladder *l)
{
    static const char *const names[] = {"converge_runs.csv", "converge.txt", "converge.csv",
                                        "converge.gp",       "converge.png", "converge_unfinished"};
    const struct brc_converge_options *o = l->study.options;
    bool may_go_on = o->is_resumed && brc_folder_has(o->dir, "converge_runs.csv");
    return brc_run_check_own(l->ctx, o->dir, o->run_case, names, sizeof names / sizeof names[0],
                             may_go_on || o->is_forced);
}

/* Everything that can be refused, before a folder is touched. */
static int prepare(struct ladder *l)
{
    struct brc_converge_study *study = &l->study;
    const struct brc_converge_options *o = study->options;
    BRC_TRY(check_options(l->ctx, o));
    BRC_TRY(choose_models(l));
    BRC_TRY(brc_converge_read_axes(l->ctx, o, study->model, study->n_models, &l->axes));
    BRC_TRY(check_folder(l));
    BRC_TRY(try_models(l));
    BRC_TRY(find_observable(l->ctx, study));
    for (int i = 0; i < study->n_models; i++)
        BRC_TRY(brc_converge_first_settings(l->ctx, o, &study->model[i]));
    brc_log(l->ctx, "%s: %zu grains, specimens: %d", o->run_case->name, l->n_grains, o->seeds);
    BRC_TRY(brc_folder_make(l->ctx, o->dir));
    return brc_converge_record_open(l->ctx, &l->record, study);
}

/* ---- one run ------------------------------------------------------------------------------- */

/* What is in the way of a run is not its setting's fault: the ladder ends. */
static int check_place(struct brc_context *ctx, const struct brc_run_options *o)
{
    int code = brc_run_check_folder(ctx, o->dir, o->run_case, o->is_resumed, o->is_forced);
    return code == BRC_ERR_INPUT ? (ctx->code = BRC_ERR_USAGE) : code;
}

static int run_task(struct brc_context *ctx, const void *user, struct brc_progress *progress,
                    struct brc_summary *out)
{
    const struct task *t = user;
    struct brc_specimen specimen = {0};
    struct brc_case run_case;
    bool has_begun = brc_run_has_begun(t->dir);
    bool goes_on = t->options->is_resumed && has_begun && brc_folder_has(t->dir, "state.h5");
    int code = brc_converge_case(ctx, t->options->run_case, t->setting, t->seed, &run_case);
    if (code == 0)
        code = brc_specimen_create(ctx, &run_case.specimen, &specimen);
    const struct brc_run_options options = {.run_case = &run_case,
                                            .model = t->model->model,
                                            .specimen = &specimen,
                                            .dir = t->dir,
                                            .is_resumed = goes_on,
                                            .is_forced = has_begun && !goes_on,
                                            .progress = progress};
    if (code == 0)
        code = check_place(ctx, &options);
    if (code == 0)
        code = brc_run(ctx, &options, out);
    brc_specimen_free(&specimen);
    brc_case_free(&run_case);
    return code;
}

static void log_run(const struct ladder *l, const struct task *t,
                    const struct brc_converge_run *run, const char *message)
{
    const struct brc_result *what = &l->study.results[l->study.observable];
    char left[32], value[64];
    brc_progress_duration(l->weight_left / l->study.options->jobs, left, sizeof left);
    if (isfinite(run->result[l->study.observable]))
        snprintf(value, sizeof value, "%s %.4g %s", what->name, run->result[l->study.observable],
                 strcmp(what->unit, "1") == 0 ? "" : what->unit);
    else
        snprintf(value, sizeof value, "no %s", what->name);
    brc_log(l->ctx, "%d of %d  %s  %s %s  seed %d  %s%s  %" PRId64 " steps  %.2f s  about %s left",
            l->n_done, l->n_wanted, t->model->model->name, t->setting->axis, t->setting->label,
            l->study.options->run_case->specimen.seed + t->seed, *message ? "failed: " : "",
            *message ? message : value, run->steps, run->cpu_s, left);
}

/* What a run costs, by what the case's own runs have cost. */
static double expected(const struct brc_converge_model *m, const struct brc_converge_setting *s)
{
    double sum = 0;
    int n = 0;
    for (int i = 0; i < BRC_CONVERGE_MAX_SEEDS; i++)
        if (m->setting[BRC_CONVERGE_AT_CASE].run[i].is_done) {
            sum += m->setting[BRC_CONVERGE_AT_CASE].run[i].cpu_s;
            n++;
        }
    return n > 0 ? s->weight * sum / n : 0;
}

/* Of the runs in progress each tells itself what it has saved. */
static int fail_interrupted(struct ladder *l)
{
    BRC_FAIL(l->ctx, BRC_ERR_INTERRUPTED, "interrupted; %zu finished runs are kept in %s",
             l->record.n, l->study.options->dir);
}

/* A run that its setting has spoilt has no value but is done; other failures end all. */
static int read_outcome(struct ladder *l, int slot)
{
    struct task *t = &l->task[slot];
    const struct brc_outcome *o = &l->child[slot].outcome;
    struct brc_converge_run *run = &t->setting->run[t->seed];
    bool is_spoilt = o->code == BRC_ERR_BLOWUP || o->code == BRC_ERR_ENERGY ||
                     o->code == BRC_ERR_INPUT || o->code == BRC_ERR_GEOMETRY;
    if (o->code == BRC_ERR_NOT_BEGUN)
        return fail_interrupted(l);
    if (o->code != 0 && !is_spoilt)
        BRC_FAIL(l->ctx, o->code, "%s: %s", t->model->model->name, o->message);
    run->steps = o->summary.steps;
    run->dt = o->summary.dt;
    run->cpu_s = o->summary.cpu_s;
    snprintf(run->ended_by, sizeof run->ended_by, "%s", o->code ? "failure" : o->summary.ended_by);
    for (int i = 0; i < l->study.n_results; i++)
        run->result[i] = o->code ? NAN : o->summary.results[i].value;
    BRC_TRY(brc_converge_record_add(l->ctx, &l->record, t->model->model->name,
                                    l->study.options->run_case->specimen.seed + t->seed, t->setting,
                                    run));
    run->is_done = true;
    BRC_TRY(brc_run_remove(l->ctx, t->dir));
    l->n_done++;
    l->weight_left = fmax(l->weight_left - expected(t->model, t->setting), 0);
    log_run(l, t, run, o->code ? o->message : "");
    return 0;
}

/* ---- all runs ------------------------------------------------------------------------------ */

/* A run with the same parameters goes on now. */
static bool is_running(const struct ladder *l, uint64_t key)
{
    for (int i = 0; i < l->study.options->jobs; i++)
        if (l->child[i].pipe >= 0 && l->task[i].setting->run[l->task[i].seed].key == key)
            return true;
    return false;
}

/* Takes from the record what is done; true when the run has to be done. */
static bool is_missing(const struct ladder *l, struct brc_converge_run *run)
{
    if (!run->is_done) {
        const struct brc_converge_run *done = brc_converge_record_find(&l->record, run->key);
        if (done)
            *run = *done;
    }
    return !run->is_done;
}

static int start_task(struct ladder *l, int slot, const struct task *task)
{
    struct task *t = &l->task[slot];
    *t = *task;
    t->options = l->study.options;
    uint64_t key = t->setting->run[t->seed].key;
    char name[64];
    snprintf(name, sizeof name, "converge_unfinished/%016" PRIx64, key);
    BRC_TRY(brc_folder_path(l->ctx, t->options->dir, name, t->dir));
    snprintf(l->child[slot].name, sizeof l->child[slot].name, "%s", t->model->model->name);
    const struct brc_child_work work = {run_task, t};
    return brc_children_start(l->ctx, l->child, l->study.options->jobs, slot, &work);
}

/* Waits a little; takes the outcomes of runs that have ended. */
static int listen(struct ladder *l)
{
    bool was_running[MAX_JOBS];
    int n = l->study.options->jobs;
    for (int i = 0; i < n; i++)
        was_running[i] = l->child[i].pipe >= 0;
    BRC_TRY(brc_children_listen(l->ctx, l->child, n, NULL));
    for (int i = 0; i < n; i++)
        if (was_running[i] && l->child[i].pipe < 0)
            BRC_TRY(read_outcome(l, i));
    return 0;
}

/* Starts the run unless its like is done or going on; waits for a free slot first. */
static int offer(struct ladder *l, const struct task *task)
{
    struct brc_converge_run *run = &task->setting->run[task->seed];
    int n = l->study.options->jobs;
    while (is_missing(l, run) && !brc_signals_held()) {
        int slot = 0;
        while (slot < n && l->child[slot].pipe >= 0)
            slot++;
        if (slot < n && !is_running(l, run->key))
            return start_task(l, slot, task);
        BRC_TRY(listen(l));
    }
    return 0;
}

/* Calls act for the runs of all models' settings first to end, specimen after specimen. */
static int each_run(struct ladder *l, int first, int end,
                    int (*act)(struct ladder *l, const struct task *task))
{
    for (int seed = 0; seed < l->study.options->seeds; seed++)
        for (int i = 0; i < l->study.n_models; i++) {
            struct brc_converge_model *m = &l->study.model[i];
            for (int k = first; k < m->n && k < end; k++) {
                const struct task task = {.model = m, .setting = &m->setting[k], .seed = seed};
                BRC_TRY(act(l, &task));
            }
        }
    return 0;
}

/* Counts a run that is missing; of those with the same parameters the first. */
static int count(struct ladder *l, const struct task *task)
{
    uint64_t key = task->setting->run[task->seed].key;
    if (!is_missing(l, &task->setting->run[task->seed]))
        return 0;
    for (const struct brc_converge_setting *s = task->model->setting; s < task->setting; s++)
        if (s->run[task->seed].key == key)
            return 0;
    l->n_wanted++;
    l->weight_left += expected(task->model, task->setting);
    return 0;
}

static int fill(struct ladder *l, const struct task *task)
{
    struct brc_converge_run *run = &task->setting->run[task->seed];
    if (is_missing(l, run))
        return fail_interrupted(l);
    return 0;
}

/* Does what is missing of some settings. */
static int run_phase(struct ladder *l, int first, int end)
{
    int n = l->study.options->jobs;
    l->n_done = l->n_wanted = 0;
    l->weight_left = 0;
    BRC_TRY(each_run(l, first, end, count));
    int code = each_run(l, first, end, offer);
    while (code == 0 && brc_children_running(l->child, n) > 0)
        code = listen(l);
    if (code != 0)
        brc_children_stop(l->child, n);
    while (brc_children_running(l->child, n) > 0 &&
           brc_children_listen(l->ctx, l->child, n, NULL) == 0)
        ;
    return code ? code : each_run(l, first, end, fill);
}

/* Of the case on the first specimen, up to the peak: more specimens leave the ladder as it is. */
static double mean_rate(const struct brc_converge_study *study, const struct brc_converge_model *m)
{
    const struct brc_converge_run *run = &m->setting[BRC_CONVERGE_AT_CASE].run[0];
    for (int i = 0; i < study->n_results; i++)
        if (strcmp(study->results[i].name, "strain_at_peak") == 0 && run->steps > 0)
            return run->result[i] / ((double)run->steps * run->dt);
    return 0;
}

static int run_all(struct ladder *l)
{
    BRC_TRY(run_phase(l, 0, 1));
    for (int i = 0; i < l->study.n_models; i++) {
        struct brc_converge_model *m = &l->study.model[i];
        m->mean_rate = mean_rate(&l->study, m);
        BRC_TRY(brc_converge_axis_settings(l->ctx, l->study.options, &l->axes, m));
    }
    BRC_TRY(run_phase(l, 1, BRC_CONVERGE_MAX_SETTINGS));
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(l->ctx, l->study.options->dir, "converge_unfinished", path));
    rmdir(path);
    return 0;
}

/* ---- results ------------------------------------------------------------------------------- */

static int report(struct ladder *l)
{
    const struct brc_converge_study *study = &l->study;
    struct brc_text_file file;
    struct brc_converge_report *reports =
        brc_alloc(l->ctx, (size_t)study->n_models, sizeof *reports);
    if (!reports)
        return BRC_ERR_MEMORY;
    for (int i = 0; i < study->n_models; i++)
        brc_converge_report_make(study, i, &reports[i]);
    brc_converge_print(stdout, study, reports);
    fflush(stdout);
    int code = brc_text_file_begin(l->ctx, &file, study->options->dir, "converge.txt");
    if (code == 0) {
        brc_converge_print(file.out, study, reports);
        code = brc_text_file_end(l->ctx, &file);
    }
    if (code == 0)
        code = brc_converge_csv(l->ctx, study, reports);
    if (code == 0)
        code = brc_converge_plot(l->ctx, study, reports);
    free(reports);
    return code;
}

int brc_converge(struct brc_context *ctx, const struct brc_converge_options *options)
{
    struct ladder *l = brc_alloc(ctx, 1, sizeof *l);
    if (!l)
        return BRC_ERR_MEMORY;
    l->ctx = ctx;
    l->study.options = options;
    brc_children_init(l->child, MAX_JOBS);
    int code = prepare(l);
    if (code == 0)
        code = run_all(l);
    if (code == 0)
        code = report(l);
    brc_converge_record_close(&l->record);
    for (int i = 0; i < l->study.n_models; i++)
        free(l->study.model[i].setting);
    free(l);
    return code;
}
