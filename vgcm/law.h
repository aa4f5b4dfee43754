/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of one local point: linear elastic, then damage in tension and shear under one scalar
 * damage, then compression and Coulomb friction. Opening and tension are positive here. The shear
 * force is the one on b, so it points against the slip.
 *
 * A point's damage is D = min(1, dn + ds); both strengths are the peak values times
 * vgcm_law_strength(D). Tension unloads along the secant, shear elastically. */
#ifndef VGCM_LAW_H
#define VGCM_LAW_H

#include "common/brc.h"

#include <math.h>

/* for functions that are called with literal flags: the loops shed what the flags turn off */
#define VGCM_INLINE static inline __attribute__((always_inline))

/* literal flags of the specialised loops */
enum vgcm_flags { VGCM_BRITTLE = 1, VGCM_LEDGER = 2, VGCM_VISCOUS = 4, VGCM_N_LOOPS = 8 };

/* What all contacts of a case share. */
struct vgcm_law {
    double e_bar, eta, mu;
    double sigma_t, tau;   /* Pa, peak strengths */
    double g_fn, g_fs;     /* J/m2, fracture energies */
    int is_brittle;        /* no softening branch; g_fn and g_fs are not used */
    int is_post_peak;      /* g_fn and g_fs count from the peak on, not from zero */
    double kink, slope[2]; /* damage at the kink; fall of the strength per damage, either side */
    double wc;             /* end of softening past the peak, in (post-peak energy)/strength */
    double viscous;        /* 1/s */
};

/* What the points of one contact share; stiffness per unit area. */
struct vgcm_bond {
    const struct vgcm_law *law;
    double kn, ks; /* Pa/m */
    double u0;     /* m, opening at the tensile strength */
    double wn, ws; /* m, displacement past the peak at which damage is 1 */
};

struct vgcm_point {
    double un;     /* m, opening */
    double fn;     /* N, normal force, tension positive */
    double fs, ft; /* N, shear force on b in the contact frame */
    double dn, ds; /* damage by opening and by slip */
    double lost;   /* J, dissipated until the damage was 1 */
};

/* Energy of a step: changes of what is stored, and what was dissipated [J]. */
struct vgcm_energy {
    double bond, normal, shear, damage, friction;
};

/* beta: strength left at the kink (fraction of the peak); w1: its place past the peak in units of
 * (post-peak energy)/strength. The end follows from the area under the curve. */
static inline void vgcm_law_softening(struct vgcm_law *law, double beta, double w1)
{
    law->wc = (2 - w1) / beta;
    law->kink = w1 / law->wc;
    law->slope[0] = (1 - beta) / law->kink;
    law->slope[1] = beta / (1 - law->kink);
}

/* Strength at a damage over the peak strength: 1 at 0, beta at the kink, 0 at 1. */
static inline double vgcm_law_strength(const struct vgcm_law *law, double damage)
{
    return damage < law->kink ? 1 - law->slope[0] * damage : law->slope[1] * (1 - damage);
}

/* Elastic energies at the peak strengths per unit area [J/m2]. */
static inline double vgcm_law_elastic_n(const struct vgcm_law *law, double kn)
{
    return law->sigma_t * law->sigma_t / (2 * kn);
}

static inline double vgcm_law_elastic_s(const struct vgcm_law *law, double kn)
{
    return law->eta > 0 ? law->tau * law->tau / (2 * law->eta * kn) : 0;
}

static inline struct vgcm_bond vgcm_bond_of(const struct vgcm_law *law, double kn)
{
    double elastic_n = law->is_post_peak ? 0 : vgcm_law_elastic_n(law, kn);
    double elastic_s = law->is_post_peak ? 0 : vgcm_law_elastic_s(law, kn);
    return (struct vgcm_bond){.law = law,
                              .kn = kn,
                              .ks = law->eta * kn, /* eq:vgcm:29 */
                              .u0 = law->sigma_t / kn,
                              .wn = law->wc * (law->g_fn - elastic_n) / law->sigma_t,
                              .ws = law->wc * (law->g_fs - elastic_s) / law->tau};
}

static inline double vgcm_law_damage(const struct vgcm_point *p)
{
    double d = p->dn + p->ds;
    return d < 1 ? d : 1;
}

/* Normal force over area [Pa] at the damage d: compression is never weakened; tension follows the
 * secant to the strength at the largest opening u0 + dn wn. */
VGCM_INLINE double vgcm_law_normal(const struct vgcm_bond *bond, int flags,
                                   const struct vgcm_point *p, double d)
{
    if (p->un <= 0)
        return bond->kn * p->un;
    if (d >= 1)
        return 0;
    if (flags & VGCM_BRITTLE)
        return bond->kn * p->un;
    double reach = bond->u0 / (bond->u0 + p->dn * bond->wn);
    return bond->kn * p->un * reach * vgcm_law_strength(bond->law, d); /* eq:vgcm:32 */
}

