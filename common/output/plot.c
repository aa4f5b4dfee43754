/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts of gnuplot with the data of cracks in them: pictures can be drawn again, or changed,
 * without breccia. Facets are drawn, not grains: what matters is where the specimen has broken.
 * Called by runs/run.c for one run and runs/compare.c for several side by side; knows of a test
 * only the view that it declares. Pictures for a look at the whole; for all else there are frames.
 */
#include "common/output/plot.h"

#include "common/base/text_file.h"
#include "common/output/frame_mesh.h"
#include "common/output/gnuplot.h"
#include "common/geometry/edges.h"
#include "common/geometry/vec.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N_SHADES = 5 };

static const double MM = 1e3; /* pictures are in mm */
/* of a run's panel in a picture of cracks, in heights of the picture */
#define PANEL_WIDTH  0.75
#define PANEL_HEIGHT 0.80

/* ---- broken area --------------------------------------------------------------------------- */

/* The rows of the curve, so that the two can be drawn, and read, side by side. Facets on the
 * boundary cannot break, but at a platen that grips; they are no part of the whole. */
int brc_plot_broken(struct brc_context *ctx, const char *dir, const struct brc_sim *sim)
{
    const struct brc_curve *curve = &sim->rig.curve;
    const struct brc_events *e = &sim->events;
    size_t k = 0, n_inner;
    double sum[BRC_N_MODES] = {0};
    double all = brc_facets_inner_area(&sim->specimen->facets, &n_inner);
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, "broken.csv"));
    fputs("step [1],strain [1],tension [1],shear [1],torsion [1]\n", file.out);
    for (size_t i = 0; i < curve->table.n; i++) {
        for (; k < e->table.n && e->step[k] <= curve->step[i]; k++)
            sum[e->mode[k]] += e->area[k] / all;
        fprintf(file.out, "%" PRId64 ",%.17g,%.17g,%.17g,%.17g\n", curve->step[i], curve->strain[i],
                sum[BRC_MODE_TENSION], sum[BRC_MODE_SHEAR], sum[BRC_MODE_TORSION]);
    }
    return brc_text_file_end(ctx, &file);
}

/* ---- cracks -------------------------------------------------------------------------------- */

/* Angles of gnuplot's `set view`, and the direction towards the viewer. */
struct view {
    double tilt, turn; /* degrees */
    double to_eye[3], to_light[3];
};

/* From the side, or from above where what breaks is seen there, as in a disc that is loaded across
 * its face; the case may say otherwise. The light comes from beside the eye, so that faces differ
 * in shade. */
static struct view choose_view(const struct brc_output_params *output,
                               const struct brc_rig_view *of_test)
{
    bool top = output->view == BRC_VIEW_TOP ||
               (output->view == BRC_VIEW_AUTO && of_test && of_test->is_from_above);
    struct view v = {.tilt = top ? 16 : 76, .turn = top ? 0 : 28};
    double a = v.tilt * BRC_PI / 180, b = v.turn * BRC_PI / 180;
    brc_set(v.to_eye, sin(a) * sin(b), -sin(a) * cos(b), cos(a));
    a -= 0.5;
    b -= 0.6;
    brc_set(v.to_light, sin(a) * sin(b), -sin(a) * cos(b), cos(a));
    return v;
}

/* Broken facets: their mode (-1: not drawn), how many there are and how many are drawn. Counted by
 * mode, since the legend is. */
struct cracks {
    int8_t *mode; /* [n_facets] */
    size_t n_broken[BRC_N_MODES], n_drawn[BRC_N_MODES];
    double area[BRC_N_MODES]; /* m2, broken */
};

/* How far the two sides of an inner facet have moved against each other at its centroid; slip
 * counts as opening does. */
static double facet_opening(const struct brc_sim *sim, size_t facet)
{
    const struct brc_facets *f = &sim->specimen->facets;
    double low[3], high[3];
    if (f->cell[facet][1] < 0)
        return 0;
    brc_frame_mesh_sides(sim, facet, f->centroid[facet], low, high);
    return brc_distance(low, high);
}

/* The mode with most of the broken area, -1 while less than the part of the facet is broken. The
 * small allowance is for sums of areas that make up the whole but for rounding. */
