/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shape operation: cells become eroded cores with the mass of the whole cell. Called once, by
 * sim.c. Erosion itself is geometry and stands in common/specimen/erosion.h; what a core is for is
 * not known there, and how it is cut not here. */
#include "polyhedra/poly.h"

#include "common/specimen/erosion.h"

/* The smallest of the grains' largest inscribed spheres, below a radius that some grain lacks. What
 * fails on the way does not replace the message that this radius is for. */
static double smallest_inscribed(struct brc_erosion *e, const struct brc_facets *f, double radius)
{
    for (size_t i = 0; i < f->n_cells; i++) {
        struct brc_context own = BRC_CONTEXT_INIT;
        if (brc_erosion_begin(&own, e, f, i) != 0)
            continue;
        bool is_kept = brc_erosion_core(&own, e, radius, f->centre[i]) == 0 && e->core.n_faces > 0;
        if (!is_kept)
            radius = brc_erosion_inscribed(e, radius);
    }
    return radius;
}

/* Moves the core to the body frame and adds it. The frame is that of the principal axes of the
 * whole cell: there the inertia is diagonal, as the integrator wants it, and the core never
 * changes. */
static int add_core(struct brc_context *ctx, struct poly_shapes *shapes, struct brc_convex *core,
                    const double x[3], const double q[4])
{
    double m[3][3], d[3];
    brc_quat_matrix(m, q);
    for (size_t v = 0; v < core->n_vertices; v++) {
        brc_sub(d, core->vertex[v], x);
        brc_mat_mul_t(core->vertex[v], m, d);
    }
    for (size_t i = 0; i < core->n_faces; i++) {
        brc_copy(d, core->plane[i].n);
        brc_mat_mul_t(core->plane[i].n, m, d);
    }
    return poly_shapes_add(ctx, shapes, core);
}

/* Mass, centre and inertia are those of the cell before erosion: a rock has no gaps where its
 * grains are rounded. */
static int shape_cell(struct brc_sim *sim, struct poly_state *st, struct brc_erosion *e, size_t i)
{
    struct brc_context *ctx = sim->ctx;
    const struct brc_facets *f = &sim->specimen->facets;
    const struct poly_params *p = poly_params_of(sim);
    struct brc_bodies *b = &sim->bodies;
    double inertia[3][3], moment[3];
    BRC_TRY(brc_erosion_begin(ctx, e, f, i));
    brc_convex_mass(&e->cell, &b->volume[i], b->x[i], inertia);
    BRC_TRY(poly_principal(ctx, (const double(*)[3])inertia, moment, b->q[i]));
    b->true_mass[i] = p->density * b->volume[i];
    brc_scale(b->true_inertia[i], moment, p->density);
    BRC_TRY(brc_erosion_core(ctx, e, p->radius, b->x[i]));
    if (e->core.n_faces == 0)
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "polyhedra.radius = %g m erodes grain %zu (volume %g m3) away; all grains keep a core "
            "below %g m, the smallest inscribed sphere: use a smaller radius or larger grains",
            p->radius, i, b->volume[i], smallest_inscribed(e, f, p->radius));
    /* Bonds may take the mean of a facet's two areas, and the header says how many facets lose one
     * of them (bonding.c). */
    BRC_TRY(brc_erosion_areas(ctx, e, st->eroded));
    BRC_TRY(add_core(ctx, &st->shapes, &e->core, b->x[i], b->q[i]));
    /* The rounding reaches R farther than any vertex of the core. */
    b->bounding_radius[i] = brc_convex_reach(&e->core, (double[3]){0, 0, 0}) + p->radius;
    return 0;
}

int poly_shape(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    struct brc_erosion e = {0};
    int code = 0;
    st->eroded = brc_alloc(sim->ctx, sim->specimen->facets.n_facets, sizeof *st->eroded);
    if (st->eroded == NULL)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < sim->bodies.n_grains; i++)
        code = shape_cell(sim, st, &e, i);
    brc_erosion_free(&e);
    BRC_TRY(code);
    st->global_vertices =
        brc_alloc(sim->ctx, st->shapes.first[st->shapes.n].vertex, sizeof *st->global_vertices);
    st->rotation = brc_alloc(sim->ctx, sim->bodies.n, sizeof *st->rotation);
    st->global_planes =
        brc_alloc(sim->ctx, st->shapes.first[st->shapes.n].face, sizeof *st->global_planes);
    if (st->global_vertices == NULL || st->rotation == NULL || st->global_planes == NULL)
        return BRC_ERR_MEMORY;
    /* Platens do not turn, but they are posed like all bodies. */
    for (size_t i = sim->bodies.n_grains; i < sim->bodies.n; i++)
        sim->bodies.q[i][0] = 1;
    return 0;
}
