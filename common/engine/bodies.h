/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies: the grains, then the platens of the rig (kinematic, moved by it alone). */
#ifndef BRC_BODIES_H
#define BRC_BODIES_H

#include "common/base/table.h"

/* v and w are half-step values while forces are computed: the displacement of a point in the step
 * that has just been made is (v + w x r) dt, with the positions at its end. */
#define BRC_BODY_FIELDS(SCALAR, VECTOR, RENAMED)                                                \
    VECTOR(double, x, 3, BRC_STATE, "m", "centre of mass")                                      \
    VECTOR(double, v, 3, BRC_STATE, "m s-1", "velocity, at the half step")                      \
    VECTOR(double, q, 4, BRC_STATE, "1", "orientation, principal axes to space, scalar first")  \
    VECTOR(double, w, 3, BRC_STATE, "rad s-1", "angular velocity in space, at the half step")   \
    VECTOR(double, l, 3, BRC_STATE, "kg m2 s-1", "angular momentum in space, at the half step") \
    VECTOR(double, f, 3, BRC_STATE, "N", "sum of forces")                                       \
    VECTOR(double, t, 3, BRC_STATE, "N m", "sum of moments about the centre")                   \
    VECTOR(double, sum, 8, BRC_SCRATCH, "N, N m, J",                                            \
           "f, 0, t, energy of bonds of pairs, while they are added up")                        \
    VECTOR(double, energy, 8, BRC_STATE, "J", "booked by contacts: accounts.h")                 \
    SCALAR(double, terms, BRC_SCRATCH, "J, N", "terms of a sum over bodies, before it is made") \
    SCALAR(double, damping, BRC_STATE, "J", "work of local damping so far")                     \
    SCALAR(double, damping_ahead, BRC_STATE, "J", "and over the half step after the last kick") \
    SCALAR(double, mass, BRC_STATE, "kg", "inertial mass in use; 0 on platens")                 \
    VECTOR(double, inertia, 3, BRC_STATE, "kg m2", "principal moments of inertia in use")       \
    RENAMED(double, path_length, travel, BRC_STATE, "m",                                        \
            "path of the centre plus bounding radius times turn, summed")                       \
    RENAMED(double, path_at_rebuild, travel_listed, BRC_STATE, "m",                             \
            "path_length at the last neighbour search")                                         \
    SCALAR(double, true_mass, BRC_STATE, "kg", "mass from the density")                         \
    VECTOR(double, true_inertia, 3, BRC_STATE, "kg m2", "principal moments from the density")   \
    SCALAR(double, volume, BRC_STATE, "m3", "volume")                                           \
    RENAMED(double, bounding_radius, reach, BRC_STATE, "m",                                     \
            "radius of the bounding sphere about the centre")                                   \
    VECTOR(double, v_mean, 3, BRC_STATE, "m s-1", "mean velocity of the last steps")            \
    VECTOR(double, w_mean, 3, BRC_STATE, "rad s-1", "mean angular velocity of the last steps")  \
    VECTOR(double, x0, 3, BRC_STATE, "m", "centre of mass at the start")                        \
    VECTOR(double, q0, 4, BRC_STATE, "1", "orientation at the start")                           \
    VECTOR(double, side_area, 3, BRC_STATE, "m2", "force of a unit pressure on the sides")      \
    VECTOR(double, side_moment, 3, BRC_STATE, "m3", "its moment about the centre")              \
    SCALAR(uint8_t, has_left, BRC_STATE, "1", "1: no longer part of the specimen's sides")

struct brc_bodies {
    BRC_BODY_FIELDS(BRC_COLUMN, BRC_COLUMN3, BRC_COLUMN_RENAMED)
    size_t n;        /* grains and platens */
    size_t n_grains; /* grain i is cell i of the specimen; platens follow */
    struct brc_table table;
    struct brc_table model; /* the model's body fields */
    void *model_columns;    /* owner struct of the model's body fields; owned */
};

int brc_bodies_create(struct brc_context *ctx, struct brc_bodies *b, size_t n_grains,
                      size_t n_platens, struct brc_fieldset model);
void brc_bodies_free(struct brc_bodies *b);
/* Where the point of a body that was at p at the start is now. */
void brc_bodies_carry(const struct brc_bodies *b, size_t body, const double p[3], double now[3]);

#endif
