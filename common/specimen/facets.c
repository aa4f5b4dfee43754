/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checks that every specimen passes before a model sees it, in every build: tessellations fail
 * for inputs that nobody foresees, and a cell that is not closed gives wrong forces without a sign.
 * Asked of all makers alike: CGAL's cells, the disc's prisms and the cells of a file. Knows nothing
 * of how cells are mended; whoever can, tries again with another tolerance. */
#include "common/specimen/facets.h"

#include "common/base/table.h"
#include "common/geometry/edges.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

/* Limits of brc_facets_verify, relative to the cell or the domain. They are far above rounding and
 * far below any real fault. Cells of a file fail them by what its digits leave open: this many
 * units of the last digit, more on the plane of a facet that is small. */
static const double closure_limit = 1e-8;
static const double convexity_limit = 1e-6;
static const double volume_limit = 1e-12;
static const double digits_margin = 8;

void brc_facets_free(struct brc_facets *f)
{
    brc_pool_free(&f->pool);
    memset(f, 0, sizeof *f);
}

/* Apart from the arrays of the cells, since seeds are there first: cells are measured from them. */
int brc_facets_seeds(struct brc_context *ctx, struct brc_facets *f, size_t n)
{
    f->seed = brc_pool_alloc(ctx, &f->pool, n, sizeof *f->seed);
    f->radius = brc_pool_alloc(ctx, &f->pool, n, sizeof *f->radius);
    return f->seed && f->radius ? 0 : BRC_ERR_MEMORY;
}

/* |sum A n| / sum A over the facets of a cell: 0 for a closed body of flat facets. A facet without
 * area has its loop the wrong way round, or has collapsed. */
static double cell_closure(const struct brc_facets *f, size_t cell, bool *has_reversed)
{
    double sum[3] = {0, 0, 0}, total = 0;
    *has_reversed = false;
    for (size_t k = f->cell_first[cell]; k < f->cell_first[cell + 1]; k++) {
        int32_t facet = f->cell_facet[k];
        double sign = f->cell[facet][0] == (int32_t)cell ? 1 : -1;
        brc_axpy(sum, sign * f->area[facet], f->normal[facet]);
        total += f->area[facet];
        *has_reversed = *has_reversed || !(f->area[facet] > 0);
    }
    return total > 0 ? brc_norm(sum) / total : 1;
}

/* |sum of the cells / volume of the domain - 1|. The sum is compensated, as the limit is near what
 * a plain one loses over many cells. */
static double volume_error(const struct brc_facets *f, double domain_volume)
{
    double sum = 0, rest = 0;
    for (size_t i = 0; i < f->n_cells; i++) {
        double term = f->volume[i] - rest, next = sum + term;
        rest = (next - sum) - term;
        sum = next;
    }
    return fabs(sum / domain_volume - 1);
}

/* Those on the boundary are as large as the cells are cut, and no contact of grains. */
double brc_facets_inner_area(const struct brc_facets *f, size_t *n)
{
    double area = 0;
    *n = 0;
    for (size_t i = 0; i < f->n_facets; i++)
        if (f->cell[i][1] >= 0) {
            area += f->area[i];
            ++*n;
        }
    return area;
}

double brc_facets_radius(const struct brc_facets *f, size_t cell)
{
    return f->radius[cell] > 0 ? f->radius[cell] : cbrt(3 * f->volume[cell] / (4 * BRC_PI));
}

/* Of the mean inner area, so that the limit goes with the size of the grains. Facets on the
 * boundary always count: platens bear on all of them. */
void brc_facets_mark_contacts(struct brc_facets *f, double min_area_ratio)
{
    size_t n;
    double total = brc_facets_inner_area(f, &n);
    double limit = n > 0 ? min_area_ratio * total / (double)n : 0;
    f->area_dropped = 0;
    for (size_t i = 0; i < f->n_facets; i++) {
        f->is_contact[i] = f->cell[i][1] < 0 || f->area[i] >= limit;
        if (!f->is_contact[i])
            f->area_dropped += f->area[i];
    }
}

/* By area and perimeter rather than by the smallest extent in the plane, which would take a
 * rotating search; for a long rectangle both are its width. */
