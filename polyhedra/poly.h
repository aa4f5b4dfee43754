/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameters, fields and private memory of the bonded spheropolyhedra, shared by this folder.
 * Included by every file of it that knows a simulation; the laws (geometry.h, contact.h, bond.h) do
 * without. */
#ifndef POLY_POLY_H
#define POLY_POLY_H

#include "polyhedra/batch.h"

#include "common/engine/sim.h"

#include <string.h>

/* Skin of the feature lists, in radii R: a smaller one lists fewer pairs, more often. */
#define POLY_LIST_SKIN 0.2
/* The same of the vertices listed for a platen. */
#define POLY_PLATEN_SKIN 0.05

#define POLY_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                                   \
    REAL(density, "kg/m3", "3000 kg/m3", "(0, inf)", "density of the whole cells (no porosity)")  \
    REAL(radius, "m", "auto", "(0, inf)",                                                         \
         "sphero-radius R of erosion and rounding, eq 2; auto: by radius_ratio")                  \
    REAL(radius_ratio, "1", "0.05", "(0, 0.5)",                                                   \
         "radius auto: R over the mean grain size, the cube root of the mean volume",             \
         "radius=auto")                                                                           \
    REAL(kn, "N/m", "auto", "(0, inf)",                                                           \
         "normal stiffness K_n of a feature contact, eq 4; auto: by kn_modulus")                  \
    REAL(kn_modulus, "Pa", "9.2 GPa", "(0, inf)",                                                 \
         "kn auto: K_n over mean facet area / mean distance of the cell centres", "kn=auto")      \
    REAL(kt, "N/m", "auto", "[0, inf)",                                                           \
         "tangential stiffness K_t of a feature contact, eq 8; auto: by kt_ratio")                \
    REAL(kt_ratio, "1", "0.6", "[0, 10]", "kt auto: K_t over K_n", "kt=auto")                     \
    REAL(mu, "1", "0.85", "[0, 10]", "friction coefficient of grains")                            \
    REAL(gn, "1/s", "2529.8 1/s", "[0, inf)", "normal viscosity, eq 10; dynamic regime only",     \
         "run.regime=dynamic")                                                                    \
    REAL(gt, "1/s", "0 1/s", "[0, inf)", "tangential viscosity, eq 10; dynamic regime only",      \
         "run.regime=dynamic")                                                                    \
    FLAG(bonds, "on", "bonds where the specimen has facets; off: a cohesionless pack")            \
    FLAG(breakable, "on", "bonds break by eq 15", "bonds=on")                                     \
    REAL(bn, "Pa", "9 GPa", "[0, inf)", "normal modulus of the bonds, eq 11", "bonds=on")         \
    REAL(bt, "Pa", "1.1 GPa", "[0, inf)", "tangential modulus of the bonds, eq 13", "bonds=on")   \
    REAL(bm, "Pa", "0.18 GPa", "[0, inf)", "torsion modulus of the bonds, eq 14",                 \
         "bonds=on, torsion=on")                                                                  \
    REAL(eps_th, "1", "2.66e-3", "(0, inf)", "strain limit of the bonds, eq 15",                  \
         "bonds=on, breakable=on")                                                                \
    FLAG(theta_limit, "on", "eq 15 has its torsion term; off: only strains break bonds",          \
         "bonds=on, breakable=on, torsion=on")                                                    \
    REAL(theta_th, "rad", "0.05 rad", "(0, inf)", "torsion limit of the bonds, eq 15",            \
         "bonds=on, breakable=on, torsion=on, theta_limit=on")                                    \
    CHOICE(                                                                                       \
        strain_length, "gap|centres", "centres",                                                  \
        "strains are per gap between the eroded faces (2 R) or per distance of the cell centres", \
        "bonds=on")                                                                               \
    CHOICE(area, "eroded|facet", "facet",                                                         \
           "bond area: mean of the two eroded faces, or the facet's own", "bonds=on")             \
    FLAG(torsion, "on", "bonds resist torsion, eq 14", "bonds=on")                                \
    REAL(torsion_length, "m", "0 m", "[0, inf)",                                                  \
         "length that makes eq 14 a torque; 0: the strain length", "bonds=on, torsion=on")        \
    CHOICE(features, "closed|strict|merged", "merged",                                            \
           "feature pairs that are springs: all within reach, eq 1; feet strictly inside; each "  \
           "physical contact once, with a continuous force",                                      \
           .flags = BRC_PARAM_AXIS)                                                               \
    CHOICE(evaluation, "auto|literal|condensed", "auto",                                          \
           "bond and springs of a pair: each at each step; or, while the same ones act, their "   \
           "sum, linear in the motion since all were computed; auto: condensed in the "           \
           "quasi-static regime",                                                                 \
           .flags = BRC_PARAM_AXIS)                                                               \
    REAL(condensed_path, "1", "0.005", "(0, 0.05]",                                               \
         "condensed: relative path, in radii R, until all are computed anew",                     \
         "evaluation=auto|condensed, evaluation=condensed or run.regime=quasi_static")