static int8_t facet_mode(const double area[BRC_N_MODES], double least)
{
    double sum = 0;
    int most = 0;
    for (int m = 0; m < BRC_N_MODES; m++) {
        sum += area[m];
        most = area[m] > area[most] ? m : most;
    }
    return (int8_t)(sum > 0 && sum >= least * (1 - 1e-9) ? most : -1);
}

/* Takes back the facets that have opened less than the given multiple of the mean: cracks that have
 * hardly opened hide those along which the specimen has come apart. The legend tells how many were
 * left out. */
static void drop_closed(const struct brc_sim *sim, double multiple, struct cracks *c)
{
    const struct brc_facets *f = &sim->specimen->facets;
    double sum = 0;
    size_t n = 0;
    for (size_t i = 0; i < f->n_facets; i++)
        if (c->mode[i] >= 0) {
            sum += facet_opening(sim, i);
            n++;
        }
    for (size_t i = 0; i < f->n_facets; i++) {
        int mode = c->mode[i];
        if (mode < 0)
            continue;
        c->n_broken[mode]++;
        c->area[mode] += f->area[i];
        if (facet_opening(sim, i) * (double)n >= multiple * sum)
            c->n_drawn[mode]++;
        else
            c->mode[i] = -1;
    }
}

/* From the log of cracks: contacts of facets that broke whole may be gone. */
static int classify(struct brc_context *ctx, const struct brc_sim *sim,
                    const struct brc_output_params *output, struct cracks *c)
{
    const struct brc_facets *f = &sim->specimen->facets;
    const struct brc_events *e = &sim->events;
    *c = (struct cracks){.mode = brc_alloc(ctx, f->n_facets, 1)};
    double(*area)[BRC_N_MODES] = brc_alloc(ctx, f->n_facets, sizeof *area);
    if (!c->mode || !area) {
        free(c->mode);
        free(area);
        return BRC_ERR_MEMORY;
    }
    for (size_t k = 0; k < e->table.n; k++)
        if (e->facet[k] >= 0 && (size_t)e->facet[k] < f->n_facets)
            area[e->facet[k]][e->mode[k]] += e->area[k];
    for (size_t i = 0; i < f->n_facets; i++)
        c->mode[i] = facet_mode(area[i], output->facet_part * f->area[i]);
    drop_closed(sim, output->opening, c);
    free(area);
    return 0;
}

/* Facets whose normals meet the light at like angles share one of N_SHADES colours. Few shades,
 * since each is a data block of its own. */
static int facet_shade(const struct view *v, const double normal[3])
{
    int shade = (int)(fabs(brc_dot(normal, v->to_light)) * N_SHADES);
    return shade < N_SHADES ? shade : N_SHADES - 1;
}

/* Colour of a mode, 0xrrggbb, darkened by the shade; the last shade is full. */
static unsigned mode_colour(int mode, int shade)
{
    static const unsigned full[BRC_N_MODES] = {0xe8472b, 0x2f7fd6, 0x2fa84f};
    double part = 0.55 + 0.45 * shade / (N_SHADES - 1);
    unsigned colour = 0;
    for (int shift = 0; shift <= 16; shift += 8)
        colour |= (unsigned)(part * (double)(full[mode] >> shift & 0xff)) << shift;
    return colour;
}

static void put_point(FILE *out, const double x[3])
{
    fprintf(out, "%.4f %.4f %.4f\n", MM * x[0], MM * x[1], MM * x[2]);
}

/* One data block a mode and shade; used[mode][shade] tells which exist. */
static void put_cracks(FILE *out, const struct brc_facets *f, const struct cracks *c,
                       const struct view *v, bool used[BRC_N_MODES][N_SHADES])
{
    for (int mode = 0; mode < BRC_N_MODES; mode++) {
        for (int shade = 0; shade < N_SHADES; shade++) {
            used[mode][shade] = false;
            for (size_t i = 0; i < f->n_facets; i++) {
                if (c->mode[i] != mode || facet_shade(v, f->normal[i]) != shade)
                    continue;
                if (!used[mode][shade])
                    fprintf(out, "$%s_%d << end_of_data\n", brc_mode_name((enum brc_mode)mode),
                            shade);
                used[mode][shade] = true;
                for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
                    put_point(out, f->vertex[f->loop[k]]);
                fputc('\n', out);
            }
            if (used[mode][shade])
                fputs("end_of_data\n", out);
        }
    }
}

/* Edges of the domain that are sharp or on the rim as seen; is_hidden: those behind it. They are
 * told apart here, since `pm3d depthorder` sorts polygons alone. */
