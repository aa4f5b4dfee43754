/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a calibration minimises: for a vector of contact parameters the tests that the targets ask
 * for are run, and each measured value gives one weighted residual. */
#ifndef CALIB_OBJECTIVE_H
#define CALIB_OBJECTIVE_H

#include "calib/target.h"
#include "common/output/output.h"

/* One free parameter: a key of the model's list, with bounds in SI. Only quantities can be varied,
 * not choices. */
struct calib_variable {
    const char *key;
    double low, high;
};

/* One test to run: the case of that test with these values in place of its own. */
struct calib_trial {
    const char *model;
    int test; /* number of it, see rigs.h */
    size_t n;
    const struct calib_variable *variables;
    const double *x; /* SI */
};

/* Runs a trial and fills the summary: at least its results. A function pointer, so that tests of a
 * search can put a formula in place of a simulation. */
struct calib_runner {
    int (*run)(struct brc_context *ctx, void *user, const struct calib_trial *trial,
               struct brc_summary *out);
    void *user;
};

/* What is to be met, by what. All pointers are the caller's and outlive the calls. */
struct calib_objective {
    const char *model;
    const struct calib_targets *targets;
    size_t n;
    const struct calib_variable *variables;
    double relative_deviation; /* of targets whose deviation is not known, such as 0.05 */
    struct calib_runner runner;
};

struct calib_residual {
    enum calib_quantity_code quantity;
    double target, deviation, measured; /* SI */
    double residual;                    /* (measured - target) / deviation */
};

/* residual in the order of the targets, those without a test left out. */
struct calib_evaluation {
    size_t n;
    struct calib_residual residual[CALIB_N_QUANTITIES];
    double cost;  /* half the sum of the residuals' squares */
    double cpu_s; /* of all tests */
    int n_runs;
};

/* Number of residuals: targets that a test measures. */
size_t calib_objective_size(const struct calib_objective *o);
/* Judges names, bounds and weights; to be called once. list is the model's. */
int calib_objective_check(struct brc_context *ctx, const struct calib_objective *o,
                          struct brc_param_list list);
/* Runs each test once. x outside its bounds is an error, and so is a run without the value. */
int calib_objective_evaluate(struct brc_context *ctx, const struct calib_objective *o,
                             const double *x, struct calib_evaluation *out);

#endif
