/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What tess.c asks of CGAL: the C face of tess_cgal.cpp, which alone includes CGAL. */
#ifndef BRC_TESS_CGAL_H
#define BRC_TESS_CGAL_H

#include "common/specimen/cell_complex.h"

/* A plane triangle mesh. */
struct brc_cgal_mesh {
    size_t n_vertices, n_triangles;
    double (*vertex)[2];
    int32_t (*triangle)[3];  /* counter-clockwise */
    int32_t (*neighbour)[3]; /* triangle opposite to each vertex, -1: none */
};

/* Cells of the seeds (radius NULL: Voronoi; else Laguerre with weights r^2) in a region of the
 * given half-width about centre, bounded far outside it. hider[i] is -1 where seed i has a cell,
 * else the seed that takes its place; cells are made for all seeds that have one. */
int brc_cgal_cells(struct brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
                   const double centre[3], double half_width, int32_t *hider,
                   struct brc_cell_complex *out);

/* Delaunay mesh of a convex polygon with triangles of at most max_area [m2]; its arrays are the
 * pool's. */
int brc_cgal_triangulate(struct brc_context *ctx, double (*corner)[2], size_t n, double max_area,
                         struct brc_pool *pool, struct brc_cgal_mesh *out);

#endif
