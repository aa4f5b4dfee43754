/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surfaces of platens for the loops of contact models: four points at a time. */
#ifndef BRC_PLATEN_SURFACE_H
#define BRC_PLATEN_SURFACE_H

#include "common/base/lanes.h"
#include "common/engine/platens.h"

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

#endif
