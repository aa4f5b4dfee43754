/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs works on blocks of rows: their feature pairs are sorted into work lists
 * by what must be computed, four at a time, and the touches come back row by row. A block fits in
 * the cache; nothing in it outlives it. */
#ifndef POLY_BLOCK_H
#define POLY_BLOCK_H

#include "features.h"

#include "common/lanes.h"
#include "common/sim.h"

#include <string.h>

enum {
    POLY_ROWS = 64,         /* of a block */
    POLY_SLOTS = 1024,      /* touches at a time; a row begins at a multiple of BRC_LANES */
    POLY_SPARE = POLY_SLOTS /* slots that nobody reads */
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
    struct poly_wrenches bond;
    brc_lanes stored, slid;                         /* J, of the tangential springs */
    brc_lanes work_normal, work_bond, work_viscous; /* J */
};

/* What a point's touch is computed from (struct poly_points, item): numbers of st->world and
 * st->plane, so that nothing else of the point need be looked at while its row is calm. */
enum {
    /* a vertex of one core at a known place of the other */
    POLY_ITEM_VERTEX,
    POLY_ITEM_PLACE, /* plane; or both ends of the edge, twice the same for a vertex */
    POLY_ITEM_NEAR = POLY_ITEM_PLACE + 2, /* POLY_NEAR vertices, -1: none; or first and number */
    /* edges: four ends, 1 or -1 for the side (0: not known), reach of struct poly_pair */
    POLY_ITEM_END = 0,
    POLY_ITEM_SIDE = POLY_ITEM_END + 4,
    POLY_ITEM_REACH,
    POLY_ITEM_LIST = 7, /* of the block, + POLY_OF_A; POLY_NO_LIST: not set */
    POLY_ITEM
};

static inline double poly_item_reach(const int32_t *item)
{
    double reach;
    memcpy(&reach, item + POLY_ITEM_REACH, sizeof reach);
    return reach;
}

/* Lists of vertices: by the place of the foot (plane; edge or vertex) and by how many vertices of
 * the other core may lower the weight: up to one, up to POLY_NEAR, any number. Then that of edges.
 */
enum {
    POLY_NO_LIST,
    POLY_FLAT,
    POLY_FLAT_NEAR,
    POLY_FLAT_ALL,
    POLY_SHARP,
    POLY_SHARP_NEAR,
    POLY_SHARP_ALL,
    POLY_CROSSING,
    POLY_N_LISTS,
    POLY_OF_A = 8 /* added where the vertex belongs to a */
};

/* A point to look at, and where its touch goes. */
struct poly_task {
    int32_t slot, point;
};

struct poly_segment {
    int32_t row, slot, n; /* row of the block; slots */
    int32_t point;        /* of the first slot */
    bool follow;          /* the other points follow it; else block->point has them */
    bool fresh;           /* some points begin to touch */
};

/* Sums over the points of a row. */
enum {
    POLY_SUM_NORMAL,      /* force on b and its moment about the centre of a */
    POLY_SUM_SHEAR = 6,   /* the same of the tangential springs */
    POLY_SUM_K = 12,      /* stiffness */
    POLY_SUM_STORED = 15, /* J, of the tangential springs */
    POLY_SUM_SLID,
    POLY_SUM_VISCOUS,
    POLY_SUMS = 24
};

struct poly_block {
    struct brc_sim *sim;
    struct poly_state *st;
    double kn, kt, stiff; /* N/m; stiff: the larger one of those that act */
    double rest, ell, skin;
    int32_t n_rows, n_slots, n_segments;
    int32_t n_ahead, ahead[POLY_ROWS];                  /* rows of the next block */
    int32_t row[POLY_ROWS], a[POLY_ROWS], b[POLY_ROWS]; /* filled up to whole groups */
    bool listed[POLY_ROWS], calm[POLY_ROWS];
    struct poly_pair pair; /* of the row pair_row */
    int32_t pair_row;
    int32_t n_tasks[POLY_N_LISTS];
    struct poly_segment segment[POLY_ROWS];
    int32_t point[POLY_SLOTS];
    _Alignas(64) double sum[POLY_ROWS][POLY_SUMS];
    double nearest[POLY_ROWS]; /* the smallest gap of its points */
    struct poly_row_group group[POLY_ROWS / BRC_LANES];
    struct poly_touches touch[POLY_SLOTS / BRC_LANES + 1];
    struct poly_task task[POLY_N_LISTS][POLY_SLOTS + BRC_LANES];
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
