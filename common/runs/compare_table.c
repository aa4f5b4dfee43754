/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table for readers: units by the size of the values, one for a row, so that columns compare.
 */
#include "common/runs/compare.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_WIDTH = 26, COLUMN_WIDTH = 16, MAX_ROWS_OF_RESULTS = 64 };

struct brc_shown brc_compare_unit(const char *name, const char *unit, double largest)
{
    if (strcmp(unit, "Pa") == 0)
        return largest >= 1e9 ? (struct brc_shown){1e-9, "GPa"} : (struct brc_shown){1e-6, "MPa"};
    if (strcmp(unit, "N") == 0)
        return (struct brc_shown){1e-3, "kN"};
    if (strncmp(name, "strain", 6) == 0)
        return (struct brc_shown){100, "%"};
    return (struct brc_shown){1, strcmp(unit, "1") == 0 ? "" : unit};
}

static void put_label(FILE *out, const char *name, const char *unit)
{
    char label[96];
    snprintf(label, sizeof label, "%s%s%s%s", name, *unit ? " [" : "", unit, *unit ? "]" : "");
    for (char *c = label; *c && *c != '['; c++)
        if (*c == '_')
            *c = ' ';
    fprintf(out, "%-*s", LABEL_WIDTH, label);
}

/* Four digits; whole numbers as such; a dash for what was not measured. */
static void put_value(FILE *out, double value)
{
    char text[32];
    if (!isfinite(value))
        snprintf(text, sizeof text, "-");
    else if (value == floor(value) && fabs(value) < 1e15)
        snprintf(text, sizeof text, "%.0f", value);
    else if (fabs(value) >= 1e-3 && fabs(value) < 1e5)
        snprintf(text, sizeof text, "%.*f",
                 3 - (int)floor(log10(fabs(value)) + 1e-9) > 0
                     ? 3 - (int)floor(log10(fabs(value)) + 1e-9)
                     : 0,
                 value);
    else
        snprintf(text, sizeof text, "%.3e", value);
    fprintf(out, "%*s", COLUMN_WIDTH, text);
}

static void put_result(FILE *out, const struct brc_summary *const *summary, int n,
                       const struct brc_summary_value *row)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const struct brc_summary_value *r = brc_output_result(summary[i], row->name);
        if (r && isfinite(r->value))
            largest = fmax(largest, fabs(r->value));
    }
    struct brc_shown shown = brc_compare_unit(row->name, row->unit, largest);
    put_label(out, row->name, shown.unit);
    for (int i = 0; i < n; i++) {
        const struct brc_summary_value *r = brc_output_result(summary[i], row->name);
        put_value(out, r ? shown.factor * r->value : NAN);
    }
    fputc('\n', out);
}

static void put_rule(FILE *out, int n)
{
    for (int i = 0; i < LABEL_WIDTH + n * COLUMN_WIDTH; i++)
        fputc('-', out);
    fputc('\n', out);
}

/* Rows that every test has. */
static double cost_value(const struct brc_summary *s, int row)
{
    const double value[] = {(double)s->n_grains, s->n_contacts_mean, (double)s->n_points,
                            (double)s->steps,    s->cpu_s,           s->ns_per_contact_step,
                            s->energy_residual,  s->energy_drift,    s->unbalanced_max};
    return value[row];
}

static void put_costs(FILE *out, const struct brc_summary *const *summary, int n)
{
    static const struct {
        const char *name, *unit;
        bool is_whole;
    } row[] = {{"grains", "", true},
               {"active contacts, mean", "", true},
               {"points", "", true},
               {"steps", "", true},
               {"CPU", "s", false},
               {"per contact and step", "ns", false},
               {"energy residual", "", false},
               {"energy drift", "", false},
               {"unbalanced, largest", "", false}};
    for (int k = 0; k < (int)(sizeof row / sizeof row[0]); k++) {
        put_label(out, row[k].name, row[k].unit);
        for (int i = 0; i < n; i++) {
            double value = cost_value(summary[i], k);
            put_value(out, row[k].is_whole ? round(value) : value);
        }
        fputc('\n', out);
    }
}

/* How a run ended, where the end is not that the load has dropped. */
static void put_end(FILE *out, const struct brc_summary *s)
{
    const struct brc_summary_value *strength = brc_output_result(s, "strength");
    if (!s->is_finished)
        fprintf(out, "%s did not reach the end of the test: ended by %s\n", s->model, s->ended_by);
    else if (strength && !isfinite(strength->value))
        fprintf(out, "%s: ended by %s without a failure\n", s->model, s->ended_by);
    else if (strength && strcmp(s->ended_by, "test.stop_drop") != 0)
        fprintf(out,
                "%s: ended by %s, past its peak, before the load had fallen to test.stop_drop\n",
                s->model, s->ended_by);
}

/* Why a dash stands for a value; names with the same reason share a line. */
static void put_notes(FILE *out, const struct brc_summary *s)
{
    for (int i = 0; i < s->n_results; i++) {
        const char *note = s->results[i].note;
        bool is_told = !note;
        for (int k = 0; k < i && !is_told; k++)
            is_told = s->results[k].note && strcmp(s->results[k].note, note) == 0;
        if (is_told)
            continue;
        fprintf(out, "%s: %s", s->model, s->results[i].name);
        for (int k = i + 1; k < s->n_results; k++)
            if (s->results[k].note && strcmp(s->results[k].note, note) == 0)
                fprintf(out, ", %s", s->results[k].name);
        fprintf(out, ": %s\n", note);
    }
}

static void put_energy(FILE *out, const struct brc_summary *s)
{
    char text[512];
    if (*brc_output_energy(s, text, sizeof text))
        fprintf(out, "%s\n", text);
}

void brc_compare_table(FILE *out, const struct brc_summary *const *summary, int n)
{
    fprintf(out, "%s\n", *summary[0]->title ? summary[0]->title : summary[0]->case_name);
    put_rule(out, n);
    fprintf(out, "%-*s", LABEL_WIDTH, "");
    for (int i = 0; i < n; i++)
        fprintf(out, "%*s", COLUMN_WIDTH, summary[i]->model);
    fputc('\n', out);
    put_rule(out, n);
    for (int i = 0; i < summary[0]->n_results; i++)
        put_result(out, summary, n, &summary[0]->results[i]);
    put_rule(out, n);
    put_costs(out, summary, n);
    put_rule(out, n);
    fputs("broken: bonds, or local points where a model has several a contact\n", out);
    for (int i = 0; i < n; i++) {
        put_end(out, summary[i]);
        put_notes(out, summary[i]);
        put_energy(out, summary[i]);
    }
}