double brc_facets_width(const struct brc_facets *f, size_t facet)
{
    double perimeter = 0;
    for (size_t i = f->first[facet]; i < f->first[facet + 1]; i++) {
        size_t j = i + 1 < f->first[facet + 1] ? i + 1 : f->first[facet];
        perimeter += brc_distance(f->vertex[f->loop[j]], f->vertex[f->loop[i]]);
    }
    return 2 * f->area[facet] / perimeter;
}

/* Through the centroid, which lies in the middle of what the digits of the vertices leave open; a
 * single vertex may be off by the whole of it. */
void brc_facets_cell_planes(const struct brc_facets *f, size_t cell, struct brc_plane *planes)
{
    for (size_t k = f->cell_first[cell]; k < f->cell_first[cell + 1]; k++) {
        int32_t facet = f->cell_facet[k];
        struct brc_plane *p = planes + (k - f->cell_first[cell]);
        brc_scale(p->n, f->normal[facet], f->cell[facet][0] == (int32_t)cell ? 1 : -1);
        p->d = brc_dot(p->n, f->centroid[facet]);
        p->id = facet;
    }
}

/* Number of vertex v among the first n of list, added when it is new. Cells have some tens of
 * vertices, for which a search is the quickest index. */
static int32_t local_number(int32_t *list, size_t *n, int32_t v)
{
    for (size_t i = 0; i < *n; i++)
        if (list[i] == v)
            return (int32_t)i;
    list[*n] = v;
    return (int32_t)(*n)++;
}

/* One cell at a time, in the caller's work space: what is asked of whole cells (closed, convex, its
 * core) is asked once each, and cells that were kept as bodies would hold each facet twice and each
 * vertex several times. */
int brc_facets_cell(struct brc_context *ctx, const struct brc_facets *f, size_t cell,
                    struct brc_convex *c)
{
    size_t n_faces = f->cell_first[cell + 1] - f->cell_first[cell], n_loop = 0;
    for (size_t k = f->cell_first[cell]; k < f->cell_first[cell + 1]; k++)
        n_loop += f->first[f->cell_facet[k] + 1] - f->first[f->cell_facet[k]];
    BRC_TRY(brc_convex_reserve(ctx, c, n_loop, n_faces, n_loop));
    int32_t *list = brc_alloc(ctx, n_loop, sizeof *list);
    if (!list)
        return BRC_ERR_MEMORY;
    brc_facets_cell_planes(f, cell, c->plane);
    c->n_vertices = 0;
    c->n_faces = n_faces;
    c->first[0] = 0;
    for (size_t k = 0; k < n_faces; k++) {
        int32_t facet = f->cell_facet[f->cell_first[cell] + k];
        size_t first = f->first[facet], n = f->first[facet + 1] - first;
        bool reverse = f->cell[facet][0] != (int32_t)cell;
        for (size_t i = 0; i < n; i++)
            c->loop[c->first[k] + i] =
                local_number(list, &c->n_vertices, f->loop[first + (reverse ? n - 1 - i : i)]);
        c->first[k + 1] = c->first[k] + n;
    }
    for (size_t v = 0; v < c->n_vertices; v++)
        brc_copy(c->vertex[v], f->vertex[list[v]]);
    free(list);
    return 0;
}

/* Each edge once in each direction, and Euler's formula, which tells one body from two that share
 * nothing. */
static bool is_closed(const struct brc_convex *c, const struct brc_edges *edges)
{
    if (edges->n_sides != 2 * edges->n || c->n_vertices + c->n_faces != edges->n + 2)
        return false;
    for (size_t i = 0; i < edges->n_sides; i += 2) {
        const struct brc_side *p = &edges->side[i], *q = p + 1;
        if (p->edge != q->edge || p->is_rising == q->is_rising)
            return false;
    }
    return true;
}

/* Each vertex of the cell lies behind each of its planes, but for what the digits of a file leave
 * open: a narrow facet's plane turns by a digit over its width, and is off by as many more digits
 * as the cell is larger than that. */