static void put_outline(FILE *out, const struct brc_convex *c, const struct brc_edges *edges,
                        const struct view *v, bool is_hidden)
{
    static const double sharp = 0.87; /* cosine of the turn of the normal, 30 degrees */
    fprintf(out, "$%s << end_of_data\n", is_hidden ? "hidden" : "outline");
    for (size_t i = 0; i < edges->n; i++) {
        const struct brc_side *side = &edges->side[edges->first[i]]; /* two of a closed body */
        const double *n0 = c->plane[side[0].face].n, *n1 = c->plane[side[1].face].n;
        bool front0 = brc_dot(n0, v->to_eye) > 0, front1 = brc_dot(n1, v->to_eye) > 0;
        bool drawn = brc_dot(n0, n1) < sharp || front0 != front1;
        if (!drawn || (front0 || front1) == is_hidden)
            continue;
        put_point(out, c->vertex[side->low]);
        put_point(out, c->vertex[side->high]);
        fputs("\n\n", out);
    }
    fputs("end_of_data\n", out);
}

/* A step of 1, 2 or 5 times a power of ten that gives at most `most` steps over the length. */
static double tic_step(double length, int most)
{
    static const double nice[] = {1, 2, 5, 10};
    double step = pow(10, floor(log10(length / most)));
    int i = 0;
    while (i < 3 && nice[i] * step * most < length)
        i++;
    return nice[i] * step;
}

/* Scale of `set view` that fits the specimen into a panel, the size of which is given in heights of
 * the picture. Gnuplot draws the base with 4/7 of the panel less its margins at scale 1. */
static double fit_scale(const struct view *v, const double extent[3])
{
    static const double base = 0.522 * PANEL_WIDTH;
    double a = v->tilt * BRC_PI / 180, b = v->turn * BRC_PI / 180;
    double wide = extent[0] * cos(b) + extent[1] * sin(b);
    double deep = extent[0] * sin(b) + extent[1] * cos(b);
    double high = extent[2] * sin(a) + deep * cos(a);
    double unit = base / fmax(extent[0], extent[1]);
    return fmin(0.9 * PANEL_HEIGHT / (high * unit), 0.70 * PANEL_WIDTH / (wide * unit));
}

/* Ranges and view; only the axes that the view shows at length have tics, as those of the others
 * would lie over each other. */
static void put_axes(FILE *out, const struct brc_convex *domain, const struct view *v)
{
    double low[3], high[3], extent[3];
    bool side = v->tilt > 45;
    brc_box_of(low, high, domain->vertex, domain->n_vertices);
    for (int k = 0; k < 3; k++) {
        extent[k] = MM * (high[k] - low[k]);
        fprintf(out, "set %crange [%.4f:%.4f]\n", "xyz"[k], MM * low[k], MM * high[k]);
        if ((k == 2) == side)
            fprintf(out, "set %ctics %g\nset %clabel '%c [mm]'\n", "xyz"[k], tic_step(extent[k], 4),
                    "xyz"[k], "xyz"[k]);
        else
            fprintf(out, "unset %ctics\nunset %clabel\n", "xyz"[k], "xyz"[k]);
    }
    fputs(side ? "set zlabel rotate parallel offset 2,0\n"
               : "set xlabel offset 0,1\nset ylabel offset -3.7,0\n",
          out);
    fprintf(out, "set view %g,%g,%.4g*panel_scale\nset view equal xyz\nset xyplane relative 0\n",
            v->tilt, v->turn, fit_scale(v, extent));
}

/* Lines under the picture; cracks.gp says where the panel is. Numbers are of all broken facets, and
 * of those that are drawn where these are fewer. */
static void put_legend(FILE *out, const struct cracks *c)
{
    for (int mode = 0; mode < BRC_N_MODES; mode++) {
        char drawn[32] = "";
        if (c->n_drawn[mode] < c->n_broken[mode])
            snprintf(drawn, sizeof drawn, ", %zu drawn", c->n_drawn[mode]);
        fprintf(
            out,
            "set label %d '%s: %zu facets, %.3g cm\u00b2%s' at screen panel_left, screen %.3f left "
            "offset 1.5,0 point pt 5 ps 2 lc rgb '#%06x'\n",
            mode + 1, brc_mode_name((enum brc_mode)mode), c->n_broken[mode], 1e4 * c->area[mode],
            drawn, 0.08 - 0.028 * mode, mode_colour(mode, N_SHADES - 1));
    }
}

