/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The last steps of a complex: boundary vertices onto their planes, order, measures. Numbers of
 * facets and vertices are settled here, from those of the cells alone, so that they do not show in
 * what order CGAL or a file had them. */
#include "common/specimen/cell_complex.h"

#include "common/base/invariant.h"
#include "common/base/tuples.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

/* A plane on which a boundary vertex lies. */
struct incidence {
    int32_t vertex, plane;
};

/* Sort key of a facet: the low cell, then inner before boundary facets, then what is beyond. */
struct key {
    int32_t cell, is_boundary, other;
    size_t facet;
};

/* Moves x onto n planes, one after the other, each time along the planes that came before. A plane
 * that (nearly) follows from these is met already. Least squares over all of them would leave x
 * near each plane and on none. */
static void move_onto(double x[3], const struct brc_convex *domain, const struct incidence *list,
                      size_t n)
{
    double done[3][3];
    int n_done = 0;
    for (size_t i = 0; i < n && n_done < 3; i++) {
        const struct brc_plane *p = &domain->plane[list[i].plane];
        double q[3];
        brc_copy(q, p->n);
        for (int k = 0; k < n_done; k++)
            brc_axpy(q, -brc_dot(q, done[k]), done[k]);
        if (brc_normalise(q, q) < 1e-6)
            continue;
        brc_axpy(x, (p->d - brc_dot(p->n, x)) / brc_dot(p->n, q), q);
        brc_copy(done[n_done++], q);
    }
}

/* By vertex and not by facet: one on an edge or in a corner of the domain lies on two or three
 * planes and must end on all of them, whichever of its facets is met first. */
int brc_cell_complex_snap_to_planes(struct brc_context *ctx, struct brc_cell_complex *c,
                                    const struct brc_convex *domain)
{
    size_t n = 0;
    for (size_t f = 0; f < c->n_facets; f++)
        n += c->facet[f].face >= 0 ? (size_t)c->facet[f].n : 0;
    struct incidence *list = brc_alloc(ctx, n, sizeof *list);
    if (!list)
        return BRC_ERR_MEMORY;
    n = 0;
    for (size_t f = 0; f < c->n_facets; f++) {
        if (c->facet[f].face < 0)
            continue;
        int32_t plane = (int32_t)brc_convex_face(domain, c->facet[f].face);
        for (int32_t i = 0; i < c->facet[f].n; i++)
            list[n++] = (struct incidence){c->loop[c->facet[f].first + (size_t)i], plane};
    }
    qsort(list, n, sizeof *list, brc_tuple2_compare);
    for (size_t i = 0, end; i < n; i = end) {
        size_t m = 1;
        for (end = i + 1; end < n && list[end].vertex == list[i].vertex; end++)
            if (list[end].plane != list[i + m - 1].plane)
                list[i + m++] = list[end];
        move_onto(c->vertex[list[i].vertex], domain, list + i, m);
    }
    free(list);
    return 0;
}

/* Order of the facets: cell, then inner ones by neighbour, then boundary ones by face. */
static int sort_facets(struct brc_context *ctx, const struct brc_cell_complex *c, struct key *keys,
                       size_t *n_keys)
{
    size_t n = 0;
    for (size_t f = 0; f < c->n_facets; f++) {
        const struct brc_cell_complex_facet *facet = &c->facet[f];
        if (facet->n == 0)
            continue;
        if (facet->face == BRC_FACE_OPEN)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "cell %d is not bounded by the domain", facet->cell[0]);
        bool is_boundary = facet->cell[1] < 0;
        keys[n++] = (struct key){facet->cell[0], is_boundary,
                                 is_boundary ? facet->face : facet->cell[1], f};
    }
    qsort(keys, n, sizeof *keys, brc_tuple3_compare);
    for (size_t i = 1; i < n; i++)
        if (brc_tuple3_compare(&keys[i], &keys[i - 1]) == 0)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "cell %d has two facets towards %s %d", keys[i].cell,
                     keys[i].is_boundary ? "boundary face" : "cell", keys[i].other);
    *n_keys = n;
    return 0;
}

