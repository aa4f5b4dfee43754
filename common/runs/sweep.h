/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many runs: all combinations of the axes of a sweep file, side by side, with a record from which
 * finished ones are taken, and tables of what they give. Called by the program alone; docs/sweep.md
 * tells the user. */
#ifndef BRC_SWEEP_H
#define BRC_SWEEP_H

#include "common/base/error.h"

enum { BRC_SWEEP_MAX_JOBS = 256 };
struct brc_sweep_options {
    const char *path;       /* of the sweep file */
    const char *dir;        /* of tables, and of unfinished runs; NULL: results/<name of path> */
    const char *cache;      /* the record; NULL: that of the file, else dir/runs.jsonl */
    const char *verify;     /* "2%": this part of the kept runs is done again and compared; NULL */
    const char *const *set; /* "section.key=value" for all runs */
    int n_set;
    int jobs; /* runs at a time; 0: one a processor */
    bool is_fresh, is_dry, keeps, is_forced;
};

/* Does what is missing, writes sweep.csv, runs.csv and sweep.h5, and prints the means. Failed runs
 * are told, and are BRC_ERR_RUNS when all others are done; so are runs that --verify finds other
 * than kept. is_dry: prints what would be done, and makes nothing. Start no MPI before. */
int brc_sweep(struct brc_context *ctx, const struct brc_sweep_options *options);

#endif