static bool is_convex(const struct brc_facets *f, const struct brc_convex *c, double size)
{
    for (size_t k = 0; k < c->n_faces; k++) {
        double width = brc_facets_width(f, (size_t)c->plane[k].id);
        double blur = digits_margin * f->precision * (1 + size / width);
        double limit = c->plane[k].d + fmax(convexity_limit * size, blur);
        for (size_t v = 0; v < c->n_vertices; v++)
            if (brc_dot(c->plane[k].n, c->vertex[v]) > limit)
                return false;
    }
    return true;
}

/* The first fault is told, from gross to subtle, since the later questions presume the earlier
 * ones. The comparisons are such that NAN is a fault. */
static int verify_cell(struct brc_context *ctx, const struct brc_facets *f, size_t cell,
                       const double origin[3], struct brc_convex *c, struct brc_edges *edges)
{
    BRC_TRY(brc_facets_cell(ctx, f, cell, c));
    BRC_TRY(brc_edges_find(ctx, edges, c->n_faces, c->first, c->loop));
    const char *fault = NULL;
    bool has_reversed;
    double closure = cell_closure(f, cell, &has_reversed), size = cbrt(f->volume[cell]);
    if (!(f->volume[cell] > 0))
        fault = "has no volume";
    else if (!is_closed(c, edges))
        fault = "is not a closed body: an edge has not exactly two facets";
    else if (!(closure <= fmax(closure_limit, digits_margin * f->precision / size)))
        fault = "is not closed: its facets' areas do not balance";
    else if (has_reversed)
        fault = "has a facet turned inside out";
    else if (!is_convex(f, c, size))
        fault = "is not convex";
    double seed[3];
    brc_add(seed, f->seed[cell], origin);
    if (fault)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "cell %zu of the seed at (%g, %g, %g) %s (volume %g m3, closure error %g); move "
                 "seeds that nearly coincide or are nearly regular",
                 cell, seed[0], seed[1], seed[2], fault, f->volume[cell], closure);
    return 0;
}

/* Cells first, as a fault there has a place; the sum of the volumes, which has none, finds what is
 * left: cells that overlap, or that do not fill the domain together. */
int brc_facets_verify(struct brc_context *ctx, const struct brc_facets *f, double domain_volume,
                      const double origin[3])
{
    struct brc_convex c = {0};
    struct brc_edges edges = {0};
    int code = 0;
    for (size_t i = 0; i < f->n_cells && code == 0; i++)
        code = verify_cell(ctx, f, i, origin, &c, &edges);
    brc_convex_free(&c);
    brc_edges_free(&edges);
    BRC_TRY(code);
    double error = volume_error(f, domain_volume);
    if (!(error <= volume_limit))
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "the cells' volumes sum to %.3g of the domain's volume too much or too little",
                 error);
    return 0;
}

static void shift(double (*x)[3], size_t n, const double by[3])
{
    for (size_t i = 0; i < n; i++)
        brc_add(x[i], x[i], by);
}

/* Normals have no place, and radii, areas and volumes are of the body itself. */
void brc_facets_shift(struct brc_facets *f, const double by[3])
{
    shift(f->vertex, f->n_vertices, by);
    shift(f->centroid, f->n_facets, by);
    shift(f->centre, f->n_cells, by);
    shift(f->seed, f->n_cells, by);
}

/* Areas, normals and volumes follow from these. */
uint64_t brc_facets_hash(const struct brc_facets *f)
{
    const size_t n[4] = {f->n_cells, f->n_facets, f->n_vertices, f->first[f->n_facets]};
    uint64_t hash = brc_hash_bytes(n, sizeof n, BRC_HASH_SEED);
    hash = brc_hash_bytes(f->seed, f->n_cells * sizeof *f->seed, hash);
    hash = brc_hash_bytes(f->radius, f->n_cells * sizeof *f->radius, hash);
    hash = brc_hash_bytes(f->cell, f->n_facets * sizeof *f->cell, hash);
    hash = brc_hash_bytes(f->is_contact, f->n_facets * sizeof *f->is_contact, hash);
    hash = brc_hash_bytes(f->loop, f->first[f->n_facets] * sizeof *f->loop, hash);
    return brc_hash_bytes(f->vertex, f->n_vertices * sizeof *f->vertex, hash);
}
