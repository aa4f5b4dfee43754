/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs works on blocks of rows: their feature pairs are sorted into lists by
 * what must be computed, and worked off four at a time, of whatever rows the four are. A block fits
 * in the cache; nothing in it outlives it. */
#ifndef POLY_BLOCK_H
#define POLY_BLOCK_H

#include "features.h"

#include "common/base/lanes.h"
#include "common/engine/sim.h"

#include <string.h>

enum {
    POLY_ROWS = 32,   /* of a block; row POLY_ROWS is what nobody reads */
    POLY_TASKS = 1024 /* points at a time */
};

/* Four touches, as in struct poly_touch; where nothing touches all is zero but for delta, and
 * -delta is a relative path of the bodies that cannot bring them in touch. Where they fade, they
 * can but touch with a weight that grows from 0: edges, by their ends. Those that touch do so for a
 * path of `lasts` at least, as long as the foot of a vertex keeps its place. */
struct poly_touches {
    brc_lanes n[3], x[3], delta, weight, g[3], c[3], lasts;
    brc_mask fades;
};

/* Force on b and its moment about the centre of a, for four rows. */
struct poly_wrenches {
    brc_lanes f[3], m[3];
};

/* Four rows. */
struct poly_row_group {
    brc_lanes x[3], dv[3], wa[3], wb[3]; /* from a to b; relative velocity and spins */
    brc_lanes path;                      /* m, relative path of the step */
    brc_lanes broken;                    /* > 1: the bond breaks */
    brc_lanes k[3], gap;
    struct poly_wrenches bond;
    brc_lanes opening, bond_stored;                 /* m, J, of the bond, if any */
    brc_lanes stored, slid;                         /* J, of the tangential springs */
    brc_lanes work_normal, work_bond, work_viscous; /* J */
};

/* The bond of a row (struct poly_rows): in the frame of a and then in that of b the material point,
 * the normal of the face, outward, and a tangent that is the same in space at the start; area and
 * strain length. */
enum {
    POLY_BOND_CA,
    POLY_BOND_AREA = 3,
    POLY_BOND_CB,
    POLY_BOND_LENGTH = 7,
    POLY_BOND_NA,
    POLY_BOND_NB = 12,
    POLY_BOND_TA = 16,
    POLY_BOND_TB = 20,
    POLY_BOND = 24
};

/* A point's spring (struct poly_points), in one line of the cache. */
enum { POLY_XI = 0, POLY_WEIGHT = 3, POLY_NORMAL = 4, POLY_SPRING = 8 };

/* Motion of a row since it was computed literally (struct poly_rows, shift): displacement of b
 * relative to a at the centre of a, path, turn of b relative to a, path at which it is computed
 * anew (0: at each step), a quarter of the sum of both turns; what its bond stored then. */
enum {
    POLY_SHIFT_PATH = 3,
    POLY_SHIFT_TURN,
    POLY_SHIFT_END = 7,
    POLY_SHIFT_BOTH,
    POLY_SHIFT_STORED = 11,
    POLY_SHIFT
};

/* What a point's touch is computed from (struct poly_points, item): numbers of st->world and
 * st->plane, so that nothing else of the point need be looked at while its row is calm. */
enum {
    /* a vertex of one core at a known place of the other */
    POLY_ITEM_VERTEX,
    POLY_ITEM_PLACE, /* plane; or both ends of the edge, twice the same for a vertex */
    POLY_ITEM_NEAR = POLY_ITEM_PLACE + 2, /* vertices that may lower the weight, or the first */
    /* edges: four ends, 1 or -1 for the side (0: not known), reach of struct poly_pair */
    POLY_ITEM_END = 0,
    POLY_ITEM_SIDE = POLY_ITEM_END + 4,
    POLY_ITEM_REACH,
    POLY_ITEM_LIST = 7, /* of the block, and what follows; POLY_NO_LIST: not set */
    POLY_ITEM
};