/* In the order of the words of their keys. */
enum poly_strain_length { POLY_LENGTH_GAP, POLY_LENGTH_CENTRES };
enum poly_area { POLY_AREA_ERODED, POLY_AREA_FACET };
enum poly_evaluation { POLY_AUTO, POLY_LITERAL, POLY_LINEARISED };

struct poly_params {
    BRC_PARAM_MEMBERS(POLY_PARAMS)
};

/* Contact fields. Tables of work hold force and moment about a of the last step, for the trapezoid
 * rule of ledger.h; they are written only while the ledger is on. */
#define POLY_CONTACT_FIELDS(SCALAR, VECTOR, RENAMED, RENAMED3)                                   \
    RENAMED(double, rebuild_at, wake, BRC_STATE, "m",                                            \
            "no features listed: path of a and b to list anew")                                  \
    RENAMED(double, skin_left, room, BRC_STATE, "m",                                             \
            "features listed: relative path left to list anew")                                  \
    SCALAR(int32_t, awake, BRC_STATE, "1", "points that are looked at; the others sleep")        \
    SCALAR(double, stable_above, BRC_SCRATCH, "m",                                               \
           "items stay right while there is more skin left than so")                             \
    SCALAR(int32_t, ready, BRC_SCRATCH, "1", "the points that are awake have their items")       \
    VECTOR(double, bond, POLY_BOND, BRC_STATE, "m, 1, m2", "bond, in both frames (POLY_BOND)")   \
    RENAMED(uint8_t, is_linearised, carried, BRC_STATE, "1", "1: moved by its tangent")          \
    RENAMED3(double, motion, shift, POLY_MOTION, BRC_STATE, "m, 1",                              \
             "linearised: motion since all was computed (POLY_MOTION)")                          \
    RENAMED3(double, linearised_force, held, 6, BRC_STATE, "N, N m",                             \
             "linearised: force and moment about a then")                                        \
    VECTOR(double, tangent, 36, BRC_STATE, "N m-1, N, N m", "linearised: their slope by motion") \
    VECTOR(double, bond_old, 6, BRC_STATE, "N, N m", "bond force on b, its moment about a")      \
    VECTOR(double, normal_old, 6, BRC_STATE, "N, N m",                                           \
           "the same of the normal springs; linearised: of all springs and the bond")            \
    VECTOR(double, viscous_old, 6, BRC_STATE, "N, N m",                                          \
           "the same of the viscous forces; linearised: poly_tangent_end, m")

struct poly_contacts {
    POLY_CONTACT_FIELDS(BRC_COLUMN, BRC_COLUMN3, BRC_COLUMN_RENAMED, BRC_COLUMN3_RENAMED)
};

/* Linearised, features: closed: path for which the tangent holds while no sleeper touches. In a
 * column that such runs have no use for, as they go without viscosity: one more would change the
 * hash of each state, and so all runs that sweeps have kept. */
static inline double *poly_tangent_end(const struct poly_contacts *columns, size_t contact)
{
    return &columns->viscous_old[contact][0];
}

