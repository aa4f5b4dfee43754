/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The disc of extruded triangles: gt12's Brazilian specimen, one grain thick. A mesh gives its
 * cells directly, so that no cut and no merging is needed: vertices are shared from the start, and
 * walls on the rim lie on the planes of the polygon but for rounding. Their normals are set to
 * those of the planes, since platens ask which facets face them. Called by specimen.c. */
#include "common/geometry/hilbert.h"
#include "common/specimen/tess.h"
#include "common/specimen/tess_cgal.h"
#include "common/geometry/vec.h"

#include <string.h>

enum { FACE_BOTTOM, FACE_TOP, FACE_SIDE };

struct disc {
    double radius, thickness;
    int n_sides;
    struct brc_cgal_mesh mesh;
    struct brc_cell_complex complex;
    double (*centre)[3];  /* [n_triangles] */
    size_t *order;        /* [n_triangles] triangle of a cell */
    int32_t *cell;        /* [n_triangles] cell of a triangle */
    struct brc_pool pool; /* owns the arrays, those of the mesh included */
};

/* Direction of side k's normal, or of corner k - 1/2; side 0 faces +y, where a platen stands. */
static double side_angle(const struct disc *d, double k)
{
    return BRC_PI / 2 + 2 * BRC_PI * k / d->n_sides;
}

static int make_mesh(struct brc_context *ctx, struct disc *d, double max_area)
{
    double(*corner)[2] = brc_pool_alloc(ctx, &d->pool, (size_t)d->n_sides, sizeof *corner);
    if (!corner)
        return BRC_ERR_MEMORY;
    for (int k = 0; k < d->n_sides; k++) {
        corner[k][0] = d->radius * cos(side_angle(d, k - 0.5));
        corner[k][1] = d->radius * sin(side_angle(d, k - 0.5));
    }
    return brc_cgal_triangulate(ctx, corner, (size_t)d->n_sides, max_area, &d->pool, &d->mesh);
}

/* Numbers the cells along a space-filling curve. */
static int number_cells(struct brc_context *ctx, struct disc *d)
{
    const struct brc_cgal_mesh *m = &d->mesh;
    d->centre = brc_pool_alloc(ctx, &d->pool, m->n_triangles, sizeof *d->centre);
    d->order = brc_pool_alloc(ctx, &d->pool, m->n_triangles, sizeof *d->order);
    d->cell = brc_pool_alloc(ctx, &d->pool, m->n_triangles, sizeof *d->cell);
    if (d->pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t t = 0; t < m->n_triangles; t++) {
        const int32_t *v = m->triangle[t];
        for (int k = 0; k < 2; k++)
            d->centre[t][k] = (m->vertex[v[0]][k] + m->vertex[v[1]][k] + m->vertex[v[2]][k]) / 3;
        d->centre[t][2] = d->thickness / 2;
    }
    BRC_TRY(brc_hilbert_order(ctx, d->centre, m->n_triangles, d->order));
    for (size_t i = 0; i < m->n_triangles; i++)
        d->cell[d->order[i]] = (int32_t)i;
    return 0;
}

/* Vertex v of the mesh is vertex 2 v of the complex at the bottom and 2 v + 1 at the top. */
static int add_vertices(struct brc_context *ctx, struct disc *d)
{
    for (size_t v = 0; v < d->mesh.n_vertices; v++)
        for (int top = 0; top < 2; top++) {
            double x[3] = {d->mesh.vertex[v][0], d->mesh.vertex[v][1], top ? d->thickness : 0};
            BRC_TRY(brc_cell_complex_add_vertex(ctx, &d->complex, x));
        }
    return 0;
}

/* The wall over the edge opposite to vertex k of a triangle; inner walls once, from the low cell.
 */
