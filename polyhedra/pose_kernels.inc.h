/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vertices and planes of all cores in space, four at a time. Called once a step, before forces.
 * Knows cores and poses, not who touches whom. */
#ifndef POLY_POSE_KERNELS_H
#define POLY_POSE_KERNELS_H

#include "polyhedra/poly.h"

/* Pose of a body, the same in all lanes: rotation matrix and centre. */
struct poly_body_pose4 {
    brc_lanes r[9], x[3];
};

/* Four vectors of body frames in space. */
BRC_LANES_INLINE void poly_to_space4(brc_lanes out[3], const brc_lanes r[9], const brc_lanes v[3])
{
    poly_set3(out, brc_lanes_dot(r, v), brc_lanes_dot(r + 3, v), brc_lanes_dot(r + 6, v));
}

/* Where the four of a range that begin at i are: the last ones are the last four once more. A core
 * has four vertices and faces at least. They are computed twice, to the same bits; a remainder done
 * one by one would be a second piece of code, and padded arrays would change the numbers of
 * features. */
BRC_LANES_INLINE size_t poly_whole_four(size_t i, size_t end)
{
    return i + BRC_LANES <= end ? i : end - BRC_LANES;
}

BRC_LANES_INLINE void poly_pose_vertices(const struct poly_state *st,
                                         const struct poly_body_pose4 *pose, size_t first,
                                         size_t end)
{
    for (size_t i = first; i < end; i += BRC_LANES) {
        size_t at = poly_whole_four(i, end);
        brc_lanes v[3];
        brc_lanes_at3(v, st->shapes.vertex + at);
        poly_to_space4(v, pose->r, v);
        poly_add3(v, pose->x, v);
        brc_lanes_put3(st->global_vertices + at, v);
    }
}

/* A plane in space is its turned normal and n . x: the offset in the body frame plus that of the
 * centre. */
BRC_LANES_INLINE void poly_pose_planes(const struct poly_state *st,
                                       const struct poly_body_pose4 *pose, size_t first, size_t end)
{
    for (size_t i = first; i < end; i += BRC_LANES) {
        size_t at = poly_whole_four(i, end);
        const double *from[BRC_LANES];
        brc_lanes p[BRC_LANES];
        for (size_t k = 0; k < BRC_LANES; k++)
            from[k] = (const double *)(st->shapes.face + at + k); /* n, d */
        brc_lanes_gather4(p, from);
        poly_to_space4(p, pose->r, p);
        p[3] = brc_lanes_dot(p, pose->x) + p[3];
        brc_lanes_transpose(p);
        for (size_t k = 0; k < BRC_LANES; k++)
            brc_lanes_put(st->global_planes[at + k], p[k]);
    }
}

/* All vertices and planes of all grains at each step: each serves several contacts, and memory
 * is read in order. */
__attribute__((flatten)) static inline void poly_pose_cores(const struct brc_sim *sim,
                                                            const struct poly_state *st)
{
    const struct brc_bodies *b = &sim->bodies;
    const struct poly_shapes *s = &st->shapes;
    for (size_t i = 0; i < b->n_grains; i++) {
        struct poly_body_pose4 pose;
        for (int k = 0; k < 9; k++)
            pose.r[k] = brc_lanes_all(st->rotation[i][k / 3][k % 3]);
        for (int k = 0; k < 3; k++)
            pose.x[k] = brc_lanes_all(b->x[i][k]);
        poly_pose_vertices(st, &pose, s->first[i].vertex, s->first[i + 1].vertex);
        poly_pose_planes(st, &pose, s->first[i].face, s->first[i + 1].face);
    }
}

#endif
