/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Test rigs: platens, loading, and the measures of stress and strain. docs/measures.md says how
 * each value is measured. Compression is positive in all reports. */
#ifndef BRC_RIG_H
#define BRC_RIG_H

#include "common/engine/platens.h"
#include "common/input/params.h"

enum brc_test { BRC_TEST_COMPRESSION, BRC_TEST_TENSION, BRC_TEST_BRAZILIAN, BRC_TEST_NONE };
enum brc_loading { BRC_LOADING_ADAPTIVE, BRC_LOADING_FIXED };

#define BRC_TEST_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                              \
    CHOICE(kind, "compression|tension|brazilian|none", "compression",                            \
           "compression and tension along z, Brazilian along y; none: no platens")               \
    CHOICE(loading, "adaptive|fixed", "adaptive",                                                \
           "adaptive: fast while the specimen is elastic, slow while it breaks; fixed: at rate", \
           "kind=compression|tension|brazilian")                                                 \
    REAL(rate, "1/s", "0 1/s", "[0, inf)",                                                       \
         "fixed loading: strain rate; adaptive: the first one; 0: strain_max / 1e5 a second, "   \
         "strain_max x target x 0.005; "                                                         \
         "in the quasi-static regime one step is one second",                                    \
         "kind=compression|tension|brazilian")                                                   \
    REAL(target, "1", "0.003", "(0, 1)",                                                         \
         "adaptive: strain a step, over the strain at which damage began",                       \
         "kind=compression|tension|brazilian, loading=adaptive")                                 \
    REAL(rate_min, "1/s", "0 1/s", "[0, inf)", "adaptive: smallest strain rate",                 \
         "kind=compression|tension|brazilian, loading=adaptive")                                 \
    REAL(rate_max, "1/s", "1e-3 1/s", "(0, inf)", "adaptive: largest strain rate",               \
         "kind=compression|tension|brazilian, loading=adaptive")                                 \
    REAL(strain_max, "1", "0.02", "(0, 10)", "the test ends at this platen strain",              \
         "kind=compression|tension|brazilian")                                                   \
    REAL(stop_drop, "1", "0.5", "[0, 1)",                                                        \
         "the test ends when the load has fallen to this part of "                               \
         "its peak; 0: never",                                                                   \
         "kind=compression|tension|brazilian")                                                   \
    REAL(friction, "1", "0", "[0, 10]", "friction coefficient of the platens",                   \
         "kind=compression|brazilian")                                                           \
    CHOICE(grip, "axial|full", "axial",                                                          \
           "tension: platens hold only the axial motion of the end grains, or all of it",        \
           "kind=tension")                                                                       \
    REAL(gauge, "1", "0.6", "(0, 1]", "middle part of the specimen where strain is measured",    \
         "kind=compression|tension|brazilian")                                                   \
    REAL(plate_width, "m", "0 m", "[0, inf)", "Brazilian: width of the plates; 0: unlimited",    \
         "kind=brazilian")                                                                       \
    REAL(modulus_low, "1", "0.05", "[0, 1)", "moduli: least squares from this part of the peak", \
         "kind=compression|tension")                                                             \
    REAL(modulus_high, "1", "0.15", "(0, 1]", "moduli: up to this part of the peak",             \
         "kind=compression|tension")                                                             \
    INT(sample_steps, "10", "[1, 1000000]", "steps between two rows of the curve")

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

struct brc_result {
    const char *name;
    double value; /* NAN: not measured */
    const char *unit;
    const char *note; /* why it was not measured; static, NULL where it was */
};
enum { BRC_MAX_RESULTS = 24 };

/* A curve without a row. */
void brc_rig_start_curve(struct brc_sim *sim);
/* Judges the keys together; brc_rig_create does so too. */
int brc_rig_check(struct brc_context *ctx, const struct brc_test_params *test);
/* Number of platens of a test. */
int brc_rig_platens(const struct brc_test_params *test);
/* The rate at which a test starts [1/s]: its own, or the automatic one. */
double brc_rig_start_rate(const struct brc_test_params *test);
/* Places the platen bodies at the specimen's ends and gives them and the grains the
 * velocity field of a uniform strain at the starting rate. Called once, when bodies have
 * their places. */
int brc_rig_create(struct brc_sim *sim, const struct brc_test_params *test);
/* Velocity [m/s] of a grain in the field of a uniform strain at the present rate, about the middle
 * of the specimen; needs platens. */
void brc_rig_field(const struct brc_sim *sim, size_t grain, double v[3]);
void brc_rig_free(struct brc_sim *sim);
/* After the forces of a step: platen forces, boundary work, strain, loading rate. Platens that
 * meet are an error. */
int brc_rig_step(struct brc_sim *sim);
/* At the end of a step: a row of the curve every sample_steps. */
int brc_rig_sample(struct brc_sim *sim);
/* The test has reached its end: strain_max, or the load has fallen to stop_drop of its
 * peak. */
bool brc_rig_done(const struct brc_sim *sim);
/* Steps until strain_max at the rate of the loading's present stage, for "time left, at most":
 * HUGE_VAL while adaptive loading has not met damage, as all hangs on where it begins, and without
 * platens. It falls from then on; brakes for avalanches are left out. */
double brc_rig_steps_left(const struct brc_sim *sim);
/* The values measured so far; returns how many. What was not measured has a note: strength and all
 * that hangs on the peak before the load has fallen from it, moduli without a gauge or without two
 * rows. A value that is not finite and has no note is the result of a computation that failed.
 * docs/measures.md says how each is measured. */
int brc_rig_results(const struct brc_sim *sim, struct brc_result out[BRC_MAX_RESULTS]);
/* Largest unbalanced ratio of the rows up to the peak that carry a tenth of it or more. */
double brc_rig_unbalanced_max(const struct brc_sim *sim);
/* After a loaded state has replaced bodies, curve and scalars. */
void brc_rig_restore(struct brc_sim *sim);

#endif
