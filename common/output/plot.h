/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plots and pictures: gnuplot scripts with their data next to the results, run where gnuplot is
 * installed. Without it the scripts stay and a log line says so. */
#ifndef BRC_PLOT_H
#define BRC_PLOT_H

#include "common/output/output.h"
#include "common/engine/sim.h"

enum { BRC_PLOT_MAX_RUNS = 16 };

/* Runs side by side: label and folder of each, relative to the folder of the picture. At most as
 * many as a picture has room for. */
struct brc_plot_runs {
    const char *title;
    const struct brc_rig_view *view; /* NULL: a test without one */
    int n;
    const char *label[BRC_PLOT_MAX_RUNS], *folder[BRC_PLOT_MAX_RUNS];
};

/* DIR/broken.csv: at each row of the curve step, platen strain, and the part of the specimen's
 * inner facet area that is broken in tension, in shear and in torsion. */
int brc_plot_broken(struct brc_context *ctx, const char *dir, const struct brc_sim *sim);
/* DIR/cracks.plot: broken facets of a run as polygons coloured by mode, outline of the specimen.
 * Data and view alone, so that cracks.gp can put several runs side by side. */
int brc_plot_cracks(struct brc_context *ctx, const char *dir, const struct brc_sim *sim,
                    const struct brc_output_params *output);
/* DIR/curves.gp and curves.png from each run's curve.csv and broken.csv; DIR/cracks.gp and
 * cracks.png from each run's cracks.plot. */
int brc_plot_draw(struct brc_context *ctx, const char *dir, const struct brc_plot_runs *runs,
                  const struct brc_output_params *output);

#endif
