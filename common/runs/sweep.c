/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the file to the tables: which runs are kept, which are missing, where they run, what becomes
 * of their results. A run is in the record before its folder goes: a stop between the two costs a
 * little space, in the other order a run. A failure that the case leads to (an instability) is a
 * result and is kept; one of the machine (a full disk) is told, and done again the next time. */
#include "common/runs/sweep.h"

#include "common/base/signals.h"
#include "common/base/text_file.h"
#include "common/runs/child.h"
#include "common/runs/ranks.h"
#include "common/runs/sweep_estimate.h"
#include "common/runs/sweep_plot.h"
#include "common/runs/sweep_table.h"
#include "common/runs/task.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

_Static_assert((int)BRC_SWEEP_MAX_JOBS <= (int)BRC_QUEUE_MAX, "more jobs than a queue has slots");

struct sweep {
    struct brc_context *ctx;
    struct brc_sweep_options own;
    const struct brc_sweep_options *options; /* those */
    struct brc_pool pool;
    struct brc_sweep_plan plan;
    struct brc_sweep_runs runs;
    struct brc_run_record record;
    /* numbers of the runs that are to be done now */
    size_t *task, n_tasks;
    size_t n_done, n_kept, n_failed;
    bool is_verifying;
    struct brc_ranks *ranks; /* NULL: this process alone */
    char *answer;            /* in the helper of a rank: the line of its last run */
    double seconds_left;     /* of processor time, expected; NAN: not known */
    struct brc_work bar;
};

/* ---- before any run ------------------------------------------------------------------------ */

/* Of tables that a sweep has written the header tells; anything else of their names is the user's.
 */
static int check_folder(struct sweep *s)
{
    static const char *const names[] = {"sweep.csv", "runs.csv", "sweep.h5", "sweep.gp",
                                        "sweep.png"};
    const struct brc_sweep_options *o = s->options;
    char path[BRC_PATH_SIZE], line[16] = "";
    BRC_TRY(brc_folder_check_writable(s->ctx, o->dir));
    BRC_TRY(brc_folder_path(s->ctx, o->dir, names[0], path));
    FILE *file = fopen(path, "r");
    bool is_ours = file && fgets(line, sizeof line, file) && strncmp(line, "group,", 6) == 0;
    if (file)
        fclose(file);
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !is_ours && !o->is_forced; i++)
        if (brc_folder_has(o->dir, names[i]))
            BRC_FAIL(s->ctx, BRC_ERR_INPUT,
                     "%s holds a %s that no sweep has written; replace it with --force, or choose "
                     "another folder with -o",
                     o->dir, names[i]);
    return 0;
}

/* The command line before the file; names of the file count from its folder. */
static int find_cache(struct sweep *s, char path[BRC_PATH_SIZE])
{
    const char *cache = s->plan.cache, *slash = strrchr(s->plan.path, '/');
    if (s->options->cache) {
        snprintf(path, BRC_PATH_SIZE, "%s", s->options->cache);
        return 0;
    }
    if (!*cache)
        return brc_folder_path(s->ctx, s->options->dir, "runs.jsonl", path);
    bool is_free = *cache == '/' || !slash;
    if (snprintf(path, BRC_PATH_SIZE, "%.*s%s", is_free ? 0 : (int)(slash - s->plan.path) + 1,
                 s->plan.path, cache) >= BRC_PATH_SIZE)
        BRC_FAIL(s->ctx, BRC_ERR_INPUT, "%s: cache: the path is too long", s->plan.path);
    return 0;
}

/* What the record holds of the runs; nothing of it counts where all are to be done anew. */
static int take_kept(struct sweep *s)
{
    s->n_kept = 0;
    for (size_t i = 0; i < s->runs.n && !s->options->is_fresh; i++) {
        struct brc_sweep_run *run = &s->runs.run[i];
        const char *line = run->first == i ? brc_run_record_find(&s->record, &run->key) : NULL;
        if (!line)
            continue;
        BRC_TRY(brc_run_record_read(s->ctx, &s->pool, line, &run->kept));
        run->is_done = true;
        s->n_kept++;
    }
    return 0;
}

