/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts of gnuplot: writing them, and running them where gnuplot is installed. */
#ifndef BRC_GNUPLOT_H
#define BRC_GNUPLOT_H

#include "error.h"

#include <stdio.h>

/* Opens DIR/NAME for writing; close tells of a full disk. */
int brc_gnuplot_open(struct brc_context *ctx, const char *dir, const char *name, FILE **out);
int brc_gnuplot_close(struct brc_context *ctx, const char *dir, const char *name, FILE *out);
/* Text between double quotes of gnuplot, with its markup switched off. */
void brc_gnuplot_quoted(FILE *out, const char *text);
/* Runs each DIR/<picture>.gp, which draws <picture>.png. Without gnuplot the scripts stay and a log
 * line says so. */
int brc_gnuplot_draw(struct brc_context *ctx, const char *dir, const char *const *picture, int n);

#endif
