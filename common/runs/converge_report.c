/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the finished runs say. Errors are differences over the same specimens, which cancels most of
 * the scatter between them. A setting that has lost runs has no error: the mean over the rest would
 * be of other specimens. Called by converge.c for each model; it runs nothing and prints nothing.
 */
#include "common/runs/converge_report.h"

#include <math.h>
#include <string.h>

const double brc_converge_within[2] = {0.01, 0.05};

/* A test ends by a key of its own or of `test:`; others are run.max_steps, "signal", "failure". */
static bool is_end_of_test(const char *ended_by)
{
    return strchr(ended_by, '.') && strncmp(ended_by, "run.", 4) != 0;
}

/* It reached the end of the test and measured the observable: a run that max_steps has ended may
 * have a largest load that is no strength. */
static bool is_good(const struct brc_converge_study *study, const struct brc_converge_run *run)
{
    return run->is_done && is_end_of_test(run->ended_by) &&
           isfinite(run->result[study->observable]);
}

/* Values of the observable over the specimens; NAN where a run has not reached the end. */
static void copy_values(const struct brc_converge_study *study,
                        const struct brc_converge_setting *s, double *value)
{
    for (int i = 0; i < study->options->seeds; i++)
        value[i] = is_good(study, &s->run[i]) ? s->run[i].result[study->observable] : NAN;
}

/* Of a against b, specimen by specimen: those that only one of them has finished are left out. */
static struct brc_converge_error difference(const struct brc_converge_study *study,
                                            const struct brc_converge_setting *a,
                                            const struct brc_converge_setting *b)
{
    double x[BRC_CONVERGE_MAX_SEEDS], y[BRC_CONVERGE_MAX_SEEDS];
    copy_values(study, a, x);
    copy_values(study, b, y);
    return brc_converge_error(x, y, study->options->seeds);
}

/* A setting that lost runs has no error: the mean of those that are left would be another one.
 * Ladders are judged against the reference, choices and grains against the case, as there is no
 * right one among them. */
static void fill_row(const struct brc_converge_study *study, const struct brc_converge_model *m,
                     const struct brc_converge_setting *s, struct brc_converge_row *row)
{
    double value[BRC_CONVERGE_MAX_SEEDS], steps[BRC_CONVERGE_MAX_SEEDS],
        cpu[BRC_CONVERGE_MAX_SEEDS];
    const struct brc_converge_setting *the_case = &m->setting[BRC_CONVERGE_AT_CASE];
    bool is_ladder = s->role <= BRC_CONVERGE_LADDER;
    int n = study->options->seeds;
    *row = (struct brc_converge_row){.setting = s};
    row->is_case = s != the_case && s->run[0].key == the_case->run[0].key;
    row->error =
        difference(study, s, is_ladder ? &m->setting[BRC_CONVERGE_AT_REFERENCE] : the_case);
    copy_values(study, s, value);
    for (int i = 0; i < n; i++) {
        steps[i] = (double)s->run[i].steps;
        cpu[i] = s->run[i].cpu_s;
        row->n_good += is_good(study, &s->run[i]);
    }
    row->value = brc_converge_mean(value, n);
    row->steps = brc_converge_median(steps, n);
    row->cpu_s = brc_converge_median(cpu, n);
    if (row->n_good < n)
        row->error = (struct brc_converge_error){.mean = NAN, .deviation = NAN, .single = NAN};
}

/* A ladder is known by its first row; its settings follow each other. */
static void fill_rung(struct brc_converge_report *r, int i)
{
    const struct brc_converge_setting *s = r->row[i].setting;
    bool goes_on = i > 0 && strcmp(r->row[i - 1].setting->axis, s->axis) == 0;
    r->rung[i] = (struct brc_converge_rung){
        .ladder = goes_on ? r->rung[i - 1].ladder : i,
        .fineness = s->fineness,
        .error = s->role == BRC_CONVERGE_LADDER ? r->row[i].error.mean : NAN,
        .cost = r->row[i].cpu_s};
}

/* The part of the loading is measured at the larger step, so that three settings give both parts.
 */
void brc_converge_report_make(const struct brc_converge_study *study, int model,
                              struct brc_converge_report *out)
{
    const struct brc_converge_model *m = &study->model[model];
    const struct brc_converge_setting *s = m->setting;
    double value[BRC_CONVERGE_MAX_SEEDS];
    *out = (struct brc_converge_report){.model = m, .n = m->n};
    for (int i = 0; i < m->n; i++) {
        fill_row(study, m, &s[i], &out->row[i]);
        fill_rung(out, i);
    }
    out->step = difference(study, &s[BRC_CONVERGE_AT_STEP], &s[BRC_CONVERGE_AT_REFERENCE]);
    out->loading = difference(study, &s[BRC_CONVERGE_AT_LOADING], &s[BRC_CONVERGE_AT_STEP]);
    out->reference = out->row[BRC_CONVERGE_AT_REFERENCE].value;
    out->uncertainty = brc_converge_uncertainty(&out->loading, &out->step);
    copy_values(study, &s[BRC_CONVERGE_AT_REFERENCE], value);
    out->scatter = brc_converge_scatter(value, study->options->seeds);
    for (int k = 0; k < 2; k++)
        out->cheapest[k] = brc_converge_cheapest(out->rung, out->n, brc_converge_within[k]);
}

bool brc_converge_is_shown(const struct brc_converge_report *r, int i, double error)
{
    const struct brc_converge_error *e = &r->row[i].error;
    return fabs(e->mean) + hypot(e->deviation, r->uncertainty) <= error;
}
