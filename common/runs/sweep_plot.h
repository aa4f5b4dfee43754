/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture of the groups of a sweep that have an axis of numbers: means with their 95 % intervals
 * over it, a panel a result, a curve for each place on the other axes. */
#ifndef BRC_SWEEP_PLOT_H
#define BRC_SWEEP_PLOT_H

#include "common/runs/sweep_runs.h"

/* dir/sweep.gp and sweep.png; nothing where no group has such an axis. */
int brc_sweep_plot(struct brc_context *ctx, const struct brc_sweep_runs *runs, const char *dir);

#endif