/* Shear strength [N] under the normal force fn at the damage d. */
VGCM_INLINE double vgcm_law_limit(const struct vgcm_bond *bond, int flags, double area, double fn,
                                  double d)
{
    double left = flags & VGCM_BRITTLE ? d < 1 : vgcm_law_strength(bond->law, d);
    double limit = bond->law->tau * left * area - bond->law->mu * fn; /* eq:vgcm:33 */
    return limit > 0 ? limit : 0;
}

/* Opening by dun: eqs 14, 15, 17 with the secant; damage grows past the largest opening so far. */
VGCM_INLINE void vgcm_law_open(const struct vgcm_bond *bond, int flags, double area, double dun,
                               struct vgcm_point *p)
{
    double d = vgcm_law_damage(p);
    p->un += dun; /* eq:vgcm:14 */
    if (d < 1 && p->un > bond->u0) {
        double dn = flags & VGCM_BRITTLE ? 1 : (p->un - bond->u0) / bond->wn;
        p->dn = dn > p->dn ? dn : p->dn;
        d = vgcm_law_damage(p);
    }
    p->fn = area * vgcm_law_normal(bond, flags, p, d); /* eq:vgcm:17 */
}

/* Shear: trial force, then back to the strength, which falls with the slip. In terms of the
 * displacement past the peak the damage grows by excess/(ks ws) on both branches, because
 * ks (slip) = ks ws dD + tau (fall of the strength). Returns 1 when the force was cut. */
VGCM_INLINE int vgcm_law_slide(const struct vgcm_bond *bond, int flags, double area,
                               const double du[3], struct vgcm_point *p)
{
    double k = bond->ks * area;
    p->fs -= k * du[1]; /* eq:vgcm:16, eq:vgcm:18 */
    p->ft -= k * du[2];
    double d = vgcm_law_damage(p);
    double limit = vgcm_law_limit(bond, flags, area, p->fn, d);
    double force2 = p->fs * p->fs + p->ft * p->ft;
    if (force2 <= limit * limit)
        return 0;
    double force = sqrt(force2);
    if (d < 1) {
        p->ds = flags & VGCM_BRITTLE ? 1 : p->ds + (force - limit) / (k * bond->ws);
        d = vgcm_law_damage(p);
        limit = vgcm_law_limit(bond, flags, area, p->fn, d);
        p->fn = area * vgcm_law_normal(bond, flags, p, d);
    }
    p->fs *= limit / force;
    p->ft *= limit / force;
    return 1;
}

/* Energies of a step from the state before (old) and the trial shear force's cut; trapezoid rule
 * for each force, see common/ledger.h. */
VGCM_INLINE void vgcm_law_account(const struct vgcm_bond *bond, double area, const double du[3],
                                  const struct vgcm_point *old, struct vgcm_point *p,
                                  struct vgcm_energy *e)
{
    double k = bond->ks * area, inv = k > 0 ? 1 / k : 0;
    double d_old = vgcm_law_damage(old), d = vgcm_law_damage(p);
    double stored = p->fn * p->un / 2, stored_old = old->fn * old->un / 2;
    double shear = (p->fs * p->fs + p->ft * p->ft) * inv / 2;
    double shear_old = (old->fs * old->fs + old->ft * old->ft) * inv / 2;
    double work = (old->fn + p->fn) / 2 * du[0];
    double loss = d > d_old ? work - (stored - stored_old) : 0;
    double slip[2] = {(old->fs - k * du[1] - p->fs) * inv, (old->ft - k * du[2] - p->ft) * inv};
    double slid = ((old->fs + p->fs) * slip[0] + (old->ft + p->ft) * slip[1]) / 2;
    double rubbed = slid;
    if (d_old < 1) {
        double push = p->fn < 0 ? -p->fn : 0;
        rubbed = bond->law->mu * push * sqrt(slip[0] * slip[0] + slip[1] * slip[1]);
        rubbed = rubbed < slid ? rubbed : slid > 0 ? slid : 0;
        p->lost += loss + slid;
    }
    e->damage += loss + slid - rubbed;
    e->friction += rubbed;
    if (d < 1) {
        e->bond += work - loss + shear - shear_old;
    } else if (d_old < 1) {
        e->bond -= stored_old + shear_old;
        e->normal += stored;
        e->shear += shear;
    } else {
        e->normal += work;
        e->shear += shear - shear_old;
    }
}

/* One step of one point: du = opening and slip along s and t in this step. p holds the state before
 * on entry except fn, which is formed here, and the state after on return. */
VGCM_INLINE void vgcm_law_step(const struct vgcm_bond *bond, int flags, double area,
                               const double du[3], struct vgcm_point *p, struct vgcm_energy *e)
{
    struct vgcm_point old = *p;
    double d_old = vgcm_law_damage(p);
    vgcm_law_open(bond, flags, area, du[0], p);
    int slid = vgcm_law_slide(bond, flags, area, du, p);
    if ((flags & VGCM_LEDGER) || (d_old < 1 && (slid || p->dn > old.dn))) {
        old.fn = area * vgcm_law_normal(bond, flags, &old, d_old);
        vgcm_law_account(bond, area, du, &old, p, e);
    }
}

#endif