static int add_wall(struct brc_context *ctx, struct disc *d, size_t t, int k)
{
    int32_t u = d->mesh.triangle[t][(k + 1) % 3], v = d->mesh.triangle[t][(k + 2) % 3];
    int32_t other = d->mesh.neighbour[t][k];
    int32_t loop[4] = {2 * u, 2 * v, 2 * v + 1, 2 * u + 1};
    const double *p = d->mesh.vertex[u], *q = d->mesh.vertex[v];
    struct brc_cell_complex_facet facet = {{d->cell[t], -1}, BRC_FACE_INNER, 4, 0, {0, 0, 0}};
    brc_set(facet.normal, q[1] - p[1], p[0] - q[0], 0);
    brc_normalise(facet.normal, facet.normal);
    if (other >= 0) {
        facet.cell[1] = d->cell[other];
        if (facet.cell[1] < facet.cell[0])
            return 0;
    } else {
        double angle = atan2(facet.normal[1], facet.normal[0]) - side_angle(d, 0);
        int side = (int)lround(angle / (2 * BRC_PI) * d->n_sides);
        side = (side % d->n_sides + d->n_sides) % d->n_sides;
        facet.face = FACE_SIDE + side;
        double tilt = 2 * BRC_PI * side / d->n_sides;
        brc_set(facet.normal, -sin(tilt), cos(tilt), 0);
    }
    return brc_cell_complex_add_facet(ctx, &d->complex, &facet, loop);
}

/* Loops turn counter-clockwise about their normals, hence two corners of the bottom change places.
 */
static int add_prisms(struct brc_context *ctx, struct disc *d)
{
    for (size_t t = 0; t < d->mesh.n_triangles; t++) {
        const int32_t *v = d->mesh.triangle[t];
        int32_t bottom[3] = {2 * v[0], 2 * v[2], 2 * v[1]};
        int32_t top[3] = {2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1};
        struct brc_cell_complex_facet low = {{d->cell[t], -1}, FACE_BOTTOM, 3, 0, {0, 0, -1}};
        struct brc_cell_complex_facet high = {{d->cell[t], -1}, FACE_TOP, 3, 0, {0, 0, 1}};
        BRC_TRY(brc_cell_complex_add_facet(ctx, &d->complex, &low, bottom));
        BRC_TRY(brc_cell_complex_add_facet(ctx, &d->complex, &high, top));
        for (int k = 0; k < 3; k++)
            BRC_TRY(add_wall(ctx, d, t, k));
    }
    return 0;
}

static int make_disc(struct brc_context *ctx, struct disc *d, double max_area,
                     struct brc_facets *out)
{
    if (d->n_sides < 3 || !(d->radius > 0) || !(d->thickness > 0) || !(max_area > 0))
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "a disc mesh needs 3 or more sides and a radius, thickness and triangle area "
                 "above 0; these are %d, %g m, %g m, %g m2",
                 d->n_sides, d->radius, d->thickness, max_area);
    BRC_TRY(make_mesh(ctx, d, max_area));
    BRC_TRY(number_cells(ctx, d));
    size_t n = d->complex.n_cells = d->mesh.n_triangles;
    BRC_TRY(add_vertices(ctx, d));
    BRC_TRY(add_prisms(ctx, d));
    BRC_TRY(brc_facets_seeds(ctx, out, n));
    for (size_t i = 0; i < n; i++)
        brc_copy(out->seed[i], d->centre[d->order[i]]);
    BRC_TRY(brc_cell_complex_finish(ctx, &d->complex, out));
    double area = d->n_sides * d->radius * d->radius * sin(2 * BRC_PI / d->n_sides) / 2;
    const double zero[3] = {0, 0, 0};
    return brc_facets_verify(ctx, out, area * d->thickness, zero);
}

int brc_tess_disc(struct brc_context *ctx, double radius, double thickness, int n_sides,
                  double max_area, struct brc_facets *out)
{
    struct disc d = {.radius = radius, .thickness = thickness, .n_sides = n_sides};
    memset(out, 0, sizeof *out);
    int code = make_disc(ctx, &d, max_area, out);
    brc_cell_complex_free(&d.complex);
    brc_pool_free(&d.pool);
    if (code != 0)
        brc_facets_free(out);
    return code;
}
