/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ladder from the first check to the last table: which runs are missing, where they run, and
 * what becomes of their results. The record is written as each run ends, so that a stop loses no
 * finished run; a run is known by a hash of all its parameters, so that settings that are the same
 * run share it. A run that its setting has spoilt counts as done, without a value: that a step is
 * too large is what a ladder is to find out.
 *
 * There are two phases, as the rungs of the axis rate hang on what the case itself has done: first
 * the case on all specimens, then all else. */
#include "common/runs/converge.h"

#include "common/base/grow.h"
#include "common/base/text_file.h"
#include "common/runs/child.h"
#include "common/runs/converge_axes.h"
#include "common/runs/converge_plot.h"
#include "common/runs/converge_record.h"
#include "common/runs/converge_table.h"
#include "common/runs/task.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A run that is missing. */
struct task {
    struct brc_converge_model *model;
    struct brc_converge_setting *setting;
    int seed; /* number of the specimen */
};

struct ladder {
    struct brc_context *ctx;
    struct brc_converge_study study;
    struct brc_converge_axes axes;
    struct brc_converge_record record;
    size_t n_grains; /* of the case's own specimen */
    /* the present phase: what was missing as it began, and how far it has come */
    struct task *task;
    size_t n_tasks, cap_tasks;
    int n_done;
    double weight_left; /* expected processor time of the rest, s */
};

/* ---- what can be refused ------------------------------------------------------------------- */

/* What no setting can mend. Grains of a file are one specimen: several seeds would be the same run,
 * and its scatter zero. */
static int check_options(struct brc_context *ctx, const struct brc_converge_options *o)
{
    const struct brc_specimen_params *p = &o->run.run_case->specimen;
    bool is_given = p->grains == BRC_GRAINS_POINTS || p->grains == BRC_GRAINS_TESS;
    const struct brc_rig_type *rig = brc_rigs_at(o->run.run_case->test.kind);
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

/* Known only when a simulation has been built: a test declares its results, and events add theirs.
 */
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
    struct brc_sim sim;
    BRC_TRY(brc_case_sim(l->ctx, l->study.options->run.run_case, m->model, specimen, &sim));
    m->test = sim.rig.params;
    l->study.n_results = brc_rigs_results(&sim, l->study.results);
    brc_sim_free(&sim);
    m->setting = brc_alloc(l->ctx, BRC_CONVERGE_MAX_SETTINGS, sizeof *m->setting);
    return m->setting ? 0 : BRC_ERR_MEMORY;
}

/* One model where the options name it: the others of the case keep their lines in the record. */
static int choose_models(struct ladder *l)
{
    const struct brc_converge_options *o = l->study.options;
    const struct brc_model *model[BRC_CONVERGE_MAX_MODELS];
    l->study.n_models = 1;
    if (o->model)
        BRC_TRY(brc_case_model(l->ctx, o->model, &model[0]));
    else
        BRC_TRY(brc_case_models(l->ctx, o->run.run_case, model, BRC_CONVERGE_MAX_MODELS,
                                &l->study.n_models));
    for (int i = 0; i < l->study.n_models; i++)
        l->study.model[i].model = model[i];
    return 0;
}

/* On the specimen of the case alone: those of other seeds are made by their runs, side by side. */
static int try_models(struct ladder *l)
{
    struct brc_specimen specimen = {0};
    struct brc_converge_study *study = &l->study;
    int code = brc_specimen_create(l->ctx, &study->options->run.run_case->specimen, &specimen);
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
    bool may_go_on = o->run.is_resumed && brc_folder_has(o->run.dir, "converge_runs.csv");
    return brc_run_check_own(l->ctx, &o->run, names, sizeof names / sizeof names[0],
                             may_go_on || o->run.is_forced);
}

/* Everything that can be refused, before a folder is touched: the cheap checks first, then the
 * specimen and the models. */
static int prepare(struct ladder *l)
{
    struct brc_converge_study *study = &l->study;
    const struct brc_converge_options *o = study->options;
    BRC_TRY(check_options(l->ctx, o));
    BRC_TRY(choose_models(l));
    BRC_TRY(brc_converge_read_axes(l->ctx, study, &l->axes));
    BRC_TRY(check_folder(l));
    BRC_TRY(try_models(l));
    BRC_TRY(find_observable(l->ctx, study));
    for (int i = 0; i < study->n_models; i++)
        BRC_TRY(brc_converge_first_settings(l->ctx, o, &study->model[i]));
    brc_log(l->ctx, "%s: %zu grains, specimens: %d", o->run.run_case->name, l->n_grains, o->seeds);
    BRC_TRY(brc_folder_make(l->ctx, o->run.dir));
    return brc_converge_record_open(l->ctx, &l->record, study);
}

