/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moduli of an isotropic pack whose contacts follow a uniform strain, bimodular contacts included.
 *
 * A facet whose normal makes the angle acos(u) with the load sees, for a unit axial shortening and
 * the lateral lengthening nu, the opening nu - (1+nu) u^2 and the slip (1+nu) u sqrt(1-u^2); it
 * opens below u0 = sqrt(nu/(1+nu)). Normals are uniform in u, so each integral is a polynomial.
 *
 * Forward (stiffnesses to moduli) nu is the root of a monotone function, found by bisection: 200
 * halvings end at the last digit wherever the root is, and a guess is made once. Backward all is
 * linear, so that nothing is iterated. Slip of friction springs is left out (small strain). */
#include "calib/guess.h"

#include <math.h>

/* From 0 to u: opening times (1-u^2), opening times u^2, and u^2 (1-u^2). */
static double lateral_integral(double nu, double u)
{
    return nu * u - (1 + 2 * nu) * pow(u, 3) / 3 + (1 + nu) * pow(u, 5) / 5;
}

static double axial_integral(double nu, double u)
{
    return nu * pow(u, 3) / 3 - (1 + nu) * pow(u, 5) / 5;
}

static double slip_integral(double u)
{
    return pow(u, 3) / 3 - pow(u, 5) / 5;
}

/* u0: facets whose normals are nearer to the load close. Without lateral lengthening all do. */
static double opening_limit(double nu)
{
    return nu > 0 ? sqrt(nu / (1 + nu)) : 0;
}

/* An integral from 0 to 1 whose integrand has one stiffness below u0, where facets open, and
 * another above it, where they close. */
static double both_parts(double open, double closed, double below_u0, double whole)
{
    return open * below_u0 + closed * (whole - below_u0);
}

static double slip_sum(const struct calib_stiffness *s, double u0)
{
    return both_parts(s->t_open, s->t_closed, slip_integral(u0), slip_integral(1));
}

/* Lateral stress of a unit shortening with this nu; rises with nu, 0 in the uniaxial test. */
static double lateral_stress(const struct calib_stiffness *s, double nu)
{
    double u0 = opening_limit(nu);
    return both_parts(s->n_open, s->n_closed, lateral_integral(nu, u0), lateral_integral(nu, 1)) +
           (1 + nu) * slip_sum(s, u0);
}

static double axial_modulus(const struct calib_stiffness *s, double nu)
{
    double u0 = opening_limit(nu);
    return 3 * ((1 + nu) * slip_sum(s, u0) -
                both_parts(s->n_open, s->n_closed, axial_integral(nu, u0), axial_integral(nu, 1)));
}

int calib_moduli(struct brc_context *ctx, const struct calib_stiffness *s, double *e, double *nu)
{
    double low = -1, high = 100;
    bool is_positive = s->n_open > 0 && s->n_closed > 0 && s->t_open >= 0 && s->t_closed >= 0;
    if (!is_positive || !(lateral_stress(s, low) < 0) || !(lateral_stress(s, high) > 0))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "first guess: stiffnesses %g, %g (normal) and %g, %g Pa (shear) give no uniaxial "
                 "test; normal ones must be above 0, shear ones at least 0",
                 s->n_open, s->n_closed, s->t_open, s->t_closed);
    for (int i = 0; i < 200; i++) {
        double middle = 0.5 * (low + high);
        if (lateral_stress(s, middle) > 0)
            high = middle;
        else
            low = middle;
    }
    *nu = 0.5 * (low + high);
    *e = axial_modulus(s, *nu);
    return 0;
}

/* t_closed that goes with n_closed = 1: for a given nu the lateral balance is linear in it, so that
 * two evaluations give the root. */
static double shear_of(const struct calib_inverse *how, double nu)
{
    struct calib_stiffness normal = {how->n_ratio, 1, 0, 0}, shear = {0, 0, how->t_ratio, 1};
    return -lateral_stress(&normal, nu) / lateral_stress(&shear, nu);
}

/* Range of nu, the smaller first, that shear ratios from 1 down to eta_min reach. */
static int reachable(struct brc_context *ctx, const struct calib_inverse *how, double range[2])
{
    for (int i = 0; i < 2; i++) {
        double eta = i ? how->eta_min : 1, e;
        struct calib_stiffness limit = {how->n_ratio, 1, how->t_ratio * eta, eta};
        BRC_TRY(calib_moduli(ctx, &limit, &e, &range[i]));
    }
    return 0;
}

/* E only scales all stiffnesses, so that the ratio of shear to normal follows from nu alone, and
 * the scale from E at the end. */
int calib_moduli_invert(struct brc_context *ctx, double e, double nu,
                        const struct calib_inverse *how, struct calib_stiffness *out)
{
    double range[2];
    BRC_TRY(reachable(ctx, how, range));
    bool is_inside = nu >= range[0] && nu <= range[1];
    if (!is_inside && !how->is_nearest)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "first guess: Poisson's ratio %g is out of reach of a uniform strain; allowed "
                 "[%.4f, %.4f] for shear over normal stiffness from 1 to %g; `nearest` takes the "
                 "nearest and states the misfit",
                 nu, range[0], range[1], how->eta_min);
    double eta = is_inside ? shear_of(how, nu) : nu < range[0] ? 1 : how->eta_min;
    double reached = is_inside ? nu : nu < range[0] ? range[0] : range[1];
    struct calib_stiffness unit = {how->n_ratio, 1, how->t_ratio * eta, eta};
    double scale = e / axial_modulus(&unit, reached);
    *out = (struct calib_stiffness){scale * unit.n_open, scale * unit.n_closed, scale * unit.t_open,
                                    scale * unit.t_closed};
    return 0;
}
