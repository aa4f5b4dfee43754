/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How cracks lie against the load, and whether they lie in one plane. */
#ifndef BRC_CRACK_FABRIC_H
#define BRC_CRACK_FABRIC_H

#include "common/engine/events.h"
#include "common/specimen/facets.h"

/* Bins of 5 degrees of the angle between the plane of a crack and the load: 0 along it. */
enum { BRC_CRACK_BINS = 18 };
#define BRC_CRACK_ANGLE_FIELDS(SCALAR, VECTOR)                         \
    SCALAR(double, low, BRC_STATE, "rad", "lower end of the bin")      \
    SCALAR(double, high, BRC_STATE, "rad", "upper end of the bin")     \
    SCALAR(double, tension, BRC_STATE, "m2", "area broken in tension") \
    SCALAR(double, shear, BRC_STATE, "m2", "area broken in shear")     \
    SCALAR(double, torsion, BRC_STATE, "m2", "area broken in torsion") \
    SCALAR(double, random, BRC_STATE, "m2", "what random directions would have")

struct brc_crack_angles {
    BRC_CRACK_ANGLE_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
    double mean;      /* rad, angle to the load by area; 0.571 (32.7 degrees) of random ones */
    double alignment; /* mean square of the sine of the angle of normal and load: 1 all cracks along
                         the load, 0 all across it, 2/3 random */
};

/* NAN where nothing has broken. Freed by brc_crack_angles_free, also after a failure. */
int brc_crack_angles_measure(struct brc_context *ctx, const struct brc_events *e, int axis,
                             struct brc_crack_angles *out);
void brc_crack_angles_free(struct brc_crack_angles *a);

/* The plane whose slab holds most of the broken area. */
struct brc_crack_plane {
    double part; /* of the broken area that lies within it */
    double normal[3];
    size_t n; /* broken facets; part and normal are 0 where there are none */
};
/* thickness [m] of the slab. Places are those of the facets at the start: fragments fly. */
int brc_crack_plane_find(struct brc_context *ctx, const struct brc_events *e,
                         const struct brc_facets *f, double thickness, struct brc_crack_plane *out);

#endif
