/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `breccia envelope`: fits to the points of runs, as a table, as CSV and as a picture. All three
 * have the same numbers: what is printed is what is drawn.
 *
 * Direct tension is a point of Hoek and Brown's curve and none of Mohr and Coulomb's line, which
 * has no meaning left of its cut-off: one such point among few would turn the line away from all
 * others. */
#include "calib/envelope_runs.h"

#include "common/base/folders.h"
#include "common/base/text_file.h"
#include "common/output/gnuplot.h"
#include "common/output/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 8, STEPS = 200 };
static const double MPA = 1e-6, DEGREES = 180 / BRC_PI;

/* A fitted value as tables have it. */
struct row {
    const char *law, *name, *unit, *meaning;
    double scale; /* to that unit */
    struct calib_estimate of;
};

struct report {
    const struct calib_envelope_options *options;
    struct calib_runs runs;
    struct calib_peak *point; /* of all runs; compressed ones, then those in tension */
    size_t n_compressed;
    bool has_line, has_curve;
    /* one for each law: that one does not fit is no failure of the other */
    struct brc_context line_ctx, curve_ctx;
    struct calib_mohr_coulomb line;
    struct calib_hoek_brown curve;
    struct row row[MOST_ROWS];
    int n_rows;
};

/* ---- fits ---------------------------------------------------------------------------------- */

/* What this report is of: one of the two states of a run. */
static const struct calib_peak *point_of(const struct report *r, size_t i)
{
    const struct calib_run *run = &r->runs.run[i];
    return r->options->is_residual ? &run->residual : &run->peak;
}

/* Compressed ones first, so that the line's points are the beginning of the curve's. */
static void sort_points(struct report *r)
{
    size_t n = 0;
    for (int tension = 0; tension < 2; tension++) {
        for (size_t i = 0; i < r->runs.n; i++)
            if ((point_of(r, i)->sigma_3 < 0) == tension)
                r->point[n++] = *point_of(r, i);
        r->n_compressed = tension ? r->n_compressed : n;
    }
}

static void add_row(struct report *r, struct row row)
{
    r->row[r->n_rows++] = row;
}

/* Listed once, for the screen and for the file: neither can have a value that the other lacks. */
static void list_rows(struct report *r)
{
    static const char line[] = "Mohr-Coulomb", curve[] = "Hoek-Brown";
    const struct calib_mohr_coulomb *mc = &r->line;
    const struct calib_hoek_brown *hb = &r->curve;
    if (r->has_line) {
        add_row(r, (struct row){line, "c", "MPa", "cohesion", MPA, mc->cohesion});
        add_row(r, (struct row){line, "phi", "deg", "angle of friction", DEGREES, mc->angle});
        add_row(r, (struct row){line, "UCS", "MPa", "sigma_1 at sigma_3 = 0", MPA, mc->strength});
    }
    if (r->has_curve) {
        add_row(r, (struct row){curve, "sigma_ci", "MPa", "sigma_1 at sigma_3 = 0; B of gt12 eq 30",
                                MPA, hb->strength});
        add_row(r, (struct row){curve, "m", "1", "of intact rock, s = 1, a = 1/2", 1, hb->m});
        add_row(r, (struct row){curve, "A", "MPa", "m sigma_ci; A of gt12 eq 30", MPA, hb->a});
    }
}

/* A failure only where neither law fits: a set with two pressures and a tension has a curve and no
 * line. The first law's message is told, as the second one says the same of the same points. */
static int fit(struct brc_context *ctx, struct report *r)
{
    int code = calib_mohr_coulomb_fit(&r->line_ctx, r->point, r->n_compressed, &r->line);
    r->has_line = code == 0;
    r->has_curve = calib_hoek_brown_fit(&r->curve_ctx, r->point, r->runs.n, &r->curve) == 0;
    if (!r->has_line && !r->has_curve)
        return brc_error_set(ctx, code, __FILE__, __LINE__, "%s", r->line_ctx.message);
    list_rows(r);
    return 0;
}

/* ---- the table ----------------------------------------------------------------------------- */

/* A dash and not 0: an unconfined test has a sigma_3 of 0. */
static void print_stress(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, " %9.2f", MPA * value);
    else
        fprintf(out, " %9s", "-");
}

/* Both states of a run, whichever is fitted: the fall from one to the other is what readers ask for
 * next. */
