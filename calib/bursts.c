/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two readings of one word. gt12 counts breaks in equal spans and draws a line through the
 * histogram of these counts (its Fig 24): a rate, whose exponent hangs on the span. An avalanche is
 * a number of breaks that follow each other without a quiet gap: the relaxation of one step of the
 * load, and what theory has exponents for. Gaps are in steps, as in the quasi-static regime a step
 * is a step of relaxation and time has no meaning; spans are parts of the strain of a run. */
#include "calib/bursts.h"

#include "calib/power_law.h"
#include "common/base/folders.h"
#include "common/base/input_file.h"
#include "common/base/text_file.h"

#include <gsl/gsl_fit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N_SPANS = 3, N_GAPS = 3, MOST_CLASSES = 64, RESAMPLES = 100, LARGEST = 1 << 28 };
static const double SPANS[N_SPANS] = {1e-3, 3e-3, 1e-2}; /* of the strain of the run */
static const long GAPS[N_GAPS] = {10, 30, 100};          /* steps */

/* A row in which bonds have broken. */
struct row {
    int run;
    long step, breaks; /* breaks since the row before */
    double strain;     /* over that of the run's end */
};

struct bursts {
    struct row *row;
    size_t n, room;
    int n_runs;
    long n_breaks;
};

/* ---- reading ------------------------------------------------------------------------------- */

/* Places of the columns; run: -1 in a run's own curve. */
struct columns {
    int run, step, strain, broken;
};

static int column_of(const char *head, const char *name)
{
    size_t n = strlen(name);
    int column = 0;
    for (const char *at = head; at; at = strchr(at, ','), at = at ? at + 1 : NULL, column++)
        if (strncmp(at, name, n) == 0 && (at[n] == ' ' || at[n] == ',' || at[n] == '\0'))
            return column;
    return -1;
}

static double number_at(const char *line, int column)
{
    for (; line && column > 0; column--) {
        line = strchr(line, ',');
        line = line ? line + 1 : NULL;
    }
    return line ? strtod(line, NULL) : NAN;
}

static int add(struct brc_context *ctx, struct bursts *b, struct row row)
{
    if (b->n == b->room) {
        size_t room = 2 * b->room + 1024;
        struct row *more = realloc(b->row, room * sizeof *more);
        if (!more)
            BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory for %zu rows of breaks", room);
        b->row = more;
        b->room = room;
    }
    b->row[b->n++] = row;
    b->n_breaks += row.breaks;
    return 0;
}

/* Strains of the run that has been read, over that of its end. */
static void end_run(struct bursts *b, size_t first, double end)
{
    for (size_t i = first; i < b->n; i++)
        b->row[i].strain /= end;
    b->n_runs++;
}

static int read_lines(struct brc_context *ctx, struct bursts *b, const char *path, char *text)
{
    char *line = strtok(text, "\r\n");
    struct columns c = {line ? column_of(line, "run") : -1, line ? column_of(line, "step") : -1,
                        line ? column_of(line, "strain") : -1,
                        line ? column_of(line, "broken") : -1};
    double run = NAN, end = 0;
    long before = 0;
    size_t first = b->n;
    if (c.step < 0 || c.strain < 0 || c.broken < 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s:1: no columns step, strain and broken, as curve.csv of a run has them", path);
    for (size_t number = 2; (line = strtok(NULL, "\r\n")); number++) {
        double of = c.run < 0 ? 0 : number_at(line, c.run), strain = number_at(line, c.strain);
        double broken = number_at(line, c.broken), step = number_at(line, c.step);
        if (!isfinite(of + strain + broken + step) || fabs(broken) > 1e15 || fabs(step) > 1e15)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "%s:%zu: not four numbers", path, number);
        if (of != run && !isnan(run)) {
            end_run(b, first, end);
            first = b->n;
            before = 0;
        }
        run = of;
        if ((long)broken > before)
            BRC_TRY(
                add(ctx, b, (struct row){b->n_runs, (long)step, (long)broken - before, strain}));
        before = (long)broken;
        end = strain;
    }
    if (!isnan(run))
        end_run(b, first, end);
    return 0;
}

static int read_run(struct brc_context *ctx, struct bursts *b, const char *name)
{
    char path[BRC_PATH_SIZE], *text;
    size_t n = strlen(name);
    const struct brc_input in = {
        .noun = "the breaks of a run", .path = path, .largest = LARGEST, .is_plain = true};
    if (n > 4 && strcmp(name + n - 4, ".csv") == 0)
        snprintf(path, sizeof path, "%s", name);
    else
        BRC_TRY(brc_folder_path(ctx, name, "curve.csv", path));
    BRC_TRY(brc_input_read(ctx, &in, &text, &n));
    int code = read_lines(ctx, b, path, text);
    free(text);
    return code;
}