static inline double poly_item_reach(const int32_t *item)
{
    double reach;
    memcpy(&reach, item + POLY_ITEM_REACH, sizeof reach);
    return reach;
}

/* Lists of a block: vertices by the place of the foot (plane; edge or vertex), edges, and touches
 * that are known already (block->known). */
enum {
    POLY_NO_LIST,
    POLY_FLAT,
    POLY_SHARP,
    POLY_CROSSING,
    POLY_KNOWN,
    POLY_N_LISTS,
    POLY_LIST = 7, /* mask */
    /* of an item */
    POLY_OF_A = 8,      /* the vertex belongs to a */
    POLY_IN_TURN = 16,  /* vertices near: all from the first on, in turn */
    POLY_NEAR_SHIFT = 5 /* how many vertices are near, from this bit on */
};

/* A point to look at, of a row of the block. */
struct poly_task {
    int32_t row, point;
};

/* A point that does not touch. */
struct poly_apart {
    int32_t row, point;
    double path;
    bool fades;
};

/* What the points of a row want of it, in fours for gathers. */
enum {
    POLY_FRAME_XA,        /* centre of a; then viscosity along the normal */
    POLY_FRAME_X = 4,     /* from a to b; then viscosity across it */
    POLY_FRAME_SLIP = 8,  /* struct poly_row_group */
    POLY_FRAME_TURN = 12, /* a row of slope, then a part of turn, three times */
    POLY_FRAME = 24
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
    double limit;         /* of xi per overlap */
    double rest, ell, skin;
    bool viscous;
    int32_t n_rows, n_points, n_apart;
    int32_t n_ahead, ahead[POLY_ROWS];                  /* rows of the next block */
    int32_t row[POLY_ROWS], a[POLY_ROWS], b[POLY_ROWS]; /* filled up to whole groups */
    bool listed[POLY_ROWS], calm[POLY_ROWS];
    bool open[POLY_ROWS + 1];   /* some of its points are apart */
    bool steady[POLY_ROWS + 1]; /* its tangent is found */
    struct poly_pair pair;      /* of the row pair_row */
    int32_t pair_row;
    int32_t n_tasks[POLY_N_LISTS];
    double nearest[POLY_ROWS + 1]; /* the smallest gap of a row's points */
    double lasting[POLY_ROWS + 1]; /* path for which its springs act, while its tangent is found */
    _Alignas(64) double frame[POLY_ROWS + 1][POLY_FRAME];
    double sum[POLY_ROWS + 1][POLY_SUMS];
    double tangent[POLY_ROWS + 1][36]; /* column after column */
    brc_lanes carried_work;            /* J */
    struct poly_row_group group[POLY_ROWS / BRC_LANES];
    struct poly_touches known[POLY_TASKS / BRC_LANES];
    struct poly_task task[POLY_N_LISTS][POLY_TASKS + BRC_LANES];
    struct poly_apart apart[POLY_TASKS];
};

/* What is done four at a time. */
typedef void poly_kernel(struct poly_block *block);
typedef int poly_list_kernel(struct brc_context *ctx, struct poly_list *l,
                             const struct poly_pair *p, enum poly_rule rule, double skin,
                             double *allowance);
typedef void poly_world_kernel(const struct brc_sim *sim, const struct poly_state *st);
struct poly_kernels {
    poly_world_kernel *world; /* vertices and planes in space */
    poly_list_kernel *list;   /* poly_list_features */
    poly_kernel *motion;      /* motion and bonds of the rows */
    poly_kernel *points;      /* the lists: touches, forces, springs */
    poly_kernel *finish;      /* sums of the rows, their works */
    poly_kernel *carry;       /* condensed rows, or NULL */
};
/* kernels.h for each instruction set: the kernels for the options of a simulation. */
struct poly_kernels poly_kernels_base(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx2(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx512(const struct brc_sim *sim);

#endif