/* Equal runs share what one of them gives. */
static void share(struct sweep *s)
{
    for (size_t i = 0; i < s->runs.n; i++) {
        const struct brc_sweep_run *first = &s->runs.run[s->runs.run[i].first];
        s->runs.run[i].kept = first->kept;
        s->runs.run[i].is_done = first->is_done;
    }
}

/* From the files alone: every rank gets the same. */
static int read_runs(struct sweep *s)
{
    const struct brc_sweep_options *o = s->options;
    BRC_TRY(brc_sweep_file_read(s->ctx, &s->pool, o->path, &s->plan));
    s->runs = (struct brc_sweep_runs){&s->plan, &s->pool, o->set, o->n_set, o->keeps, 0, NULL};
    BRC_TRY(brc_sweep_runs_make(s->ctx, &s->runs));
    s->task = brc_pool_alloc(s->ctx, &s->pool, s->runs.n, sizeof *s->task);
    return s->task ? 0 : BRC_ERR_MEMORY;
}

static int prepare(struct sweep *s)
{
    const struct brc_sweep_options *o = s->options;
    char cache[BRC_PATH_SIZE];
    BRC_TRY(find_cache(s, cache));
    if (!o->is_dry) {
        BRC_TRY(check_folder(s));
        BRC_TRY(brc_folder_make(s->ctx, o->dir));
    }
    BRC_TRY(brc_run_record_open(s->ctx, &s->record, cache, o->is_dry));
    return take_kept(s);
}

/* ---- one run ------------------------------------------------------------------------------- */

static struct brc_sweep_run *run_of(const struct sweep *s, int i)
{
    return &s->runs.run[s->task[i]];
}

static const char *name_of(const void *user, int i)
{
    const struct sweep *s = user;
    return run_of(s, i)->name;
}

static int folder_of(struct brc_context *ctx, const struct sweep *s, int i, char dir[BRC_PATH_SIZE])
{
    const char *group = s->is_verifying ? "verified" : s->options->keeps ? "runs" : "unfinished";
    return brc_task_folder(ctx, s->options->dir, group, run_of(s, i)->key.hash, dir);
}

/* In a process of its own. */
static int act(struct brc_context *ctx, const void *user, int i, struct brc_progress *progress,
               struct brc_summary *out)
{
    const struct sweep *s = user;
    const struct brc_sweep_run *run = run_of(s, i);
    struct brc_case run_case;
    char dir[BRC_PATH_SIZE];
    BRC_TRY(folder_of(ctx, s, i, dir));
    bool goes_on = !s->is_verifying && !s->options->is_fresh;
    int code = brc_sweep_run_case(ctx, run, &run_case);
    if (code == 0)
        code = brc_task_run(ctx, &run_case, run->model, dir, goes_on, progress, out);
    brc_case_free(&run_case);
    return code;
}

/* A line a run, on standard error; on a terminal a bar below it tells of the whole. */
static void log_run(struct sweep *s, int i, const char *said)
{
    const struct brc_sweep_run *run = run_of(s, i);
    char label[400], left[32], about[64] = "";
    if (isfinite(s->seconds_left))
        snprintf(about, sizeof about, "  about %s left",
                 brc_progress_duration(s->seconds_left / s->options->jobs, left, sizeof left));
    brc_work_end(&s->bar);
    brc_log(s->ctx, "%zu of %zu  %s  %s%s", s->n_done, s->n_tasks,
            brc_sweep_run_label(run, label, sizeof label), said, about);
    if (s->bar.is_terminal)
        brc_work_update(&s->bar, (double)s->n_done / (double)s->n_tasks);
}

/* The first result that the group collects, or the strength: something to watch. */
static const char *tell(const struct brc_sweep_run *run, char *text, size_t size)
{
    const struct brc_kept_run *k = &run->kept;
    const char *name = run->group->n_collect > 0 ? run->group->collect[0] : "strength";
    double value = brc_kept_result(k, name);
    int n = k->code != 0      ? snprintf(text, size, "failed: %.900s", k->message)
            : isfinite(value) ? snprintf(text, size, "%s %.4g", name, value)
                              : snprintf(text, size, "no %s", name);
    if (n >= 0 && (size_t)n < size)
        snprintf(text + n, size - (size_t)n, "  %" PRId64 " steps  %.2f s", k->steps, k->cpu_s);
    return text;
}

