/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strength envelopes of runs that have ended, from their folders: `breccia envelope`. */
#ifndef CALIB_ENVELOPE_RUNS_H
#define CALIB_ENVELOPE_RUNS_H

#include "calib/envelope.h"
#include "common/base/brc.h"
#include "common/base/names.h"

struct calib_envelope_options {
    const char *const *run; /* folders of runs, and tables: points_file.h */
    size_t n;
    const char *dir; /* of table and picture; NULL: none, the table goes to standard output alone */
    bool is_residual; /* envelope of what is left, instead of the peaks */
    bool is_forced;   /* replaces files in dir */
};

/* One run that has a point. */
struct calib_run {
    const char *dir;
    char model[64], hash[32], test[64];
    int seed;
    struct calib_peak peak, residual; /* NAN: none */
    char *keys; /* its parameters, "section.key = value" lines; NULL: not known */
};

struct calib_runs {
    struct calib_run *run;
    size_t n;
    char differ[BRC_NAMES_SIZE]; /* keys in which they are not alike, "a, b" */
};

/* Reads the runs; those without a point are left out, with a line on standard error that says why.
 * A folder that holds no run is an error, and so is a table that cannot be read. Freed also after a
 * failure. */
int calib_runs_read(struct brc_context *ctx, const struct calib_envelope_options *o,
                    struct calib_runs *out);
void calib_runs_free(struct calib_runs *r);
/* Reads, fits, prints, and writes envelope.csv, envelope_fits.csv, envelope.gp and envelope.png to
 * dir. Too few points, or points at one pressure alone, are errors; a law that does not fit, while
 * the other one does, is a note. */
int calib_envelope(struct brc_context *ctx, const struct calib_envelope_options *o);

#endif
