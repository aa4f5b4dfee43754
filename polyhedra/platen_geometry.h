/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Core vertices of grains at platens: the loop has four, energy and springs one alone, in all
 * lanes. a is the grain, b the platen, which has no rounding: the contact distance is R. Vertices
 * alone: a plane touches a convex body at its vertices first, and on a round surface edges and
 * faces between them are not seen. */
#ifndef POLY_PLATEN_GEOMETRY_H
#define POLY_PLATEN_GEOMETRY_H

#include "polyhedra/poly.h"

#include "common/engine/platen_surface.h"

/* Height beyond a sharp edge, in contact distances: far, but finite, since the place below a vertex
 * is height times normal, and 0 times infinity is no number. */
static const double POLY_BEYOND_EDGE = 1e3;

/* Heights s and outward normals of four vertices v over their platens; far above them beyond a
 * sharp edge. Four that are at one platen, as most are, ask its surface at once. */
BRC_LANES_INLINE void poly_platen_heights(brc_lanes *s, brc_lanes out[3], const struct brc_sim *sim,
                                          const brc_lanes v[3], const int32_t body[BRC_LANES])
{
    const double(*x)[3] = (const double(*)[3])sim->bodies.x;
    for (int k = 0; k < BRC_LANES; k++) {
        const struct brc_platen *platen = brc_sim_platen(sim, body[k]);
        brc_lanes height, normal[3];
        if (k > 0 && body[k] == body[k - 1])
            continue;
        brc_mask is_over = brc_platen_heights(platen, x[body[k]], v, &height, normal);
        height = brc_lanes_pick(is_over, height,
                                brc_lanes_all(POLY_BEYOND_EDGE * poly_params_of(sim)->radius));
        for (int lane = k; lane < BRC_LANES; lane++) {
            (*s)[lane] = height[lane];
            for (int j = 0; j < 3; j++)
                out[j][lane] = normal[j][lane];
        }
    }
}

/* Vertices by their numbers in st->global_vertices, at platens by their bodies; also of what would
 * touch if R were larger by skin. Returns where they touch. A platen pushes the vertex out along
 * its own normal there, so sign is -1: the vertex belongs to a. */
BRC_LANES_INLINE brc_mask poly_platen_geometry(struct poly_geometry4 *t, const struct brc_sim *sim,
                                               const struct poly_state *st,
                                               const int32_t vertex[BRC_LANES],
                                               const int32_t body[BRC_LANES], double skin)
{
    brc_lanes v[3], s, out[3];
    brc_lanes_gather3(v, st->global_vertices, vertex);
    poly_platen_heights(&s, out, sim, v, body);
    brc_mask touches =
        poly_vertex_geometry(t, v, s, out, brc_lanes_all(-1), poly_params_of(sim)->radius + skin);
    poly_hide_apart(t, touches);
    return touches;
}

/* Number of the vertex of a point of a platen contact. */
static inline int32_t poly_platen_vertex(const struct brc_sim *sim, const struct poly_state *st,
                                         size_t contact, size_t p)
{
    const struct poly_points *points = sim->platens.point_columns;
    return (int32_t)st->shapes.first[sim->platens.a[contact]].vertex + points->i[p];
}

/* A point of a platen contact alone. */
static inline bool poly_platen_contact(struct poly_geometry *t, const struct brc_sim *sim,
                                       const struct poly_state *st, size_t contact, size_t p,
                                       double skin)
{
    int32_t v = poly_platen_vertex(sim, st, contact, p), vertex[BRC_LANES] = {v, v, v, v};
    int32_t b = sim->platens.b[contact], body[BRC_LANES] = {b, b, b, b};
    struct poly_geometry4 all;
    brc_mask touches = poly_platen_geometry(&all, sim, st, vertex, body, skin);
    poly_geometry_lane(t, &all, 0);
    return touches[0] != 0;
}

#endif
