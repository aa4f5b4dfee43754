/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What came of a sweep: a row for each run, and a row for each quantity of runs that are averaged.
 * From the record alone, so that tables can be made anew anywhere. */
#ifndef BRC_SWEEP_TABLE_H
#define BRC_SWEEP_TABLE_H

#include "common/runs/sweep_runs.h"

#include <stdio.h>

/* dir/sweep.csv, runs.csv and sweep.h5, which holds both. */
int brc_sweep_write(struct brc_context *ctx, const struct brc_sweep_runs *runs, const char *dir);
/* The means of what is collected, a table a group, for readers. */
int brc_sweep_print(struct brc_context *ctx, FILE *out, const struct brc_sweep_runs *runs);

#endif
