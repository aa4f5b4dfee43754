/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts of gnuplot: writing them, and running them where gnuplot is installed. For the pictures
 * of runs (plot.c) and of ladders (runs/converge_plot.c). The program links no library for drawing:
 * scripts can be changed by the user and drawn again. */
#ifndef BRC_GNUPLOT_H
#define BRC_GNUPLOT_H

#include "common/base/error.h"

#include <stdio.h>

/* First lines of the script <name>.gp, which draws <name>.png of width x height pixels. Markup is
 * off: titles and names stand in the picture as they are. */
void brc_gnuplot_head(FILE *out, const char *name, int width, int height, int font);
/* Any text as a string of gnuplot, quotes included: gnuplot takes nothing in it for a command, a
 * macro or the end of the string. */
void brc_gnuplot_quoted(FILE *out, const char *text);
/* Runs each DIR/<picture>.gp, which draws <picture>.png. Without gnuplot the scripts stay and a log
 * line says so. */
int brc_gnuplot_draw(struct brc_context *ctx, const char *dir, const char *const *picture, int n);

#endif
