/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of a ladder. Columns hold what a reader decides by: the error, how certain it is, and
 * what it costs. The same function prints to the terminal and to converge.txt, so that both are the
 * same. Called by converge.c. */
#include "common/runs/converge_table.h"

#include "common/base/text_file.h"
#include "common/runs/compare.h"
#include "common/output/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 104 };

/* Errors at which the steps of both kinds of loading are compared. */
static const double levels[] = {0.01, 0.02, 0.05, 0.1};

static const char *percent(double part, bool is_signed, char text[BRC_DIGITS_SIZE])
{
    if (!isfinite(part))
        snprintf(text, BRC_DIGITS_SIZE, "-");
    else
        snprintf(text, BRC_DIGITS_SIZE, is_signed ? "%+.2f" : "%.2f", 100 * part);
    return text;
}

/* ---- one model ----------------------------------------------------------------------------- */

/* A question mark behind a mark says that the uncertainty reaches beyond the error that is asked
 * for. */
static void put_row(FILE *out, const struct brc_converge_report *r, int i, struct brc_shown shown,
                    int n_seeds)
{
    const struct brc_converge_row *row = &r->row[i];
    char text[BRC_DIGITS_SIZE];
    fprintf(out, "%-10s %-24s", row->setting->axis, row->setting->label);
    fprintf(out, "%10s", brc_compare_digits(shown.factor * row->value, text));
    fprintf(out, "%9s", percent(row->error.mean, true, text));
    fprintf(out, "%8s", percent(row->error.deviation, false, text));
    fprintf(out, "%8s", percent(row->error.single, false, text));
    fprintf(out, "%9.0f", row->steps);
    fprintf(out, "%9s  ", brc_compare_digits(row->cpu_s, text));
    for (int k = 0; k < 2; k++)
        if (r->cheapest[k] == i)
            fprintf(out, "<= %g %%%s ", 100 * brc_converge_within[k],
                    brc_converge_is_shown(r, i, brc_converge_within[k]) ? "" : "?");
    if (row->is_case)
        fputs("as written ", out);
    if (row->n_good < n_seeds)
        fprintf(out, "%d of %d ended", row->n_good, n_seeds);
    fputc('\n', out);
}

/* By what they are; of the references only the finest, as the others serve its uncertainty alone.
 */
static void put_rows(FILE *out, const struct brc_converge_study *study,
                     const struct brc_converge_report *r)
{
    static const char *const title[] = {
        [BRC_CONVERGE_CHOICE] = "choices of the model: differences to the case\n",
        [BRC_CONVERGE_GRAINS] = "other grains: differences to the case\n"};
    const struct brc_result *seen = &study->results[study->observable];
    struct brc_shown shown = brc_compare_unit(seen->name, seen->unit, fabs(r->reference));
    for (enum brc_converge_role role = 0; role <= BRC_CONVERGE_GRAINS; role++) {
        const char *what = title[role];
        for (int i = 0; i < r->n; i++) {
            bool is_hidden = i == BRC_CONVERGE_AT_STEP || i == BRC_CONVERGE_AT_LOADING;
            if (r->row[i].setting->role != role || is_hidden)
                continue;
            fputs(what ? what : "", out);
            what = NULL;
            put_row(out, r, i, shown, study->options->seeds);
        }
    }
}

/* How many specimens a mean needs follows from their scatter: its standard error falls with the
 * square root of their number. */
static void put_head(FILE *out, const struct brc_converge_study *study,
                     const struct brc_converge_report *r)
{
    const struct brc_result *seen = &study->results[study->observable];
    struct brc_shown shown = brc_compare_unit(seen->name, seen->unit, fabs(r->reference));
    char value[BRC_DIGITS_SIZE], all[BRC_DIGITS_SIZE], loading[BRC_DIGITS_SIZE],
        step[BRC_DIGITS_SIZE], scatter[BRC_DIGITS_SIZE];
    char column[BRC_DIGITS_SIZE];
    fprintf(out, "%s: reference %s %s %s, uncertain by %s %%", r->model->model->name, seen->name,
            brc_compare_digits(shown.factor * r->reference, value), shown.unit,
            percent(r->uncertainty, false, all));
    fprintf(out, " (loading %s %%, step %s %%, and chance)\n",
            percent(r->loading.mean, true, loading), percent(r->step.mean, true, step));
    fprintf(out, "scatter of the specimens %s %%", percent(r->scatter, false, scatter));
    if (isfinite(r->scatter))
        fprintf(out, ": a mean is good to 1 %% over %.0f of them, to 5 %% over %.0f",
                fmax(ceil(pow(r->scatter / 0.01, 2)), 1), fmax(ceil(pow(r->scatter / 0.05, 2)), 1));
    fputc('\n', out);
    brc_compare_rule(out, WIDTH);
    snprintf(column, sizeof column, "[%s]", *shown.unit ? shown.unit : "1");
    fprintf(out, "%-10s %-24s%10s%9s%8s%8s%9s%9s  %s\n", "axis", "setting", column, "error %",
            "+- %", "one %", "steps", "CPU s", "cheapest");
    brc_compare_rule(out, WIDTH);
}

/* ---- adaptive against fixed loading -------------------------------------------------------- */

/* In steps: seconds of the two kinds of loading hang on the machine. */
static void put_cost(FILE *out, struct brc_converge_cost cost)
{
    if (isfinite(cost.cost))
        fprintf(out, "%s%.0f", cost.is_bound ? "at most " : "", cost.cost);
    else
        fputs("none of the rungs", out);
}

