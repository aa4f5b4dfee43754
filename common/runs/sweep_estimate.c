/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs of one case and model differ in cost by a factor of a few, by their axes; a dry run shall
 * tell minutes from days, and no more. Called by sweep.c. */
#include "common/runs/sweep_estimate.h"

#include "common/rigs/loading.h"

#include <math.h>
#include <string.h>
#include <time.h>

/* s of steps that are timed */
static const double TIMED = 1;

static bool is_like(const struct brc_sweep_run *a, const struct brc_sweep_run *b)
{
    return a->model == b->model && strcmp(a->name, b->name) == 0;
}

double brc_sweep_estimate(const struct brc_sweep_runs *runs, const struct brc_sweep_run *run)
{
    double sum[2] = {0, 0};
    int n[2] = {0, 0};
    for (size_t i = 0; i < runs->n; i++) {
        const struct brc_sweep_run *r = &runs->run[i];
        if (!r->is_done || r->first != i || r->kept.code != 0 || r->model != run->model)
            continue;
        int k = is_like(r, run) ? 0 : 1;
        sum[k] += r->kept.cpu_s;
        n[k]++;
    }
    return n[0] ? sum[0] / n[0] : n[1] ? sum[1] / n[1] : NAN;
}

double brc_sweep_estimate_all(const struct brc_sweep_runs *runs, const size_t *number, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += brc_sweep_estimate(runs, &runs->run[number[i]]);
    return sum;
}

/* ---- a short timing ------------------------------------------------------------------------ */

static double cpu_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds up to the end that the loading would reach at its present rate: at most, as a test may
 * end before; a test that is not loaded by a rate goes up to max_steps. */
static int time_steps(struct brc_sim *sim, double *seconds)
{
    double start = cpu_now(), now = start;
    while (!brc_rigs_done(sim) && sim->step < sim->run.max_steps && now - start < TIMED) {
        BRC_TRY(brc_sim_step(sim));
        now = cpu_now();
    }
    double most = (double)(sim->run.max_steps - sim->step);
    double left = sim->rig.n_platens > 0 ? brc_loading_steps_left(sim) : most;
    left = brc_rigs_done(sim) ? 0 : isfinite(left) ? fmin(left, most) : most;
    *seconds = (now - start) * (1 + left / fmax((double)sim->step, 1));
    return 0;
}

static int time_run(struct brc_context *ctx, const struct brc_sweep_run *run, double *seconds)
{
    struct brc_specimen specimen = {0};
    struct brc_case run_case;
    struct brc_sim sim;
    int code = brc_sweep_run_case(ctx, run, &run_case);
    if (code == 0)
        code = brc_specimen_create(ctx, &run_case.specimen, &specimen);
    if (code == 0)
        code = brc_case_sim(ctx, &run_case, run->model, &specimen, &sim);
    if (code == 0) {
        code = time_steps(&sim, seconds);
        brc_sim_free(&sim);
    }
    brc_specimen_free(&specimen);
    brc_case_free(&run_case);
    return code;
}

/* ---- what is printed ----------------------------------------------------------------------- */

/* Of all runs like this one that are missing, told once, at the first of them. */
static int print_like(struct brc_context *ctx, FILE *out, const struct brc_sweep_runs *runs,
                      size_t i, double *total)
{
    const struct brc_sweep_run *run = &runs->run[i];
    double seconds = brc_sweep_estimate(runs, run);
    bool is_timed = !isfinite(seconds);
    size_t n = 0;
    for (size_t k = 0; k < runs->n; k++) {
        const struct brc_sweep_run *r = &runs->run[k];
        bool is_missing = r->first == k && !r->is_done && is_like(r, run);
        if (is_missing && k < i)
            return 0;
        n += is_missing;
    }
    if (is_timed)
        BRC_TRY(time_run(ctx, run, &seconds));
    *total += seconds * (double)n;
    fprintf(out, "%s, %s: %zu to do, %s%.3g s each, %s\n", run->name, run->model->name, n,
            is_timed ? "at most about " : "about ", seconds,
            is_timed ? "by the first steps of one" : "by those that are done");
    return 0;
}

static void print_group(FILE *out, const struct brc_sweep_runs *runs,
                        const struct brc_sweep_group *g)
{
    size_t n = 0, n_done = 0, n_repeated = 0;
    for (size_t i = 0; i < runs->n; i++) {
        const struct brc_sweep_run *r = &runs->run[i];
        n += r->group == g;
        n_done += r->group == g && r->is_done;
        n_repeated += r->group == g && r->first != i && !r->is_done;
    }
    fprintf(out, "%s: %zu runs", g->name, n);
    for (size_t a = 0; a < g->n_axes; a++)
        fprintf(out, "%s%s %zu%s", a ? " x " : " = ", g->axis[a].name, g->axis[a].n,
                g->axis[a].is_over ? " (mean)" : "");
    fprintf(out, "; %zu kept", n_done);
    if (n_repeated > 0)
        fprintf(out, ", %zu the same as others", n_repeated);
    fputc('\n', out);
}

int brc_sweep_estimate_print(struct brc_context *ctx, FILE *out, const struct brc_sweep_runs *runs,
                             int jobs)
{
    double total = 0;
    size_t n_missing = 0;
    char text[2][32], label[400];
    for (size_t i = 0; i < runs->n; i++)
        if (runs->run[i].first == i && !runs->run[i].is_done) {
            fprintf(out, "  %s\n", brc_sweep_run_label(&runs->run[i], label, sizeof label));
            n_missing++;
        }
    for (size_t g = 0; g < runs->plan->n_groups; g++)
        print_group(out, runs, &runs->plan->group[g]);
    for (size_t i = 0; i < runs->n; i++)
        if (runs->run[i].first == i && !runs->run[i].is_done)
            BRC_TRY(print_like(ctx, out, runs, i, &total));
    fprintf(out, "%zu of %zu runs to do: about %s of processor time, %s with %d at a time\n",
            n_missing, runs->n, brc_progress_duration(total, text[0], sizeof text[0]),
            brc_progress_duration(total / jobs, text[1], sizeof text[1]), jobs);
    return 0;
}
