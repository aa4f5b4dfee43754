/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables are long and tidy: programs that draw and test take them so, and axes of all groups fit
 * into one. Failed runs count as missing, and are counted. */
#include "common/runs/sweep_table.h"

#include "common/output/columns.h"
#include "common/runs/compare.h"
#include "common/runs/sweep_cells.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- columns ------------------------------------------------------------------------------- */

/* A table with a column for each axis of any group, as both tables begin. That of runs tells case
 * and model anyway. */
static int begin(struct brc_sweep_cells *c, struct brc_columns *t, const char *name, size_t n_rows,
                 bool is_of_runs)
{
    const struct brc_sweep_plan *plan = c->runs->plan;
    *t = (struct brc_columns){.name = name, .pool = &c->pool, .n_rows = n_rows};
    BRC_TRY(brc_columns_add(c->ctx, t, "group", "", true));
    for (size_t g = 0; g < plan->n_groups; g++)
        for (size_t a = 0; a < plan->group[g].n_axes; a++) {
            const char *axis = plan->group[g].axis[a].name;
            size_t k = 0;
            bool is_there = is_of_runs && (strcmp(axis, "case") == 0 || strcmp(axis, "model") == 0);
            while (k < t->n && strcmp(t->column[k].name, axis) != 0)
                k++;
            if (k == t->n && !is_there)
                BRC_TRY(brc_columns_add(c->ctx, t, axis, "", true));
        }
    return 0;
}

static void put_axes(const struct brc_columns *t, size_t row, const struct brc_sweep_run *run,
                     bool has_over)
{
    const struct brc_sweep_group *g = run->group;
    t->column[0].text[row] = g->name;
    for (size_t a = 0; a < g->n_axes; a++)
        for (size_t k = 1; k < t->n && (has_over || !g->axis[a].is_over); k++)
            if (t->column[k].text && strcmp(t->column[k].name, g->axis[a].name) == 0)
                t->column[k].text[row] = g->axis[a].value[run->at[a]].label;
}

static int add_numbers(struct brc_sweep_cells *c, struct brc_columns *t,
                       const char *const (*name)[2], size_t n)
{
    for (size_t i = 0; i < n; i++)
        BRC_TRY(brc_columns_add(c->ctx, t, name[i][0], name[i][1], false));
    return 0;
}

/* A text for a column of the table of runs. */
static int put_text(struct brc_sweep_cells *c, const char **at, const char *text)
{
    char *kept = brc_pool_alloc(c->ctx, &c->pool, strlen(text) + 1, 1);
    *at = kept ? strcpy(kept, text) : "";
    return kept ? 0 : BRC_ERR_MEMORY;
}

/* ---- the table of runs --------------------------------------------------------------------- */

static const char *const run_texts[] = {"case",     "model",      "key",
                                        "ended_by", "state_hash", "message"};
static const char *const run_numbers[][2] = {
    {"code", ""},       {"steps", "1"},  {"n_grains", "1"},        {"dt", "s"},
    {"cpu_s", "s"},     {"wall_s", "s"}, {"energy_residual", "1"}, {"energy_drift", "1"},
    {"unbalanced", "1"}};
enum { N_RUN_TEXTS = sizeof run_texts / sizeof run_texts[0] };
enum { N_RUN_NUMBERS = sizeof run_numbers / sizeof run_numbers[0] };

static int put_run(struct brc_sweep_cells *c, struct brc_columns *t, size_t first, size_t row)
{
    const struct brc_sweep_run *run = &c->runs->run[row];
    const struct brc_kept_run *k = &run->kept;
    char key[20], state[20];
    struct brc_column *column = &t->column[first];
    snprintf(key, sizeof key, "%016" PRIx64, run->key.hash);
    snprintf(state, sizeof state, "%016" PRIx64, k->state_hash);
    const char *const text[] = {run->name,
                                run->model->name,
                                key,
                                run->is_done ? k->ended_by : "",
                                k->state_hash ? state : "",
                                run->is_done ? k->message : "not done"};
    const double number[] = {
        k->code,          (double)k->steps, k->n_grains,        k->dt,
        k->cpu_s,         k->wall_s,        k->energy_residual, k->energy_drift,
        k->unbalanced_max};
    put_axes(t, row, run, true);
    for (int i = 0; i < N_RUN_TEXTS; i++)
        BRC_TRY(put_text(c, &column[i].text[row], text[i]));
    for (int i = 0; i < N_RUN_NUMBERS; i++)
        column[N_RUN_TEXTS + i].number[row] = run->is_done ? number[i] : NAN;
    return 0;
}

