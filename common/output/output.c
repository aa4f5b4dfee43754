/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON and CSV by hand: two dozen keys and plain tables do not need a library. Numbers have 17
 * digits, so that they read back to the same bits, and what was not measured is null, never 0. */
#include "common/output/output.h"

#include "common/base/text_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define BRC_OWNER struct brc_output_params
static const struct brc_param output_params[] = {BRC_PARAM_LIST(BRC_OUTPUT_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_output_param_list =
    BRC_PARAMS(output_params, struct brc_output_params);

enum { CELL_SIZE = 512 };
#define HEADER SIZE_MAX /* the row before row 0 */

/* ---- JSON ---------------------------------------------------------------------------------- */

/* Bytes above 0x7f pass: texts come from a case, which is UTF-8. */
void brc_output_json_text(FILE *out, const char *text)
{
    fputc('"', out);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fprintf(out, "\\%c", *c);
        else if (*c < 0x20)
            fprintf(out, "\\u%04x", *c);
        else
            fputc(*c, out);
    }
    fputc('"', out);
}

/* In digits that read back to the same bits. */
void brc_output_json_number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.17g", value);
    else
        fputs("null", out);
}

static void json_text_entry(FILE *out, const char *name, const char *text)
{
    fprintf(out, "  \"%s\": ", name);
    brc_output_json_text(out, text);
    fputs(",\n", out);
}

static void json_number_entry(FILE *out, const char *name, double value)
{
    fprintf(out, "  \"%s\": ", name);
    brc_output_json_number(out, value);
    fputs(",\n", out);
}

/* Results in the order in which the test declares them, each with the reason where it was not
 * measured: a missing value is to be told from one that the test never has. */
static void json_results(FILE *out, const struct brc_summary *s)
{
    fputs("  \"results\": {", out);
    for (int i = 0; i < s->n_results; i++) {
        const struct brc_result *r = &s->results[i];
        fprintf(out, "%s\n    \"%s\": {\"value\": ", i ? "," : "", r->name);
        brc_output_json_number(out, r->value);
        fputs(", \"unit\": ", out);
        brc_output_json_text(out, r->unit);
        if (r->note) {
            fputs(", \"note\": ", out);
            brc_output_json_text(out, r->note);
        }
        fputc('}', out);
    }
    fputs(s->n_results ? "\n  }\n" : "}\n", out);
}

/* How many frames there are, and the size of the last one: what a viewer has to take at once. */
static void json_frames(FILE *out, const struct brc_summary *s)
{
    fprintf(out, "  \"n_frames\": %zu,\n", s->n_frames);
    if (s->n_frames == 0 || !s->frame[0].name) /* a run that goes on may have written none yet */
        return;
    fputs("  \"last_frame\": {", out);
    for (int k = 0; k < BRC_N_FRAME_KINDS; k++)
        fprintf(out, "%s\n    \"%s\": {\"n_points\": %zu, \"n_cells\": %zu}", k ? "," : "",
                s->frame[k].name, s->frame[k].n_points, s->frame[k].n_cells);
    fputs("\n  },\n", out);
}

/* Where the energy went: null without the ledger, whose zeros would look like values. */
static void json_energy(FILE *out, const char *key, const struct brc_ledger *l, bool is_known)
{
    const char *comma = "";
    fprintf(out, "  \"%s\": {", key);
#define TERM(name, sign, meaning)                          \
    fprintf(out, "%s\n    \"" #name "\": ", comma);        \
    brc_output_json_number(out, is_known ? l->name : NAN); \
    comma = ",";
    BRC_LEDGER_TERMS(TERM)
#undef TERM
    fputs("\n  },\n", out);
}

/* Keys in reading order: what ran, how it ended, how large it was, what it took, whether it can be
 * trusted, what it gave. What of them depends on the machine is only the times. */
int brc_output_summary(struct brc_context *ctx, const char *dir, const char *name,
                       const struct brc_summary *s)
{
    static const char *const checks[] = BRC_ENERGY_CHECKS;
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, name));
    FILE *out = file.out;
    fputs("{\n", out);
    json_text_entry(out, "model", s->model);
    json_text_entry(out, "case", s->case_name);
    json_text_entry(out, "title", s->title);
    fprintf(out, "  \"finished\": %s,\n", s->is_finished ? "true" : "false");
    json_text_entry(out, "ended_by", s->ended_by);
    fprintf(out, "  \"seed\": %d,\n", s->seed);
    json_text_entry(out, "version", BRC_VERSION);
    fprintf(out, "  \"n_grains\": %zu,\n  \"n_facets\": %zu,\n", s->n_grains, s->n_facets);
    fprintf(out, "  \"n_contacts\": %zu,\n  \"n_contacts_listed\": %zu,\n", s->n_contacts,
            s->n_contacts_listed);
    json_number_entry(out, "n_contacts_mean", s->n_contacts_mean);
    fprintf(out, "  \"n_points\": %zu,\n  \"steps\": %" PRId64 ",\n", s->n_points, s->steps);
    fprintf(out, "  \"n_fragments\": %zu,\n", s->n_fragments);
    json_frames(out, s);
    json_number_entry(out, "dt", s->dt);
    json_number_entry(out, "cpu_s", s->cpu_s);
    json_number_entry(out, "wall_s", s->wall_s);
    json_number_entry(out, "ns_per_contact_step", s->ns_per_contact_step);
    json_number_entry(out, "energy_residual", s->energy_residual);
    json_number_entry(out, "energy_drift", s->energy_drift);
    json_text_entry(out, "energy_check", checks[s->energy_check]);
    bool is_on = s->energy_check != BRC_ENERGY_OFF;
    json_energy(out, "energy", &s->ledger, is_on);
    json_energy(out, "energy_at_peak", &s->ledger_at_peak, is_on && s->has_peak);
    json_number_entry(out, "unbalanced_max", s->unbalanced_max);
    fprintf(out, "  \"state_hash\": \"%016" PRIx64 "\",\n", s->state_hash);
    json_results(out, s);
    fputs("}\n", out);
    return brc_text_file_end(ctx, &file);
}

