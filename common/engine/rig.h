/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A test is one const struct of this type, filled in common/rigs/<name>.c and named brc_rig_<name>;
 * the Makefile lists them. The engine calls its operations and knows no test; docs/add-a-test.md
 * walks through one. docs/measures.md says how each value is measured. Compression is positive in
 * all reports. */
#ifndef BRC_RIG_H
#define BRC_RIG_H

#include "common/base/table.h"
#include "common/engine/platens.h"
#include "common/input/params.h"

enum brc_loading { BRC_LOADING_ADAPTIVE, BRC_LOADING_FIXED };

/* Keys that tests share; each test names those that it uses (`kind=*`). */
#define BRC_TEST_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                              \
    CHOICE(kind, BRC_RIG_NAMES, BRC_RIG_DEFAULT, "see `breccia tests`")                          \
    CHOICE(loading, "adaptive|fixed", "adaptive",                                                \
           "adaptive: fast while the specimen is elastic, slow while it breaks; fixed: at rate", \
           "kind=*")                                                                             \
    REAL(rate, "1/s", "0 1/s", "[0, inf)",                                                       \
         "fixed loading: strain rate; adaptive: the first one; 0: strain_max / 1e5 a second, "   \
         "strain_max x target x 0.005; "                                                         \
         "in the quasi-static regime one step is one second",                                    \
         "kind=*")                                                                               \
    REAL(target, "1", "0.003", "(0, 1)",                                                         \
         "adaptive: strain a step, over the strain at which damage began",                       \
         "kind=*, loading=adaptive")                                                             \
    REAL(rate_min, "1/s", "0 1/s", "[0, inf)", "adaptive: smallest strain rate",                 \
         "kind=*, loading=adaptive")                                                             \
    REAL(rate_max, "1/s", "1e-3 1/s", "(0, inf)", "adaptive: largest strain rate",               \
         "kind=*, loading=adaptive")                                                             \
    REAL(strain_max, "1", "0.02", "(0, 10)", "the test ends at this platen strain", "kind=*",    \
         .flags = BRC_PARAM_MAY_CHANGE)                                                          \
    REAL(stop_drop, "1", "0.5", "[0, 1)",                                                        \
         "the test ends when the load has fallen to this part of "                               \
         "its peak; 0: never",                                                                   \
         "kind=*", .flags = BRC_PARAM_MAY_CHANGE)                                                \
    REAL(friction, "1", "0", "[0, 10]", "friction coefficient of the platens", "kind=*")         \
    CHOICE(grip, "axial|full", "axial",                                                          \
           "platens hold only the axial motion of the end grains, or all of it", "kind=*")       \
    REAL(gauge, "1", "0.6", "(0, 1]", "middle part of the specimen where strain is measured",    \
         "kind=*")                                                                               \
    REAL(plate_width, "m", "0 m", "[0, inf)", "width of the plates; 0: unlimited", "kind=*")     \
    REAL(modulus_low, "1", "0.05", "[0, 1)", "moduli: least squares from this part of the peak", \
         "kind=*")                                                                               \
    REAL(modulus_high, "1", "0.15", "(0, 1]", "moduli: up to this part of the peak", "kind=*")   \
    REAL(plateau, "1", "0.005", "[0, 1)",                                                        \
         "a load that stays within 1 % over this strain counts as a peak passed; 0: never",      \
         "kind=*")                                                                               \
    INT(sample_steps, "10", "[1, 1000000]", "steps between two rows of the curve")               \
    INT(acoustic_steps, "10", "[0, 1000000]",                                                    \
        "acoustic events: breaks of one are at most so many steps apart",                        \
        .flags = BRC_PARAM_MAY_CHANGE)                                                           \
    REAL(acoustic_radii, "1", "6", "(0, 1000]",                                                  \
         "acoustic events: and at most so many mean grain radii", .flags = BRC_PARAM_MAY_CHANGE)

struct brc_test_params {
    BRC_PARAM_MEMBERS(BRC_TEST_PARAMS)
};
extern const struct brc_param_list brc_test_param_list;