/* A column for each result that any run has, collected or not: the file is the record as a table.
 */
static int put_results(struct brc_sweep_cells *c, struct brc_columns *t, size_t first)
{
    for (size_t i = 0; i < c->runs->n; i++) {
        const struct brc_quantity *q;
        for (int k = 0; (q = brc_sweep_quantity(c->runs->run[i].rig, k)) != NULL; k++) {
            size_t at = first;
            while (at < t->n && strcmp(t->column[at].name, q->name) != 0)
                at++;
            if (at < t->n)
                continue;
            BRC_TRY(brc_columns_add(c->ctx, t, q->name, q->unit, false));
            for (size_t row = 0; row < c->runs->n; row++)
                brc_columns_last(t)->number[row] =
                    brc_sweep_is_good(&c->runs->run[row])
                        ? brc_kept_result(&c->runs->run[row].kept, q->name)
                        : NAN;
        }
    }
    return 0;
}

static int make_runs(struct brc_sweep_cells *c, struct brc_columns *t)
{
    BRC_TRY(begin(c, t, "runs", c->runs->n, true));
    size_t first = t->n;
    for (int i = 0; i < N_RUN_TEXTS; i++)
        BRC_TRY(brc_columns_add(c->ctx, t, run_texts[i], "", true));
    BRC_TRY(add_numbers(c, t, run_numbers, N_RUN_NUMBERS));
    for (size_t row = 0; row < c->runs->n; row++)
        BRC_TRY(put_run(c, t, first, row));
    return put_results(c, t, t->n);
}

/* ---- the table of means -------------------------------------------------------------------- */

static const char *const mean_numbers[][2] = {
    {"n", ""},       {"mean", ""},   {"standard_error", ""}, {"ci_low", ""},
    {"ci_high", ""}, {"cpu_s", "s"}, {"runs", ""},           {"failed", ""}};
enum { N_MEAN_NUMBERS = sizeof mean_numbers / sizeof mean_numbers[0] };

static void put_mean(struct brc_sweep_cells *c, struct brc_columns *t, size_t row, size_t first,
                     const struct brc_sweep_cell *cell, const struct brc_quantity *q)
{
    struct brc_sweep_mean m = brc_sweep_cell_mean(c, cell, q->name);
    const double number[] = {m.n,    m.mean,      m.standard_error, m.low,
                             m.high, cell->cpu_s, cell->n_done,     cell->n_failed};
    put_axes(t, row, cell->run[0], false);
    t->column[first].text[row] = q->name;
    t->column[first + 1].text[row] = q->unit;
    for (int i = 0; i < N_MEAN_NUMBERS; i++)
        t->column[first + 2 + (size_t)i].number[row] = number[i];
}

/* A first pass counts the rows. */
static int make_means(struct brc_sweep_cells *c, struct brc_columns *t)
{
    size_t n_rows = 0, first = 0;
    for (int is_counted = 0; is_counted < 2; is_counted++) {
        size_t row = 0;
        for (size_t k = 0; k < c->n; k++) {
            const struct brc_sweep_run *run = c->cell[k].run[0];
            const struct brc_quantity *q;
            for (int i = 0; (q = brc_sweep_quantity(run->rig, i)) != NULL; i++) {
                if (!brc_sweep_is_collected(run->group, q->name))
                    continue;
                if (is_counted)
                    put_mean(c, t, row, first, &c->cell[k], q);
                row++;
            }
        }
        n_rows = row;
        if (is_counted)
            break;
        BRC_TRY(begin(c, t, "sweep", n_rows, false));
        first = t->n;
        BRC_TRY(brc_columns_add(c->ctx, t, "quantity", "", true));
        BRC_TRY(brc_columns_add(c->ctx, t, "unit", "", true));
        BRC_TRY(add_numbers(c, t, mean_numbers, N_MEAN_NUMBERS));
    }
    return 0;
}

static int write_all(struct brc_sweep_cells *c, const char *dir)
{
    struct brc_columns means, runs;
    const struct brc_columns *const both[] = {&means, &runs};
    BRC_TRY(make_means(c, &means));
    BRC_TRY(make_runs(c, &runs));
    BRC_TRY(brc_columns_csv(c->ctx, &means, dir, "sweep.csv"));
    BRC_TRY(brc_columns_csv(c->ctx, &runs, dir, "runs.csv"));
    return brc_columns_h5(c->ctx, both, 2, dir, "sweep.h5");
}

