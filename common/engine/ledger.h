/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy ledger. Each term is integrated from its own force: over a step from n to n + 1 a force
 * does the work (F_n + F_n+1)/2 . dx, which with the kinetic energy m v_n-1/2 . v_n+1/2 / 2
 * balances the leapfrog scheme to round-off for linear springs, so that a residual shows a term
 * that is missing or wrong. bond ... local_damping and gravity are sums over the grains
 * (accounts.h), up to date once they are settled; the others always are. */
#ifndef BRC_LEDGER_H
#define BRC_LEDGER_H

#include "common/base/brc.h"

/* name, sign in the balance (+1 taken up by the sample, -1 put into it), meaning */
#define BRC_LEDGER_TERMS(X)                                                   \
    X(kinetic, 1, "kinetic energy now")                                       \
    X(bond, 1, "work stored in bonds")                                        \
    X(contact_normal, 1, "work stored in normal contact springs")             \
    X(contact_shear, 1, "work stored in tangential contact springs")          \
    X(friction, 1, "dissipated by friction")                                  \
    X(damage, 1, "dissipated by damage and broken bonds")                     \
    X(viscous, 1, "dissipated by viscous contact forces")                     \
    X(local_damping, 1, "dissipated by local damping")                        \
    X(mass_scaling, 1, "kinetic energy removed when scaled masses change")    \
    X(rate_change, 1, "kinetic energy removed when the loading rate changes") \
    X(boundary, -1, "work of the platens")                                    \
    X(gravity, -1, "work of gravity")

struct brc_ledger {
#define BRC_LEDGER_MEMBER(name, sign, meaning) double name;
    BRC_LEDGER_TERMS(BRC_LEDGER_MEMBER)
#undef BRC_LEDGER_MEMBER
    double start; /* kinetic and stored energy at the start */
};

/* Sum of all terms with their signs, less the start; 0 when nothing is lost [J]. */
double brc_ledger_imbalance(const struct brc_ledger *l);
/* How far a run's energy can be trusted, by the larger one of residual and drift. */
enum brc_energy_check { BRC_ENERGY_OFF, BRC_ENERGY_GOOD, BRC_ENERGY_DOUBTFUL, BRC_ENERGY_WRONG };
#define BRC_ENERGY_CHECKS                  \
    {                                      \
        "off", "good", "doubtful", "wrong" \
    }
/* Parts of the work from which a run is doubtful, and from which it is wrong: docs/numerics.md
 * says where sound runs lie. */
#define BRC_ENERGY_DOUBT 0.03
#define BRC_ENERGY_ERROR 0.2

/* |imbalance| / (|boundary work| + |work of gravity| + energy at the start); 1 when those are 0 and
 * the imbalance is not. */
double brc_ledger_residual(const struct brc_ledger *l);
/* |stored terms - energy stored by the state alone| over the same: the error of the time step, to
 * which the imbalance is blind, because a force's work over a step is taken by the trapezoid rule
 * that the integrator itself follows. */
double brc_ledger_drift(const struct brc_ledger *l, const double stored[3]);
/* The same judged; energies below `noise` [J] are rounding. Values that are no numbers are wrong.
 */
enum brc_energy_check brc_ledger_check(const struct brc_ledger *l, const double stored[3],
                                       double noise);

#endif