/* Behind, what is broken, in front: gnuplot draws in this order what it does not sort. */
static void put_splot(FILE *out, bool used[BRC_N_MODES][N_SHADES])
{
    fputs("splot $hidden with lines lc rgb '#b8b8b8' lw 1 dt 2 notitle", out);
    for (int mode = 0; mode < BRC_N_MODES; mode++)
        for (int shade = 0; shade < N_SHADES; shade++)
            if (used[mode][shade])
                fprintf(out, ", \\\n  $%s_%d with polygons fs solid 1 fc rgb '#%06x' notitle",
                        brc_mode_name((enum brc_mode)mode), shade, mode_colour(mode, shade));
    fputs(", \\\n  $outline with lines lc rgb '#404040' lw 1.4 notitle\n", out);
}

int brc_plot_cracks(struct brc_context *ctx, const char *dir, const struct brc_sim *sim,
                    const struct brc_output_params *output)
{
    const struct brc_specimen *s = sim->specimen;
    struct view v = choose_view(output, sim->rig.type->view);
    bool used[BRC_N_MODES][N_SHADES];
    struct cracks c;
    struct brc_edges edges = {0};
    struct brc_text_file file;
    BRC_TRY(classify(ctx, sim, output, &c));
    int code = brc_edges_find(ctx, &edges, s->domain.n_faces, s->domain.first, s->domain.loop);
    if (code == 0)
        code = brc_text_file_begin(ctx, &file, dir, "cracks.plot");
    if (code == 0) {
        FILE *out = file.out;
        fprintf(out,
                "# Broken facets of a run of breccia, one block a mode and shade; lengths in mm.\n"
                "# Drawn by cracks.gp, which sets the terminal and loads this file.\n");
        put_cracks(out, &s->facets, &c, &v, used);
        put_outline(out, &s->domain, &edges, &v, false);
        put_outline(out, &s->domain, &edges, &v, true);
        put_axes(out, &s->domain, &v);
        put_legend(out, &c);
        put_splot(out, used);
        code = brc_text_file_end(ctx, &file);
    }
    brc_edges_free(&edges);
    free(c.mode);
    return code;
}

/* ---- scripts ------------------------------------------------------------------------------- */

/* Runs beyond the fourth share colours: their labels tell them apart. */
static const char *run_colour(int i)
{
    static const char *const colour[] = {"#1b4f8f", "#d1570b", "#3a7d2c", "#7a3b93"};
    return colour[i % 4];
}

