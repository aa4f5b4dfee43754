/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far facets are from normal to the line of their grains' centres, and what that does to the
 * stiffness. In a Laguerre diagram with the centres at its generators they are normal exactly. */
#ifndef BRC_OBLIQUE_H
#define BRC_OBLIQUE_H

#include "common/specimen/facets.h"

/* Over the inner facets that are contacts, weighted by area. */
struct brc_oblique {
    double mean_cos; /* of the angle between facet normal and line of centres; 1 without facets */
    /* A uniform strain of springs A/d between the centres stores this part of what the same medium
     * without obliqueness does: least and largest over the axes and diagonals of a cube. */
    double soft, stiff;
    size_t reversed; /* a facet whose centres lie on the wrong sides; SIZE_MAX: none */
};

/* Cosine between a facet's normal and the line from the centre of its first cell to that of its
 * second. */
double brc_oblique_cos(const struct brc_facets *f, double (*centre)[3], size_t facet);
/* centre: [n_cells], where forces of a grain act; is_projected: areas count as seen along the line
 * of centres. */
void brc_oblique_measure(struct brc_oblique *o, const struct brc_facets *f, double (*centre)[3],
                         bool is_projected);

#endif
