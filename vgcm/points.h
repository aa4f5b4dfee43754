/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interaction points of a facet: where its forces act, and the area that each stands for. For
 * make_contacts.c. */
#ifndef VGCM_POINTS_H
#define VGCM_POINTS_H

#include "common/specimen/facets.h"

enum vgcm_points_rule {
    VGCM_POINTS_PAPER, /* vertices and centroid; a third of each triangle to its corners */
    VGCM_POINTS_EXACT, /* the same, drawn in so that the second moments are the facet's own */
    VGCM_POINTS_ONE    /* the centroid alone */
};

/* Number of points on a facet of n vertices. Asked before, so that the caller can make room. */
int vgcm_points_count(enum vgcm_points_rule rule, size_t n);
/* Places and areas of the points of a facet: vgcm_points_count of them, the centroid's last. The
 * areas sum to the facet's area and their centroid is the facet's. */
void vgcm_points_place(enum vgcm_points_rule rule, const struct brc_facets *facets, size_t facet,
                       double (*x)[3], double *area);

#endif
