/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The record of a ladder's finished runs, converge_runs.csv: a line is added as each run ends, so
 * that a ladder that was stopped goes on with what is missing. It knows runs by their keys, and not
 * what a key is made of. */
#ifndef BRC_CONVERGE_RECORD_H
#define BRC_CONVERGE_RECORD_H

#include "common/base/folders.h"
#include "common/runs/converge_study.h"

struct brc_converge_record {
    FILE *file;
    char path[BRC_PATH_SIZE];
    int n_results;
    size_t n, cap;
    struct brc_converge_run *run; /* finished ones */
};

/* Opens the record in a folder that is there; it is locked until it is closed. Existing lines are
 * an error unless they are to be kept or replaced; kept lines must be of the same results. Closed
 * also after a failure. */
int brc_converge_record_open(struct brc_context *ctx, struct brc_converge_record *r,
                             const struct brc_converge_study *study);
/* The finished run of this key, NULL when there is none. */
const struct brc_converge_run *brc_converge_record_find(const struct brc_converge_record *r,
                                                        uint64_t key);
int brc_converge_record_add(struct brc_context *ctx, struct brc_converge_record *r,
                            const char *model, int seed, const struct brc_converge_setting *s,
                            const struct brc_converge_run *run);
/* Ends the lock, too; one that was never opened is accepted. */
void brc_converge_record_close(struct brc_converge_record *r);

#endif
