/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of a sweep: what it asks for, without a look at any case. docs/sweep.md has the form.
 *
 *     breccia: 1
 *     case: ../demo_tension.yaml
 *     set: {specimen: {diameter: 18 mm}}
 *     axes:
 *       model: [polyhedra, vgcm]
 *       specimen.seed: 1..3
 *       vgcm.e_bar: [0.5x, 1x, 2x]
 *       rock:
 *         soft: {vgcm.eta: 0.125, polyhedra.kt_ratio: 0.6}
 *         hard: {vgcm.eta: 0.25, polyhedra.kt_ratio: 0.9}
 *
 * Every axis is read to values that each are a list of assignments, so that all that follows knows
 * one form. */
#ifndef BRC_SWEEP_FILE_H
#define BRC_SWEEP_FILE_H

#include "common/base/pool.h"

/* key = text as --set takes them: `model` and `case`, or section.key. Line 0: of the command line.
 */
struct brc_sweep_assignment {
    const char *key, *text;
    int line;
};
struct brc_sweep_assignments {
    size_t n;
    struct brc_sweep_assignment *item;
};
struct brc_sweep_value {
    const char *label; /* in tables: the value as written, or the name of a set of values */
    struct brc_sweep_assignments set;
};
struct brc_sweep_axis {
    const char *name;
    int line;
    bool is_over; /* averaged over */
    size_t n;
    struct brc_sweep_value *value;
};
/* Runs that belong together: all combinations of the values of its axes. */
struct brc_sweep_group {
    const char *name;
    int line;
    struct brc_sweep_assignments set; /* of all its runs; later ones hold */
    size_t n_axes;
    struct brc_sweep_axis *axis;
    size_t n_collect; /* 0: all that the tests measure */
    const char **collect;
    int collect_line;
};
struct brc_sweep_plan {
    const char *path, *title, *cache; /* cache "": not given */
    size_t n_groups;
    struct brc_sweep_group *group;
};

/* Memory is the pool's. BRC_ERR_INPUT with file and line for what is not of the form. */
int brc_sweep_file_read(struct brc_context *ctx, struct brc_pool *pool, const char *path,
                        struct brc_sweep_plan *out);

#endif