static void print_points(FILE *out, const struct report *r)
{
    int width = 3;
    for (size_t i = 0; i < r->runs.n; i++)
        width = (int)fmax(width, (double)strlen(r->runs.run[i].dir));
    fprintf(out, "%-*s  %-14s %5s %19s %19s\n%-*s  %-14s %5s %9s %9s %9s %9s\n", width, "", "", "",
            "peak [MPa]", "residual [MPa]", width, "run", "test", "seed", "sigma_3", "sigma_1",
            "sigma_3", "sigma_1");
    for (size_t i = 0; i < r->runs.n; i++) {
        const struct calib_run *run = &r->runs.run[i];
        fprintf(out, "%-*s  %-14s %5d", width, run->dir, run->test, run->seed);
        print_stress(out, run->peak.sigma_3);
        print_stress(out, run->peak.sigma_1);
        print_stress(out, run->residual.sigma_3);
        print_stress(out, run->residual.sigma_1);
        fputc('\n', out);
    }
}

/* Also where there is no fit: who asked for two laws is told why there is one. */
static void print_quality(FILE *out, const char *law, bool is_there, double r2, double scatter,
                          size_t n, const char *why)
{
    if (is_there)
        fprintf(out, "%-12s %zu points, R2 %.4f, scatter of sigma_1 %.3g MPa\n", law, n, r2,
                MPA * scatter);
    else
        fprintf(out, "%-12s no fit: %s\n", law, why);
}

/* Intervals beside the values, not errors: with few points a standard error says too little by a
 * factor that readers do not have in mind. */
static void print_fits(FILE *out, const struct report *r)
{
    fprintf(out, "\n%-12s %-8s %9s  %-21s\n", r->options->is_residual ? "residual" : "peak", "",
            "value", "95 % confidence");
    for (int i = 0; i < r->n_rows; i++) {
        const struct row *w = &r->row[i];
        char range[64];
        snprintf(range, sizeof range, "%.4g to %.4g", w->scale * w->of.low, w->scale * w->of.high);
        fprintf(out, "%-12s %-8s %9.4g  %-21s %-3s %s\n", w->law, w->name, w->scale * w->of.value,
                range, w->unit, w->meaning);
    }
    print_quality(out, "Mohr-Coulomb", r->has_line, r->line.r2, r->line.scatter, r->n_compressed,
                  r->line_ctx.message);
    print_quality(out, "Hoek-Brown", r->has_curve, r->curve.r2, r->curve.scatter, r->runs.n,
                  r->curve_ctx.message);
    if (r->has_line && r->n_compressed < r->runs.n)
        fprintf(out, "note: Mohr-Coulomb's line is without the %zu points in tension\n",
                r->runs.n - r->n_compressed);
    if (*r->runs.differ)
        fprintf(out, "note: these are runs of different rock, they differ in %s\n", r->runs.differ);
}

/* ---- files --------------------------------------------------------------------------------- */

/* In SI and with all digits, as in every table for programs; the fits are in the units of the
 * screen, which the file names. */
static int write_points(struct brc_context *ctx, const struct report *r)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, r->options->dir, "envelope.csv"));
    fputs("run,model,test,seed [1],sigma_3 [Pa],sigma_1 [Pa],sigma_3_residual [Pa],"
          "sigma_1_residual [Pa]\n",
          file.out);
    for (size_t i = 0; i < r->runs.n; i++) {
        const struct calib_run *run = &r->runs.run[i];
        brc_output_cell(file.out, run->dir);
        fprintf(file.out, ",%s,%s,%d,%.17g,%.17g,%.17g,%.17g\n", run->model, run->test, run->seed,
                run->peak.sigma_3, run->peak.sigma_1, run->residual.sigma_3, run->residual.sigma_1);
    }
    return brc_text_file_end(ctx, &file);
}

static int write_fits(struct brc_context *ctx, const struct report *r)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, r->options->dir, "envelope_fits.csv"));
    fputs("law,name,unit,value,standard error,low,high,R2\n", file.out);
    for (int i = 0; i < r->n_rows; i++) {
        const struct row *w = &r->row[i];
        bool is_line = strcmp(w->law, "Mohr-Coulomb") == 0;
        fprintf(file.out, "%s,%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g\n", w->law, w->name, w->unit,
                w->scale * w->of.value, w->scale * w->of.error, w->scale * w->of.low,
                w->scale * w->of.high, is_line ? r->line.r2 : r->curve.r2);
    }
    return brc_text_file_end(ctx, &file);
}

/* Laws as tables of points and not as formulas: gnuplot would draw a root left of where it is real
 * as a gap, and the script could not be read without the law. */
