/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Data stand in the script, so that it can be drawn again without the sweep. A row of panels a
 * group, a panel a result; curves are the other axes. Called by sweep.c. */
#include "common/runs/sweep_plot.h"

#include "common/base/text_file.h"
#include "common/output/gnuplot.h"
#include "common/runs/compare.h"
#include "common/runs/sweep_cells.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PANELS = 4, MAX_CURVES = 8, MAX_ROWS = 6 };

/* The cells of a group that are drawn. */
struct row {
    size_t first, end;
    size_t axis; /* the one along x */
    int n;
    const struct brc_quantity *shown[MAX_PANELS];
};

/* "0.5x", "3 MPa": the number that a label begins with. */
static bool is_number(const char *label)
{
    char *end;
    double value = strtod(label, &end);
    return end != label && isfinite(value);
}

/* The last axis whose values are all numbers; false: there is none. */
static bool find_axis(const struct brc_sweep_group *g, size_t *axis)
{
    for (size_t a = g->n_axes; a-- > 0;) {
        bool is = !g->axis[a].is_over && g->axis[a].n > 1;
        for (size_t i = 0; i < g->axis[a].n; i++)
            is = is && is_number(g->axis[a].value[i].label);
        *axis = a;
        if (is)
            return true;
    }
    return false;
}

/* What distinguishes the curve of a cell: its other axes. */
static const char *curve_name(const struct brc_sweep_run *run, size_t axis, char *text, size_t size)
{
    const struct brc_sweep_group *g = run->group;
    size_t n = 0;
    text[0] = '\0';
    for (size_t a = 0; a < g->n_axes && n < size; a++)
        if (a != axis && !g->axis[a].is_over)
            n += (size_t)snprintf(text + n, size - n, "%s%s", n ? ", " : "",
                                  g->axis[a].value[run->at[a]].label);
    return text;
}

/* The curves of a row by the cells that they begin with; how many. */
static int list_curves(const struct brc_sweep_cells *c, const struct row *r,
                       size_t curve[MAX_CURVES])
{
    char name[2][200];
    int n = 0;
    for (size_t k = r->first; k < r->end && n < MAX_CURVES; k++) {
        int i = 0;
        curve_name(c->cell[k].run[0], r->axis, name[0], sizeof name[0]);
        while (i < n &&
               strcmp(curve_name(c->cell[curve[i]].run[0], r->axis, name[1], sizeof name[1]),
                      name[0]) != 0)
            i++;
        if (i == n)
            curve[n++] = k;
    }
    return n;
}

/* x, mean, and the interval; a single value is its own. False where there is nothing. */
static bool put_data(FILE *out, struct brc_sweep_cells *c, const struct row *r, size_t curve,
                     const struct brc_quantity *q, double factor)
{
    char name[2][200];
    bool has_any = false;
    curve_name(c->cell[curve].run[0], r->axis, name[0], sizeof name[0]);
    for (size_t k = curve; k < r->end; k++) {
        const struct brc_sweep_run *run = c->cell[k].run[0];
        struct brc_sweep_mean m = brc_sweep_cell_mean(c, &c->cell[k], q->name);
        if (m.n == 0 || strcmp(curve_name(run, r->axis, name[1], sizeof name[1]), name[0]) != 0)
            continue;
        bool has_interval = isfinite(m.low);
        fprintf(out, "%.9g %.9g %.9g %.9g\n",
                strtod(run->group->axis[r->axis].value[run->at[r->axis]].label, NULL),
                factor * m.mean, factor * (has_interval ? m.low : m.mean),
                factor * (has_interval ? m.high : m.mean));
        has_any = true;
    }
    return has_any;
}

static void put_label(FILE *out, const char *what, const char *text)
{
    fprintf(out, "set %s ", what);
    brc_gnuplot_quoted(out, text);
    fputc('\n', out);
}

static struct brc_shown put_labels(FILE *out, struct brc_sweep_cells *c, const struct row *r,
                                   const struct brc_quantity *q)
{
    const struct brc_sweep_group *g = c->cell[r->first].run[0]->group;
    char name[200];
    double most = 0;
    for (size_t k = r->first; k < r->end; k++)
        most = fmax(most, fabs(brc_sweep_cell_mean(c, &c->cell[k], q->name).mean));
    struct brc_shown unit = brc_compare_unit(q->name, q->unit, most);
    snprintf(name, sizeof name, *unit.unit ? "%s [%s]" : "%s", q->name, unit.unit);
    put_label(out, "ylabel", name);
    put_label(out, "xlabel", g->axis[r->axis].name);
    put_label(out, "title", g->name);
    return unit;
}

