/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The three meshes of a frame: grains (each with the polygons of its facets, where it is now),
 * bonds (a polygon a facet between grains, half-way between its two sides), and contacts (a line a
 * contact that carries force, between the centres). */
#ifndef BRC_FRAME_MESH_H
#define BRC_FRAME_MESH_H

#include "common/engine/fragments.h"
#include "common/output/mesh.h"
#include "common/engine/sim.h"

/* Values of the polygons of grains. Those of the whole grain stand in each of its polygons:
 * ParaView shows values by cell. */
#define BRC_GRAIN_CELL_FIELDS(SCALAR, VECTOR)                                                \
    SCALAR(int32_t, grain, BRC_STATE, "1", "grain that the polygon belongs to")              \
    SCALAR(int32_t, facet, BRC_STATE, "1", "facet of the specimen")                          \
    SCALAR(int32_t, neighbour, BRC_STATE, "1", "grain behind the facet, -1 on the boundary") \
    SCALAR(int32_t, fragment, BRC_STATE, "1", "fragment of the grain, 0 is the largest")     \
    SCALAR(double, fragment_volume, BRC_STATE, "m3", "volume of the fragment")               \
    VECTOR(double, displacement, 3, BRC_STATE, "m", "of the grain's centre since the start") \
    VECTOR(double, velocity, 3, BRC_STATE, "m s-1", "of the grain's centre")                 \
    VECTOR(double, spin, 3, BRC_STATE, "rad s-1", "angular velocity of the grain")

/* Values of the facets between grains that were bonded, intact and broken alike: what broke when,
 * and how far its sides are apart now. */
#define BRC_BOND_CELL_FIELDS(SCALAR, VECTOR)                                               \
    SCALAR(int32_t, facet, BRC_STATE, "1", "facet of the specimen")                        \
    SCALAR(int32_t, a, BRC_STATE, "1", "grain with the lower number")                      \
    SCALAR(int32_t, b, BRC_STATE, "1", "grain with the higher number")                     \
    SCALAR(uint8_t, status, BRC_STATE, "1", "0 never bonded, 1 intact, 2 broken")          \
    SCALAR(int32_t, mode, BRC_STATE, "1",                                                  \
           "that broke most of the area: 0 tension, 1 shear, 2 torsion; -1 nothing broke") \
    SCALAR(double, tension, BRC_STATE, "1", "part of the area that broke in tension")      \
    SCALAR(double, shear, BRC_STATE, "1", "part of the area that broke in shear")          \
    SCALAR(double, torsion, BRC_STATE, "1", "part of the area that broke in torsion")      \
    SCALAR(int64_t, first_break, BRC_STATE, "1",                                           \
           "step of the first break, -1 while there is none")                              \
    VECTOR(double, opening, 3, BRC_STATE, "m", "of b's side against a's, at the centroid") \
    VECTOR(double, force, 3, BRC_STATE, "N", "force on b")

/* Values of the lines between bodies that push or pull: chains of forces. */
#define BRC_CONTACT_CELL_FIELDS(SCALAR, VECTOR)                                                  \
    SCALAR(int32_t, a, BRC_STATE, "1", "grain with the lower number")                            \
    SCALAR(int32_t, b, BRC_STATE, "1", "grain with the higher number, or body of the platen")    \
    SCALAR(uint8_t, is_platen, BRC_STATE, "1", "1: b is a platen")                               \
    SCALAR(uint8_t, status, BRC_STATE, "1", "0 never bonded, 1 intact bond, 2 broken bond")      \
    VECTOR(double, force, 3, BRC_STATE, "N", "force on b")                                       \
    SCALAR(double, compression, BRC_STATE, "N", "force along the line, positive when it pushes") \
    SCALAR(double, gap, BRC_STATE, "m", "smallest distance of the surfaces, negative in overlap")

struct brc_grain_cells {
    BRC_GRAIN_CELL_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
struct brc_bond_cells {
    BRC_BOND_CELL_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
struct brc_contact_cells {
    BRC_CONTACT_CELL_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};

struct brc_frame_mesh {
    struct brc_mesh grains, bonds, contacts;
    struct brc_grain_cells grain_cells;
    struct brc_bond_cells bond_cells;
    struct brc_contact_cells contact_cells;
};

/* Where the two sides of an inner facet carry the point p of the specimen as it was: low is the
 * side of the cell with the lower number. The facet has opened by high - low there. */
void brc_frame_mesh_sides(const struct brc_sim *sim, size_t facet, const double p[3], double low[3],
                          double high[3]);
/* Makes the meshes from the present state. The tables point into *f: do not copy it. Freed by
 * brc_frame_mesh_free, also after a failure. */
int brc_frame_mesh_make(struct brc_context *ctx, const struct brc_sim *sim,
                        struct brc_frame_mesh *f);
void brc_frame_mesh_free(struct brc_frame_mesh *f);

#endif