/* Points: feature pairs near enough to touch before the contact is listed anew. */
#define POLY_POINT_FIELDS(SCALAR, VECTOR, RENAMED)                                         \
    SCALAR(uint8_t, kind, BRC_STATE, "1", "0 vertex of a, 1 vertex of b, 2 edges")         \
    SCALAR(uint8_t, active, BRC_STATE, "1",                                                \
           "0 apart, 1 in contact, 2 the same with edges whose "                           \
           "cross product points from b to a")                                             \
    SCALAR(int32_t, i, BRC_STATE, "1", "feature of a: vertex, face (or place), edge")      \
    SCALAR(int32_t, j, BRC_STATE, "1", "feature of b")                                     \
    VECTOR(int32_t, near, POLY_NEAR, BRC_STATE, "1",                                       \
           "vertices that may lower the weight; -1: no more; -2 first: too many to name")  \
    SCALAR(double, sleep, BRC_STATE, "m",                                                  \
           "the pair cannot touch while its contact has more skin left")                   \
    RENAMED(double, feature_valid_to, hold, BRC_STATE, "m",                                \
            "vertices: the closest feature is sure while there is more skin left; edges: " \
            "POLY_FADES or more")                                                          \
    VECTOR(int32_t, item, POLY_ITEM, BRC_SCRATCH, "1", "what the touch is computed from")  \
    VECTOR(double, spring, POLY_SPRING, BRC_STATE, "m, 1",                                 \
           "tangential displacement xi, eq 9; weight; normal from a to b; 0")

/* edges that are apart, and can but touch with a weight that grows from 0 */
#define POLY_FADES (-HUGE_VAL)

struct poly_points {
    POLY_POINT_FIELDS(BRC_COLUMN, BRC_COLUMN3, BRC_COLUMN_RENAMED)
};

static inline struct poly_feature poly_point(const struct poly_points *points, size_t p)
{
    struct poly_feature f = {.i = points->i[p], .j = points->j[p], .kind = points->kind[p]};
    memcpy(f.near, points->near[p], sizeof f.near);
    return f;
}

/* Nothing here is saved: what a restart needs is in the fields, and the rest is derived from
 * specimen, parameters and poses. */
struct poly_state {
    struct poly_shapes shapes;
    double (*eroded)[2]; /* m2, of each facet of the specimen: what either grain's core keeps */
    /* derived from the poses at each use */
    double (*global_vertices)[3]; /* vertices of all cores in space */
    double (*global_planes)[4];   /* planes of all faces in space: outward normal n, and n . x */
    double (*rotation)[3][3];     /* rotation matrix of each body, platens included */
    struct poly_list list;        /* work space */
    struct brc_springs ahead;     /* work space of poly_foresee */
    size_t n_removed;             /* facets that erosion removes on either side */
    size_t n_bonds;
    double mean_area, mean_length; /* of the bonds */
    bool is_scaled;                /* K_n follows from kn_modulus */
    struct poly_kernels kernels;
    struct poly_batch *batch; /* work space of the loop over pairs */
};

static inline const struct poly_params *poly_params_of(const struct brc_sim *sim)
{
    return sim->params;
}

static inline bool poly_is_viscous(const struct brc_sim *sim)
{
    const struct poly_params *p = poly_params_of(sim);
    return sim->run.regime == BRC_DYNAMIC && (p->gn > 0 || p->gt > 0);
}

/* One question for all who ask, so that kernels and bookkeeping cannot disagree. */
static inline bool poly_is_linearised(const struct brc_sim *sim)
{
    const struct poly_params *p = poly_params_of(sim);
    return BRC_OPTION(p->evaluation == POLY_LINEARISED ||
                      (p->evaluation == POLY_AUTO && sim->run.regime != BRC_DYNAMIC));
}

/* Smaller one of the radii of two cores about their centres. By it a relative path of the bodies
 * bounds how far they turn against each other. */
static inline double poly_core_reach(const struct brc_sim *sim, int32_t a, int32_t b)
{
    return poly_least(sim->bodies.bounding_radius[a], sim->bodies.bounding_radius[b]) -
           poly_params_of(sim)->radius;
}

/* scale.c: values that are `auto`, from the grains; what is given stays. A specimen without inner
 * facets counts as cubes of the mean volume. Measured anew by whoever asks, so that a check before
 * the run and the run have the same. */
struct poly_scale {
    double size;           /* m, cube root of the mean volume */
    double area, distance; /* m2, m: mean inner facet, mean distance of the centres over it */
};
void poly_scale_measure(struct poly_scale *scale, const struct brc_facets *facets);
void poly_scale_params(const struct poly_scale *scale, struct poly_params *params);

/* bonding.c: initial bonds. contact_points.c: contacts from the neighbour list, their points. */
int poly_open_bonds(struct brc_sim *sim, void *state);
int poly_update_contacts(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                         const struct brc_neighbours *platens);
/* Lists the features of a contact of pairs, or of platens. */
int poly_list_contact(struct brc_sim *sim, struct poly_state *st, size_t contact);
int poly_list_platen(struct brc_sim *sim, struct poly_state *st, size_t contact);
/* The points of a contact that are awake come first, sorted by feature; then those that sleep,
 * sorted by when they wake up. Brings in those that its skin left wakes. So that the loop runs over
 * awake points without a test, and one look at the first sleeper tells whether any wakes. */