/* ---- outcomes ------------------------------------------------------------------------------ */

static bool is_same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* Bits of the state, and every result; difference: the largest of results, relative. */
static bool is_as_kept(const struct brc_kept_run *kept, const struct brc_kept_run *now,
                       double *difference)
{
    bool is = kept->code == now->code && kept->state_hash == now->state_hash;
    *difference = 0;
    for (int i = 0; i < now->n_results; i++) {
        double a = brc_kept_result(kept, now->result[i].name), b = now->result[i].value;
        if (is_same(a, b))
            continue;
        is = false;
        *difference = fmax(*difference, fabs(b - a) / fmax(fabs(a), fabs(b)));
    }
    return is;
}

static void verify(struct sweep *s, int i, const struct brc_kept_run *now)
{
    const struct brc_sweep_run *run = run_of(s, i);
    double difference;
    char said[1200] = "as it was kept", label[400];
    if (!is_as_kept(&run->kept, now, &difference)) {
        s->n_failed++;
        snprintf(said, sizeof said,
                 "IS NOT AS KEPT: state %016" PRIx64 ", was %016" PRIx64
                 ", results differ by up to %.2g of their values %.300s",
                 now->state_hash, run->kept.state_hash, difference, now->message);
        brc_error_set(s->ctx, BRC_ERR_RUNS, __FILE__, __LINE__, "%s %s",
                      brc_sweep_run_label(run, label, sizeof label), said);
    }
    log_run(s, i, said);
}

/* A failure of the machine is in no record; it counts as failed for this time. */
static int keep(struct sweep *s, int i, const struct brc_kept_run *now, const char *line)
{
    struct brc_sweep_run *run = run_of(s, i);
    char said[1200];
    if (now->code == 0 || brc_task_is_result(now->code))
        BRC_TRY(brc_run_record_add(s->ctx, &s->record, line));
    run->kept = *now;
    run->is_done = true;
    log_run(s, i, tell(run, said, sizeof said));
    return 0;
}

/* By its line in the record, as which it comes from other ranks, too. What is not done because of a
 * signal is seen at the end. */
static int end_line(struct brc_context *ctx, void *user, int i, const char *line)
{
    struct sweep *s = user;
    struct brc_kept_run now;
    char dir[BRC_PATH_SIZE];
    BRC_TRY(brc_run_record_read(ctx, &s->pool, line, &now));
    if (now.code == BRC_ERR_INTERRUPTED || now.code == BRC_ERR_NOT_BEGUN)
        return 0;
    s->n_done++;
    if (isfinite(s->seconds_left))
        s->seconds_left = fmax(s->seconds_left - brc_sweep_estimate(&s->runs, run_of(s, i)), 0);
    if (s->is_verifying)
        verify(s, i, &now);
    else
        BRC_TRY(keep(s, i, &now, line));
    BRC_TRY(folder_of(ctx, s, i, dir));
    return s->options->keeps && !s->is_verifying ? 0 : brc_run_remove(ctx, dir);
}

static int end(struct brc_context *ctx, void *user, int i, const struct brc_outcome *o)
{
    struct sweep *s = user;
    const char *line = brc_run_record_line(ctx, &s->pool, &run_of(s, i)->key, o);
    return line ? end_line(ctx, user, i, line) : BRC_ERR_MEMORY;
}

/* ---- all runs ------------------------------------------------------------------------------ */

static void list_missing(struct sweep *s)
{
    s->n_tasks = 0;
    for (size_t i = 0; i < s->runs.n; i++)
        if (s->runs.run[i].first == i && !s->runs.run[i].is_done)
            s->task[s->n_tasks++] = i;
}

/* A run by its number among all, as the helpers of ranks have no list of tasks; the key tells them
 * whether it is still the same run. */
static void order(const void *user, int i, struct brc_order *out)
{
    const struct sweep *s = user;
    *out =
        (struct brc_order){{(int64_t)s->task[i], (int64_t)run_of(s, i)->key.hash, s->is_verifying}};
}

