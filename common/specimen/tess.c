/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is done around the diagram that tess_cgal.cpp makes: seeds without a cell are named, and the
 * length below which vertices are one is raised in steps until the cells pass the checks. The least
 * length that works is the one that changes the geometry least. Called by specimen.c through
 * tess.h; knows no case and no model, and CGAL only by the C face of tess_cgal.h. */
#include "common/specimen/tess.h"

#include "common/base/invariant.h"
#include "common/base/progress.h"
#include "common/specimen/tess_cgal.h"
#include "common/geometry/vec.h"

#include <stdio.h>
#include <string.h>

/* Lengths in units of the mean cell size. Vertices nearer than merge_length are one, vertices
 * nearer than a tenth of it to a domain plane lie on it. Rounding is below 1e-13, facets that
 * matter are above 1e-6. Only details of just the merge length can spoil a cell; then the next
 * length is tried. */
static const double merge_lengths[] = {1e-9, 1e-11, 1e-7};
static const double clip_part = 0.1;
/* what the cells of CGAL and their cuts take of the time, about; only the bar of progress needs it
 */
static const double cells_part = 0.5, clips_part = 0.3;

/* CGAL would take a seed outside as well, and the cuts would leave a part of its cell. The number
 * of seeds is bounded so that those of vertices, some seven a cell, stay far within int32_t. */
static int check_seeds(struct brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
                       const struct brc_convex *domain)
{
    if (n == 0 || n > INT32_MAX / 64)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "%zu seeds; allowed are 1 to %d", n, INT32_MAX / 64);
    for (size_t i = 0; i < n; i++) {
        bool is_good = isfinite(brc_norm2(seed[i])) && (!radius || isfinite(radius[i]));
        for (size_t f = 0; f < domain->n_faces && is_good; f++)
            is_good = brc_dot(domain->plane[f].n, seed[i]) <= domain->plane[f].d;
        if (!is_good)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "seed %zu at (%g, %g, %g) m lies outside the domain", i,
                     seed[i][0], seed[i][1], seed[i][2]);
        BRC_ASSERT(!radius || radius[i] >= 0);
    }
    return 0;
}

/* The cut takes vertices within a tenth of the merge length as on its plane: any that it leaves
 * just beside the plane are near enough to their new neighbours for the second merge. */
static int clip_and_merge(struct brc_context *ctx, struct brc_cell_complex *c,
                          const struct brc_convex *domain, double merge_length,
                          struct brc_work *work)
{
    BRC_TRY(brc_cell_complex_merge_vertices(ctx, c, merge_length));
    for (size_t f = 0; f < domain->n_faces; f++) {
        BRC_TRY(brc_cell_complex_clip(ctx, c, &domain->plane[f], clip_part * merge_length));
        brc_work_update(work, cells_part + clips_part * (double)(f + 1) / (double)domain->n_faces);
    }
    BRC_TRY(brc_cell_complex_merge_vertices(ctx, c, merge_length));
    return brc_cell_complex_snap_to_planes(ctx, c, domain);
}

/* The input and the work arrays of one call of brc_tess_laguerre; places are relative to origin.
 * What an attempt leaves here is what its message needs. */
struct work {
    double (*seed)[3];
    const double *radius;
    size_t n;
    const struct brc_convex *domain;
    double origin[3];              /* 0 where the domain is near */
    struct brc_convex near_domain; /* the domain, moved to the origin */
    double volume, centroid[3];
    struct brc_cell_complex complex;
    int32_t *hider;    /* as of brc_cgal_cells */
    uint8_t *is_empty; /* no cell inside the domain */
    struct brc_work progress;
    bool is_incomplete;   /* some seed has no cell: no other merge length helps */
    struct brc_pool pool; /* owns the arrays */
};

/* Names the first seed without a cell and, where known, the seed that takes its place. One without
 * a cell at all has a hider; one whose cell lies outside the domain has none. */
static int name_missing(struct brc_context *ctx, const struct work *w)
{
    const double *radius = w->radius;
    char why[80] = " inside the domain";
    for (size_t i = 0; i < w->n; i++) {
        int32_t j = w->hider[i];
        double x[3];
        brc_add(x, w->seed[i], w->origin);
        if (j >= 0 && brc_distance(w->seed[i], w->seed[j]) == 0)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                     "seeds %zu and %d coincide at (%g, %g, %g) m; move one of them", i, j, x[0],
                     x[1], x[2]);
        if (j >= 0)
            snprintf(why, sizeof why, ": sphere %d, radius %g m, takes its place", j,
                     radius ? radius[j] : 0);
        if (j >= 0 || w->is_empty[i])
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                     "sphere %zu at (%g, %g, %g) m, radius %g m, has no cell%s; relax the packing "
                     "on or use more equal radii",
                     i, x[0], x[1], x[2], radius ? radius[i] : 0, why);
    }
    return 0;
}

/* From CGAL on for each merge length: merging and cutting leave nothing as it was, and a second
 * length is needed too seldom for a copy of the complex to be worth its memory. */