/* ---- one run ------------------------------------------------------------------------------- */

static int task_folder(struct brc_context *ctx, const struct ladder *l, const struct task *t,
                       char dir[BRC_PATH_SIZE])
{
    return brc_task_folder(ctx, l->study.options->run.dir, "converge_unfinished",
                           t->setting->run[t->seed].key, dir);
}

static const char *name_of(const void *user, int i)
{
    const struct ladder *l = user;
    return l->task[i].model->model->name;
}

/* In the child: the case of the setting, then as any run of many. */
static int run_task(struct brc_context *ctx, const void *user, int i, struct brc_progress *progress,
                    struct brc_summary *out)
{
    const struct ladder *l = user;
    const struct task *t = &l->task[i];
    const struct brc_converge_options *o = l->study.options;
    struct brc_case run_case;
    char dir[BRC_PATH_SIZE];
    BRC_TRY(task_folder(ctx, l, t, dir));
    int code = brc_converge_case(ctx, o->run.run_case, t->setting, t->seed, &run_case);
    if (code == 0)
        code = brc_task_run(ctx, &run_case, t->model->model, dir, o->run.is_resumed, progress, out);
    brc_case_free(&run_case);
    return code;
}

/* A line a run, on standard error: a ladder may take days, and its tables come at the end alone. */
static void log_run(const struct ladder *l, const struct task *t, const struct brc_outcome *outcome)
{
    const struct brc_result *what = &l->study.results[l->study.observable];
    const struct brc_converge_run *run = &t->setting->run[t->seed];
    double value = run->result[l->study.observable];
    char left[32], said[sizeof outcome->message];
    brc_progress_duration(l->weight_left / l->study.options->jobs, left, sizeof left);
    if (outcome->code != 0)
        snprintf(said, sizeof said, "failed: %.9000s", outcome->message);
    else if (isfinite(value))
        snprintf(said, sizeof said, "%s %.4g %s", what->name, value,
                 strcmp(what->unit, "1") == 0 ? "" : what->unit);
    else
        snprintf(said, sizeof said, "no %s", what->name);
    brc_log(l->ctx, "%d of %zu  %s  %s %s  seed %d  %s  %" PRId64 " steps  %.2f s  about %s left",
            l->n_done, l->n_tasks, t->model->model->name, t->setting->axis, t->setting->label,
            l->study.options->run.run_case->specimen.seed + t->seed, said, run->steps, run->cpu_s,
            left);
}

/* What a run costs, by what the case's own runs have cost: nothing is known before, and the time
 * left is told as 0. */
static double expected(const struct brc_converge_model *m, const struct brc_converge_setting *s)
{
    const struct brc_converge_run *run = m->setting[BRC_CONVERGE_AT_CASE].run;
    double sum = 0;
    int n = 0;
    for (int i = 0; i < BRC_CONVERGE_MAX_SEEDS; i++)
        if (run[i].is_done) {
            sum += run[i].cpu_s;
            n++;
        }
    return n > 0 ? s->weight * sum / n : 0;
}

/* Of the runs in progress each tells itself what it has saved. */
static int fail_interrupted(struct ladder *l)
{
    BRC_FAIL(l->ctx, BRC_ERR_INTERRUPTED, "interrupted; %zu finished runs are kept in %s",
             l->record.n, l->study.options->run.dir);
}

/* A run that its setting has spoilt has no value but is done; other failures end all. It is in the
 * record before its folder goes: a stop between the two costs a little space, in the other order a
 * run. */
