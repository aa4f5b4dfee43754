/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One running simulation: what a step reads and writes. */
#ifndef BRC_SIM_H
#define BRC_SIM_H

#include "common/engine/bodies.h"
#include "common/engine/contacts.h"
#include "common/engine/events.h"
#include "common/engine/ledger.h"
#include "common/engine/model.h"
#include "common/engine/rig.h"
#include "common/base/simd.h"
#include "common/specimen/specimen.h"

enum brc_regime { BRC_DYNAMIC, BRC_QUASI_STATIC };
enum brc_damping { BRC_DAMPING_CARTESIAN, BRC_DAMPING_ALONG_VELOCITY };
enum brc_damped { BRC_DAMPED_AUTO, BRC_DAMPED_MOTION, BRC_DAMPED_FLUCTUATION };

#define BRC_RUN_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                                \
    CHOICE(                                                                                       \
        regime, "dynamic|quasi_static", "quasi_static",                                           \
        "dynamic: true mass, viscous contact damping; quasi_static: scaled mass, step 1, local "  \
        "damping")                                                                                \
    REAL(dt, "s", "0 s", "[0, inf)", "dynamic: time step; 0: automatic; above the limit: error",  \
         "regime=dynamic")                                                                        \
    REAL(dt_margin, "1", "0.5", "(0, 1)", "dynamic, automatic: part of the stable limit",         \
         "regime=dynamic, dt=0")                                                                  \
    REAL(mass_margin, "1", "1.2", "(0, 100]",                                                     \
         "quasi_static: factor on the scaled masses; below 1.2 the largest eigenfrequency is "    \
         "measured, and an unstable step is an error",                                            \
         "regime=quasi_static")                                                                   \
    REAL(local_damping, "1", "0.7", "[0, 1)",                                                     \
         "quasi_static: local non-viscous damping alpha against the whole motion",                \
         "regime=quasi_static, damped=auto|motion")                                               \
    REAL(fluctuation_damping, "1", "0.3", "[0, 1)",                                               \
         "quasi_static: alpha against the fluctuation about the mean motion, in its place",       \
         "regime=quasi_static, damped=auto|fluctuation")                                          \
    CHOICE(damping, "cartesian|along_velocity", "cartesian",                                      \
           "local damping per Cartesian component as printed, or along the velocity",             \
           "regime=quasi_static")                                                                 \
    CHOICE(damped, "auto|motion|fluctuation", "auto",                                             \
           "local damping acts against the whole motion, as printed, or against its fluctuation " \
           "about the mean of the last steps; auto: fluctuation under adaptive loading",          \
           "regime=quasi_static")                                                                 \
    REAL(damping_memory, "1", "35", "[1, 1000]", "steps that this mean reaches back",             \
         "regime=quasi_static, damped=auto|fluctuation or test.loading=adaptive")                 \
    REAL3(gravity, "m/s2", "0 m/s2, 0 m/s2, 0 m/s2", NULL, "acceleration of gravity")             \
    FLAG(ledger, "on", "energy ledger; off costs nothing and reports no residual")                \
    REAL(skin, "1", "0.2", "[0.01, 0.5]", "candidates: skin, in mean grain radii")                \
    CHOICE(                                                                                       \
        simd, "auto|base|avx2|avx512", "auto",                                                    \
        "instructions that hot loops use; the same bits with each of them; where a loop has no "  \
        "AVX-512 build, avx512 runs its AVX2 one",                                                \
        .flags = BRC_PARAM_MAY_CHANGE | BRC_PARAM_COST)                                           \
    INT(max_steps, "10000000", "[1, 2000000000]", "the run ends after this many steps",           \
        .flags = BRC_PARAM_MAY_CHANGE)                                                            \
    REAL(checkpoint, "s", "5 min", "[0, inf)",                                                    \
         "elapsed time between saved states; 0: none by time",                                    \
         .flags = BRC_PARAM_MAY_CHANGE | BRC_PARAM_COST)                                          \
    INT(checkpoint_steps, "0", "[0, 2000000000]", "steps between saved states; 0: none by steps", \
        .flags = BRC_PARAM_MAY_CHANGE | BRC_PARAM_COST)

