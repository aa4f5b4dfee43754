/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run: a model on a specimen through a test, from the case to the files in its folder. */
#ifndef BRC_RUN_H
#define BRC_RUN_H

#include "job.h"
#include "progress.h"

struct brc_run_order {
    const struct brc_job *job;
    const struct brc_model *model;
    const struct brc_specimen *specimen;
    const char *dir; /* where results go; made when it is missing */
    bool is_resumed; /* go on from dir/state.h5; from the start when the run has not saved one */
    bool is_forced;  /* replace results that are there */
    struct brc_progress *progress;
    int progress_run; /* number of this run's line */
};

/* Runs to the end of the test. Writes to dir: case.yaml, log, state.h5, curve.csv, events.csv,
 * broken.csv, summary.json, and the plots. A signal that was held (brc_run_hold_signals) saves the
 * state and ends in BRC_ERR_INTERRUPTED; curves are written after any failure of a started run. */
int brc_run(struct brc_context *ctx, const struct brc_run_order *order, struct brc_summary *out);

/* A run has been started in dir, by its log. */
bool brc_run_has_begun(const char *dir);
/* Fails when dir holds results and neither is_resumed nor is_forced allows it. */
int brc_run_check_folder(struct brc_context *ctx, const char *dir, bool is_resumed, bool is_forced);
/* From now on SIGINT, SIGTERM, SIGHUP and a lost reader wait: each run of the process saves its
 * state and ends after the present step. */
void brc_run_hold_signals(void);
bool brc_run_is_stopped(void);
/* Makes a folder and those above it. */
int brc_run_make_folder(struct brc_context *ctx, const char *path);

#endif
