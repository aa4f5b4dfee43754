/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shape operation: cells become eroded cores with the mass of the whole cell. */
#include "poly.h"

#include <stdlib.h>

struct eroder {
    struct brc_convex cell, core;
    struct brc_plane *plane;
    double (*vertex)[3], (*normal)[3];
    int32_t *facet;
    size_t cap; /* of planes, normals and facets */
    size_t cap_vertices;
};

static void eroder_free(struct eroder *e)
{
    brc_convex_free(&e->cell);
    brc_convex_free(&e->core);
    free(e->plane);
    free(e->vertex);
    free(e->normal);
    free(e->facet);
}

static int grow_faces(struct brc_context *ctx, struct eroder *e, size_t n)
{
    if (n <= e->cap)
        return 0;
    free(e->plane);
    free(e->normal);
    free(e->facet);
    e->cap = 2 * n;
    e->plane = brc_alloc(ctx, e->cap, sizeof *e->plane);
    e->normal = brc_alloc(ctx, e->cap, sizeof *e->normal);
    e->facet = brc_alloc(ctx, e->cap, sizeof *e->facet);
    return e->plane && e->normal && e->facet ? 0 : BRC_ERR_MEMORY;
}

static int grow_vertices(struct brc_context *ctx, struct eroder *e, size_t n)
{
    if (n <= e->cap_vertices)
        return 0;
    free(e->vertex);
    e->cap_vertices = 2 * n;
    e->vertex = brc_alloc(ctx, e->cap_vertices, sizeof *e->vertex);
    return e->vertex ? 0 : BRC_ERR_MEMORY;
}

/* Core of a cell for an erosion radius; no faces when nothing is left. */
static int erode(struct brc_context *ctx, struct eroder *e, const struct brc_facets *f, size_t cell,
                 double radius, const double centre[3])
{
    size_t n = f->cell_first[cell + 1] - f->cell_first[cell];
    BRC_TRY(grow_faces(ctx, e, n));
    brc_facets_cell_planes(f, cell, e->plane);
    for (size_t i = 0; i < n; i++)
        e->plane[i].d -= radius;
    return brc_convex_from_planes(ctx, &e->core, e->plane, n, centre,
                                  2 * brc_convex_reach(&e->cell, centre));
}

/* Radius of the largest sphere inside a cell: that at which its core vanishes. */
static double inscribed_radius(struct brc_context *ctx, struct eroder *e,
                               const struct brc_facets *f, size_t cell, double high)
{
    double low = 0;
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (low + high);
        if (erode(ctx, e, f, cell, middle, f->centre[cell]) == 0 && e->core.n_faces >= 4)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The same for the grain with the smallest one, starting from a radius that some grain lacks. */
static double smallest_inscribed(struct brc_context *ctx, struct eroder *e,
                                 const struct brc_facets *f, double radius)
{
    for (size_t i = 0; i < f->n_cells; i++) {
        bool is_kept = brc_facets_cell(ctx, f, i, &e->cell) == 0 &&
                       erode(ctx, e, f, i, radius, f->centre[i]) == 0 && e->core.n_faces >= 4;
        if (!is_kept)
            radius = inscribed_radius(ctx, e, f, i, radius);
    }
    return radius;
}

/* The core in the body frame. */
static int add_core(struct brc_context *ctx, struct poly_shapes *shapes, struct eroder *e,
                    const double x[3], const double q[4])
{
    double m[3][3];
    brc_quat_matrix(m, q);
    BRC_TRY(grow_vertices(ctx, e, e->core.n_vertices));
    BRC_TRY(grow_faces(ctx, e, e->core.n_faces));
    for (size_t v = 0; v < e->core.n_vertices; v++) {
        double d[3];
        brc_sub(d, e->core.vertex[v], x);
        brc_mat_mul_t(e->vertex[v], m, d);
    }
    for (size_t i = 0; i < e->core.n_faces; i++) {
        brc_mat_mul_t(e->normal[i], m, e->core.plane[i].n);
        e->facet[i] = e->core.plane[i].id;
    }
    struct poly_solid solid = {
        e->core.n_vertices, (const double(*)[3])e->vertex, e->core.n_faces, e->core.first,
        e->core.loop,       (const double(*)[3])e->normal, e->facet};
    return poly_shapes_add(ctx, shapes, &solid);
}

static int shape_cell(struct brc_sim *sim, struct poly_state *st, struct eroder *e, size_t i)
{
    struct brc_context *ctx = sim->ctx;
    const struct brc_facets *f = &sim->specimen->facets;
    const struct poly_params *p = poly_params_of(sim);
    struct brc_bodies *b = &sim->bodies;
    double inertia[3][3], moment[3];
    BRC_TRY(brc_facets_cell(ctx, f, i, &e->cell));
    brc_convex_mass(&e->cell, &b->volume[i], b->x[i], inertia);
    BRC_TRY(poly_principal(ctx, (const double(*)[3])inertia, moment, b->q[i]));
    b->true_mass[i] = p->density * b->volume[i];
    brc_scale(b->true_inertia[i], moment, p->density);
    BRC_TRY(erode(ctx, e, f, i, p->radius, b->x[i]));
    if (e->core.n_faces < 4)
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "polyhedra.radius = %g m erodes grain %zu (volume %g m3) away; all grains keep a core "
            "below %g m, the smallest inscribed sphere: use a smaller radius or larger grains",
            p->radius, i, b->volume[i], smallest_inscribed(ctx, e, f, p->radius));
    BRC_TRY(add_core(ctx, &st->shapes, e, b->x[i], b->q[i]));
    b->reach[i] = poly_shapes_reach(&st->shapes, i) + p->radius;
    return 0;
}

int poly_shape(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    struct eroder e = {0};
    int code = 0;
    brc_convex_init(&e.cell);
    brc_convex_init(&e.core);
    for (size_t i = 0; code == 0 && i < sim->bodies.n_grains; i++)
        code = shape_cell(sim, st, &e, i);
    eroder_free(&e);
    BRC_TRY(code);
    st->world = brc_alloc(sim->ctx, st->shapes.vertex_first[st->shapes.n], sizeof *st->world);
    st->turn = brc_alloc(sim->ctx, sim->bodies.n, sizeof *st->turn);
    st->plane = brc_alloc(sim->ctx, st->shapes.face_first[st->shapes.n], sizeof *st->plane);
    if (st->world == NULL || st->turn == NULL || st->plane == NULL)
        return BRC_ERR_MEMORY;
    for (size_t i = sim->bodies.n_grains; i < sim->bodies.n; i++)
        sim->bodies.q[i][0] = 1;
    return 0;
}