/* A panel without a value stays empty: the others keep their places. */
static void put_panel(FILE *out, struct brc_sweep_cells *c, const struct row *r,
                      const struct brc_quantity *q)
{
    static const char *const colour[MAX_CURVES] = {"#1b4f8f", "#d1570b", "#3a7d2c", "#7a3b93",
                                                   "#8c6d1f", "#555555", "#c0001a", "#159a9c"};
    size_t curve[MAX_CURVES];
    bool has[MAX_CURVES], has_any = false;
    char name[200];
    struct brc_shown unit = put_labels(out, c, r, q);
    int n = list_curves(c, r, curve);
    for (int i = 0; i < n; i++) {
        fprintf(out, "$curve_%d << end_of_data\n", i);
        has[i] = put_data(out, c, r, curve[i], q, unit.factor);
        has_any = has_any || has[i];
        fputs("end_of_data\n", out);
    }
    fputs(has_any ? "plot" : "set multiplot next\n", out);
    for (int i = 0; i < n && has_any; i++) {
        if (!has[i])
            continue;
        fprintf(out,
                " \\\n  $curve_%d using 1:2:3:4 with yerrorbars pt 0 lw 1.5 lc rgb '%s' notitle,"
                " \\\n  $curve_%d using 1:2 with linespoints pt 7 ps 1.1 lw 2 lc rgb '%s' title ",
                i, colour[i], i, colour[i]);
        brc_gnuplot_quoted(out, curve_name(c->cell[curve[i]].run[0], r->axis, name, sizeof name));
        fputc(',', out);
    }
    fputc('\n', out);
}

/* The groups that have an axis of numbers. */
static int find_rows(struct brc_sweep_cells *c, struct row row[MAX_ROWS])
{
    int n = 0;
    for (size_t first = 0, end; first < c->n && n < MAX_ROWS; first = end) {
        const struct brc_sweep_run *run = c->cell[first].run[0];
        for (end = first; end < c->n && c->cell[end].run[0]->group == run->group;)
            end++;
        row[n] = (struct row){.first = first, .end = end};
        row[n].n = brc_sweep_shown(run, row[n].shown, MAX_PANELS);
        if (row[n].n > 0 && find_axis(run->group, &row[n].axis))
            n++;
    }
    return n;
}

static int draw(struct brc_sweep_cells *c, const char *dir)
{
    static const char *const picture[] = {"sweep"};
    struct row row[MAX_ROWS];
    struct brc_text_file file;
    int n = find_rows(c, row), most = 0;
    for (int i = 0; i < n; i++)
        most = row[i].n > most ? row[i].n : most;
    if (n == 0)
        return 0;
    BRC_TRY(brc_text_file_begin(c->ctx, &file, dir, "sweep.gp"));
    brc_gnuplot_head(file.out, "sweep", 460 * most, 400 * n, 11);
    fprintf(file.out,
            "set grid lc rgb '#dddddd' lt 1\nset border 3\nset tics nomirror\nset key top left\n"
            "set offsets graph 0.05, graph 0.05, graph 0.2, graph 0.05\n"
            "set multiplot layout %d,%d\n",
            n, most);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < most; k++) {
            if (k < row[i].n)
                put_panel(file.out, c, &row[i], row[i].shown[k]);
            else
                fputs("set multiplot next\n", file.out);
        }
    fputs("unset multiplot\n", file.out);
    BRC_TRY(brc_text_file_end(c->ctx, &file));
    return brc_gnuplot_draw(c->ctx, dir, picture, 1);
}

int brc_sweep_plot(struct brc_context *ctx, const struct brc_sweep_runs *runs, const char *dir)
{
    struct brc_sweep_cells c;
    int code = brc_sweep_cells_make(ctx, runs, &c);
    if (code == 0)
        code = draw(&c, dir);
    brc_sweep_cells_free(&c);
    return code;
}