/* One row of the curve. */
#define BRC_CURVE_FIELDS(SCALAR, VECTOR)                                                           \
    SCALAR(int64_t, step, BRC_STATE, "1", "step")                                                  \
    SCALAR(double, time, BRC_STATE, "s", "time (steps in the quasi-static regime)")                \
    SCALAR(double, strain, BRC_STATE, "1", "platen strain, in the sense of the test")              \
    SCALAR(double, stress, BRC_STATE, "Pa", "stress, in the sense of the test (Brazilian: eq 16)") \
    SCALAR(double, force, BRC_STATE, "N", "mean platen force")                                     \
    SCALAR(double, strain_axial, BRC_STATE, "1", "gauge strain along the load, compression +")     \
    SCALAR(double, strain_lateral, BRC_STATE, "1", "gauge strain across the load, compression +")  \
    SCALAR(double, rate, BRC_STATE, "s-1", "strain rate")                                          \
    SCALAR(double, unbalanced, BRC_STATE, "1", "unbalanced-force ratio")                           \
    SCALAR(double, kinetic_ratio, BRC_STATE, "1", "kinetic / stored energy")                       \
    SCALAR(double, residual, BRC_STATE, "1", "energy residual")                                    \
    SCALAR(int64_t, broken, BRC_STATE, "1", "events so far")

/* A value that a test measures; declared by the test, known before any run. */
struct brc_quantity {
    const char *name, *unit, *meaning;
};
/* What came of it. */
struct brc_measured {
    double value;     /* NAN: not measured */
    const char *note; /* why it was not measured, or what to know of it; static */
};
/* Both, for those who know no test: tables, summaries, calibration. All texts are static, so that a
 * child process can hand a result to its parent as it is. */
struct brc_result {
    const char *name;
    double value;
    const char *unit;
    const char *note;
    bool is_detail; /* for files and programs, not for the table on the screen */
};
/* What a test declares, and with what is read off every test. */
enum { BRC_MAX_QUANTITIES = 24, BRC_MAX_RESULTS = 48 };

/* Sides of a core that is loaded along its axis. Those of a disc, which a Brazilian test needs
 * under its platens (specimen.c), would make polyhedra a third stiffer: a side cuts more corners
 * into the outer facets, and each corner is a spring. */
enum { BRC_CORE_SIDES = 64 };

/* How the pictures of a test are drawn. */
struct brc_rig_view {
    bool is_from_above;  /* of cracks: along z; else from the side */
    const char *strain;  /* column of the curve that is drawn as strain; NULL: none */
    const char *lateral; /* and the one drawn dashed; NULL: none */
    const char *strain_label, *stress_label;
};

struct brc_rig_type {
    const char *name, *meaning;   /* test.kind, and what `breccia tests` prints */
    const char *keys;             /* shared keys that it uses, with spaces between */
    struct brc_param_list params; /* keys of its own, in a section of its name; none: no section */
    struct brc_fieldset state;    /* one row of scalars that are saved with the run */
    struct brc_fieldset columns;  /* its own columns of the curve */
    struct brc_fieldset along;    /* columns of profile.csv: values along the specimen at the end */
    const struct brc_quantity *quantities;
    int n_quantities;
    int n_platens;
    int physics; /* its version, which moves when it loads or measures otherwise: brc_physics */
    int sides;   /* of the polygon that stands for a circle, unless the case says; 0: as for any */
    bool has_sides;                  /* it acts on the specimen's sides: pressure.h */
    const struct brc_rig_view *view; /* NULL: stress over the gauge strains, cracks from the side */

    /* --- required --- */

    /* Lengths, areas, platens and the velocities at the start. Called once, when bodies have their
     * places. */
    int (*place)(struct brc_sim *sim);
    /* After the forces of a step, when those of the platens and their work are known: loads,
     * strains, the velocity of each platen. */
    int (*drive)(struct brc_sim *sim);
    /* At the end of a step: rows of the curve. */
    int (*measure)(struct brc_sim *sim);
    /* The values of its quantities so far, in their order. */
    void (*results)(const struct brc_sim *sim, struct brc_measured *out);

    /* --- optional, with a default --- */

    /* Stresses along x, y, z of a row of the curve [Pa], which must be principal ones. Default: the
     * stress is not uniform, so that envelopes learn nothing of the test. */
    void (*stresses)(const struct brc_sim *sim, size_t row, double sigma[3]);
    /* Judges keys together. Default: accepts. */
    int (*check)(struct brc_context *ctx, const struct brc_test_params *test, const void *own);
    /* Velocity of a grain in the field that the test imposes now. Default: at rest. */
    void (*field)(const struct brc_sim *sim, size_t grain, double v[3]);
    /* The key that has ended the test, NULL while it goes on. Default: test.strain_max, or
     * test.stop_drop where the load has fallen so far. */
    const char *(*end)(const struct brc_sim *sim);
    /* After a saved state has been read: what `memory` derives from it. Default: nothing. */
    void (*restore)(struct brc_sim *sim);
    /* Frees `memory`. Default: there is none. */
    void (*free)(void *memory);
    /* Fills an empty table of the columns `along`. Required where there are any. */
    int (*profile)(const struct brc_sim *sim, struct brc_table *out);
};