static int run_queue(struct sweep *s)
{
    const struct brc_queue alone = {.n = (int)s->n_tasks,
                                    .at_once = s->options->jobs,
                                    .user = s,
                                    .name = name_of,
                                    .act = act,
                                    .end = end};
    const struct brc_ranks_queue shared = {
        .n = (int)s->n_tasks, .user = s, .order = order, .end = end_line};
    return s->ranks ? brc_ranks_run(s->ranks, &shared) : brc_queue_run(s->ctx, &alone);
}

static int run_tasks(struct sweep *s, const char *what)
{
    char path[BRC_PATH_SIZE];
    static const char *const folders[] = {"unfinished", "verified"};
    s->n_done = 0;
    s->seconds_left = brc_sweep_estimate_all(&s->runs, s->task, s->n_tasks);
    brc_work_begin(&s->bar, s->ctx, what);
    int code = run_queue(s);
    brc_work_end(&s->bar);
    for (int i = 0; i < 2; i++)
        if (brc_folder_path(s->ctx, s->options->dir, folders[i], path) == 0)
            rmdir(path); /* stays where something lies in it */
    return code;
}

static int fail_interrupted(struct sweep *s)
{
    BRC_FAIL(s->ctx, BRC_ERR_INTERRUPTED, "interrupted; finished runs are kept in %s",
             s->record.path);
}

static int do_missing(struct sweep *s)
{
    list_missing(s);
    brc_log(s->ctx, "%s: %zu runs, %zu of them kept, %zu to do, %d at a time", s->plan.path,
            s->runs.n, s->n_kept, s->n_tasks, s->options->jobs);
    BRC_TRY(run_tasks(s, "sweep"));
    list_missing(s);
    if (s->n_tasks > 0)
        return fail_interrupted(s);
    share(s);
    return 0;
}

/* By chance, other ones each time: over the years all are looked at. At least one. */
static int do_verify(struct sweep *s, double part)
{
    size_t n = 0, wanted;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t random = (uint64_t)now.tv_nsec + (uint64_t)now.tv_sec;
    for (size_t i = 0; i < s->runs.n; i++)
        if (s->runs.run[i].first == i)
            s->task[n++] = i;
    wanted = (size_t)ceil(part * (double)n);
    for (size_t i = 0; i < wanted && i < n; i++) { /* the first of a random order */
        random = brc_hash_bytes(&random, sizeof random, BRC_HASH_SEED);
        size_t k = i + (size_t)(random % (n - i)), swap = s->task[i];
        s->task[i] = s->task[k];
        s->task[k] = swap;
    }
    s->n_tasks = wanted;
    s->is_verifying = true;
    brc_log(s->ctx, "done again and compared with what is kept: %zu of %zu runs", wanted, n);
    BRC_TRY(run_tasks(s, "verify"));
    if (s->n_done < s->n_tasks)
        return fail_interrupted(s);
    printf("verified: %zu of %zu runs, %zu not as kept\n", s->n_done, n, s->n_failed);
    return s->n_failed ? BRC_ERR_RUNS : 0;
}

/* "2%", "2 %" or 0.02. */
static int read_part(struct brc_context *ctx, const char *text, double *part)
{
    char *end;
    *part = strtod(text, &end);
    end += strspn(end, " ");
    bool is_percent = strcmp(end, "%") == 0;
    *part /= is_percent ? 100 : 1;
    if (end == text || (*end && !is_percent) || !(*part > 0 && *part <= 1))
        BRC_FAIL(ctx, BRC_ERR_USAGE,
                 "--verify takes a part of the runs, from above 0 to 1 or in %%, as 2%%, not "
                 "'%.40s'",
                 text);
    return 0;
}

static int check_failures(struct sweep *s)
{
    char label[400];
    const struct brc_sweep_run *first = NULL;
    for (size_t i = 0; i < s->runs.n; i++)
        if (s->runs.run[i].kept.code != 0) {
            first = first ? first : &s->runs.run[i];
            s->n_failed++;
        }
    if (first)
        BRC_FAIL(s->ctx, BRC_ERR_RUNS, "%zu of %zu runs failed, see runs.csv; the first: %s: %s",
                 s->n_failed, s->runs.n, brc_sweep_run_label(first, label, sizeof label),
                 first->kept.message);
    return 0;
}