static int make_facets(struct brc_context *ctx, struct work *w, double merge_length,
                       struct brc_facets *out)
{
    brc_cell_complex_free(&w->complex);
    w->complex.n_cells = w->n;
    BRC_TRY(brc_cgal_cells(ctx, w->seed, w->radius, w->n, w->centroid,
                           brc_convex_reach(w->domain, w->centroid), w->hider, &w->complex));
    brc_work_update(&w->progress, cells_part);
    BRC_TRY(clip_and_merge(ctx, &w->complex, w->domain, merge_length, &w->progress));
    w->is_incomplete = brc_cell_complex_empty_cells(&w->complex, w->is_empty) > 0;
    if (w->is_incomplete)
        return name_missing(ctx, w);
    BRC_TRY(brc_facets_seeds(ctx, out, w->n));
    memcpy(out->seed, w->seed, w->n * sizeof *out->seed);
    if (w->radius)
        memcpy(out->radius, w->radius, w->n * sizeof *out->radius);
    BRC_TRY(brc_cell_complex_finish(ctx, &w->complex, out));
    return brc_facets_verify(ctx, out, w->volume, w->origin);
}

/* Tries the merge lengths in turn; the first failure is the one reported, as it is that of the
 * length that should have done. Failures other than of geometry end the trying: more memory will
 * not come of another length. */
static int try_facets(struct brc_context *ctx, struct work *w, struct brc_facets *out)
{
    const int n_tries = (int)(sizeof merge_lengths / sizeof *merge_lengths);
    double size = cbrt(w->volume / (double)w->n);
    struct brc_context first = *ctx;
    int code = 0;
    for (int i = 0; i < n_tries; i++) {
        code = make_facets(ctx, w, merge_lengths[i] * size, out);
        if (code != BRC_ERR_GEOMETRY || w->is_incomplete)
            return code;
        brc_facets_free(out);
        if (i == 0)
            first = *ctx;
        brc_error_clear(ctx);
    }
    *ctx = first;
    return code;
}

/* Moves seeds and domain of a place far from the origin there, where no digits are lost. The domain
 * is made anew from its moved planes: its vertices have lost their digits already. */
static int come_near(struct brc_context *ctx, struct work *w)
{
    const double zero[3] = {0, 0, 0};
    double reach = brc_convex_reach(w->domain, w->centroid), back[3];
    brc_convex_origin(w->centroid, reach, w->origin);
    if (brc_norm(w->origin) == 0)
        return 0;
    brc_scale(back, w->origin, -1);
    double(*seed)[3] = brc_pool_alloc(ctx, &w->pool, w->n, sizeof *seed);
    struct brc_plane *plane = brc_pool_alloc(ctx, &w->pool, w->domain->n_faces, sizeof *plane);
    if (w->pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < w->n; i++)
        brc_add(seed[i], w->seed[i], back);
    memcpy(plane, w->domain->plane, w->domain->n_faces * sizeof *plane);
    brc_planes_shift(plane, w->domain->n_faces, back);
    BRC_TRY(
        brc_convex_from_planes(ctx, &w->near_domain, plane, w->domain->n_faces, zero, 4 * reach));
    w->seed = seed;
    w->domain = &w->near_domain;
    return 0;
}

/* Seeds are checked against the domain as it was given: moved, a seed on its surface may lie a
 * digit outside. */
static int prepare(struct brc_context *ctx, struct work *w)
{
    double inertia[3][3];
    brc_convex_mass(w->domain, &w->volume, w->centroid, inertia);
    BRC_TRY(check_seeds(ctx, w->seed, w->radius, w->n, w->domain));
    BRC_TRY(come_near(ctx, w));
    brc_convex_mass(w->domain, &w->volume, w->centroid, inertia);
    w->hider = brc_pool_alloc(ctx, &w->pool, w->n, sizeof *w->hider);
    w->is_empty = brc_pool_alloc(ctx, &w->pool, w->n, sizeof *w->is_empty);
    return w->pool.is_failed ? BRC_ERR_MEMORY : 0;
}

/* Areas are measured and judged near the origin, where no digits are lost; places are moved last.
 */
static int tessellate(struct brc_context *ctx, struct work *w, double min_area_ratio,
                      struct brc_facets *out)
{
    BRC_TRY(prepare(ctx, w));
    BRC_TRY(try_facets(ctx, w, out));
    brc_facets_mark_contacts(out, min_area_ratio);
    if (brc_norm(w->origin) > 0)
        brc_facets_shift(out, w->origin);
    return 0;
}

/* What work was done before a failure is freed here, and out holds nothing then. */
int brc_tess_laguerre(struct brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
                      const struct brc_convex *domain, double min_area_ratio,
                      struct brc_facets *out)
{
    struct work w = {.seed = seed, .radius = radius, .n = n, .domain = domain};
    memset(out, 0, sizeof *out);
    brc_work_begin(&w.progress, ctx, "tessellating");
    int code = tessellate(ctx, &w, min_area_ratio, out);
    brc_work_end(&w.progress);
    brc_cell_complex_free(&w.complex);
    brc_convex_free(&w.near_domain);
    brc_pool_free(&w.pool);
    if (code != 0)
        brc_facets_free(out);
    return code;
}