/* When all numbers are known, so that nothing grows. There is room for the vertices that no facet
 * has, too: how many these are is known only when the others have been numbered. */
static int allocate(struct brc_context *ctx, const struct brc_cell_complex *c, size_t n,
                    struct brc_facets *out)
{
    struct brc_pool *pool = &out->pool;
    size_t n_loop = 0;
    for (size_t f = 0; f < c->n_facets; f++)
        n_loop += (size_t)c->facet[f].n;
    out->n_cells = c->n_cells;
    out->n_facets = n;
    out->volume = brc_pool_alloc(ctx, pool, c->n_cells, sizeof *out->volume);
    out->centre = brc_pool_alloc(ctx, pool, c->n_cells, sizeof *out->centre);
    out->cell_first = brc_pool_alloc(ctx, pool, c->n_cells + 1, sizeof *out->cell_first);
    out->cell_facet = brc_pool_alloc(ctx, pool, 2 * n, sizeof *out->cell_facet);
    out->cell = brc_pool_alloc(ctx, pool, n, sizeof *out->cell);
    out->face = brc_pool_alloc(ctx, pool, n, sizeof *out->face);
    out->is_contact = brc_pool_alloc(ctx, pool, n, sizeof *out->is_contact);
    out->area = brc_pool_alloc(ctx, pool, n, sizeof *out->area);
    out->centroid = brc_pool_alloc(ctx, pool, n, sizeof *out->centroid);
    out->normal = brc_pool_alloc(ctx, pool, n, sizeof *out->normal);
    out->first = brc_pool_alloc(ctx, pool, n + 1, sizeof *out->first);
    out->loop = brc_pool_alloc(ctx, pool, n_loop, sizeof *out->loop);
    out->vertex = brc_pool_alloc(ctx, pool, c->n_vertices, sizeof *out->vertex);
    return pool->is_failed ? BRC_ERR_MEMORY : 0;
}

/* Copies the facets in order; vertices are numbered as they come, so that those of a facet are near
 * in memory and those that no facet has are left behind. number is all -1. */
static void copy_facets(const struct brc_cell_complex *c, const struct key *keys, int32_t *number,
                        struct brc_facets *out)
{
    out->n_vertices = 0;
    for (size_t f = 0; f < out->n_facets; f++) {
        const struct brc_cell_complex_facet *from = &c->facet[keys[f].facet];
        out->cell[f][0] = from->cell[0];
        out->cell[f][1] = from->cell[1];
        out->face[f] = from->cell[1] < 0 ? from->face : -1;
        out->is_contact[f] = 1;
        brc_copy(out->normal[f], from->normal);
        out->first[f + 1] = out->first[f] + (size_t)from->n;
        for (size_t i = 0; i < (size_t)from->n; i++) {
            int32_t v = c->loop[from->first + i];
            if (number[v] < 0) {
                number[v] = (int32_t)out->n_vertices;
                brc_copy(out->vertex[out->n_vertices++], c->vertex[v]);
            }
            out->loop[out->first[f] + i] = number[v];
        }
        out->area[f] = brc_polygon_area(out->vertex, out->loop + out->first[f], (size_t)from->n,
                                        out->normal[f], out->centroid[f]);
    }
}

/* Facets of each cell in ascending order: counts become ends, and filling from the last facet on
 * turns ends into starts. */
static void list_cells(struct brc_facets *out)
{
    for (size_t f = 0; f < out->n_facets; f++)
        for (int k = 0; k < 2; k++)
            if (out->cell[f][k] >= 0)
                out->cell_first[out->cell[f][k]]++;
    for (size_t i = 0; i < out->n_cells; i++)
        out->cell_first[i + 1] += out->cell_first[i];
    for (size_t f = out->n_facets; f-- > 0;)
        for (int k = 0; k < 2; k++)
            if (out->cell[f][k] >= 0)
                out->cell_facet[--out->cell_first[out->cell[f][k]]] = (int32_t)f;
}