static void put_laws(FILE *out, const struct report *r, double low, double high)
{
    const struct calib_mohr_coulomb *mc = &r->line;
    const struct calib_hoek_brown *hb = &r->curve;
    double q = hb->strength.value, m = hb->m.value;
    fputs("$line << end_of_data\n", out);
    for (int i = 0; r->has_line && i < 2; i++)
        fprintf(out, "%.6g %.6g\n", MPA * i * high,
                MPA * (mc->strength.value + mc->slope.value * i * high));
    fputs("end_of_data\n$curve << end_of_data\n", out);
    double first = fmax(low, -q / m);
    for (int i = 0; r->has_curve && i <= STEPS; i++) {
        double s = first + (high - first) * i / STEPS;
        fprintf(out, "%.6g %.6g\n", MPA * s, MPA * (s + sqrt(fmax(m * q * s + q * q, 0))));
    }
    fputs("end_of_data\n", out);
}

/* The script has its data in it and stands beside the picture: it can be changed and drawn again
 * without the runs. */
static int write_picture(struct brc_context *ctx, const struct report *r)
{
    static const char *const name[] = {"envelope"};
    struct brc_text_file file;
    double low = 0, high = 0;
    for (size_t i = 0; i < r->runs.n; i++) {
        low = fmin(low, r->point[i].sigma_3);
        high = fmax(high, r->point[i].sigma_3);
    }
    BRC_TRY(brc_text_file_begin(ctx, &file, r->options->dir, "envelope.gp"));
    FILE *out = file.out;
    brc_gnuplot_head(out, name[0], 900, 700, 13);
    fputs("$points << end_of_data\n", out);
    for (size_t i = 0; i < r->runs.n; i++)
        fprintf(out, "%.6g %.6g\n", MPA * r->point[i].sigma_3, MPA * r->point[i].sigma_1);
    fputs("end_of_data\n", out);
    put_laws(out, r, 1.2 * low, 1.1 * high);
    fprintf(out,
            "set xlabel 'sigma_3 [MPa]'\nset ylabel 'sigma_1 [MPa]'\nset key top left\n"
            "set grid lc rgb '#dddddd'\nplot $points using 1:2 with points pt 7 ps 1.2 lc rgb "
            "'#333333' title '%s'",
            r->options->is_residual ? "residual" : "peak");
    if (r->has_line)
        fputs(", \\\n  $line using 1:2 with lines lw 2 lc rgb '#1b4f8f' title 'Mohr-Coulomb'", out);
    if (r->has_curve)
        fputs(", \\\n  $curve using 1:2 with lines lw 2 lc rgb '#d1570b' title 'Hoek-Brown'", out);
    fputc('\n', out);
    BRC_TRY(brc_text_file_end(ctx, &file));
    return brc_gnuplot_draw(ctx, r->options->dir, name, 1);
}

/* ---- the command --------------------------------------------------------------------------- */

/* Before anything is read: a folder that is taken is told at once. */
static int check_folder(struct brc_context *ctx, const struct calib_envelope_options *o)
{
    static const char *const names[] = {"envelope.csv", "envelope_fits.csv", "envelope.gp",
                                        "envelope.png"};
    if (!o->dir)
        return 0;
    for (size_t i = 0; !o->is_forced && i < sizeof names / sizeof names[0]; i++)
        if (brc_folder_has(o->dir, names[i]))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s already holds %s; replace it with --force, or choose another folder "
                     "with -o",
                     o->dir, names[i]);
    return brc_folder_check_writable(ctx, o->dir);
}

/* After the table is printed: a folder without room loses no fit. */
static int write_files(struct brc_context *ctx, const struct report *r)
{
    if (!r->options->dir)
        return 0;
    BRC_TRY(brc_folder_make(ctx, r->options->dir));
    BRC_TRY(write_points(ctx, r));
    BRC_TRY(write_fits(ctx, r));
    BRC_TRY(write_picture(ctx, r));
    printf("results in %s\n", r->options->dir);
    return 0;
}

/* The points are printed before they are fitted: where that fails, they show why. */
static int make_report(struct brc_context *ctx, struct report *r)
{
    BRC_TRY(calib_runs_read(ctx, r->options, &r->runs));
    r->point = brc_alloc(ctx, r->runs.n, sizeof *r->point);
    if (!r->point)
        return BRC_ERR_MEMORY;
    sort_points(r);
    print_points(stdout, r);
    BRC_TRY(fit(ctx, r));
    print_fits(stdout, r);
    return write_files(ctx, r);
}

int calib_envelope(struct brc_context *ctx, const struct calib_envelope_options *o)
{
    struct report r = {.options = o, .line_ctx = BRC_CONTEXT_INIT, .curve_ctx = BRC_CONTEXT_INIT};
    BRC_TRY(check_folder(ctx, o));
    int code = make_report(ctx, &r);
    calib_runs_free(&r.runs);
    free(r.point);
    return code;
}