int brc_sweep_write(struct brc_context *ctx, const struct brc_sweep_runs *runs, const char *dir)
{
    struct brc_sweep_cells c;
    int code = brc_sweep_cells_make(ctx, runs, &c);
    if (code == 0)
        code = write_all(&c, dir);
    brc_sweep_cells_free(&c);
    return code;
}

/* ---- for readers --------------------------------------------------------------------------- */

enum { MAX_SHOWN = 4, VALUE_WIDTH = 24 };

/* Of the column of an axis: its name and its values. */
static int width_of(const struct brc_sweep_axis *axis)
{
    size_t most = strlen(axis->name);
    for (size_t i = 0; i < axis->n; i++)
        most = strlen(axis->value[i].label) > most ? strlen(axis->value[i].label) : most;
    return (int)most + 2;
}

/* The largest mean of the group decides on the unit, so that a column has one. */
static struct brc_shown unit_of(struct brc_sweep_cells *c, size_t first, size_t end,
                                const struct brc_quantity *q)
{
    double most = 0;
    for (size_t k = first; k < end; k++)
        most = fmax(most, fabs(brc_sweep_cell_mean(c, &c->cell[k], q->name).mean));
    return brc_compare_unit(q->name, q->unit, most);
}

static void print_cell(struct brc_sweep_cells *c, FILE *out, const struct brc_sweep_cell *cell,
                       const struct brc_quantity *const *shown, const struct brc_shown *unit, int n)
{
    const struct brc_sweep_run *run = cell->run[0];
    char mean[BRC_DIGITS_SIZE], error[BRC_DIGITS_SIZE], both[2 * BRC_DIGITS_SIZE];
    for (size_t a = 0; a < run->group->n_axes; a++)
        if (!run->group->axis[a].is_over)
            fprintf(out, "%-*s", width_of(&run->group->axis[a]),
                    run->group->axis[a].value[run->at[a]].label);
    fprintf(out, "%4d", cell->n_done - cell->n_failed);
    for (int i = 0; i < n; i++) {
        struct brc_sweep_mean m = brc_sweep_cell_mean(c, cell, shown[i]->name);
        brc_compare_digits(unit[i].factor * m.mean, mean);
        brc_compare_digits(unit[i].factor * m.standard_error, error);
        snprintf(both, sizeof both, m.n > 1 ? "%s +- %s" : "%s", mean, error);
        fprintf(out, "%*s", VALUE_WIDTH, both);
    }
    fprintf(out, "%10s", brc_compare_digits(cell->cpu_s, mean));
    if (cell->n_failed > 0)
        fprintf(out, "  %d failed", cell->n_failed);
    fputc('\n', out);
}

static void print_group(struct brc_sweep_cells *c, FILE *out, size_t first, size_t end)
{
    const struct brc_sweep_run *run = c->cell[first].run[0];
    const struct brc_quantity *shown[MAX_SHOWN];
    struct brc_shown unit[MAX_SHOWN];
    char head[120];
    int n = brc_sweep_shown(run, shown, MAX_SHOWN), width = 14 + n * VALUE_WIDTH;
    fprintf(out, "\n%s\n", run->group->name);
    for (size_t a = 0; a < run->group->n_axes; a++)
        if (!run->group->axis[a].is_over) {
            fprintf(out, "%-*s", width_of(&run->group->axis[a]), run->group->axis[a].name);
            width += width_of(&run->group->axis[a]);
        }
    fprintf(out, "%4s", "runs");
    for (int i = 0; i < n; i++) {
        unit[i] = unit_of(c, first, end, shown[i]);
        snprintf(head, sizeof head, *unit[i].unit ? "%s [%s]" : "%s", shown[i]->name, unit[i].unit);
        fprintf(out, "%*s", VALUE_WIDTH, head);
    }
    fprintf(out, "%10s\n", "CPU [s]");
    brc_compare_rule(out, width);
    for (size_t k = first; k < end; k++)
        print_cell(c, out, &c->cell[k], shown, unit, n);
}

int brc_sweep_print(struct brc_context *ctx, FILE *out, const struct brc_sweep_runs *runs)
{
    struct brc_sweep_cells c;
    int code = brc_sweep_cells_make(ctx, runs, &c);
    if (code == 0)
        fprintf(out, "%s\n", *runs->plan->title ? runs->plan->title : runs->plan->path);
    for (size_t first = 0, end; code == 0 && first < c.n; first = end) {
        for (end = first; end < c.n && c.cell[end].run[0]->group == c.cell[first].run[0]->group;)
            end++;
        print_group(&c, out, first, end);
    }
    if (code == 0)
        fputs("\nmean +- standard error\n", out);
    brc_sweep_cells_free(&c);
    return code;
}
