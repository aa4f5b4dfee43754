/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saved states for other programs: tables as CSV, fragments as STL, the specimen as a Neper
 * tessellation. For all but tables the state is loaded into a simulation of its own case, so files
 * that the case names must be where the state's folder sees them. */
#ifndef BRC_EXPORT_H
#define BRC_EXPORT_H

#include "common/engine/sim.h"

#include <stdio.h>

struct brc_export_options {
    const char *path; /* of a state, or for "tess" of a case file */
    const char *out;  /* file to write; NULL: standard output */
    bool is_forced;   /* replace the file out that is there, unless it is what is read */
};

/* A table of a state, by its name in the file ("curve", "pairs/points"). */
int brc_export_table(struct brc_context *ctx, const struct brc_export_options *options,
                     const char *table);
/* "stl": the fragments of a state; "tess": the tessellation of a state, or of a case that need not
 * have run. Another name is BRC_ERR_USAGE with a list. */
int brc_export_format(struct brc_context *ctx, const struct brc_export_options *options,
                      const char *format);

/* Surfaces of the fragments, one solid each, closed: inner facets are left out, and a vertex of
 * several grains of a fragment lies in the middle of them. */
int brc_export_stl(struct brc_context *ctx, FILE *out, const struct brc_sim *sim);

#endif
