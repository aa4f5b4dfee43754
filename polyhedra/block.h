/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs works on blocks of rows: their feature pairs are sorted into work lists
 * by what must be computed, four at a time, and the touches come back row by row. A block fits in
 * the cache; nothing in it outlives it. */
#ifndef POLY_BLOCK_H
#define POLY_BLOCK_H

#include "features.h"

#include "common/lanes.h"
#include "common/sim.h"

enum {
    POLY_ROWS = 32,  /* of a block */
    POLY_SLOTS = 512 /* touches at a time; a row begins at a multiple of BRC_LANES */
};

/* Four touches of one row, as in struct poly_touch; where nothing touches all is zero but for
 * delta, and -delta is a relative path of the bodies that cannot bring them in touch. */
struct poly_touches {
    brc_lanes n[3], x[3], delta, weight, g[3], c[3];
};

/* Force on b and its moment about the centre of a, for four rows. */
struct poly_wrenches {
    brc_lanes f[3], m[3];
};

/* Four rows. */
struct poly_row_group {
    /* from a to b; relative velocity and spins */
    brc_lanes xa[3], x[3], dv[3], wa[3], wb[3];
    /* b moves at slip + slope . arm relative to a, arm from a; turn is a quarter of the sum of both
     * turns in the step */
    brc_lanes slip[3], slope[3][3], turn[3];
    brc_lanes path;   /* m, relative path of the step */
    brc_lanes broken; /* > 1: the bond breaks */
    brc_lanes gn, gt; /* N s/m, viscosities */
    brc_lanes k[3], gap;
    struct poly_wrenches bond, normal, shear, viscous, total;
    brc_lanes tb[3];
    brc_lanes stored, slid;                         /* J, of the tangential springs */
    brc_lanes work_normal, work_bond, work_viscous; /* J */
};

/* Vertex of one core at a known place of the other, by numbers of st->world and st->plane. */
struct poly_vertex_item {
    int32_t slot, vertex;
    int32_t place[2]; /* plane; or the ends of the edge, twice the same for a vertex */
    int32_t near[POLY_NEAR];
    int32_t first, n; /* vertices of the other core */
    double sign;      /* +1: the vertex belongs to b */
};

/* Edges, by the numbers of their ends in st->world. */
struct poly_edge_item {
    int32_t slot, end[4];
    int32_t side; /* 1, 2: as struct poly_points has it; 0: not known */
    double reach; /* m, as struct poly_pair has it */
};

/* Lists of vertices: by the place of the foot (plane; edge or vertex) and by how many vertices of
 * the other core may lower the weight: up to one, up to POLY_NEAR, any number. */
enum {
    POLY_FLAT,
    POLY_FLAT_NEAR,
    POLY_FLAT_ALL,
    POLY_SHARP,
    POLY_SHARP_NEAR,
    POLY_SHARP_ALL,
    POLY_N_VERTEX_LISTS
};

struct poly_segment {
    int32_t row, slot, n; /* row of the block; slots */
};

struct poly_block {
    struct brc_sim *sim;
    struct poly_state *st;
    double kn, kt, stiff; /* N/m; stiff: the larger one of those that act */
    double rest, ell, skin;
    int32_t n_rows, n_slots, n_segments;
    int32_t row[POLY_ROWS], a[POLY_ROWS], b[POLY_ROWS]; /* filled up to whole groups */
    bool listed[POLY_ROWS];
    struct poly_pair pair; /* of the row pair_row */
    int32_t pair_row;
    int32_t n_vertices[POLY_N_VERTEX_LISTS], n_edges;
    struct poly_segment segment[POLY_ROWS];
    int32_t point[POLY_SLOTS];
    struct poly_row_group group[POLY_ROWS / BRC_LANES];
    struct poly_touches touch[POLY_SLOTS / BRC_LANES];
    struct poly_vertex_item vertex[POLY_N_VERTEX_LISTS][POLY_SLOTS];
    struct poly_edge_item edge[POLY_SLOTS];
};

/* What is done four at a time. */
typedef void poly_kernel(struct poly_block *block);
typedef int poly_list_kernel(struct brc_context *ctx, struct poly_list *l,
                             const struct poly_pair *p, enum poly_rule rule, double skin,
                             double *allowance);
struct poly_kernels {
    poly_list_kernel *list; /* poly_list_features */
    poly_kernel *motion;    /* motion and bonds of the rows */
    poly_kernel *touch;     /* the work lists */
    poly_kernel *points;    /* forces of the touches */
    poly_kernel *finish;    /* sums of the rows, their works */
};
/* kernels.h for each instruction set: the kernels for the options of a simulation. */
struct poly_kernels poly_kernels_base(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx2(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx512(const struct brc_sim *sim);

#endif