/* A test as a case asks for it. */
struct brc_test {
    const struct brc_rig_type *type;
    const struct brc_test_params *params;
    const void *own; /* filled parameters of the type's own section; NULL where it has none */
};

/* Scalars that belong to the state, declared once for saving and hashing. */
#define BRC_RIG_SCALARS(X, RENAMED)                                                             \
    X(double, rate, "s-1", "strain rate")                                                       \
    X(double, change, "1", "adaptive: change of log rate a step")                               \
    X(double, strain_onset, "1", "adaptive: where damage began; 0: not yet")                    \
    X(double, kinetic_elastic, "J s2", "adaptive: kinetic energy / rate^2")                     \
    RENAMED(int64_t, is_post_peak, is_lost, "1", "adaptive: the load has fallen from its peak") \
    RENAMED(int64_t, is_steady, is_settled, "1", "the start has been left behind")              \
    X(int64_t, stage, "1", "stage of the loading, from 0")                                      \
    X(int64_t, stage_step, "1", "step at which it began")                                       \
    X(int64_t, stage_row, "1", "row of the curve with which it began")                          \
    X(int64_t, stage_events, "1", "events that are no sign of damage in it")                    \
    X(double, stage_strain, "1", "platen strain at which it began")                             \
    X(double, stage_sense, "1", "+1: the platen strain grows, -1: it falls")                    \
    X(int64_t, is_flowing, "1", "nothing was damaged at the onset: the specimen yields")        \
    X(double, stage_force, "N", "force at which it began")                                      \
    X(double, stiffest, "N", "largest change of the force over the strain, in it")              \
    X(double, strain, "1", "platen strain, in the sense of the test")                           \
    X(double, force, "N", "mean platen force now, in the sense of the test")                    \
    X(double, force_sum, "N", "sum of force since the last row of the curve")                   \
    X(double, strain_sum, "1", "sum of strain since the last row")                              \
    X(int64_t, n_summed, "1", "steps in force_sum")                                             \
    X(double, force_peak, "N", "largest row of the curve")                                      \
    X(double, strain_peak, "1", "platen strain at the peak")                                    \
    X(double, unbalanced, "1", "mean unbalanced force / mean contact force")

#define BRC_SCALAR_MEMBER(type, name, unit, meaning)            type name;
#define BRC_SCALAR_RENAMED(type, name, in_files, unit, meaning) type name;

struct brc_rig {
    const struct brc_rig_type *type;
    struct brc_test_params params;
    void *own;    /* parameters of the type's own section; owned */
    void *memory; /* what the type has made in `place`, freed by its `free` */
    int n_platens;
    struct brc_platen platen[BRC_MAX_PLATENS];
    int axis;         /* of the load */
    double sense;     /* +1 where shortening counts as positive, -1 where lengthening does */
    double length[3]; /* m, of the specimen at the start, along each axis */
    double section;   /* m2, area that the load is divided by */
    /* by axis: number of the gauge's grains, sums of their places at the start and of the squares
     */
    struct brc_gauge {
        double n, x, xx;
    } gauge[3];
    bool has_gauge[3]; /* grains enough, far enough apart for a strain along x, y, z */
    BRC_RIG_SCALARS(BRC_SCALAR_MEMBER, BRC_SCALAR_RENAMED)
    struct brc_curve {
        BRC_CURVE_FIELDS(BRC_COLUMN, BRC_COLUMN3)
        struct brc_table table;
        struct brc_table own; /* the type's own columns, same rows */
        void *own_columns;
    } curve;
    struct brc_table own_state; /* one row of the type's own scalars */
    void *own_scalars;
};

/* Judges the keys of a test together, and whether its table is complete. */
int brc_rig_check(struct brc_context *ctx, const struct brc_test *test);
/* Tables of the curve and of the type's own state, without a row of the curve. */
int brc_rig_create(struct brc_context *ctx, struct brc_rig *rig, const struct brc_test *test);
void brc_rig_free(struct brc_rig *rig);
/* A further row of the curve, of zeros; its number. */
int brc_rig_add_row(struct brc_context *ctx, struct brc_rig *rig, size_t *row);

#endif