/* ---- the paper's histogram ----------------------------------------------------------------- */

struct line {
    double exponent, error, r2;
    int n_classes;
    double at[MOST_CLASSES],
        part[MOST_CLASSES]; /* counts, and spans a unit of counts, as logarithms */
};

/* Spans of each run by their number of breaks; those without are left out, as a logarithm has to.
 * Classes of counts grow by the square root of two, and what is drawn is spans a count. */
static int fit_histogram(struct brc_context *ctx, const struct bursts *b, double span,
                         struct line *out)
{
    size_t n_spans = (size_t)(1 / span) + 2;
    long *count = brc_alloc(ctx, n_spans * (size_t)b->n_runs, sizeof *count);
    double n_of[MOST_CLASSES] = {0}, cov[3], left, offset;
    if (!count)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < b->n; i++) {
        double at = fmin(fmax(b->row[i].strain / span, 0), (double)n_spans - 1);
        count[(size_t)b->row[i].run * n_spans + (size_t)at] += b->row[i].breaks;
    }
    for (size_t i = 0; i < n_spans * (size_t)b->n_runs; i++)
        if (count[i] > 0) {
            int class = (int)(2 * log2((double)count[i]) + 1e-9);
            n_of[class < MOST_CLASSES ? class : MOST_CLASSES - 1]++;
        }
    free(count);
    *out = (struct line){.exponent = NAN, .error = NAN, .r2 = NAN};
    for (int k = 0; k < MOST_CLASSES; k++) {
        /* whole numbers in the class: the small ones have one or none */
        double low = ceil(pow(2, 0.5 * k) - 1e-9), high = ceil(pow(2, 0.5 * (k + 1)) - 1e-9);
        if (n_of[k] > 0 && high > low) {
            out->at[out->n_classes] = 0.5 * (log(low) + log(high - 1));
            out->part[out->n_classes++] = log(n_of[k] / (high - low));
        }
    }
    if (out->n_classes < 3)
        return 0;
    size_t n = (size_t)out->n_classes;
    gsl_fit_linear(out->at, 1, out->part, 1, n, &offset, &out->exponent, &cov[0], &cov[1], &cov[2],
                   &left);
    double mean = 0, all = 0;
    for (size_t i = 0; i < n; i++)
        mean += out->part[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        all += (out->part[i] - mean) * (out->part[i] - mean);
    out->error = sqrt(cov[2]);
    out->r2 = 1 - left / all;
    return 0;
}

/* ---- avalanches ---------------------------------------------------------------------------- */

static int fit_avalanches(struct brc_context *ctx, const struct bursts *b, long gap,
                          struct calib_power_law *law, size_t *n, long *largest)
{
    long *size = brc_alloc(ctx, b->n ? b->n : 1, sizeof *size);
    if (!size)
        return BRC_ERR_MEMORY;
    *n = 0;
    for (size_t i = 0; i < b->n; i++) {
        bool goes_on = i > 0 && b->row[i].run == b->row[i - 1].run &&
                       b->row[i].step - b->row[i - 1].step <= gap;
        if (!goes_on)
            size[(*n)++] = 0;
        size[*n - 1] += b->row[i].breaks;
    }
    *largest = 0;
    for (size_t i = 0; i < *n; i++)
        *largest = size[i] > *largest ? size[i] : *largest;
    int code = calib_power_law_fit(ctx, size, *n, RESAMPLES, law);
    free(size);
    return code;
}

/* ---- what is told -------------------------------------------------------------------------- */

static void tell_histogram(FILE *out, FILE *table, double span, const struct line *l)
{
    fprintf(out, "spans of %.1f %% of the strain: exponent %.3f +- %.3f, R2 %.3f, %d classes\n",
            100 * span, l->exponent, l->error, l->r2, l->n_classes);
    if (table)
        fprintf(table, "histogram,%g,%.17g,%.17g,%.17g,,,,\n", span, l->exponent, l->error, l->r2);
}

static void tell_avalanches(FILE *out, FILE *table, long gap, const struct calib_power_law *l,
                            size_t n, long largest)
{
    fprintf(
        out,
        "gaps of %ld steps: %zu avalanches, the largest of %ld breaks; exponent %.3f +- %.3f from "
        "%ld on (%zu), p %.2f; against a lognormal: log likelihood %+.1f, p %.2g\n",
        gap, n, largest, l->exponent, l->error, l->x_min, l->n_tail, l->p, l->ratio, l->ratio_p);
    if (table)
        fprintf(table, "avalanches,%ld,%.17g,%.17g,,%ld,%zu,%.17g,%.17g,%.17g\n", gap, l->exponent,
                l->error, l->x_min, l->n_tail, l->p, l->ratio, l->ratio_p);
}

