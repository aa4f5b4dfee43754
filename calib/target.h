/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Targets of a calibration: measured values of one rock, read from a file with one section per
 * quantity, `youngs_modulus: {value: 25.8 GPa, deviation: 1 GPa, source: ...}`. */
#ifndef CALIB_TARGET_H
#define CALIB_TARGET_H

#include "common/input/params.h"

/* Code, section in the file, SI unit, range, test that measures it (NULL: none), result in the
 * summary of that test, meaning. */
#define CALIB_QUANTITIES(X)                                                                        \
    X(CALIB_YOUNGS_MODULUS, "youngs_modulus", "Pa", "(0, inf)", "compression", "E",                \
      "Young's modulus in unconfined compression")                                                 \
    X(CALIB_POISSON_RATIO, "poisson_ratio", "1", "(-1, 0.5)", "compression", "nu",                 \
      "Poisson's ratio in unconfined compression")                                                 \
    X(CALIB_STRENGTH, "strength", "Pa", "(0, inf)", "compression", "strength",                     \
      "unconfined compressive strength")                                                           \
    X(CALIB_TENSILE_STRENGTH, "tensile_strength", "Pa", "(0, inf)", "tension", "strength",         \
      "direct tensile strength")                                                                   \
    X(CALIB_BRAZILIAN_STRENGTH, "brazilian_strength", "Pa", "(0, inf)", "brazilian", "strength",   \
      "Brazilian (indirect tensile) strength")                                                     \
    X(CALIB_COHESION, "cohesion", "Pa", "(0, inf)", NULL, "", "cohesion of the Mohr-Coulomb line") \
    X(CALIB_FRICTION_ANGLE, "friction_angle", "rad", "[0, 1.5707963267948966)", NULL, "",          \
      "angle of the Mohr-Coulomb line")                                                            \
    X(CALIB_DENSITY, "density", "kg/m3", "(0, inf)", NULL, "", "bulk density")

enum calib_quantity_code {
#define CALIB_QUANTITY_ENUM(code, name, unit, range, test, result, meaning) code,
    CALIB_QUANTITIES(CALIB_QUANTITY_ENUM)
#undef CALIB_QUANTITY_ENUM
        CALIB_N_QUANTITIES
};

struct calib_quantity {
    const char *name, *unit, *range;
    const char *test; /* NULL: no test measures it */
    const char *result, *meaning;
};
extern const struct calib_quantity calib_quantities[CALIB_N_QUANTITIES];

/* A value without a deviation is common in the literature; 0 says so, and the objective decides
 * what to take. */
struct calib_target {
    enum calib_quantity_code quantity;
    double value;     /* SI */
    double deviation; /* SI, standard deviation; 0: not known */
    char source[BRC_TEXT_SIZE];
};

/* At most one target a quantity, in the order of the list above. */
struct calib_targets {
    char title[BRC_TEXT_SIZE];
    size_t n;
    struct calib_target target[CALIB_N_QUANTITIES];
};

int calib_targets_read(struct brc_context *ctx, const char *path, struct calib_targets *out);
/* NULL when the rock has no value of this quantity: zero is a value (a friction angle may be 0). */
const struct calib_target *calib_targets_find(const struct calib_targets *t,
                                              enum calib_quantity_code quantity);

#endif
