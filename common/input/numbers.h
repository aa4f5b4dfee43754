/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text files of numbers: one row a line, blanks between; '#' begins a comment. For lists of points
 * and planes that a case names (specimen/seeds.c, specimen.c). Not CSV: such files are made by hand
 * or by a line of awk, and need no header. */
#ifndef BRC_NUMBERS_H
#define BRC_NUMBERS_H

#include "common/base/error.h"

struct brc_numbers {
    size_t n;      /* rows */
    int width;     /* values a row */
    double *value; /* [n * width] */
    int *line;     /* of each row in the file, 1 is the first */
};

/* Bounds of what is read; a file beyond them is an error that says so. 1e7 rows are 1e7 grains. */
enum { BRC_NUMBERS_MAX_WIDTH = 8, BRC_NUMBERS_MAX_ROWS = 10000000 };

/* Reads rows of at least low and at most high finite numbers, all rows alike. key names the key of
 * the case that gave the path, form what a row is ("nx ny nz d"); both are for messages, which give
 * file and line. An empty file is an error. Freed by brc_numbers_free; after a failure there is
 * nothing to free. */
int brc_numbers_read(struct brc_context *ctx, const char *key, const char *path, const char *form,
                     int low, int high, struct brc_numbers *out);
void brc_numbers_free(struct brc_numbers *t);

#endif
