/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory of the loop over contacts, which takes them in batches: their feature pairs are sorted
 * into lists by what must be computed, and worked off four at a time, of whatever contacts the four
 * are. Batches rather than the whole table: a batch fits in the cache. Nothing in it outlives it.
 * forces.c fills it, the kernels compute in it. */
#ifndef POLY_BATCH_H
#define POLY_BATCH_H

#include "polyhedra/bond.h"
#include "polyhedra/contact.h"
#include "polyhedra/features.h"

#include "common/engine/sim.h"

#include <string.h>

enum {
    POLY_CONTACTS = 32, /* contacts of a batch; number POLY_CONTACTS is what nobody reads */
    POLY_TASKS = 1024   /* points at a time */
};

/* Four contacts. Contact i of the batch is lane i % 4 of four i / 4. */
struct poly_contact4 {
    brc_lanes x[3], dv[3], wa[3], wb[3]; /* from a to b; relative velocity and spins */
    brc_lanes path;                      /* m, relative path of the step */
    brc_lanes broken;                    /* > 1: the bond breaks */
    brc_lanes k[3], gap;
    struct poly_wrench4 bond;
    brc_lanes opening, bond_stored; /* m, J, of the bond, if any */
    /* what the tangent of the bond is made of: stiffnesses that act, normal, place from the centre
     * of a; set where contacts are linearised */
    brc_lanes bond_kn, bond_kt, bond_ktheta, bond_n[3], bond_arm[3];
    brc_lanes stored, slid;                         /* J, of the tangential springs */
    brc_lanes work_normal, work_bond, work_viscous; /* J */
};

/* The bond of a contact (struct poly_contacts): in the frame of a and then in that of b the
 * material point, the normal of the face, outward, and a tangent that is the same in space at the
 * start; area and strain length. */
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

/* A point's spring (struct poly_points), in one line of the cache. With its normal, which the
 * spring is turned along with. */
enum { POLY_XI = 0, POLY_WEIGHT = 3, POLY_NORMAL = 4, POLY_SPRING = 8 };

/* Motion of a contact since it was computed literally (struct poly_contacts, motion): displacement
 * of b relative to a at the centre of a, path, turn of b relative to a, path at which it is
 * computed anew or looks at its sleepers (0: at each step), a quarter of the sum of both turns;
 * what its bond stored then.
 */
enum {
    POLY_MOTION_PATH = 3,
    POLY_MOTION_TURN,
    POLY_MOTION_END = 7,
    POLY_MOTION_BOTH,
    POLY_MOTION_STORED = 11,
    POLY_MOTION
};

/* What the geometry of a point is computed from (struct poly_points, item): numbers of
 * st->global_vertices and st->global_planes, so that nothing else of the point need be looked at
 * while its contact is stable. */
enum {
    /* a vertex of one core at a known feature of the other */
    POLY_ITEM_VERTEX,
    POLY_ITEM_FEATURE, /* plane; or both ends of the edge, twice the same for a vertex */
    POLY_ITEM_NEAR = POLY_ITEM_FEATURE + 2, /* vertices that may lower the weight, or the first */
    /* edges: four ends, 1 or -1 for the side (0: not known), reach of struct poly_pair */
    POLY_ITEM_END = 0,
    POLY_ITEM_SIDE = POLY_ITEM_END + 4,
    POLY_ITEM_REACH,
    POLY_ITEM_LIST = 7, /* of the batch, and what follows; POLY_NO_LIST: not set */
    POLY_ITEM
};

static inline double poly_item_reach(const int32_t *item)
{
    double reach;
    memcpy(&reach, item + POLY_ITEM_REACH, sizeof reach);
    return reach;
}

/* Lists of a batch: vertices by the closest feature (plane; edge or vertex), edges, vertices at a
 * platen, and points whose geometry is known already (batch->known). */
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

/* A point to look at, of a contact of the batch. */
struct poly_task {
    int32_t contact, point;
};

/* A point that does not touch. */
struct poly_apart {
    int32_t contact, point;
    double path;
    bool fades;
};

/* What the points of a contact want of it, in fours for gathers. */
enum {
    POLY_FRAME_XA,        /* centre of a; then viscosity along the normal */
    POLY_FRAME_X = 4,     /* from a to b; then viscosity across it */
    POLY_FRAME_SLIP = 8,  /* struct poly_frame4; then the limit of friction */
    POLY_FRAME_TURN = 12, /* a contact of slope, then a part of turn, three times */
    POLY_FRAME = 24
};

