/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solids for the tests of the polyhedra model. */
#ifndef BRC_TESTS_POLY_SOLIDS_H
#define BRC_TESTS_POLY_SOLIDS_H

#include "polyhedra/features.h"

#include <stdlib.h>

/* Planes of a solid from its vertices, for solids of files; its loops, which may run in either
 * sense, become counter-clockwise as seen from outside. plane: room for all faces. */
void solid_planes(struct brc_convex *c, struct brc_plane *plane);
/* Largest distance of a vertex from the body's origin. */
double solid_reach(const struct poly_shapes *shapes, size_t body);
/* A box with the given half edges, as core number shapes->n. */
int solid_box(struct brc_context *ctx, struct poly_shapes *shapes, const double half[3]);
/* The eroded random cell cut from a ball by planes at distances in [0.7, 1] x size. */
int solid_random(struct brc_context *ctx, struct poly_shapes *shapes, unsigned *seed, double size);
/* Uniform in [0, 1), and a random rotation. */
double solid_uniform(unsigned *seed);
void solid_rotation(double q[4], unsigned *seed);

/* A placed core: matrix and vertices in space. */
struct solid_pose {
    double x[3], q[4], m[3][3];
    double (*v)[3];
};
void solid_place(struct solid_pose *pose, const struct poly_shapes *shapes, size_t body);
struct poly_pair solid_pair(const struct poly_shapes *shapes, size_t a, const struct solid_pose *pa,
                            size_t b, const struct solid_pose *pb, double radius);

#endif
