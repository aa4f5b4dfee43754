/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The 512 packed dodecahedra of tests/data. */
#ifndef BRC_TESTS_DODECAHEDRA_H
#define BRC_TESTS_DODECAHEDRA_H

#include "common/geometry/convex.h"

struct dodecahedra {
    double radius, vertex[20][3], x[512][3], q[512][4];
    size_t n;
};

void dodecahedra_read(struct dodecahedra *d);
/* Planes of one core in its own frame (room for 20); returns how many. */
size_t dodecahedra_planes(const struct dodecahedra *d, struct brc_plane *planes);
/* The twelve planes of a body, moved out by `out`. */
void dodecahedra_place(const struct dodecahedra *d, size_t body, const struct brc_plane *from,
                       double out, struct brc_plane *to);

#endif