/* Sums over the points of a contact. */
enum {
    POLY_SUM_NORMAL,      /* force on b and its moment about the centre of a */
    POLY_SUM_SHEAR = 6,   /* the same of the tangential springs */
    POLY_SUM_K = 12,      /* stiffness */
    POLY_SUM_STORED = 15, /* J, of the tangential springs */
    POLY_SUM_SLID,
    POLY_SUM_VISCOUS,
    POLY_SUMS = 24
};

struct poly_batch {
    struct brc_sim *sim;
    struct brc_contacts *contacts; /* sim->pairs or sim->platens */
    struct poly_state *st;
    const struct poly_loop *loop;
    struct poly_spring_law law;
    struct poly_lengths len;
    bool viscous, is_platens;
    bool looks; /* linearised contacts look at their sleepers one by one */
    int32_t n_contacts, n_points, n_apart;
    int32_t n_ahead, ahead[POLY_CONTACTS]; /* contacts of the next batch */
    int32_t contact[POLY_CONTACTS], a[POLY_CONTACTS],
        b[POLY_CONTACTS];                   /* filled up to whole fours */
    bool listed[POLY_CONTACTS];             /* it has points */
    bool is_stable[POLY_CONTACTS];          /* nothing of it needs a decision in this step */
    bool has_apart[POLY_CONTACTS + 1];      /* some of its points are apart */
    bool will_linearise[POLY_CONTACTS + 1]; /* its tangent is found */
    struct poly_pair pair;                  /* of the contact pair_of_contact */
    int32_t pair_of_contact;
    int32_t n_tasks[POLY_N_LISTS];
    double nearest[POLY_CONTACTS + 1]; /* the smallest gap of a contact's points */
    double
        valid_path[POLY_CONTACTS + 1]; /* for which its springs act, while its tangent is found */
    _Alignas(64) double frame[POLY_CONTACTS + 1][POLY_FRAME];
    /* J, what contacts book in this step: summed up here first, so that what a grain's account gets
     * does not hang on which contacts make up a batch */
    double energy[POLY_CONTACTS][BRC_N_ACCOUNTS];
    double sum[POLY_CONTACTS + 1][POLY_SUMS];
    double tangent[POLY_CONTACTS + 1][36]; /* column after column */
    struct poly_contact4 four[POLY_CONTACTS / BRC_LANES];
    struct poly_geometry4 known[POLY_TASKS / BRC_LANES];
    struct poly_task task[POLY_N_LISTS][POLY_TASKS + BRC_LANES];
    struct poly_apart apart[POLY_TASKS];
};

/* Options of a run, which kernels get as literals: each is compiled without what is off, so that
 * options cost nothing in a step. */
enum poly_flags {
    POLY_LEDGER = 1,
    POLY_VISCOUS = 2,
    POLY_FRICTION = 4,
    POLY_TANGENTS = 8, /* contacts may be linearised */
    POLY_TORSION = 16,
    POLY_PLATENS = 32 /* contacts of platens */
};

/* What is done four at a time. */
typedef void poly_kernel(struct poly_batch *batch);
typedef int poly_list_kernel(struct brc_context *ctx, struct poly_list *l,
                             const struct poly_pair *p, enum poly_rule rule, double skin,
                             double *allowance);
typedef void poly_pose_kernel(const struct brc_sim *sim, const struct poly_state *st);
/* One loop: motion and bonds of the contacts; the lists: geometry, forces, springs; sums of the
 * contacts and their works. */
struct poly_loop {
    poly_kernel *motion, *points, *finish;
};
/* Chosen once a run. */
struct poly_kernels {
    poly_pose_kernel *pose; /* vertices and planes in space */
    poly_list_kernel *list; /* poly_list_features */
    struct poly_loop pairs, platens;
    poly_kernel *linearised; /* linearised contacts, or NULL */
};
/* kernels.inc.h for each instruction set: the kernels for the options of a simulation. */
struct poly_kernels poly_kernels_base(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx2(const struct brc_sim *sim);
struct poly_kernels poly_kernels_avx512(const struct brc_sim *sim);

#endif
