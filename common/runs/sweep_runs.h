/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs of a sweep: every combination of its axes, each with its case checked and its key. */
#ifndef BRC_SWEEP_RUNS_H
#define BRC_SWEEP_RUNS_H

#include "common/runs/run_record.h"
#include "common/runs/sweep_file.h"

enum { BRC_SWEEP_MAX_RUNS = 100000 };

struct brc_sweep_run {
    const struct brc_sweep_group *group;
    const size_t *at;        /* number of the value on each axis of the group */
    const char *path, *name; /* of the case: its file, and what it is called */
    const struct brc_model *model;
    const struct brc_rig_type *rig;
    const char **override; /* as of --set */
    int n_overrides;
    struct brc_run_key key;
    size_t first; /* the first run of this key: itself, unless an axis has no effect on it */
    bool is_done;
    struct brc_kept_run kept;
};
struct brc_sweep_runs {
    const struct brc_sweep_plan *plan;
    struct brc_pool *pool;
    const char *const *set; /* of the command line, for all runs */
    int n_set;
    bool keeps; /* the case's pictures and frames are made */
    size_t n;
    struct brc_sweep_run *run;
};

/* Fills n and run of *runs; all else is given. A key or a value that a case refuses is told with
 * the line of the sweep file. Freed by brc_sweep_runs_free, also after a failure. */
int brc_sweep_runs_make(struct brc_context *ctx, struct brc_sweep_runs *runs);
void brc_sweep_runs_free(struct brc_sweep_runs *runs);
/* The case of a run; freed by brc_case_free, also after a failure. */
int brc_sweep_run_case(struct brc_context *ctx, const struct brc_sweep_run *run,
                       struct brc_case *out);
/* "group vgcm specimen.seed=2"; returns text. */
const char *brc_sweep_run_label(const struct brc_sweep_run *run, char *text, size_t size);

#endif
