/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Platens: rigid bodies that a test places and moves, and all that a contact model sees of it. A
 * model asks a platen for the height of a point over its surface and for the normal there, so that
 * a test with another surface or another bond needs no change in a model. */
#ifndef BRC_PLATENS_H
#define BRC_PLATENS_H

#include "common/base/error.h"

enum brc_surface {
    BRC_SURFACE_PLANE,   /* without end */
    BRC_SURFACE_STRIP,   /* a plane of a width, with sharp or rounded edges */
    BRC_SURFACE_CYLINDER /* hollow: a jaw about a disc; round: a pin under a beam */
};

/* What the boundary facets that lie on a platen from the start feel besides contact and friction;
 * no such bond ever breaks. */
enum brc_bonding {
    BRC_BONDING_NONE,
    BRC_BONDING_GRIP,   /* held along the normal, both ways; no friction */
    BRC_BONDING_NORMAL, /* pulled along the normal as by a bond; pushed and rubbed as by contact */
    BRC_BONDING_FULL    /* held in all directions */
};

struct brc_platen {
    int32_t body;
    double n[3];      /* unit, into the specimen: does not turn */
    double across[3]; /* unit, in the plane; a cylinder's axis lies along n x across */
    enum brc_surface surface;
    double half_width;  /* m, strip: of the flat part, along across from the body's place */
    double edge_radius; /* m, strip: of the edges beyond; 0: sharp, nothing counts beyond */
    double radius;      /* m, cylinder: > 0 hollow, < 0 round; the body's place is on its surface */
    double friction;
    enum brc_bonding bonding;
    double force; /* N, along n, of the platen on the specimen */
};

enum { BRC_MAX_PLATENS = 6 };

/* Height h [m] of a point x [m] over the surface of a platen whose body is at `at`, and the
 * surface's unit normal there, into the specimen; false: beyond a sharp edge. */
bool brc_platen_height(const struct brc_platen *p, const double at[3], const double x[3], double *h,
                       double n[3]);

/* After the forces of a step: force and work of each platen. */
void brc_platens_measure(struct brc_sim *sim);
/* Forces of the platens, after a loaded state has replaced bodies. */
void brc_platens_restore(struct brc_sim *sim);

/* A boundary facet that faces a platen, within 30 degrees. */
struct brc_facing {
    int32_t cell, body; /* of the grain, of the platen */
    int32_t facet;
    bool is_on; /* it lies on the platen, to rounding */
};

/* All of them, sorted by (cell, body, facet); allocated, to be freed by the caller. */
int brc_platens_facing(const struct brc_sim *sim, struct brc_facing **out, size_t *n);

#endif
