/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of a sweep: the runs of a group that differ in what is averaged over alone, and the means
 * over them. Tables and pictures are made of cells. */
#ifndef BRC_SWEEP_CELLS_H
#define BRC_SWEEP_CELLS_H

#include "common/runs/sweep_runs.h"

/* Of n values that are there. */
struct brc_sweep_mean {
    int n;
    double mean, standard_error; /* NAN: too few values */
    double low, high;            /* of the 95 % interval of the mean by Student's t */
};
/* NAN is a value that is not there. */
struct brc_sweep_mean brc_sweep_mean(const double *value, size_t n);

struct brc_sweep_cell {
    size_t n;
    const struct brc_sweep_run **run;
    int n_failed, n_done;
    double cpu_s; /* a run */
};
struct brc_sweep_cells {
    struct brc_context *ctx;
    struct brc_pool pool; /* of the cells, and of what is made of them */
    const struct brc_sweep_runs *runs;
    size_t n;
    struct brc_sweep_cell *cell; /* those of a group follow each other */
    double *value;               /* work space */
};

/* Freed by brc_sweep_cells_free, also after a failure. */
int brc_sweep_cells_make(struct brc_context *ctx, const struct brc_sweep_runs *runs,
                         struct brc_sweep_cells *out);
void brc_sweep_cells_free(struct brc_sweep_cells *c);
/* Of a result by name; failed runs count as missing. */
struct brc_sweep_mean brc_sweep_cell_mean(struct brc_sweep_cells *c,
                                          const struct brc_sweep_cell *cell, const char *quantity);
bool brc_sweep_is_good(const struct brc_sweep_run *run);
/* Result number i of what a test measures, NULL past the last; and whether a group collects it. */
const struct brc_quantity *brc_sweep_quantity(const struct brc_rig_type *rig, int i);
bool brc_sweep_is_collected(const struct brc_sweep_group *g, const char *name);
/* The first results that the group of a run collects, in its order, or that its test measures; how
 * many, at most cap. What is shown where there is no room for all. */
int brc_sweep_shown(const struct brc_sweep_run *run, const struct brc_quantity **shown, int cap);

#endif
