/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the runs of a sweep that are missing will cost, by those that are done, and for runs without
 * any like them by a short timing. */
#ifndef BRC_SWEEP_ESTIMATE_H
#define BRC_SWEEP_ESTIMATE_H

#include "common/runs/sweep_runs.h"

#include <stdio.h>

/* Processor time [s]: the mean of the runs that are done of the same case and model, else of the
 * same model; NAN: none is done. */
double brc_sweep_estimate(const struct brc_sweep_runs *runs, const struct brc_sweep_run *run);
/* The sum over n runs by their numbers. */
double brc_sweep_estimate_all(const struct brc_sweep_runs *runs, const size_t *number, size_t n);
/* The groups with their runs, what is kept, and the time that the rest will take, jobs at a time.
 * Makes specimens and does a second of steps where nothing like a run is done. */
int brc_sweep_estimate_print(struct brc_context *ctx, FILE *out, const struct brc_sweep_runs *runs,
                             int jobs);

#endif
