/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chart, as a gnuplot script with its data in it, so that it can be drawn again without the
 * ladder. Both axes are logarithmic: what counts is by what factor an error falls for a factor of
 * cost. Called by converge.c; it judges nothing. */
#include "common/runs/converge_plot.h"

#include "common/base/text_file.h"
#include "common/output/gnuplot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative error; what is below is drawn there. A logarithm has no zero, and differences below this
 * lie in the uncertainty of the references. */
static const double LEAST = 2e-4; /* relative error; what is below is drawn there */

/* ---- curves -------------------------------------------------------------------------------- */

/* Grains are other specimens, and choices that are the case as written show no difference. What
 * took no time that the clock saw has no place on a logarithmic axis. */
static bool is_drawn(const struct brc_converge_row *row)
{
    bool is_same = row->setting->role == BRC_CONVERGE_CHOICE && row->is_case;
    return row->setting->role != BRC_CONVERGE_GRAINS && !is_same && isfinite(row->error.mean) &&
           row->cpu_s > 0;
}

/* An axis is known by its first row. Whether row i is one, and has something to draw. */
static bool is_curve(const struct brc_converge_report *r, int i)
{
    enum brc_converge_role role = r->row[i].setting->role;
    if (r->rung[i].ladder != i || (role != BRC_CONVERGE_LADDER && role != BRC_CONVERGE_CHOICE))
        return false;
    for (int k = i; k < r->n && r->rung[k].ladder == i; k++)
        if (is_drawn(&r->row[k]))
            return true;
    return false;
}

/* What stands at a point: the value in two digits, or the choice. */
static const char *short_value(const struct brc_converge_setting *s, char text[32])
{
    const char *value = strchr(s->label, '=');
    value = value ? value + 1 : s->label;
    char *end;
    double x = strtod(value, &end);
    if (*end == '\0')
        snprintf(text, 32, "%.2g", x);
    else
        snprintf(text, 32, "%.31s", value);
    return text;
}

/* Block of data: cost, error, its bounds, label. */
static void put_block(FILE *out, const struct brc_converge_report *r, int model, int axis)
{
    char text[32];
    fprintf(out, "$axis_%d_%d << end_of_data\n", model, axis);
    for (int i = axis; i < r->n && r->rung[i].ladder == axis; i++) {
        const struct brc_converge_row *row = &r->row[i];
        if (!is_drawn(row))
            continue;
        double e = fabs(row->error.mean);
        double se = isfinite(row->error.deviation) ? row->error.deviation : 0;
        fprintf(out, "%.6g %.6g %.6g %.6g ", row->cpu_s, 100 * fmax(e, LEAST),
                100 * fmax(e - se, LEAST), 100 * fmax(e + se, LEAST));
        brc_gnuplot_quoted(out, short_value(row->setting, text));
        fputc('\n', out);
    }
    fputs("end_of_data\n", out);
}

/* Ranges over all panels, as the models are to be compared: gnuplot would choose them for each. Up
 * to 20 % at least, so that a ladder of small errors does not look like one of large ones. */
static void put_range(FILE *out, const struct brc_converge_study *study,
                      const struct brc_converge_report *report)
{
    double low = HUGE_VAL, high = 0, most = 0.2;
    for (int i = 0; i < study->n_models; i++)
        for (int k = 0; k < report[i].n; k++) {
            const struct brc_converge_row *row = &report[i].row[k];
            if (!is_drawn(row))
                continue;
            low = fmin(low, row->cpu_s);
            high = fmax(high, row->cpu_s);
            most = fmax(most, fabs(row->error.mean));
        }
    if (high <= 0) /* nothing is drawn */
        low = high = 1;
    fprintf(out, "set xrange [%.4g:%.4g]\nset yrange [%.4g:%.4g]\n", low / 1.5, 1.5 * high,
            100 * LEAST, 150 * most);
}

/* ---- panels -------------------------------------------------------------------------------- */

/* number: of the axis among those that are drawn. */
static void put_curve(FILE *out, const struct brc_converge_report *r, int model, int axis,
                      int number)
{
    static const char *const colours[] = {"#1b4f8f", "#d1570b", "#3a7d2c",
                                          "#7a3b93", "#8c6d1f", "#555555"};
    const struct brc_converge_setting *s = r->row[axis].setting;
    bool is_ladder = s->role == BRC_CONVERGE_LADDER;
    const char *colour = colours[number % 6];
    char name[32];
    snprintf(name, sizeof name, "$axis_%d_%d", model, axis);
    fprintf(out, "  %s using 1:2:3:4 with yerrorbars pt 0 lw 1 lc rgb '%s' notitle, \\\n", name,
            colour);
    fprintf(out, "  %s using 1:2 with %s pt %d ps 1.1 lw 2 lc rgb '%s' title ", name,
            is_ladder ? "linespoints" : "points", is_ladder ? 7 : 6 + 2 * (number % 4), colour);
    brc_gnuplot_quoted(out, s->axis);
    fprintf(out,
            ", \\\n  %s using 1:2:5 with labels font ',8' offset 0,0.7 tc rgb '%s' notitle, \\\n",
            name, colour);
}

