/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the benchmarks share. */
#ifndef BRC_TESTS_BENCH_H
#define BRC_TESTS_BENCH_H

#include "common/sim.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static inline void must(struct brc_context *ctx, int code)
{
    if (code == 0)
        return;
    fprintf(stderr, "%s\n", ctx->message);
    exit(1);
}

static inline double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void set(struct brc_context *ctx, struct brc_param_list list, void *values,
                       const char *key, const char *text)
{
    must(ctx, brc_params_set(ctx, list, values, "bench", key, text, "bench"));
}

#endif