/* Volume and centroid from cones of the facets' triangles over the seed. Both cells of a facet see
 * the same triangles, so the volumes sum to the domain. Any point would do as the top; the seed is
 * inside, where the cones are positive and nothing cancels. */
static void measure_cell(struct brc_facets *out, size_t cell)
{
    double volume = 0, moment[3] = {0, 0, 0};
    for (size_t k = out->cell_first[cell]; k < out->cell_first[cell + 1]; k++) {
        size_t f = (size_t)out->cell_facet[k];
        double sign = out->cell[f][0] == (int32_t)cell ? 1 : -1;
        for (size_t i = out->first[f] + 1; i + 1 < out->first[f + 1]; i++) {
            double p[3], q[3], r[3], cross[3];
            brc_sub(p, out->vertex[out->loop[out->first[f]]], out->seed[cell]);
            brc_sub(q, out->vertex[out->loop[i]], out->seed[cell]);
            brc_sub(r, out->vertex[out->loop[i + 1]], out->seed[cell]);
            brc_cross(cross, q, r);
            double v = sign * brc_dot(p, cross) / 6;
            volume += v;
            brc_axpy(moment, v / 4, p);
            brc_axpy(moment, v / 4, q);
            brc_axpy(moment, v / 4, r);
        }
    }
    out->volume[cell] = volume;
    brc_copy(out->centre[cell], out->seed[cell]);
    if (volume > 0)
        brc_axpy(out->centre[cell], 1 / volume, moment);
}

/* What all readers of the facets rely on: each has two cells in ascending order or one and a plane
 * of the domain, a loop of three vertices or more, and stands in the lists of its cells. That the
 * cells are closed and convex is geometry, which verify checks in every build. */
static bool is_consistent(const struct brc_facets *f)
{
    bool is_good = f->first[0] == 0 && f->cell_first[0] == 0;
    for (size_t i = 0; i < f->n_facets; i++) {
        int32_t low = f->cell[i][0], high = f->cell[i][1];
        is_good = is_good && low >= 0 && low < (int32_t)f->n_cells && high < (int32_t)f->n_cells &&
                  (high < 0 || low < high) && f->first[i] + 3 <= f->first[i + 1];
        for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
            is_good = is_good && f->loop[k] >= 0 && f->loop[k] < (int32_t)f->n_vertices;
    }
    for (size_t i = 0; i < f->n_cells; i++)
        for (size_t k = f->cell_first[i]; k < f->cell_first[i + 1]; k++) {
            const int32_t *cell = f->cell[f->cell_facet[k]];
            is_good = is_good && (cell[0] == (int32_t)i || cell[1] == (int32_t)i);
        }
    return is_good;
}

/* Sorting comes first, since it finds what is refused; from then on nothing but memory can fail. */
static int finish(struct brc_context *ctx, const struct brc_cell_complex *c, struct brc_pool *pool,
                  struct brc_facets *out)
{
    size_t n;
    struct key *keys = brc_pool_alloc(ctx, pool, c->n_facets, sizeof *keys);
    int32_t *number = brc_pool_alloc(ctx, pool, c->n_vertices, sizeof *number);
    if (!keys || !number)
        return BRC_ERR_MEMORY;
    BRC_TRY(sort_facets(ctx, c, keys, &n));
    BRC_TRY(allocate(ctx, c, n, out));
    memset(number, 0xff, c->n_vertices * sizeof *number);
    copy_facets(c, keys, number, out);
    list_cells(out);
    for (size_t i = 0; i < out->n_cells; i++)
        measure_cell(out, i);
    BRC_ASSERT(is_consistent(out));
    return 0;
}

int brc_cell_complex_finish(struct brc_context *ctx, const struct brc_cell_complex *c,
                            struct brc_facets *out)
{
    struct brc_pool pool = {0};
    int code = finish(ctx, c, &pool, out);
    brc_pool_free(&pool);
    return code;
}