static int fit_all(struct brc_context *ctx, const struct bursts *b, FILE *table, FILE *histogram)
{
    printf("%ld breaks of %d runs\n", b->n_breaks, b->n_runs);
    for (int k = 0; k < N_SPANS; k++) {
        struct line line;
        BRC_TRY(fit_histogram(ctx, b, SPANS[k], &line));
        tell_histogram(stdout, table, SPANS[k], &line);
        for (int i = 0; histogram && i < line.n_classes; i++)
            fprintf(histogram, "%g,%.6g,%.6g\n", SPANS[k], exp(line.at[i]), exp(line.part[i]));
    }
    for (int k = 0; k < N_GAPS; k++) {
        struct calib_power_law law;
        struct brc_context quiet =
            BRC_CONTEXT_INIT; /* that one is too few is no failure of the others */
        size_t n;
        long largest;
        int code = fit_avalanches(&quiet, b, GAPS[k], &law, &n, &largest);
        if (code == BRC_ERR_INPUT)
            printf("gaps of %ld steps: %s\n", GAPS[k], quiet.message);
        else if (code != 0)
            BRC_FAIL(ctx, code, "%s", quiet.message);
        else
            tell_avalanches(stdout, table, GAPS[k], &law, n, largest);
    }
    return 0;
}

/* Rows with breaks alone, which are few; the last one of a run says where its strain ends. */
static int write_pack(struct brc_context *ctx, const struct bursts *b, const char *path)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, NULL, path));
    fputs("run,step [1],strain [1],broken [1]\n", file.out);
    long broken = 0;
    for (size_t i = 0; i < b->n; i++) {
        bool is_first = i == 0 || b->row[i].run != b->row[i - 1].run;
        bool is_last = i + 1 == b->n || b->row[i + 1].run != b->row[i].run;
        broken = is_first ? b->row[i].breaks : broken + b->row[i].breaks;
        fprintf(file.out, "%d,%ld,%.6g,%ld\n", b->row[i].run, b->row[i].step, b->row[i].strain,
                broken);
        if (is_last)
            fprintf(file.out, "%d,%ld,1,%ld\n", b->row[i].run, b->row[i].step, broken);
    }
    return brc_text_file_end(ctx, &file);
}

static int write_files(struct brc_context *ctx, const struct bursts *b, const char *dir)
{
    struct brc_text_file table, histogram;
    BRC_TRY(brc_folder_make(ctx, dir));
    BRC_TRY(brc_text_file_begin(ctx, &table, dir, "bursts.csv"));
    int code = brc_text_file_begin(ctx, &histogram, dir, "bursts_histogram.csv");
    if (code != 0) {
        brc_text_file_drop(&table);
        return code;
    }
    fputs("of,span or gap,exponent,standard error,R2,x_min,n,p,log likelihood ratio,its p\n",
          table.out);
    fputs("span [1],breaks [1],spans [1]\n", histogram.out);
    code = fit_all(ctx, b, table.out, histogram.out);
    if (code != 0) {
        brc_text_file_drop(&table);
        brc_text_file_drop(&histogram);
        return code;
    }
    BRC_TRY(brc_text_file_end(ctx, &table));
    BRC_TRY(brc_text_file_end(ctx, &histogram));
    printf("results in %s\n", dir);
    return 0;
}

static int make_report(struct brc_context *ctx, const struct calib_bursts_options *o,
                       struct bursts *b)
{
    for (size_t i = 0; i < o->n; i++)
        BRC_TRY(read_run(ctx, b, o->run[i]));
    if (b->n_breaks == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "no bond has broken in these %d runs", b->n_runs);
    if (o->pack)
        BRC_TRY(write_pack(ctx, b, o->pack));
    return o->dir ? write_files(ctx, b, o->dir) : fit_all(ctx, b, NULL, NULL);
}

int calib_bursts(struct brc_context *ctx, const struct calib_bursts_options *o)
{
    struct bursts b = {0};
    if (o->dir && !o->is_forced && brc_folder_has(o->dir, "bursts.csv"))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s already holds bursts.csv; replace it with --force, or choose another folder "
                 "with -o",
                 o->dir);
    int code = make_report(ctx, o, &b);
    free(b.row);
    return code;
}