static int run(struct sweep *s)
{
    double part = 0;
    if (s->options->verify)
        BRC_TRY(read_part(s->ctx, s->options->verify, &part));
    BRC_TRY(read_runs(s));
    BRC_TRY(prepare(s));
    if (s->options->is_dry) {
        share(s);
        return brc_sweep_estimate_print(s->ctx, stdout, &s->runs, s->options->jobs);
    }
    BRC_TRY(do_missing(s));
    BRC_TRY(brc_sweep_print(s->ctx, stdout, &s->runs));
    fflush(stdout);
    BRC_TRY(brc_sweep_write(s->ctx, &s->runs, s->options->dir));
    BRC_TRY(brc_sweep_plot(s->ctx, &s->runs, s->options->dir));
    int code = part > 0 ? do_verify(s, part) : 0;
    code = code ? code : check_failures(s);
    if (code == 0 || code == BRC_ERR_RUNS)
        printf("results in %s\n", s->options->dir);
    return code;
}

static void release(struct sweep *s)
{
    brc_run_record_close(&s->record);
    brc_sweep_runs_free(&s->runs);
    brc_pool_free(&s->pool);
}

/* ---- ranks --------------------------------------------------------------------------------- */

static int keep_text(struct brc_context *ctx, void *user, int i, const struct brc_outcome *o)
{
    struct sweep *s = user;
    struct brc_pool pool = {0};
    const char *line = brc_run_record_line(ctx, &pool, &run_of(s, i)->key, o);
    s->answer = line ? strdup(line) : NULL;
    brc_pool_free(&pool);
    return s->answer ? 0 : BRC_ERR_MEMORY;
}

/* In the helper of a rank: the list of runs is made at the first order, as rank 0 has made it. */
static char *obey(void *user, const struct brc_order *ordered)
{
    struct sweep *s = user;
    const struct brc_queue one = {
        .n = 1, .at_once = 1, .user = s, .name = name_of, .act = act, .end = keep_text};
    struct brc_outcome failed = {0};
    s->ctx->quiet = 1;
    s->answer = NULL;
    int code = s->runs.run ? 0 : read_runs(s);
    size_t i = (size_t)ordered->number[0];
    bool is_there =
        code == 0 && i < s->runs.n && s->runs.run[i].key.hash == (uint64_t)ordered->number[1];
    if (!is_there)
        return NULL; /* the files have changed since: rank 0 says that the helper is gone */
    s->task[0] = i;
    s->n_tasks = 1;
    s->is_verifying = ordered->number[2] != 0;
    code = brc_queue_run(s->ctx, &one);
    if (!s->answer) { /* a signal before the run, or no process to be had */
        failed.code = code ? code : BRC_ERR_NOT_BEGUN;
        snprintf(failed.message, sizeof failed.message, "%s", s->ctx->message);
        keep_text(s->ctx, s, 0, &failed);
    }
    return s->answer;
}

/* The first rank is as the program is without others, but that it hands its runs out. */
static int run_on_ranks(struct sweep *s)
{
    struct brc_ranks ranks;
    int code = brc_ranks_begin(s->ctx, &ranks, obey, s);
    if (code == 0 && ranks.comm.rank > 0)
        code = brc_ranks_serve(&ranks);
    else if (code == 0) {
        s->ranks = &ranks;
        s->own.jobs = ranks.comm.size;
        code = run(s);
    }
    brc_ranks_end(&ranks);
    s->ranks = NULL;
    return code;
}

/* By the file, without its ending, as that of a run by its case. */
static const char *name_folder(const char *path, char dir[BRC_PATH_SIZE])
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path,
               *dot = strrchr(name, '.');
    int n = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    snprintf(dir, BRC_PATH_SIZE, "results/%.*s", n, name);
    return dir;
}

int brc_sweep(struct brc_context *ctx, const struct brc_sweep_options *options)
{
    struct sweep s = {.ctx = ctx, .own = *options};
    char dir[BRC_PATH_SIZE];
    s.options = &s.own;
    s.own.dir = options->dir ? options->dir : name_folder(options->path, dir);
    s.own.jobs = s.own.jobs > 0 ? s.own.jobs : brc_queue_at_once();
    int code = brc_comm_is_launched() ? run_on_ranks(&s) : run(&s);
    release(&s);
    return code;
}