static int read_outcome(struct brc_context *ctx, void *user, int i, const struct brc_outcome *o)
{
    struct ladder *l = user;
    struct task *t = &l->task[i];
    struct brc_converge_run *run = &t->setting->run[t->seed];
    char dir[BRC_PATH_SIZE];
    if (o->code == BRC_ERR_NOT_BEGUN)
        return fail_interrupted(l);
    if (o->code != 0 && !brc_task_is_result(o->code))
        BRC_FAIL(ctx, o->code, "%s: %s", name_of(l, i), o->message);
    run->steps = o->summary.steps;
    run->dt = o->summary.dt;
    run->cpu_s = o->summary.cpu_s;
    snprintf(run->ended_by, sizeof run->ended_by, "%s", o->code ? "failure" : o->summary.ended_by);
    for (int k = 0; k < l->study.n_results; k++)
        run->result[k] = o->code ? NAN : o->summary.results[k].value;
    BRC_TRY(brc_converge_record_add(ctx, &l->record, name_of(l, i),
                                    l->study.options->run.run_case->specimen.seed + t->seed,
                                    t->setting, run));
    run->is_done = true;
    BRC_TRY(task_folder(ctx, l, t, dir));
    BRC_TRY(brc_run_remove(ctx, dir));
    l->n_done++;
    l->weight_left = fmax(l->weight_left - expected(t->model, t->setting), 0);
    log_run(l, t, o);
    return 0;
}

/* ---- all runs ------------------------------------------------------------------------------ */

/* Takes from the record what is done; true when the run has to be done. Runs of the same key that
 * end later are taken by the next call. */
static bool is_missing(const struct ladder *l, struct brc_converge_run *run)
{
    const struct brc_converge_run *done =
        run->is_done ? NULL : brc_converge_record_find(&l->record, run->key);
    if (done)
        *run = *done;
    return !run->is_done;
}

/* An earlier setting of the model is the same run on this specimen. */
static bool is_repeated(const struct task *t)
{
    for (const struct brc_converge_setting *s = t->model->setting; s < t->setting; s++)
        if (s->run[t->seed].key == t->setting->run[t->seed].key)
            return true;
    return false;
}

/* Lists what is missing of all models' settings first to end, specimen after specimen: so a ladder
 * that is stopped has whole specimens, whose differences count. */
static int list_tasks(struct ladder *l, int first, int end)
{
    l->n_tasks = 0;
    l->weight_left = 0;
    for (int seed = 0; seed < l->study.options->seeds; seed++)
        for (int i = 0; i < l->study.n_models; i++) {
            struct brc_converge_model *m = &l->study.model[i];
            for (int k = first; k < m->n && k < end; k++) {
                const struct task task = {.model = m, .setting = &m->setting[k], .seed = seed};
                if (!is_missing(l, &task.setting->run[seed]) || is_repeated(&task))
                    continue;
                BRC_GROW(l->ctx, l->task, l->cap_tasks, l->n_tasks + 1);
                l->task[l->n_tasks++] = task;
                l->weight_left += expected(m, task.setting);
            }
        }
    return 0;
}

/* Does what is missing of some settings. Listed again, nothing is, unless a signal has come between
 * two runs. */
static int run_phase(struct ladder *l, int first, int end)
{
    l->n_done = 0;
    BRC_TRY(list_tasks(l, first, end));
    const struct brc_queue queue = {.n = (int)l->n_tasks,
                                    .at_once = l->study.options->jobs,
                                    .user = l,
                                    .name = name_of,
                                    .act = run_task,
                                    .end = read_outcome};
    BRC_TRY(brc_queue_run(l->ctx, &queue));
    BRC_TRY(list_tasks(l, first, end));
    return l->n_tasks > 0 ? fail_interrupted(l) : 0;
}

/* Of the case on the first specimen, up to the peak: a mean over all of them would move the rungs
 * of the axis with --seeds, and the record would not fit them any more. */
static double mean_rate(const struct brc_converge_study *study, const struct brc_converge_model *m)
{
    const struct brc_converge_run *run = &m->setting[BRC_CONVERGE_AT_CASE].run[0];
    for (int i = 0; i < study->n_results; i++)
        if (strcmp(study->results[i].name, "strain_at_peak") == 0 && run->steps > 0)
            return run->result[i] / ((double)run->steps * run->dt);
    return 0;
}

/* The folder of unfinished runs is empty now; where it is not, something else lies in it, and it
 * stays. */
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
    BRC_TRY(brc_folder_path(l->ctx, l->study.options->run.dir, "converge_unfinished", path));
    rmdir(path);
    return 0;
}

/* ---- results ------------------------------------------------------------------------------- */

/* The table goes to the terminal first: it is there even when the folder has no room for it. */
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
    int code = brc_text_file_begin(l->ctx, &file, study->options->run.dir, "converge.txt");
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
    int code = prepare(l);
    if (code == 0)
        code = run_all(l);
    if (code == 0)
        code = report(l);
    brc_converge_record_close(&l->record);
    for (int i = 0; i < l->study.n_models; i++)
        free(l->study.model[i].setting);
    free(l->task);
    free(l);
    return code;
}