static void put_level(FILE *out, const struct brc_converge_report *r, const char *which,
                      double level, struct brc_converge_cost adaptive,
                      struct brc_converge_cost fixed)
{
    fprintf(out, "%s%5.2f %%: ", which, 100 * level);
    put_cost(out, adaptive);
    fputs(" against ", out);
    put_cost(out, fixed);
    if (isfinite(adaptive.cost) && isfinite(fixed.cost))
        fprintf(out, ", fixed takes %.2f times as many", fixed.cost / adaptive.cost);
    if (level < r->uncertainty)
        fputs(" (below the uncertainty of the reference)", out);
    fputc('\n', out);
}

/* At some errors, and at that of the case as written, or of the reference where that is larger. */
static void put_loadings(FILE *out, const struct brc_converge_report *r)
{
    struct brc_converge_rung rung[BRC_CONVERGE_MAX_SETTINGS];
    const struct brc_converge_row *the_case = &r->row[BRC_CONVERGE_AT_CASE];
    int adaptive = -1, fixed = -1;
    for (int i = 0; i < r->n; i++) {
        rung[i] = r->rung[i];
        rung[i].cost = r->row[i].steps;
        if (strcmp(r->row[i].setting->axis, "loading") == 0)
            adaptive = rung[i].ladder;
        if (strcmp(r->row[i].setting->axis, "rate") == 0)
            fixed = rung[i].ladder;
    }
    if (adaptive < 0 || fixed < 0)
        return;
    fputs("steps for an error, adaptive against fixed loading:\n", out);
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++)
        put_level(out, r, "              ", levels[i],
                  brc_converge_cost(rung, r->n, adaptive, levels[i]),
                  brc_converge_cost(rung, r->n, fixed, levels[i]));
    double level = fmax(fabs(the_case->error.mean), r->uncertainty);
    if (isfinite(level))
        put_level(out, r, "  as written, ", level,
                  (struct brc_converge_cost){.cost = the_case->steps},
                  brc_converge_cost(rung, r->n, fixed, level));
}

/* ---- everything ---------------------------------------------------------------------------- */

static void put_cheapest(FILE *out, const struct brc_converge_report *r)
{
    char cpu[BRC_DIGITS_SIZE];
    for (int k = 0; k < 2; k++) {
        double within = brc_converge_within[k];
        fprintf(out, "cheapest within %g %%: ", 100 * within);
        if (r->cheapest[k] < 0) {
            fputs("none of these settings\n", out);
            continue;
        }
        const struct brc_converge_row *row = &r->row[r->cheapest[k]];
        fprintf(out, "%s %s, %.0f steps, %s s%s\n", row->setting->axis, row->setting->label,
                row->steps, brc_compare_digits(row->cpu_s, cpu),
                brc_converge_is_shown(r, r->cheapest[k], within)
                    ? ""
                    : "; its uncertainty reaches beyond");
    }
}

void brc_converge_print(FILE *out, const struct brc_converge_study *study,
                        const struct brc_converge_report *report)
{
    const struct brc_case *run_case = study->options->run.run_case;
    int seeds = study->options->seeds, first = run_case->specimen.seed;
    fprintf(out, "%s\n", *run_case->file.head.title ? run_case->file.head.title : run_case->name);
    fprintf(out, "%s, %d specimen%s (seed %d", study->results[study->observable].name, seeds,
            seeds > 1 ? "s" : "", first);
    fprintf(out, seeds > 1 ? " to %d)\n" : ")\n", first + seeds - 1);
    for (int i = 0; i < study->n_models; i++) {
        const struct brc_converge_report *r = &report[i];
        fputc('\n', out);
        put_head(out, study, r);
        put_rows(out, study, r);
        brc_compare_rule(out, WIDTH);
        put_cheapest(out, r);
        put_loadings(out, r);
    }
    fputs("\nerror: mean over the specimens against the reference; +-: its standard error; one: "
          "rms on "
          "one specimen\n"
          "?: its uncertainty reaches beyond; as written: the case itself\n",
          out);
}

/* ---- CSV ----------------------------------------------------------------------------------- */

/* All columns of the table and the judgements, by numbers: what one filters by in a spreadsheet. */
static void put_csv_row(FILE *out, const struct brc_converge_report *r, int i)
{
    static const char *const role[] = {"case", "reference", "ladder", "choice", "grains"};
    const struct brc_converge_row *row = &r->row[i];
    const char *const words[] = {r->model->model->name, row->setting->axis, row->setting->label};
    for (int k = 0; k < 3; k++) {
        brc_output_cell(out, words[k]);
        fputc(',', out);
    }
    fprintf(out, "%s,%d,%.9g,%.6g,%.6g,%.6g,%.9g,%.6g", role[row->setting->role], row->n_good,
            row->value, row->error.mean, row->error.deviation, row->error.single, row->steps,
            row->cpu_s);
    for (int k = 0; k < 2; k++)
        fprintf(out, ",%d", r->cheapest[k] == i);
    fprintf(out, ",%.6g\n", r->uncertainty);
}

/* All rows, those of the reference's uncertainty too: whoever filters can leave rows out, but not
 * put them in. */
int brc_converge_csv(struct brc_context *ctx, const struct brc_converge_study *study,
                     const struct brc_converge_report *report)
{
    struct brc_text_file file;
    const struct brc_result *seen = &study->results[study->observable];
    BRC_TRY(brc_text_file_begin(ctx, &file, study->options->run.dir, "converge.csv"));
    FILE *out = file.out;
    fprintf(out,
            "model,axis,setting,role,runs [1],%s [%s],error [1],standard_error [1],"
            "one_specimen [1],steps [1],cpu_s [s],cheapest_1,cheapest_5,"
            "reference_uncertainty [1]\n",
            seen->name, seen->unit);
    for (int i = 0; i < study->n_models; i++)
        for (int k = 0; k < report[i].n; k++)
            put_csv_row(out, &report[i], k);
    return brc_text_file_end(ctx, &file);
}
