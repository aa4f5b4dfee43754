/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Seed points and sphere sizes (GSL random numbers): gt12's jittered grid and vgcm's growth
 * packing. The generator is MT19937, seeded by specimen.seed alone: equal parameters give equal
 * bits on every machine, which the C library's rand does not. Called by specimen.c; knows domains,
 * not cells. After a failure seeds can only be freed. */
#ifndef BRC_SEEDS_H
#define BRC_SEEDS_H

#include "common/base/pool.h"
#include "common/geometry/convex.h"
#include "common/specimen/specimen_params.h"

/* Zero before the first use. */
struct brc_seeds {
    size_t n;
    double (*x)[3]; /* m */
    double *radius; /* m; NULL for plain Voronoi */
    struct brc_pool pool;
};

/* Room for n seeds, with radii where has_radii says so. */
int brc_seeds_alloc(struct brc_context *ctx, struct brc_seeds *s, size_t n, bool has_radii);
void brc_seeds_free(struct brc_seeds *s);
/* One point per cubic cell of the box, uniform in a centred box of jitter cells (gt12 Fig 4). */
int brc_seeds_grid(struct brc_context *ctx, const struct brc_specimen_params *p,
                   struct brc_seeds *out);
/* The points of the file specimen.points, with radii where it has them; none may be nearer to
 * another than a thousandth of the grain size. */
int brc_seeds_points(struct brc_context *ctx, const struct brc_specimen_params *p,
                     double domain_volume, struct brc_seeds *out);
/* Uniform diameters, inserted at half radius, grown and relaxed without cohesion (vgcm 2.5). */
int brc_seeds_packing(struct brc_context *ctx, const struct brc_specimen_params *p,
                      const struct brc_convex *domain, double domain_volume, struct brc_seeds *out);
/* Renumbers along a Hilbert curve; ties keep their order. */
int brc_seeds_sort(struct brc_context *ctx, struct brc_seeds *s);

#endif
