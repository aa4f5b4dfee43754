/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run tells an envelope: the principal stresses that its test declares at the peak, so that
 * no test is named here, and the case that was kept beside them, by which runs of different rock
 * are told apart. Runs of one rock differ in their seeds and in the keys of their tests alone. */
#include "calib/envelope_runs.h"

#include "calib/points_file.h"
#include "common/base/folders.h"
#include "common/output/summary_read.h"
#include "common/runs/case.h"
#include "common/runs/case_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NOTE_SIZE = 256 };

/* ---- one run ------------------------------------------------------------------------------- */

/* The case as it was kept. One that cannot be read any more, as of an older version, does not make
 * the run's numbers worse: then nothing is known to differ. */
static void read_case(struct calib_run *r)
{
    char path[BRC_PATH_SIZE];
    const struct brc_model *model;
    struct brc_case *run_case = calloc(1, sizeof *run_case);
    struct brc_context quiet = BRC_CONTEXT_INIT;
    if (run_case && brc_folder_path(&quiet, r->dir, "case.yaml", path) == 0 &&
        brc_case_read(&quiet, run_case, path, NULL, 0) == 0 &&
        brc_case_model(&quiet, r->model, &model) == 0) {
        r->keys = brc_case_text(&quiet, run_case, model);
        r->seed = run_case->specimen.seed;
        snprintf(r->test, sizeof r->test, "%s", brc_rigs_at(run_case->test.kind)->name);
    }
    if (run_case)
        brc_case_free(run_case);
    free(run_case);
}

/* A pair of results; where the summary has no value, why there is none. */
static void read_pair(const char *summary, const char *const names[2], struct calib_peak *p,
                      char *note)
{
    double *const at[2] = {&p->sigma_1, &p->sigma_3};
    for (int k = 0; k < 2; k++)
        if (!brc_summary_result(summary, names[k], at[k], note, NOTE_SIZE))
            snprintf(note, NOTE_SIZE, "its summary has no %s: it is of an older version", names[k]);
}

/* note: "" where the run has a point. */
static int read_run(struct brc_context *ctx, const struct calib_envelope_options *o,
                    const char *dir, struct calib_run *r, char *note)
{
    static const char *const peak[] = {"sigma_1", "sigma_3"}, *const residual[] = {
                                                                  "sigma_1_residual",
                                                                  "sigma_3_residual"};
    char *summary, other[NOTE_SIZE];
    *r = (struct calib_run){.dir = dir};
    BRC_TRY(brc_summary_read(ctx, dir, &summary));
    brc_summary_text(summary, "model", r->model, sizeof r->model);
    brc_summary_text(summary, "state_hash", r->hash, sizeof r->hash);
    read_pair(summary, peak, &r->peak, o->is_residual ? other : note);
    read_pair(summary, residual, &r->residual, o->is_residual ? note : other);
    free(summary);
    snprintf(r->test, sizeof r->test, "-");
    read_case(r);
    return 0;
}

/* ---- all of them --------------------------------------------------------------------------- */

/* A run that is named twice would count twice, and make the intervals narrower than they are. */
static bool is_there(const struct calib_runs *all, const struct calib_run *r)
{
    for (size_t i = 0; i < all->n; i++)
        if (*r->hash && strcmp(all->run[i].hash, r->hash) == 0)
            return true;
    return false;
}

/* Value of a key in lines "key = value", with its length; NULL: none. */
static const char *value_of(const char *lines, const char *key, size_t n, size_t *length)
{
    for (const char *at = lines; *at; at += strcspn(at, "\n"), at += *at == '\n')
        if (strncmp(at, key, n) == 0 && at[n] == ' ') {
            *length = strcspn(at, "\n");
            return at;
        }
    return NULL;
}

