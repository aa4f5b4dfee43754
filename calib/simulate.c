/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One trial of a calibration is one ordinary run of the test's case, so that what a calibration
 * finds can be repeated from the command line. Pictures alone are left out: a search would draw
 * hundreds that nobody looks at. A specimen is made once a test and kept, since no variable of a
 * calibration changes it. */
#include "calib/simulate.h"
#include "common/base/folders.h"
#include "common/rigs/rigs.h"
#include "common/runs/run.h"

#include <stdio.h>
#include <string.h>

enum { ASSIGNMENT_SIZE = 256 };

/* Seventeen digits and the SI unit: the same double when it is read, whatever the unit of the
 * default. */
int calib_assignment(struct brc_context *ctx, const struct calib_trial *trial, size_t i,
                     struct brc_param_list list, char *buffer, size_t size)
{
    const char *key = trial->variables[i].key;
    const struct brc_param *p = brc_params_find(list, key);
    if (!p || p->kind != BRC_REAL)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "calibration: %s.%s is not a quantity of the model",
                 trial->model, key);
    if (snprintf(buffer, size, "%s.%s=%.17g%s%s", trial->model, key, trial->x[i],
                 brc_unit_blank(p->unit), brc_unit_shown(p->unit)) >= (int)size)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "calibration: %s.%s is too long", trial->model, key);
    return 0;
}

/* By the way of --set, so that a value passes the checks of any other; a case of another test than
 * it is given for is an error, as its results would have the right names and the wrong meaning. */
static int read_case(struct brc_context *ctx, const struct calib_simulator *s,
                     const struct calib_trial *trial, const struct brc_model *model,
                     struct brc_case *run_case)
{
    char text[CALIB_MAX_VARIABLES][ASSIGNMENT_SIZE];
    const char *overrides[CALIB_MAX_VARIABLES + 1];
    if (trial->n > CALIB_MAX_VARIABLES)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "calibration: %zu variables; allowed at most %d", trial->n,
                 CALIB_MAX_VARIABLES);
    for (size_t i = 0; i < trial->n; i++) {
        BRC_TRY(calib_assignment(ctx, trial, i, model->params, text[i], ASSIGNMENT_SIZE));
        overrides[i] = text[i];
    }
    overrides[trial->n] = "output.plots=off";
    BRC_TRY(brc_case_read(ctx, run_case, s->path[trial->test], overrides, (int)trial->n + 1));
    if (run_case->test.kind != trial->test)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: %s is given as the %s test, but its test.kind is %s",
                 s->path[trial->test], brc_rigs_at(trial->test)->name,
                 brc_rigs_at(run_case->test.kind)->name);
    return 0;
}

/* Results of the trial before are replaced, those that were there before the first trial are not:
 * the folder may be somebody's. */
static int run_trial(struct brc_context *ctx, struct calib_simulator *s,
                     const struct calib_trial *trial, const struct brc_model *model,
                     const struct brc_case *run_case, struct brc_summary *out)
{
    char dir[BRC_PATH_SIZE];
    struct brc_progress quiet;
    int test = trial->test;
    BRC_TRY(brc_folder_path(ctx, s->dir, brc_rigs_at(test)->name, dir));
    if (s->specimen[test].facets.n_cells == 0)
        BRC_TRY(brc_specimen_create(ctx, &run_case->specimen, &s->specimen[test]));
    brc_progress_begin(&quiet, stderr, &trial->model, 1, true);
    struct brc_run_options options = {.run_case = run_case,
                                      .model = model,
                                      .specimen = &s->specimen[test],
                                      .dir = dir,
                                      .is_forced = s->has_run[test],
                                      .progress = &quiet};
    int code = brc_run(ctx, &options, out);
    /* refused input has replaced nothing: what is in the folder then is somebody else's */
    s->has_run[test] |= brc_run_has_begun(dir) && code != BRC_ERR_INPUT;
    brc_progress_end(&quiet);
    return code;
}

/* A test that a target asks for must have a case: to leave its residual out would be a fit to
 * something else. */
int calib_simulate(struct brc_context *ctx, void *user, const struct calib_trial *trial,
                   struct brc_summary *out)
{
    struct calib_simulator *s = user;
    const struct brc_model *model;
    struct brc_case run_case = {0};
    if (!s->path[trial->test])
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: a target needs the %s test, but no case file is "
                 "given for it",
                 brc_rigs_at(trial->test)->name);
    BRC_TRY(brc_case_model(ctx, trial->model, &model));
    int code = read_case(ctx, s, trial, model, &run_case);
    if (code == 0)
        code = run_trial(ctx, s, trial, model, &run_case, out);
    brc_case_free(&run_case);
    return code;
}

void calib_simulator_free(struct calib_simulator *s)
{
    for (int i = 0; i < BRC_MAX_RIGS; i++)
        brc_specimen_free(&s->specimen[i]);
}
