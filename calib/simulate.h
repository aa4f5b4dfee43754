/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runner of an objective that simulates: one case file per test, each specimen made once. */
#ifndef CALIB_SIMULATE_H
#define CALIB_SIMULATE_H

#include "calib/objective.h"
#include "common/rigs/rigs.h"
#include "common/specimen/specimen.h"

/* More than models have stiffnesses and strengths. */
enum { CALIB_MAX_VARIABLES = 32 };

/* Zero all but path and dir before the first run. */
struct calib_simulator {
    const char *path[BRC_MAX_RIGS]; /* case file by the number of its test; NULL: no such test */
    const char *dir; /* results of the latest runs, one folder a test; without results before */
    struct brc_specimen specimen[BRC_MAX_RIGS]; /* without cells: not made yet */
    bool has_run[BRC_MAX_RIGS];                 /* its folder holds results of this simulator */
};

/* To be used as calib_runner.run with a struct calib_simulator as user. Fails as the run does, and
 * when no case is given for the test. */
int calib_simulate(struct brc_context *ctx, void *user, const struct calib_trial *trial,
                   struct brc_summary *out);
void calib_simulator_free(struct calib_simulator *s);
/* "model.key=value unit" of a variable, as --set takes it: the same double when it is read. */
int calib_assignment(struct brc_context *ctx, const struct calib_trial *trial, size_t i,
                     struct brc_param_list list, char *buffer, size_t size);

#endif
