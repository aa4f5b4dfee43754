/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How breaks come in bursts, of many runs together: `breccia bursts`. */
#ifndef CALIB_BURSTS_H
#define CALIB_BURSTS_H

#include "common/base/error.h"

struct calib_bursts_options {
    const char *const *run; /* folders of runs, and tables that `pack` has written */
    size_t n;
    const char *pack; /* file to write all breaks to; NULL: none */
    const char *dir;  /* of bursts.csv and bursts_histogram.csv; NULL: none */
    bool is_forced;   /* replaces files in dir */
};

/* Reads, fits, prints and writes. A folder without curve.csv, or breaks that are too few for any
 * fit, are errors. */
int calib_bursts(struct brc_context *ctx, const struct calib_bursts_options *o);

#endif
