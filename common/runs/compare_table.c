/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table for readers: units by the size of the values, one for a row, so that columns compare.
 */
#include "common/runs/compare.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_WIDTH = 26, COLUMN_WIDTH = 16 };

/* The prefixes that rock mechanics uses, and no others: a strength is in MPa also where it is
 * small. */
struct brc_shown brc_compare_unit(const char *name, const char *unit, double largest)
{
    if (strcmp(unit, "Pa") == 0)
        return largest >= 1e9 ? (struct brc_shown){1e-9, "GPa"} : (struct brc_shown){1e-6, "MPa"};
    if (strcmp(unit, "N") == 0)
        return (struct brc_shown){1e-3, "kN"};
    if (strcmp(unit, "rad") == 0)
        return (struct brc_shown){180 / BRC_PI, "deg"};
    if (strncmp(name, "strain", 6) == 0)
        return (struct brc_shown){100, "%"};
    return (struct brc_shown){1, strcmp(unit, "1") == 0 ? "" : unit};
}

/* Names as the fields of the summary have them, but with spaces: the table is for readers. */
static void put_label(FILE *out, const char *name, const char *unit)
{
    char label[96];
    snprintf(label, sizeof label, "%s%s%s%s", name, *unit ? " [" : "", unit, *unit ? "]" : "");
    for (char *c = label; *c && *c != '['; c++)
        if (*c == '_')
            *c = ' ';
    fprintf(out, "%-*s", LABEL_WIDTH, label);
}

/* Four digits whatever the size, rather than as many places: values are compared by their first
 * digits, and small ones would lose them. */
const char *brc_compare_digits(double value, char text[BRC_DIGITS_SIZE])
{
    double size = fabs(value);
    if (!isfinite(value))
        snprintf(text, BRC_DIGITS_SIZE, "-");
    else if (value == 0)
        snprintf(text, BRC_DIGITS_SIZE, "0");
    else if (size >= 1e-3 && size < 1e5) /* 999.96 to 1000.0, but 1000 to 1000: hence 1e-9 */
        snprintf(text, BRC_DIGITS_SIZE, "%.*f", (int)fmax(3 - floor(log10(size) + 1e-9), 0), value);
    else
        snprintf(text, BRC_DIGITS_SIZE, "%.3e", value);
    return text;
}

void brc_compare_rule(FILE *out, int width)
{
    for (int i = 0; i < width; i++)
        fputc('-', out);
    fputc('\n', out);
}

/* Whole numbers are counts, and stand as such. */
static void put_value(FILE *out, double value)
{
    char text[BRC_DIGITS_SIZE];
    if (value == floor(value) && fabs(value) < 1e15)
        fprintf(out, "%*.0f", COLUMN_WIDTH, value);
    else
        fprintf(out, "%*s", COLUMN_WIDTH, brc_compare_digits(value, text));
}

/* One unit for a row, by its largest value: columns that are to be compared must not differ in it.
 */
static void put_result(FILE *out, const struct brc_summary *const *summary, int n,
                       const struct brc_result *row)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const struct brc_result *r = brc_output_result(summary[i], row->name);
        if (r && isfinite(r->value))
            largest = fmax(largest, fabs(r->value));
    }
    struct brc_shown shown = brc_compare_unit(row->name, row->unit, largest);
    put_label(out, row->name, shown.unit);
    for (int i = 0; i < n; i++) {
        const struct brc_result *r = brc_output_result(summary[i], row->name);
        put_value(out, r ? shown.factor * r->value : NAN);
    }
    fputc('\n', out);
}

/* Rows that every test has. */
static void put_costs(FILE *out, const struct brc_summary *const *summary, int n)
{
    enum { N_ROWS = 9 };
    static const char *const label[N_ROWS][2] = {{"grains", ""},
                                                 {"active contacts, mean", ""},
                                                 {"points", ""},
                                                 {"steps", ""},
                                                 {"CPU", "s"},
                                                 {"per contact and step", "ns"},
                                                 {"energy residual", ""},
                                                 {"energy drift", ""},
                                                 {"unbalanced, largest", ""}};
    for (int k = 0; k < N_ROWS; k++) {
        put_label(out, label[k][0], label[k][1]);
        for (int i = 0; i < n; i++) {
            const struct brc_summary *s = summary[i];
            const double value[N_ROWS] = {(double)s->n_grains,
                                          round(s->n_contacts_mean),
                                          (double)s->n_points,
                                          (double)s->steps,
                                          s->cpu_s,
                                          s->ns_per_contact_step,
                                          s->energy_residual,
                                          s->energy_drift,
                                          s->unbalanced_max};
            put_value(out, value[k]);
        }
        fputc('\n', out);
    }
}

/* How a run ended, where the end is not that the load has dropped: then the numbers above mean
 * something else than they seem to. */
static void put_end(FILE *out, const struct brc_summary *s)
{
    const struct brc_result *strength = brc_output_result(s, "strength");
    if (!s->is_finished)
        fprintf(out, "%s did not reach the end of the test: ended by %s\n", s->model, s->ended_by);
    else if (strength && !isfinite(strength->value))
        fprintf(out, "%s: ended by %s without a failure\n", s->model, s->ended_by);
    else if (strength && strcmp(s->ended_by, "test.stop_drop") != 0)
        fprintf(out,
                "%s: ended by %s, past its peak, before the load had fallen to test.stop_drop\n",
                s->model, s->ended_by);
}

/* Why a dash stands for a value, or what to know of one; names with the same reason share a line.
 */
static void put_notes(FILE *out, const struct brc_summary *s)
{
    for (int i = 0; i < s->n_results; i++) {
        const char *note = s->results[i].note;
        bool is_told = !note || s->results[i].is_detail;
        for (int k = 0; k < i && !is_told; k++)
            is_told = s->results[k].note && strcmp(s->results[k].note, note) == 0;
        if (is_told)
            continue;
        fprintf(out, "%s: %s", s->model, s->results[i].name);
        for (int k = i + 1; k < s->n_results; k++)
            if (!s->results[k].is_detail && s->results[k].note &&
                strcmp(s->results[k].note, note) == 0)
                fprintf(out, ", %s", s->results[k].name);
        fprintf(out, ": %s\n", note);
    }
}

/* Results first, then what they cost; what makes one doubtful stands below in words, for which no
 * column has room. */
void brc_compare_table(FILE *out, const struct brc_summary *const *summary, int n)
{
    int width = LABEL_WIDTH + n * COLUMN_WIDTH;
    char energy[512];
    fprintf(out, "%s\n", *summary[0]->title ? summary[0]->title : summary[0]->case_name);
    brc_compare_rule(out, width);
    fprintf(out, "%-*s", LABEL_WIDTH, "");
    for (int i = 0; i < n; i++)
        fprintf(out, "%*s", COLUMN_WIDTH, summary[i]->model);
    fputc('\n', out);
    brc_compare_rule(out, width);
    for (int i = 0; i < summary[0]->n_results; i++)
        if (!summary[0]->results[i].is_detail)
            put_result(out, summary, n, &summary[0]->results[i]);
    brc_compare_rule(out, width);
    put_costs(out, summary, n);
    brc_compare_rule(out, width);
    fputs("broken: bonds, or local points where a model has several a contact\n", out);
    for (int i = 0; i < n; i++) {
        put_end(out, summary[i]);
        put_notes(out, summary[i]);
        if (*brc_output_energy(summary[i], energy, sizeof energy))
            fprintf(out, "%s\n", energy);
    }
}