/* The larger of the two errors decides. What to change is part of the sentence: numerics.md says
 * why each helps. */
const char *brc_output_energy(const struct brc_summary *s, char *text, size_t size)
{
    bool is_drift = s->energy_drift > s->energy_residual;
    bool is_wrong = s->energy_check == BRC_ENERGY_WRONG;
    *text = '\0';
    if (is_wrong || s->energy_check == BRC_ENERGY_DOUBTFUL)
        snprintf(text, size,
                 "%s: energy %s of %.3g of the work (above %g %s): take a smaller step "
                 "(run.mass_margin higher, dynamic: run.dt_margin lower), load more slowly "
                 "(test.target, test.rate) or, for polyhedra, raise polyhedra.radius "
                 "or choose features: merged",
                 s->model, is_drift ? "drift" : "residual",
                 is_drift ? s->energy_drift : s->energy_residual,
                 is_wrong ? BRC_ENERGY_ERROR : BRC_ENERGY_DOUBT,
                 is_wrong ? "the results are wrong" : "the results are doubtful");
    return text;
}

const struct brc_result *brc_output_result(const struct brc_summary *s, const char *name)
{
    for (int i = 0; i < s->n_results; i++)
        if (strcmp(s->results[i].name, name) == 0)
            return &s->results[i];
    return NULL;
}

/* ---- CSV ----------------------------------------------------------------------------------- */

/* By RFC 4180, which readers of CSV agree on: quotes around, quotes within doubled. */
void brc_output_cell(FILE *out, const char *text)
{
    if (!strpbrk(text, ",\"\r\n")) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text; text++)
        fprintf(out, *text == '"' ? "\"%c" : "%c", *text);
    fputc('"', out);
}

/* One line: the values of a row, or the names of the columns. Names are quoted as any text, since a
 * unit may hold a comma ("N, N m"). */
static void csv_line(FILE *out, const struct brc_table *t, size_t row, const char **comma)
{
    char cell[CELL_SIZE];
    for (int i = 0; i < t->set.n; i++) {
        const struct brc_field *f = &t->set.fields[i];
        int width = brc_table_saves(t, i) ? f->width : 0;
        for (int j = 0; j < width; j++) {
            fputs(*comma, out);
            *comma = ",";
            if (row != HEADER) {
                fprintf(out, "%.17g", brc_table_number(t, i, row * (size_t)width + (size_t)j));
                continue;
            }
            if (width == 1)
                snprintf(cell, sizeof cell, "%s [%s]", f->name, f->unit);
            else
                snprintf(cell, sizeof cell, "%s_%d [%s]", f->name, j + 1, f->unit);
            brc_output_cell(out, cell);
        }
    }
}

/* Two tables side by side are the curve's shared columns and those of its test. */
void brc_output_table(FILE *out, const struct brc_table *t, const struct brc_table *beside)
{
    for (size_t row = HEADER; row == HEADER || row < t->n; row++) {
        const char *comma = "";
        csv_line(out, t, row, &comma);
        if (beside)
            csv_line(out, beside, row, &comma);
        fputc('\n', out);
    }
}

int brc_output_csv(struct brc_context *ctx, const char *dir, const char *name,
                   const struct brc_table *t, const struct brc_table *beside)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, name));
    brc_output_table(file.out, t, beside);
    return brc_text_file_end(ctx, &file);
}
