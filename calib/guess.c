/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed formulas and constants of published sets: a guess costs no run and saves a calibration
 * many. What was estimated, and how, goes into a note beside the values: a uniform strain is the
 * stiffest possible motion, so that a guess is off by a known sense and an unknown amount (the
 * published vgcm set gives 28.1 GPa by these formulas and 25.8 GPa when it is run). */
#include "calib/guess.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define BRC_OWNER struct calib_guess_params
static const struct brc_param guess_params[] = {BRC_PARAM_LIST(CALIB_GUESS_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list calib_guess_param_list =
    BRC_PARAMS(guess_params, struct calib_guess_params);

/* Direct over Brazilian tensile strength of rock (Nicksiar & Martin 2013). */
static const double direct_over_brazilian = 0.77;
/* From the two calibrated sets of the VGCM-3D paper (Tables 1 and 2), means of brittle and
 * softening: friction angle above that of the contacts (40.3 and 43.7 deg), c/tau (0.254, 0.280),
 * and q_u/tau (1.176, 1.407). */
static const double interlock_angle = 42.0 * BRC_PI / 180;
static const double cohesion_over_tau = 0.267;
static const double strength_over_tau = 1.29;

/* What does not fit is cut: a note is for people, and the values say the same. */
static void __attribute__((format(printf, 2, 3)))
add_note(struct calib_guess *g, const char *format, ...)
{
    size_t used = strlen(g->note);
    va_list args;
    va_start(args, format);
    vsnprintf(g->note + used, sizeof g->note - used, format, args);
    va_end(args);
}

/* The keys are those of the model's list; that each is there, with this unit, is what a test
 * checks. */
static void add(struct calib_guess *g, const char *key, const char *unit, double value)
{
    g->value[g->n++] = (struct calib_value){key, unit, value};
}

/* Only what cannot be guessed is asked for: both moduli and one tensile strength. 0 stands for a
 * strength or an angle that is not known; what follows from it is then left out, and the note says
 * so. */
int calib_rock_from_targets(struct brc_context *ctx, const struct calib_targets *targets,
                            struct calib_rock *rock)
{
    const struct calib_target *t[CALIB_N_QUANTITIES];
    double value[CALIB_N_QUANTITIES];
    for (int i = 0; i < CALIB_N_QUANTITIES; i++) {
        t[i] = calib_targets_find(targets, (enum calib_quantity_code)i);
        value[i] = t[i] ? t[i]->value : 0;
    }
    if (!t[CALIB_YOUNGS_MODULUS] || !t[CALIB_POISSON_RATIO])
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "first guess: %s has no %s; the guess needs youngs_modulus and poisson_ratio",
                 targets->title, t[CALIB_YOUNGS_MODULUS] ? "poisson_ratio" : "youngs_modulus");
    rock->is_tension_estimated = !t[CALIB_TENSILE_STRENGTH];
    rock->tension = rock->is_tension_estimated
                        ? direct_over_brazilian * value[CALIB_BRAZILIAN_STRENGTH]
                        : value[CALIB_TENSILE_STRENGTH];
    if (!(rock->tension > 0))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "first guess: %s has neither tensile_strength nor brazilian_strength; the guess "
                 "needs one of them",
                 targets->title);
    rock->e = value[CALIB_YOUNGS_MODULUS];
    rock->nu = value[CALIB_POISSON_RATIO];
    rock->strength = value[CALIB_STRENGTH];
    rock->cohesion = value[CALIB_COHESION];
    rock->friction_angle = value[CALIB_FRICTION_ANGLE];
    return 0;
}

/* ---- parts that both models share ---------------------------------------------------------- */

/* What both models begin with: stiffnesses per unit strain, the moduli that they make, and how far
 * nu is off where it was out of reach. */
static int guess_elastic(struct brc_context *ctx, const struct calib_rock *rock,
                         const struct calib_inverse *how, struct calib_stiffness *s,
                         struct calib_guess *out)
{
    memset(out, 0, sizeof *out);
    BRC_TRY(calib_moduli_invert(ctx, rock->e, rock->nu, how, s));
    BRC_TRY(calib_moduli(ctx, s, &out->e, &out->nu));
    out->nu_misfit = out->nu - rock->nu;
    add_note(out, "Stiffnesses from E = %.4g GPa and nu = %.4g by a uniform strain.", rock->e / 1e9,
             rock->nu);
    if (fabs(out->nu_misfit) > 1e-9)
        add_note(out, " That nu is out of reach; the nearest is %.4g, off by %.4g.", out->nu,
                 out->nu_misfit);
    if (rock->is_tension_estimated)
        add_note(out, " Direct tension %.4g MPa taken as %.2f of the Brazilian strength.",
                 rock->tension / 1e6, direct_over_brazilian);
    return 0;
}

/* Contacts need only the friction that interlocked facets leave open. The interlock was seen in
 * published vgcm sets; it is taken over for polyhedra, whose facets are of the same kind. */