/* What makes the rock: the specimen but for its seed, and the model's parameters. */
static bool is_of_rock(const char *key, size_t n, const char *model)
{
    size_t m = strlen(model);
    bool is_seed = n == 13 && strncmp(key, "specimen.seed", n) == 0;
    return (strncmp(key, "specimen.", 9) == 0 && !is_seed) ||
           (strncmp(key, model, m) == 0 && key[m] == '.');
}

/* Adds a key to the list, once, however many runs differ in it. */
static void add_key(char list[BRC_NAMES_SIZE], const char *key, size_t n)
{
    char name[BRC_NAME_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)n, key);
    if (!strstr(list, name))
        brc_names_add(list, BRC_NAMES_SIZE, name);
}

/* By the texts by which a resumed run is compared with its state: all keys, defaults included, so
 * that one case that gives a default and one that leaves it out are the same. */
static void compare_runs(struct calib_runs *all, const struct calib_run *a,
                         const struct calib_run *b)
{
    if (strcmp(a->model, b->model) != 0)
        add_key(all->differ, "model", 5);
    for (const char *at = a->keys; at && b->keys && *at; at += *at == '\n') {
        size_t n = strcspn(at, " "), length = strcspn(at, "\n"), other = 0;
        if (is_of_rock(at, n, a->model)) {
            const char *twin = value_of(b->keys, at, n, &other);
            bool is_same = twin && other == length && strncmp(at, twin, length) == 0;
            if (!is_same && (twin || strcmp(a->model, b->model) == 0))
                add_key(all->differ, at, n);
        }
        at += length;
    }
}

/* A run that has a point, against the first one: a note needs the keys, not who is odd among many.
 */
static int add_run(struct brc_context *ctx, const struct calib_envelope_options *o, const char *dir,
                   struct calib_runs *out)
{
    char note[NOTE_SIZE] = "";
    struct calib_run *r = &out->run[out->n];
    BRC_TRY(read_run(ctx, o, dir, r, note));
    const struct calib_peak *p = o->is_residual ? &r->residual : &r->peak;
    bool has_point = isfinite(p->sigma_1) && isfinite(p->sigma_3);
    if (has_point && !is_there(out, r)) {
        compare_runs(out, &out->run[0], r);
        out->n++;
        return 0;
    }
    brc_log(ctx, "%s is left out: %s", r->dir,
            has_point ? "it is a run that is there already" : note);
    free(r->keys);
    r->keys = NULL;
    return 0;
}

/* The points of a table, of which nothing else is known. */
static int add_points(struct brc_context *ctx, const struct calib_envelope_options *o,
                      const char *path, size_t n_to_come, struct calib_runs *out)
{
    struct calib_peak *point;
    size_t n;
    BRC_TRY(calib_points_read(ctx, path, o->is_residual ? "_residual" : "", &point, &n));
    struct calib_run *more = realloc(out->run, (out->n + n + n_to_come) * sizeof *more);
    if (more)
        out->run = more;
    for (size_t i = 0; more && i < n; i++)
        out->run[out->n++] = (struct calib_run){
            .dir = path, .model = "-", .test = "-", .peak = point[i], .residual = point[i]};
    free(point);
    if (!more)
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory for the points of %s", path);
    return 0;
}

static bool is_table(const char *path)
{
    size_t n = strlen(path);
    return n > 4 && strcmp(path + n - 4, ".csv") == 0;
}

int calib_runs_read(struct brc_context *ctx, const struct calib_envelope_options *o,
                    struct calib_runs *out)
{
    *out = (struct calib_runs){.run = brc_alloc(ctx, o->n, sizeof *out->run)};
    if (!out->run)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < o->n; i++)
        if (is_table(o->run[i]))
            BRC_TRY(add_points(ctx, o, o->run[i], o->n - i, out));
        else
            BRC_TRY(add_run(ctx, o, o->run[i], out));
    return 0;
}

void calib_runs_free(struct calib_runs *r)
{
    for (size_t i = 0; i < r->n; i++)
        free(r->run[i].keys);
    free(r->run);
    *r = (struct calib_runs){0};
}
