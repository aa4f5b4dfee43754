/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flat end of a specimen: which boundary facets make it up, and the moments of its area. */
#ifndef BRC_END_FACE_H
#define BRC_END_FACE_H

#include "common/base/brc.h"

/* The end of the specimen at one side of an axis. */
struct brc_end {
    int axis;
    double sense;   /* +1 at the upper end of the axis, -1 at the lower one */
    double plane;   /* m, where it lies on the axis */
    double allowed; /* m, how far off a facet may lie */
};

/* What a beam of this section is made of; along: the direction in which it bends. */
struct brc_end_face {
    double area; /* m2; 0: no facet lies in the plane of the end */
    double middle[3];
    double second;   /* m4, second moment that bending along the direction counts with */
    double farthest; /* m, from the middle along the direction */
};

/* The extent of a specimen is that of all its vertices: found once, not for each facet. */
struct brc_end brc_end_of(const struct brc_specimen *s, int axis, bool is_high);
/* Whether a facet is of the boundary and lies in the plane of the end, to the rounding of a
 * tessellation. */
bool brc_end_has(const struct brc_specimen *s, struct brc_end end, size_t facet);
void brc_end_face_measure(const struct brc_specimen *s, struct brc_end end, int along,
                          struct brc_end_face *out);

#endif
