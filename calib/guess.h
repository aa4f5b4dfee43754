/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For whoever calibrates: where a search over runs should begin. Closed-form first guess of the
 * contact parameters from measured values: the uniform-strain (Voigt) estimate for stiffnesses,
 * first-break and published anchors for strengths. Derivation, and how far it may be off, in
 * docs/calibration.md. */
#ifndef CALIB_GUESS_H
#define CALIB_GUESS_H

#include "calib/fabric.h"
#include "calib/target.h"

/* Stiffness per unit strain of contacts, averaged over a specimen [Pa]: normal and tangential,
 * where the facet opens and where it closes. Equal on both sides for a linear contact. */
struct calib_stiffness {
    double n_open, n_closed, t_open, t_closed;
};

/* E [Pa] and nu of an isotropic pack in uniaxial compression under the uniform-strain hypothesis;
 * swap open and closed for tension. n E-bar, t eta E-bar gives E = (2+3 eta)/(4+eta) E-bar and
 * nu = (1-eta)/(4+eta). */
int calib_moduli(struct brc_context *ctx, const struct calib_stiffness *s, double *e, double *nu);
/* The inverse: stiffnesses of this E and nu for chosen ratios n_open/n_closed and t_open/t_closed.
 * t_closed/n_closed outside [eta_min, 1]: an error that names the reachable nu, or with is_nearest
 * the stiffnesses at that limit, which keep E. */
struct calib_inverse {
    double n_ratio, t_ratio, eta_min;
    bool is_nearest;
};
int calib_moduli_invert(struct brc_context *ctx, double e, double nu,
                        const struct calib_inverse *how, struct calib_stiffness *out);

#define CALIB_GUESS_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                       \
    FLAG(nearest, "off",                                                                     \
         "a value out of reach gives the nearest set, with its misfit, not an error")        \
    REAL(eta_min, "1", "0.02", "[0.001, 1)", "smallest ratio of shear to normal stiffness")  \
    REAL(energy_ratio, "1", "9.5", "(1, 1000]", "vgcm: fracture energy over elastic energy") \
    REAL(bond_ratio, "1", "1", "[0.001, 1000]",                                              \
         "polyhedra: normal stiffness of bonds over that of collisions")                     \
    REAL(bond_share, "1", "0.5", "(0, 1)",                                                   \
         "polyhedra: bonds' part of the shear stiffness of closed facets")                   \
    REAL(features, "1", "0.5", "(0, 20]", "polyhedra: feature pairs that act, per facet corner")

struct calib_guess_params {
    BRC_PARAM_MEMBERS(CALIB_GUESS_PARAMS)
};
extern const struct brc_param_list calib_guess_param_list;

/* What the guess starts from; 0: not known. */
struct calib_rock {
    double e, nu;              /* Pa, 1; both needed */
    double tension;            /* Pa, direct tensile strength; needed */
    double strength;           /* Pa, unconfined compressive strength */
    double cohesion;           /* Pa */
    double friction_angle;     /* rad */
    bool is_tension_estimated; /* from the Brazilian strength */
};
int calib_rock_from_targets(struct brc_context *ctx, const struct calib_targets *targets,
                            struct calib_rock *rock);

enum { CALIB_MAX_VALUES = 8 };

struct calib_value {
    const char *key, *unit; /* key of the model's parameter list */
    double value;           /* SI */
};

/* Values in the order of the model's way of thought: stiffness, strength, friction. A value that
 * could not be guessed is absent, and the note says why; the rest can still be used. */
struct calib_guess {
    size_t n;
    struct calib_value value[CALIB_MAX_VALUES];
    double e, nu;     /* uniform-strain estimate of the guess */
    double nu_misfit; /* nu - target; not 0 only with `nearest` */
    char note[1024];  /* what was estimated how, a sentence each */
};

/* The guess for each model. Fails where nu is out of reach and `nearest` is off; the message gives
 * the range. */
int calib_guess_vgcm(struct brc_context *ctx, const struct calib_rock *rock,
                     const struct calib_fabric *fabric, const struct calib_guess_params *params,
                     struct calib_guess *out);
int calib_guess_polyhedra(struct brc_context *ctx, const struct calib_rock *rock,
                          const struct calib_fabric *fabric,
                          const struct calib_guess_params *params, struct calib_guess *out);
#endif
