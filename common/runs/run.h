/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run: a model on a specimen through a test, from the case to the files in its folder. */
#ifndef BRC_RUN_H
#define BRC_RUN_H

#include "common/runs/case.h"
#include "common/base/progress.h"

/* What a run is told, and a comparison and a ladder (converge.h), which run several, too: those
 * leave out model, progress and (a ladder, which makes its own) specimen. */
struct brc_run_options {
    const struct brc_case *run_case;
    const struct brc_model *model;
    const struct brc_specimen *specimen;
    const char *dir; /* where results go; made when it is missing */
    bool is_resumed; /* go on from dir/state.h5; from the start when the run has not saved one */
    bool is_forced;  /* replace results that are there */
    struct brc_progress *progress;
};

/* Runs to the end of the test. Writes to dir: case.yaml, log, state.h5, curve.csv, events.csv,
 * broken.csv, summary.json, and the plots. A signal that was held (brc_signals_hold) saves the
 * state and ends in BRC_ERR_INTERRUPTED, before the first step in BRC_ERR_NOT_BEGUN; curves are
 * written after any failure of a started run. */
int brc_run(struct brc_context *ctx, const struct brc_run_options *options,
            struct brc_summary *out);

/* A run has been started in dir, by its log; it need not have saved anything. */
bool brc_run_has_begun(const char *dir);
/* Fails when dir holds what the run would replace (results, a file of the same name of the user's
 * own) and neither is_resumed nor is_forced allows it; when there is nothing to resume; and,
 * whatever is allowed, when an input of the case lies where a result goes. BRC_ERR_INPUT,
 * BRC_ERR_IO. */
int brc_run_check_folder(struct brc_context *ctx, const struct brc_run_options *o);
/* The same for files of commands that run several: fails when o->dir holds one of n files, or the
 * beginning of one (its name with .part), and may_replace is not set, or one is an input. */
int brc_run_check_own(struct brc_context *ctx, const struct brc_run_options *o,
                      const char *const *names, int n, bool may_replace);
/* Of the text of a kept case; the log tells it, as "case.yaml: digest ...". */
uint64_t brc_run_case_digest(const char *text);
/* Fails when this text must not replace dir/case.yaml: the case that is read, or for a resumed run
 * one that it has not kept itself, by its log. */
int brc_run_check_case(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                       const char *text, bool is_resumed);
/* Puts the text into dir/case.yaml. One that is there already stays, but for a new run's: to write
 * it tells whether there is room, before old results are removed. */
int brc_run_keep_case(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                      const char *text, bool is_new);
/* Opens a file of the folder to add to it, and locks it until it is closed, so that no second run
 * writes there; its content stays. For the log, and for the record of a ladder. Where it fails
 * *file is to be closed, too, unless it is NULL. */
int brc_run_open(struct brc_context *ctx, const char *dir, const char *name, FILE **file);
/* Fails where path is another file by now than the one that was opened: what is written would go
 * with that one, without a word. Before each line that is added. */
int brc_run_check_open(struct brc_context *ctx, FILE *file, const char *path);
/* Removes what runs write: all but case and log, and everything, with the folder when it is empty
 * then. */
int brc_run_remove_results(struct brc_context *ctx, const char *dir);
int brc_run_remove(struct brc_context *ctx, const char *dir);
#endif
