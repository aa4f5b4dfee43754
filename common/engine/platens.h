/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Platens: rigid bodies that a test places and moves, and all that a contact model sees of it. A
 * model asks a platen for the height of a point over its surface and for the normal there, so that
 * a test with another surface or another bond needs no change in a model. */
#ifndef BRC_PLATENS_H
#define BRC_PLATENS_H

#include "common/base/error.h"
#include "common/base/lanes.h"

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

/* Heights h [m] of four points x [m] over the surface of a platen whose body is at `at`, and the
 * surface's unit normals there, into the specimen; false lanes: beyond a sharp edge. */
BRC_LANES_INLINE brc_mask brc_platen_heights(const struct brc_platen *p, const double at[3],
                                             const brc_lanes x[3], brc_lanes *h, brc_lanes n[3])
{
    brc_lanes d[3], side, from, along;
    for (int k = 0; k < 3; k++) {
        d[k] = x[k] - at[k];
        n[k] = brc_lanes_all(p->n[k]);
    }
    *h = d[0] * p->n[0] + d[1] * p->n[1] + d[2] * p->n[2];
    if (p->surface == BRC_SURFACE_PLANE)
        return brc_lanes_first(BRC_LANES);
    side = d[0] * p->across[0] + d[1] * p->across[1] + d[2] * p->across[2];
    if (p->surface == BRC_SURFACE_STRIP) {
        brc_mask is_flat = ~brc_lanes_less(brc_lanes_all(p->half_width), brc_lanes_abs(side));
        if (p->edge_radius == 0)
            return is_flat;
        /* the distance to the edge's axis, which lies edge_radius below the flat part */
        from = brc_lanes_max(brc_lanes_abs(side) - p->half_width, brc_lanes_all(0));
        from = brc_lanes_sign(from, side);
        along = *h + p->edge_radius;
    } else {
        from = side;
        along = *h - p->radius;
    }
    double outward = p->surface == BRC_SURFACE_CYLINDER && p->radius > 0 ? -1 : 1;
    double curvature = p->surface == BRC_SURFACE_STRIP ? p->edge_radius : fabs(p->radius);
    brc_lanes distance = brc_lanes_sqrt(from * from + along * along);
    *h = outward * (distance - curvature);
    for (int k = 0; k < 3; k++)
        n[k] = outward * (from * p->across[k] + along * p->n[k]) / distance;
    return brc_lanes_first(BRC_LANES);
}

/* The same for one point. */
static inline bool brc_platen_height(const struct brc_platen *p, const double at[3],
                                     const double x[3], double *h, double n[3])
{
    brc_lanes point[3], normal[3], height;
    for (int k = 0; k < 3; k++)
        point[k] = brc_lanes_all(x[k]);
    bool is_there = brc_platen_heights(p, at, point, &height, normal)[0];
    *h = height[0];
    for (int k = 0; k < 3; k++)
        n[k] = normal[k][0];
    return is_there;
}

/* A boundary facet that faces a platen, within 30 degrees. */
struct brc_facing {
    int32_t cell, body; /* of the grain, of the platen */
    int32_t facet;
    bool is_on; /* it lies on the platen, to rounding */
};

/* All of them, sorted by (cell, body, facet); allocated, to be freed by the caller. */
int brc_platens_facing(const struct brc_sim *sim, struct brc_facing **out, size_t *n);

#endif
