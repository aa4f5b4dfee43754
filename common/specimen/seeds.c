/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Seeds of a grid or a file. Those that nearly coincide are refused before tessellating: the facet
 * between them would be a bond thousands of times too stiff, and the step as many times too small.
 */
#include "common/specimen/seeds.h"

#include "common/geometry/grid.h"
#include "common/geometry/hilbert.h"
#include "common/input/numbers.h"
#include "common/geometry/vec.h"

#include <gsl/gsl_rng.h>

/* Seeds nearer than this part of the grain size (of equal cubes) are one grain cut in two by a bond
 * that is a thousand times too stiff. */
static const double least_distance = 1e-3;

int brc_seeds_alloc(struct brc_context *ctx, struct brc_seeds *s, size_t n, bool has_radii)
{
    s->n = n;
    s->x = brc_pool_alloc(ctx, &s->pool, n, sizeof *s->x);
    s->radius = has_radii ? brc_pool_alloc(ctx, &s->pool, n, sizeof *s->radius) : NULL;
    return s->pool.is_failed ? BRC_ERR_MEMORY : 0;
}

void brc_seeds_free(struct brc_seeds *s)
{
    brc_pool_free(&s->pool);
    *s = (struct brc_seeds){0};
}

/* No two seeds are too near to each other. rows: of the file that they stem from, or NULL. One pair
 * is enough: a file of equal rows has as many pairs as no memory holds. */
static int check_near(struct brc_context *ctx, const struct brc_seeds *s, double size,
                      const char *key, const char *path, const struct brc_numbers *rows)
{
    struct brc_neighbours near = {.enough = 1};
    double least = least_distance * size;
    int code = brc_grid_pairs(ctx, (const double(*)[3])s->x, NULL, s->n, least, &near);
    if (code == 0 && near.n > 0) {
        int32_t a = near.pair[0][0], b = near.pair[0][1];
        const double *x = s->x[b];
        code = brc_error_set(ctx, BRC_ERR_GEOMETRY, __FILE__, __LINE__,
                             "%s: %s%s%d: the seed at (%g, %g, %g) m is %.3g m from that of %s "
                             "%d; the least is %.3g m, a thousandth of the grain size: remove or "
                             "move one of them",
                             key, path, rows ? ":" : "number ", rows ? rows->line[b] : b, x[0],
                             x[1], x[2], brc_distance(x, s->x[a]), rows ? "line" : "number",
                             rows ? rows->line[a] : a, least);
    }
    brc_neighbours_free(&near);
    return code;
}

/* Cells must be cubes, as gt12's are. A jitter of 1 lets seeds of neighbouring cells meet, which
 * check_near then refuses. */
int brc_seeds_grid(struct brc_context *ctx, const struct brc_specimen_params *p,
                   struct brc_seeds *out)
{
    const int *cells = p->cells;
    double count = (double)cells[0] * cells[1] * cells[2];
    if (count > BRC_MAX_GRAINS)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.cells gives %g seeds, at most %g are allowed", count,
                 (double)BRC_MAX_GRAINS);
    /* edges of a box in millimetres, divided, agree to rounding only */
    double edge = p->size[0] / cells[0];
    for (int k = 1; k < 3; k++)
        if (fabs(p->size[k] / cells[k] - edge) > 1e-6 * edge)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "specimen.size / specimen.cells is %g x %g x %g m; the cells must be cubes",
                     edge, p->size[1] / cells[1], p->size[2] / cells[2]);
    BRC_TRY(brc_seeds_alloc(ctx, out, (size_t)count, false));
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    if (!rng)
        return BRC_ERR_MEMORY;
    gsl_rng_set(rng, (unsigned long)p->seed);
    for (size_t i = 0; i < out->n; i++) {
        const int at[3] = {(int)(i % (size_t)cells[0]), (int)(i / (size_t)cells[0]) % cells[1],
                           (int)(i / (size_t)cells[0]) / cells[1]};
        for (int k = 0; k < 3; k++) {
            double offset = 0.5 + p->jitter * (gsl_rng_uniform(rng) - 0.5);
            out->x[i][k] = p->size[k] * (at[k] + offset) / cells[k];
        }
    }
    gsl_rng_free(rng);
    return check_near(ctx, out, edge, "specimen.jitter, specimen.seed", "", NULL);
}

/* Radii are given for all or for none, as rows of a file have one width. A radius of 0 is allowed,
 * and its cell is what the neighbours leave. */
static int take_rows(struct brc_context *ctx, const char *path, double domain_volume,
                     const struct brc_numbers *rows, struct brc_seeds *out)
{
    size_t width = (size_t)rows->width;
    BRC_TRY(brc_seeds_alloc(ctx, out, rows->n, width == 4));
    for (size_t i = 0; i < rows->n; i++) {
        const double *row = rows->value + i * width;
        brc_copy(out->x[i], row);
        if (!out->radius)
            continue;
        out->radius[i] = row[3];
        if (row[3] < 0)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "specimen.points: %s:%d: the radius is %g m; allowed [0, inf)", path,
                     rows->line[i], row[3]);
    }
    return check_near(ctx, out, cbrt(domain_volume / (double)rows->n), "specimen.points", path,
                      rows);
}

/* Seeds stay in the order of the file until they are checked: messages name its lines. */
int brc_seeds_points(struct brc_context *ctx, const struct brc_specimen_params *p,
                     double domain_volume, struct brc_seeds *out)
{
    struct brc_numbers rows;
    if (!*p->points)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.grains: points needs specimen.points, a file of 'x y z' a line");
    BRC_TRY(brc_numbers_read(ctx, "specimen.points", p->points, "x y z' or 'x y z radius", 3, 4,
                             &rows));
    int code = take_rows(ctx, p->points, domain_volume, &rows, out);
    brc_numbers_free(&rows);
    return code;
}

/* Cells get their numbers from their seeds, so that this order is that of the grains in memory and
 * in files. */
int brc_seeds_sort(struct brc_context *ctx, struct brc_seeds *s)
{
    struct brc_seeds sorted = {0};
    size_t *order = brc_pool_alloc(ctx, &s->pool, s->n, sizeof *order);
    int code = order ? brc_seeds_alloc(ctx, &sorted, s->n, s->radius != NULL) : BRC_ERR_MEMORY;
    if (code == 0)
        code = brc_hilbert_order(ctx, s->x, s->n, order);
    for (size_t i = 0; code == 0 && i < s->n; i++) {
        brc_copy(sorted.x[i], s->x[order[i]]);
        if (s->radius)
            sorted.radius[i] = s->radius[order[i]];
    }
    brc_seeds_free(code == 0 ? s : &sorted);
    *s = code == 0 ? sorted : *s;
    return code;
}
