/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal stresses at failure from a CSV file: of measured rock, of other programs, or of runs
 * whose folders are gone. */
#ifndef CALIB_POINTS_FILE_H
#define CALIB_POINTS_FILE_H

#include "calib/envelope.h"

/* The first line names the columns; "sigma_1" and "sigma_3", with `suffix` behind that ("" or
 * "_residual"), have their unit in brackets, as "sigma_1 [MPa]"; others are passed over.
 * Compression is positive. *point has n rows [Pa], to be freed by the caller; NULL after a failure.
 * A cell that is empty or nan leaves its row out. Errors name file and line. */
int calib_points_read(struct brc_context *ctx, const char *path, const char *suffix,
                      struct calib_peak **point, size_t *n);

#endif