void poly_wake_points(struct brc_contacts *c, size_t contact, bool merged);
/* A point that is awake and does not touch sleeps until its contact has no more skin left than
 * `sleep`. */
void poly_sleep_point(struct brc_contacts *c, size_t contact, size_t p, double sleep);
/* The same for the first one that sleeps already. */
void poly_sleep_on(struct brc_contacts *c, size_t contact, double sleep);

/* points.c: lists the points of contact i of the batch that may touch; computes all that is listed.
 * May work off what is listed when the lists are full. */
void poly_list_points(struct poly_batch *batch, int32_t i);
void poly_work_off(struct poly_batch *batch);

/* linearise.c. Decides whether contact i of the batch may be linearised: then its tangent is found
 * with its forces. */
void poly_begin_tangent(struct poly_batch *batch, int32_t i);
/* A contact that has been computed literally, and whose springs all touch, is linearised until it
 * has moved by the path for which they stay what they are. */
void poly_linearise(struct poly_batch *batch, int32_t i);
/* A linearised contact that has come to its end by `path`: where that is the end of a sleeper's
 * bound alone, looks whether it touches. True when none does, and the end is farther on now. */
bool poly_look_at_sleepers(struct poly_batch *batch, size_t contact, double path);
/* Where contacts may be linearised, the works of bonds are not booked by themselves: what the bond
 * of a contact has gained since it was computed last is part of the work of all that acts. */
void poly_account_bond(struct poly_batch *batch, int32_t i, double stored);

/* forces.c: the loops. */
void poly_forces(struct brc_sim *sim, void *state);
void poly_platens(struct brc_sim *sim, void *state);
/* erode.c: cells become eroded cores with the mass of the whole cell (no porosity). */
int poly_shape(struct brc_sim *sim, void *state);

/* bond_of_contact.c. One bond, or the hold of a grip. */
struct poly_bond {
    double kn, kt, ktheta; /* N/m, N/m, N m */
    double n[3], x[3];     /* mean normal from a to b, place */
    double term[3];        /* of eq 15: tension, shear, torsion */
    double energy;         /* J, stored */
};
/* After poly_pose_bodies; false where it is not intact. */
bool poly_bond_of_contact(struct poly_bond *r, const struct brc_sim *sim,
                          const struct poly_state *st, const struct brc_contacts *c,
                          size_t contact);
/* 0 tension, 1 shear, 2 torsion: the largest term of eq 15. */
int poly_bond_mode(const struct poly_bond *bond);

/* energy.c, springs.c: stored energy and springs, from state alone. */
void poly_energy(const struct brc_sim *sim, const void *state, double (*of_grain)[BRC_N_ACCOUNTS]);
int poly_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out);
/* Dynamic regime: the step bears that all listed features of a contact close at once. */
int poly_foresee(struct brc_sim *sim, struct poly_state *st, size_t contact, bool is_platen);

/* pose.c. Rotation matrices, core vertices and planes in space for the present poses. */
void poly_pose_bodies(const struct brc_sim *sim, const struct poly_state *st);
/* Two bodies as the feature functions want them; after poly_pose_bodies. */
void poly_pair_of(struct poly_pair *p, const struct brc_sim *sim, const struct poly_state *st,
                  int32_t a, int32_t b);
/* A feature contact that acts. */
struct poly_active {
    int32_t a, b;          /* bodies */
    size_t contact, point; /* of its set of contacts */
    struct poly_feature feature;
    struct poly_geometry geometry;
};
/* Visits the feature contacts of contact `contact` of c (sim->pairs or sim->platens) that touch, or
 * would touch if the contact distance were larger by skin [m]; after poly_pose_bodies. */
void poly_each_touch(const struct brc_sim *sim, const struct poly_state *st,
                     const struct brc_contacts *c, size_t contact, double skin,
                     void (*visit)(void *user, const struct poly_active *active), void *user);
/* Visits the active feature contacts of all grain pairs, computed from the present poses. */
void poly_each_active(const struct brc_sim *sim, const struct poly_state *st,
                      void (*visit)(void *user, const struct poly_active *active), void *user);

#endif
