/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saved states for other programs: tables as CSV, fragments as STL, the specimen as a Neper
 * tessellation. The state is loaded into a simulation of its own case, so files that the case names
 * must be where they were. */
#ifndef BRC_EXPORT_H
#define BRC_EXPORT_H

#include "sim.h"

#include <stdio.h>

/* A table of a state, by its name in the file ("curve", "pairs/points"), to the file out (NULL:
 * standard output). */
int brc_export_table(struct brc_context *ctx, const char *path, const char *table, const char *out);
/* "stl" or "tess"; for tess, path may be a case file. */
int brc_export_format(struct brc_context *ctx, const char *path, const char *format,
                      const char *out);

/* Surfaces of the fragments, one solid each, closed: inner facets are left out, and a vertex of
 * several grains of a fragment lies in the middle of them. */
int brc_export_stl(struct brc_context *ctx, FILE *out, const struct brc_sim *sim);

#endif
