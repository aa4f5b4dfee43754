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
#include <stdlib.h>
#include <string.h>

/* Seeds nearer than this part of the grain size (of equal cubes) are one grain cut in two by a bond
 * that is a thousand times too stiff. */
static const double least_distance = 1e-3;

void brc_seeds_free(struct brc_seeds *s)
{
    free(s->x);
    free(s->radius);
    *s = (struct brc_seeds){0};
}

/* No two seeds are too near to each other; a line of the file that each of them stands in, or NULL.
 */
static int check_near(struct brc_context *ctx, const struct brc_seeds *s, double size,
                      const char *key, const int *line)
{
    struct brc_neighbours near = {0};
    double *reach = brc_alloc(ctx, s->n, sizeof *reach), least = least_distance * size, d[3];
    int code = reach ? 0 : BRC_ERR_MEMORY;
    if (code == 0)
        code = brc_grid_pairs(ctx, (const double(*)[3])s->x, reach, s->n, least, &near);
    if (code == 0 && near.n > 0) {
        int32_t a = near.pair[0][0], b = near.pair[0][1];
        const double *x = s->x[b];
        brc_sub(d, x, s->x[a]);
        code = brc_error_set(ctx, BRC_ERR_GEOMETRY, __FILE__, __LINE__,
                             "%s: the seeds of %s %d and %d, at (%g, %g, %g) m, are %.3g m apart; "
                             "the least is %.3g m, a thousandth of the grain size: remove or move "
                             "one of them",
                             key, line ? "lines" : "numbers", line ? line[a] : a,
                             line ? line[b] : b, x[0], x[1], x[2], brc_norm(d), least);
    }
    brc_neighbours_free(&near);
    free(reach);
    return code;
}

int brc_seeds_grid(struct brc_context *ctx, const struct brc_specimen_params *p,
                   struct brc_seeds *out)
{
    const int *cells = p->cells;
    double count = (double)cells[0] * cells[1] * cells[2];
    *out = (struct brc_seeds){0};
    if (count > BRC_MAX_GRAINS)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.cells gives %g seeds, at most %g are allowed", count,
                 (double)BRC_MAX_GRAINS);
    double edge = p->size[0] / cells[0];
    for (int k = 1; k < 3; k++)
        if (fabs(p->size[k] / cells[k] - edge) > 1e-6 * edge)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "specimen.size / specimen.cells is %g x %g x %g m; the cells must be cubes",
                     edge, p->size[1] / cells[1], p->size[2] / cells[2]);
    out->n = (size_t)count;
    out->x = brc_alloc(ctx, out->n, sizeof *out->x);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    if (!out->x || !rng) {
        brc_seeds_free(out);
        return BRC_ERR_MEMORY;
    }
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
    int code = check_near(ctx, out, edge, "specimen.jitter, specimen.seed", NULL);
    if (code != 0)
        brc_seeds_free(out);
    return code;
}

/* A row of the file, for sorting by place. */
struct place {
    double x[3];
    int line;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->x[k] != q->x[k])
            return p->x[k] < q->x[k] ? -1 : 1;
    return p->line < q->line ? -1 : p->line > q->line;
}

/* No two rows at one place, no negative radius. */
static int check_points(struct brc_context *ctx, const char *path, const struct brc_numbers *rows)
{
    struct place *place = brc_alloc(ctx, rows->n, sizeof *place);
    int code = place ? 0 : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < rows->n; i++) {
        const double *row = rows->value + i * (size_t)rows->width;
        brc_copy(place[i].x, row);
        place[i].line = rows->line[i];
        if (rows->width == 4 && row[3] < 0)
            code = brc_error_set(ctx, BRC_ERR_INPUT, __FILE__, __LINE__,
                                 "specimen.points: %s:%d: the radius is %g m; allowed [0, inf)",
                                 path, rows->line[i], row[3]);
    }
    if (code == 0)
        qsort(place, rows->n, sizeof *place, compare_places);
    for (size_t i = 1; code == 0 && i < rows->n; i++) {
        const struct place *p = &place[i - 1], *q = &place[i];
        if (p->x[0] == q->x[0] && p->x[1] == q->x[1] && p->x[2] == q->x[2])
            code = brc_error_set(ctx, BRC_ERR_GEOMETRY, __FILE__, __LINE__,
                                 "specimen.points: %s:%d: the seed coincides with that of line "
                                 "%d at (%g, %g, %g) m; remove or move one of them",
                                 path, q->line, p->line, q->x[0], q->x[1], q->x[2]);
    }
    free(place);
    return code;
}

int brc_seeds_points(struct brc_context *ctx, const struct brc_specimen_params *p,
                     double domain_volume, struct brc_seeds *out)
{
    struct brc_numbers rows;
    *out = (struct brc_seeds){0};
    if (!*p->points)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.grains: points needs specimen.points, a file of 'x y z' a line");
    BRC_TRY(brc_numbers_read(ctx, "specimen.points", p->points, "x y z' or 'x y z radius", 3, 4,
                             &rows));
    int code = check_points(ctx, p->points, &rows);
    if (code == 0) {
        out->n = rows.n;
        out->x = brc_alloc(ctx, rows.n, sizeof *out->x);
        out->radius = rows.width == 4 ? brc_alloc(ctx, rows.n, sizeof *out->radius) : NULL;
        code = ctx->code;
    }
    for (size_t i = 0; code == 0 && i < rows.n; i++) {
        const double *row = rows.value + i * (size_t)rows.width;
        brc_copy(out->x[i], row);
        if (out->radius)
            out->radius[i] = row[3];
    }
    if (code == 0)
        code = check_near(ctx, out, cbrt(domain_volume / (double)rows.n), "specimen.points",
                          rows.line);
    brc_numbers_free(&rows);
    if (code != 0)
        brc_seeds_free(out);
    return code;
}

int brc_seeds_sort(struct brc_context *ctx, struct brc_seeds *s)
{
    size_t *order = brc_alloc(ctx, s->n, sizeof *order);
    double(*x)[3] = brc_alloc(ctx, s->n, sizeof *x);
    double *radius = brc_alloc(ctx, s->n, sizeof *radius);
    int code = order && x && radius ? brc_hilbert_order(ctx, s->x, s->n, order) : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < s->n; i++) {
        brc_copy(x[i], s->x[order[i]]);
        radius[i] = s->radius ? s->radius[order[i]] : 0;
    }
    if (code == 0)
        memcpy(s->x, x, s->n * sizeof *x);
    if (code == 0 && s->radius)
        memcpy(s->radius, radius, s->n * sizeof *radius);
    free(order);
    free(x);
    free(radius);
    return code;
}