/* A single point; gnuplot draws none without a data set, hence the first point of its own. */
static void put_point(FILE *out, const struct brc_converge_row *row, int mark, double size,
                      const char *rgb)
{
    fprintf(out,
            "  '+' every ::0::0 using (%.6g):(%.6g) with points pt %d ps %g lw 2.5 lc rgb '%s' "
            "title ",
            row->cpu_s, 100 * fmax(fabs(row->error.mean), LEAST), mark, size, rgb);
}

/* The case as written, and the cheapest setting within each error, ringed. */
static void put_marks(FILE *out, const struct brc_converge_report *r)
{
    static const char *const ring[] = {"#c0001a", "#e8a000"};
    if (is_drawn(&r->row[BRC_CONVERGE_AT_CASE])) {
        put_point(out, &r->row[BRC_CONVERGE_AT_CASE], 3, 2, "#000000");
        fputs("'as written', \\\n", out);
    }
    for (int k = 0; k < 2; k++) {
        if (r->cheapest[k] < 0)
            continue;
        put_point(out, &r->row[r->cheapest[k]], 6, k ? 3.4 : 2.6, ring[k]);
        fprintf(out, "'cheapest within %g %%', \\\n", 100 * brc_converge_within[k]);
    }
}

/* One model. The grey band is the uncertainty of its reference: errors in it are not told apart.
 * Dashed lines at 1 and 5 %. */
static void put_panel(FILE *out, const struct brc_converge_report *r, int model)
{
    int number = 0;
    double within = fmin(fmax(r->uncertainty, LEAST), 10);
    fputs("set title ", out);
    brc_gnuplot_quoted(out, r->model->model->name);
    fputs("\nunset object\n", out);
    if (isfinite(r->uncertainty))
        fprintf(out,
                "set object 1 rectangle from graph 0, first %.6g to graph 1, first %.6g behind fs "
                "solid 1 noborder fc rgb '#e4e4e4'\n",
                100 * LEAST, 100 * within);
    fputs("plot \\\n", out);
    for (int i = 0; i < r->n; i++)
        if (is_curve(r, i))
            put_curve(out, r, model, i, number++);
    put_marks(out, r);
    fputs("  1 with lines dt 2 lw 1 lc rgb '#888888' notitle, \\\n"
          "  5 with lines dt 2 lw 1 lc rgb '#888888' notitle\n",
          out);
}

int brc_converge_plot(struct brc_context *ctx, const struct brc_converge_study *study,
                      const struct brc_converge_report *report)
{
    static const char *const picture[] = {"converge"};
    const struct brc_case *run_case = study->options->run.run_case;
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, study->options->run.dir, "converge.gp"));
    FILE *out = file.out;
    brc_gnuplot_head(out, "converge", 760 * study->n_models, 660, 12);
    fprintf(out,
            "set logscale xy\nset grid lc rgb '#dddddd' lt 1\nset border 3\nset tics nomirror\n"
            "set key at graph 0.5, graph -0.14 center top horizontal maxrows 3\nset bmargin 8\n"
            "set xlabel 'processor time of a run [s]'\nset ylabel 'error of the %s [%%]'\n",
            study->results[study->observable].name);
    for (int i = 0; i < study->n_models; i++)
        for (int k = 0; k < report[i].n; k++)
            if (is_curve(&report[i], k))
                put_block(out, &report[i], i, k);
    put_range(out, study, report);
    fprintf(out, "set multiplot layout 1,%d title ", study->n_models);
    brc_gnuplot_quoted(out,
                       *run_case->file.head.title ? run_case->file.head.title : run_case->name);
    fputs(" font ',14'\n", out);
    for (int i = 0; i < study->n_models; i++)
        put_panel(out, &report[i], i);
    fputs("unset multiplot\n", out);
    BRC_TRY(brc_text_file_end(ctx, &file));
    return run_case->output.plots ? brc_gnuplot_draw(ctx, study->options->run.dir, picture, 1) : 0;
}
