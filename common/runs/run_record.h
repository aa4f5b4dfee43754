/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A record of finished runs: a text file to which a line is added as each run ends, so that a stop
 * loses none, and lines of two versions of the file can be put together by hand or by git. A line
 * is a JSON object: key, complete input, how the run ended, cost, energies, state hash, results
 * with notes, and last the digest of all before it: a line that was changed is refused, and a last
 * one that was cut is dropped. A run is known by its key and its whole input. */
#ifndef BRC_RUN_RECORD_H
#define BRC_RUN_RECORD_H

#include "common/base/folders.h"
#include "common/base/pool.h"
#include "common/runs/child.h"
#include "common/runs/run_key.h"

struct brc_run_record {
    FILE *file; /* NULL: for reading alone */
    char path[BRC_PATH_SIZE];
    struct brc_pool pool;
    size_t n, cap;
    struct brc_run_row {
        uint64_t key;
        const char *line;
    } * row;
};

/* What a line tells of a run; texts are the pool's that it was read into. */
struct brc_kept_run {
    int code;            /* 0, or of the failure */
    const char *message; /* of the failure, "" */
    const char *ended_by;
    int64_t steps;
    double n_grains, n_contacts_mean, dt, cpu_s, wall_s;
    double energy_residual, energy_drift, unbalanced_max;
    uint64_t state_hash; /* of the last state; 0 after a failure without one */
    int n_results;
    struct brc_kept_result {
        const char *name, *note; /* note "": none */
        double value;            /* NAN: not measured */
    } result[BRC_MAX_RESULTS];
};

/* Opens path to add to it; the file, with its folder, is made when it is missing, and locked until
 * it is closed. is_read_only: what is there, if anything, without lock. Closed also after a
 * failure. */
int brc_run_record_open(struct brc_context *ctx, struct brc_run_record *r, const char *path,
                        bool is_read_only);
void brc_run_record_close(struct brc_run_record *r);
/* The last line of this run; NULL when there is none. */
const char *brc_run_record_find(const struct brc_run_record *r, const struct brc_run_key *key);
/* The line of an outcome, NULL when out of memory; it has no pointer in it, so that any process can
 * take it. */
char *brc_run_record_line(struct brc_context *ctx, struct brc_pool *pool,
                          const struct brc_run_key *key, const struct brc_outcome *outcome);
/* Adds a line, whole or not at all. */
int brc_run_record_add(struct brc_context *ctx, struct brc_run_record *r, const char *line);
int brc_run_record_read(struct brc_context *ctx, struct brc_pool *pool, const char *line,
                        struct brc_kept_run *out);
/* The value of a result, NAN where it was not measured. */
double brc_kept_result(const struct brc_kept_run *run, const char *name);

#endif
