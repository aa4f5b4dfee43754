/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finished packings on disk, in $BRECCIA_CACHE, else $XDG_CACHE_HOME/breccia, else
 * ~/.cache/breccia: growing the default packing takes longer than tessellating it, and a
 * comparison, a ladder or a calibration asks for the same one again and again. A file that is
 * damaged or of another version is made anew; a folder that cannot be written is a log line, never
 * a failure. */
#ifndef BRC_PACKING_CACHE_H
#define BRC_PACKING_CACHE_H

#include "common/specimen/seeds.h"

/* True when seeds were found; they are the bits that were saved. */
bool brc_packing_cache_load(struct brc_context *ctx, const struct brc_specimen_params *p,
                            const struct brc_convex *domain, struct brc_seeds *out);
void brc_packing_cache_save(struct brc_context *ctx, const struct brc_specimen_params *p,
                            const struct brc_convex *domain, const struct brc_seeds *seeds);

#endif