/* Names from the folder of the picture, in which gnuplot runs: the whole folder can be moved. */
static void put_file(FILE *out, const struct brc_plot_runs *runs, int i, const char *name)
{
    char path[BRC_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", runs->folder[i], name);
    brc_gnuplot_quoted(out, path);
}

/* Columns and labels of a test without a view of its own. */
static const struct brc_rig_view plain_view = {.strain = "strain_axial",
                                               .lateral = "strain_lateral",
                                               .strain_label =
                                                   "axial strain; dashed: lateral strain",
                                               .stress_label = "axial stress"};

/* "file using strain:stress with lines STYLE": a curve against one of the strains. */
static void put_curve(FILE *out, const struct brc_plot_runs *runs, int i, const char *strain,
                      const char *style)
{
    put_file(out, runs, i, "curve.csv");
    fprintf(out,
            " using (100*column('%s [1]')):(1e-6*column('stress [Pa]')) with lines %s lc rgb '%s' ",
            strain, style, run_colour(i));
}

/* Stress against strain: along the load, and across it to the left. */
static void put_stress_panel(FILE *out, const struct brc_plot_runs *runs)
{
    const struct brc_rig_view *v = runs->view ? runs->view : &plain_view;
    fprintf(out, "set xlabel '%s [%%]'\nset ylabel '%s [MPa]'\nplot ", v->strain_label,
            v->stress_label);
    for (int i = 0; i < runs->n; i++) {
        fputs(i ? ", \\\n  " : "", out);
        put_curve(out, runs, i, v->strain, "lw 2.4");
        fputs("title ", out);
        brc_gnuplot_quoted(out, runs->label[i]);
        if (!v->lateral)
            continue;
        fputs(", \\\n  ", out);
        put_curve(out, runs, i, v->lateral, "lw 1.6 dt (8,5)");
        fputs("notitle", out);
    }
    fputc('\n', out);
}

/* Which modes occur is asked by gnuplot, as it reads the files: a mode that never does has no entry
 * in the legend. */
static void put_broken_panel(FILE *out, const struct brc_plot_runs *runs)
{
    static const char *const dash[BRC_N_MODES] = {"1", "(10,4)", "(2,4)"};
    for (int i = 0; i < runs->n; i++)
        for (int mode = 0; mode < BRC_N_MODES; mode++) {
            fputs("stats ", out);
            put_file(out, runs, i, "broken.csv");
            fprintf(out, " using (column('%s [1]')) name 'part_%d_%d' nooutput\n",
                    brc_mode_name((enum brc_mode)mode), i, mode);
        }
    fputs("set xlabel 'platen strain [%]'\nset ylabel 'broken area [% of all facets]'\nplot ", out);
    for (int i = 0; i < runs->n; i++)
        for (int mode = 0; mode < BRC_N_MODES; mode++) {
            char label[128];
            fputs(i || mode ? ", \\\n  " : "", out);
            put_file(out, runs, i, "broken.csv");
            fprintf(out,
                    " using (100*column('strain [1]')):(100*column('%s [1]')) with lines lw 2.2 dt "
                    "%s lc rgb '%s' title (part_%d_%d_max > 0 ? ",
                    brc_mode_name((enum brc_mode)mode), dash[mode], run_colour(i), i, mode);
            snprintf(label, sizeof label, "%s, %s", runs->label[i],
                     brc_mode_name((enum brc_mode)mode));
            brc_gnuplot_quoted(out, label);
            fputs(" : '')", out);
        }
    fputc('\n', out);
}

/* Stress to the left, what has broken to the right, over the same strain. */
static int write_curves(struct brc_context *ctx, const char *dir, const struct brc_plot_runs *runs)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, "curves.gp"));
    FILE *out = file.out;
    brc_gnuplot_head(out, "curves", 1500, 640, 13);
    fputs("set datafile separator ','\nset grid lc rgb '#dddddd' lt 1\nset border 3\n"
          "set tics nomirror\nset key outside top center horizontal\n"
          "set multiplot layout 1,2 title ",
          out);
    brc_gnuplot_quoted(out, runs->title);
    fputs(" font ',15'\n", out);
    put_stress_panel(out, runs);
    put_broken_panel(out, runs);
    fputs("unset multiplot\n", out);
    return brc_text_file_end(ctx, &file);
}

/* One panel a run, all of one height and view, with the script of each run's cracks loaded into it:
 * what a run looks like is written once, by the run. */
static int write_pictures(struct brc_context *ctx, const char *dir,
                          const struct brc_plot_runs *runs, int height)
{
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, "cracks.gp"));
    FILE *out = file.out;
    brc_gnuplot_head(out, "cracks", (int)(PANEL_WIDTH * height * runs->n), height, height / 70);
    fputs("set pm3d depthorder border lc rgb '#202020' lw 0.4\nset border 0\n"
          "panel_scale = 1.0 # of the specimen in its panel\nset multiplot title ",
          out);
    brc_gnuplot_quoted(out, runs->title);
    fputs("\n", out);
    for (int i = 0; i < runs->n; i++) {
        fprintf(out, "panel_left = %.4f\nset origin %.4f,0.11\nset size %.4f,%.4f\nset label 9 ",
                (i + 0.24) / runs->n, (double)i / runs->n, 1.0 / runs->n, PANEL_HEIGHT);
        brc_gnuplot_quoted(out, runs->label[i]);
        fprintf(out, " at screen %.4f,0.935 center font ',%d'\nload ", (i + 0.5) / runs->n,
                height / 60);
        put_file(out, runs, i, "cracks.plot");
        fputc('\n', out);
    }
    fputs("unset multiplot\n", out);
    return brc_text_file_end(ctx, &file);
}

/* Scripts first, both, so that they are there whatever gnuplot does. */
int brc_plot_draw(struct brc_context *ctx, const char *dir, const struct brc_plot_runs *runs,
                  const struct brc_output_params *output)
{
    static const char *const picture[] = {"curves", "cracks"};
    BRC_TRY(write_curves(ctx, dir, runs));
    BRC_TRY(write_pictures(ctx, dir, runs, output->picture_height));
    return brc_gnuplot_draw(ctx, dir, picture, 2);
}