struct brc_run_params {
    BRC_PARAM_MEMBERS(BRC_RUN_PARAMS)
};
extern const struct brc_param_list brc_run_param_list;
/* Versions of what this folder computes: motion, masses, neighbour search, platens, ledger. */
extern const struct brc_physics brc_engine_physics[];

/* Scalars that belong to the state, declared once for saving and hashing; with those of the rig and
 * the ledger's terms. */
#define BRC_SIM_SCALARS(X, RENAMED)                                                         \
    X(int64_t, step, "1", "steps made")                                                     \
    X(double, time, "s", "time")                                                            \
    X(double, dt, "s", "time step")                                                         \
    X(double, dt_limit, "s", "stable limit at the last estimate")                           \
    X(double, stiffness_bound, "s-2", "largest sum k / m at the last estimate of dt_limit") \
    RENAMED(int64_t, n_rebuilds, n_listings, "1", "neighbour searches so far")

struct brc_sim {
    struct brc_context *ctx;
    struct brc_model model; /* a copy, so that tests may spoil one operation */
    void *params;           /* the model's parameter struct; owned */
    void *state;            /* the model's private memory */
    const struct brc_specimen *specimen;
    struct brc_run_params run;
    struct brc_bodies bodies;
    struct brc_contacts pairs, platens;
    struct brc_events events;
    struct brc_ledger ledger;
    struct brc_ledger ledger_at_peak; /* at the end of the largest row of the curve */
    struct brc_rig rig;
    BRC_SIM_SCALARS(BRC_SCALAR_MEMBER, BRC_SCALAR_RENAMED)
    double skin;           /* m */
    double damping_alpha;  /* local damping in use: 0 in the dynamic regime */
    bool tracks_mean;      /* the mean velocities are kept */
    bool damp_fluctuation; /* once the start is settled, local damping leaves them alone */
    double mass_checked;   /* kg, sum of the masses at the last look at the eigenfrequencies */
    int64_t k_seen[2];     /* k_version of pairs and platens when dt or masses were last set */
};

/* The scalars of clock, rig and ledger as fields of one row, which is struct brc_sim itself: what
 * saves and compares tables serves them, too. */
extern const struct brc_fieldset brc_sim_scalars;

/* Builds bodies, platens, contacts and the first forces. params is the model's filled parameter
 * struct (copied); specimen must outlive the simulation. Nothing is left behind on failure. */
int brc_sim_create(struct brc_context *ctx, struct brc_sim *sim, const struct brc_model *model,
                   const void *params, const struct brc_specimen *specimen,
                   const struct brc_test *test, const struct brc_run_params *run);
/* The tables of a model's state without a row, for reading files; nothing else of it may be used.
 */
int brc_sim_tables(struct brc_context *ctx, struct brc_sim *sim, const struct brc_model *model);
void brc_sim_free(struct brc_sim *sim);
/* Grain-platen pairs with (x - platen) . n < bounding radius + skin; platen bodies follow the
 * grains. */
int brc_sim_near_platens(const struct brc_sim *sim, struct brc_neighbours *out);
/* Forces of all contacts after a motion, and their sums on the bodies: part of a step. */
void brc_sim_forces(struct brc_sim *sim);
/* One step: drift, candidates, forces, loading, kick, sample. */
int brc_sim_step(struct brc_sim *sim);
/* After all tables and scalars of a created simulation have been replaced by saved ones: derives
 * what is not saved (adjacency, counts, the model's private memory). */
int brc_sim_restore(struct brc_sim *sim);
/* 64-bit hash over bodies, contacts, points, events, rig and ledger. */
uint64_t brc_sim_hash(struct brc_sim *sim);

/* Platen of a body number (a platen body). */
static inline const struct brc_platen *brc_sim_platen(const struct brc_sim *sim, int32_t body)
{
    return &sim->rig.platen[(size_t)body - sim->bodies.n_grains];
}

#endif
