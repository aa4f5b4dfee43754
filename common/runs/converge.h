/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What accuracy costs: a case run over ladders of its numerical settings, one at a time, on several
 * specimens, against a reference with a finer loading and a smaller step. Called by the program
 * alone. docs/speed-and-error.md says how errors are judged. */
#ifndef BRC_CONVERGE_H
#define BRC_CONVERGE_H

#include "common/runs/run.h"

/* Bounds of what is asked for: tables of settings are arrays of these sizes. */
enum { BRC_CONVERGE_MAX_SEEDS = 64, BRC_CONVERGE_MAX_SETTINGS = 96, BRC_CONVERGE_MAX_REFINE = 256 };
enum { BRC_CONVERGE_MAX_MODELS = 16, BRC_CONVERGE_MAX_AXES = 32 };

struct brc_converge_options {
    /* dir: of converge*, beside those of other commands; resumed: finished runs are kept,
     * unfinished ones go on */
    struct brc_run_options run;
    const char *model;       /* this one alone; NULL: those of the case */
    const char *observable;  /* name of a result */
    const char *axes;        /* names, separated by commas; "": all */
    int seeds, refine, jobs; /* specimens; factor of the finest loading; runs at a time */
};

/* Runs what is missing, prints the table and writes converge.txt, converge.csv (a line a setting),
 * converge_runs.csv (a line a run) and the chart. Start no MPI before. */
int brc_converge(struct brc_context *ctx, const struct brc_converge_options *options);

#endif