static int guess_friction(struct brc_context *ctx, const struct calib_rock *rock,
                          const struct calib_guess_params *params, struct calib_guess *out)
{
    double angle = rock->friction_angle - interlock_angle;
    if (rock->friction_angle == 0) {
        add_note(out, " Friction of contacts not guessed: no friction_angle.");
        return 0;
    }
    if (angle < 0 && !params->nearest)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "first guess: friction_angle %.4g deg is below the %.4g deg that interlocked "
                 "facets give without friction; `nearest` takes friction 0 and states the misfit",
                 rock->friction_angle * 180 / BRC_PI, interlock_angle * 180 / BRC_PI);
    if (angle < 0) {
        add_note(out, " Friction angle is out of reach; friction 0, off by %.4g deg.",
                 -angle * 180 / BRC_PI);
        angle = 0;
    } else {
        add_note(out, " Friction: interlocking gives %.3g deg of the friction angle.",
                 interlock_angle * 180 / BRC_PI);
    }
    add(out, "mu", "1", tan(angle));
    return 0;
}

/* ---- vgcm ---------------------------------------------------------------------------------- */

/* Cohesion of points, 0 when the rock has no value to start from. Cohesion before strength: the
 * published sets agree on its ratio within 5 % of their mean, on that of the strength within 9 %.
 */
static double guess_tau(const struct calib_rock *rock, struct calib_guess *out)
{
    if (rock->cohesion > 0) {
        add_note(out, " tau = cohesion / %.3g (published sets).", cohesion_over_tau);
        return rock->cohesion / cohesion_over_tau;
    }
    if (rock->strength > 0) {
        add_note(out, " tau = unconfined strength / %.3g (published sets).", strength_over_tau);
        return rock->strength / strength_over_tau;
    }
    add_note(out, " tau not guessed: neither cohesion nor strength.");
    return 0;
}

/* The contact is linear, equal on both sides: E-bar by the coverage of the contacts, eta by nu. */
int calib_guess_vgcm(struct brc_context *ctx, const struct calib_rock *rock,
                     const struct calib_fabric *fabric, const struct calib_guess_params *params,
                     struct calib_guess *out)
{
    struct calib_inverse how = {1, 1, params->eta_min, params->nearest};
    struct calib_stiffness s;
    BRC_TRY(guess_elastic(ctx, rock, &how, &s, out));
    double e_bar = s.n_closed / fabric->coverage, eta = s.t_closed / s.n_closed;
    /* the point whose normal is the load's breaks first, at E-bar times the strain */
    double sigma_t = rock->tension * e_bar / out->e;
    double tau = guess_tau(rock, out);
    /* elastic energy per area at the strength: sigma^2 d / (2 E-bar), and tau^2 d / (2 eta E-bar)
     */
    double energy_scale = params->energy_ratio * fabric->mean_distance / (2 * e_bar);
    add(out, "e_bar", "Pa", e_bar);
    add(out, "eta", "1", eta);
    add(out, "sigma_t", "Pa", sigma_t);
    add(out, "g_fn", "J/m2", energy_scale * sigma_t * sigma_t);
    if (tau > 0) {
        add(out, "tau", "Pa", tau);
        add(out, "g_fs", "J/m2", energy_scale * tau * tau / eta);
    }
    add_note(out, " Fracture energies are %.3g times the elastic ones.", params->energy_ratio);
    return guess_friction(ctx, rock, params, out);
}

/* ---- polyhedra ----------------------------------------------------------------------------- */

/* Largest |opening| + |slip| over all facets, for a unit axial lengthening: at 22.5 deg. The sum is
 * what eq 15 of gt12 compares with eps_th. */
static double largest_bond_strain(double nu)
{
    return 0.5 * (1 - nu) + (1 + nu) / sqrt(2);
}

/* The contact is bimodular: an open facet has its bond alone. So there are two more unknowns than
 * targets, and bond_ratio and bond_share choose them. */
int calib_guess_polyhedra(struct brc_context *ctx, const struct calib_rock *rock,
                          const struct calib_fabric *fabric,
                          const struct calib_guess_params *params, struct calib_guess *out)
{
    struct calib_inverse how = {params->bond_ratio, params->bond_share, params->eta_min,
                                params->nearest};
    struct calib_stiffness s;
    double e_tension, nu_tension, corners = params->features * fabric->corners;
    BRC_TRY(guess_elastic(ctx, rock, &how, &s, out));
    struct calib_stiffness swapped = {s.n_closed, s.n_open, s.t_closed, s.t_open};
    BRC_TRY(calib_moduli(ctx, &swapped, &e_tension, &nu_tension));
    /* an open facet has its bond alone; a closed one its corners, and the bond in shear */
    add(out, "kn", "N/m", s.n_closed / corners);
    add(out, "kt", "N/m", (s.t_closed - s.t_open) / corners);
    add(out, "bn", "Pa", s.n_open / fabric->bond);
    add(out, "bt", "Pa", s.t_open / fabric->bond);
    add(out, "eps_th", "1",
        fabric->stretch * largest_bond_strain(nu_tension) * rock->tension / e_tension);
    add_note(out, " Modulus in tension %.4g GPa. eps_th: first bond to break in direct tension.",
             e_tension / 1e9);
    return guess_friction(ctx, rock, params, out);
}
