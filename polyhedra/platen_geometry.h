/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Core vertices of grains at platens: the loop has four, energy and springs one alone, in all
 * lanes. a is the grain, b the platen, which has no rounding: the contact distance is R. */
#ifndef POLY_PLATEN_GEOMETRY_H
#define POLY_PLATEN_GEOMETRY_H

#include "polyhedra/poly.h"

/* Vertices by their numbers in st->global_vertices, at platens by their bodies; also of what would
 * touch if R were larger by skin. Returns where they touch. */
BRC_LANES_INLINE brc_mask poly_platen_geometry(struct poly_geometry4 *t, const struct brc_sim *sim,
                                               const struct poly_state *st,
                                               const size_t vertex[BRC_LANES],
                                               const int32_t body[BRC_LANES], double skin)
{
    double at[3][BRC_LANES], normal[3][BRC_LANES], height[BRC_LANES];
    brc_lanes v[3], out[3];
    for (int k = 0; k < BRC_LANES; k++) {
        const struct brc_platen *platen = brc_sim_platen(sim, body[k]);
        const double *x = st->global_vertices[vertex[k]];
        /* The surface is asked for one point at a time, as the four may be at different platens. */
        double n[3];
        if (!brc_platen_height(platen, sim->bodies.x[body[k]], x, &height[k], n))
            height[k] = HUGE_VAL; /* beyond a sharp edge */
        for (int j = 0; j < 3; j++) {
            at[j][k] = x[j];
            normal[j][k] = n[j];
        }
    }
    poly_set3(v, brc_lanes_at(at[0]), brc_lanes_at(at[1]), brc_lanes_at(at[2]));
    poly_set3(out, brc_lanes_at(normal[0]), brc_lanes_at(normal[1]), brc_lanes_at(normal[2]));
    brc_mask touches = poly_vertex_geometry(t, v, brc_lanes_at(height), out, brc_lanes_all(-1),
                                            poly_params_of(sim)->radius + skin);
    poly_hide_apart(t, touches);
    return touches;
}

/* Number of the vertex of a point of a platen contact. */
static inline size_t poly_platen_vertex(const struct brc_sim *sim, const struct poly_state *st,
                                        size_t row, size_t p)
{
    const struct poly_points *points = sim->platens.point_columns;
    return st->shapes.vertex_first[sim->platens.a[row]] + (size_t)points->i[p];
}

/* A point of a platen contact alone. */
static inline bool poly_platen_contact(struct poly_geometry *t, const struct brc_sim *sim,
                                       const struct poly_state *st, size_t row, size_t p,
                                       double skin)
{
    size_t v = poly_platen_vertex(sim, st, row, p), vertex[BRC_LANES] = {v, v, v, v};
    int32_t b = sim->platens.b[row], body[BRC_LANES] = {b, b, b, b};
    struct poly_geometry4 all;
    brc_mask touches = poly_platen_geometry(&all, sim, st, vertex, body, skin);
    poly_geometry_lane(t, &all, 0);
    return touches[0] != 0;
}

#endif
