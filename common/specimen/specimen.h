/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A specimen: domain, seeds and tessellation, before any contact model. One specimen serves both
 * models. The axis of cylinders and of compression and tension is z; the Brazilian load is along y.
 */
#ifndef BRC_SPECIMEN_H
#define BRC_SPECIMEN_H

#include "common/specimen/facets.h"
#include "common/specimen/specimen_params.h"

struct brc_specimen {
    struct brc_specimen_params params;
    struct brc_convex domain; /* face ids: box -x +x -y +y -z +z = 0..5; cylinder 0 bottom, 1 top,
                                 2 + k side k with its normal at 90 deg + k 360/(number of sides) */
    double domain_volume;     /* m3 */
    struct brc_facets facets;
};

/* Makes (or loads from the cache) the specimen. Equal parameters give equal bits. */
int brc_specimen_create(struct brc_context *ctx, const struct brc_specimen_params *params,
                        struct brc_specimen *out);
void brc_specimen_free(struct brc_specimen *s);
/* Logs a warning where the specimen is only a few grains wide in some direction. */
void brc_specimen_warn(struct brc_context *ctx, const struct brc_specimen *s);
/* Extent of the domain: lowest and highest corner. */
void brc_specimen_extent(const struct brc_specimen *s, double low[3], double high[3]);

#endif
