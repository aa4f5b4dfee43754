/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of one local point: linear elastic, then damage in tension and shear under one scalar
 * damage, then compression and Coulomb friction. Opening and tension are positive here. The shear
 * force is the one on b, so it points against the slip.
 *
 * A point's damage is D = min(1, dn + ds); both strengths are the peak values times
 * vgcm_law_strength(D). Tension unloads along the secant, shear elastically. */
#ifndef VGCM_LAW_H
#define VGCM_LAW_H

#include "common/lanes.h"

/* for functions that are called with literal flags: the loops shed what the flags turn off */
#define VGCM_INLINE BRC_LANES_INLINE

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

/* The same for four bonds, points and sums side by side: the law is written for these. */
struct vgcm_bond_lanes {
    brc_lanes kn, ks, u0, wn, ws;
};

struct vgcm_point_lanes {
    brc_lanes un, fn, fs, ft, dn, ds, lost;
};

struct vgcm_energy_lanes {
    brc_lanes bond, normal, shear, damage, friction;
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
VGCM_INLINE brc_lanes vgcm_lanes_strength(const struct vgcm_law *law, brc_lanes damage)
{
    return brc_lanes_pick(brc_lanes_less(damage, brc_lanes_all(law->kink)),
                          1 - law->slope[0] * damage, law->slope[1] * (1 - damage));
}

static inline double vgcm_law_strength(const struct vgcm_law *law, double damage)
{
    return vgcm_lanes_strength(law, brc_lanes_all(damage))[0];
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

VGCM_INLINE void vgcm_lanes_bond(struct vgcm_bond_lanes *bond, const struct vgcm_law *law,
                                 brc_lanes kn)
{
    double per_kn[2] = {law->is_post_peak ? 0 : vgcm_law_elastic_n(law, 1),
                        law->is_post_peak ? 0 : vgcm_law_elastic_s(law, 1)};
    brc_lanes inv = 1 / kn;
    bond->kn = kn;
    bond->ks = law->eta * kn; /* eq:vgcm:29 */
    bond->u0 = law->sigma_t * inv;
    bond->wn = law->wc / law->sigma_t * (law->g_fn - per_kn[0] * inv);
    bond->ws = law->wc / law->tau * (law->g_fs - per_kn[1] * inv);
}

static inline struct vgcm_bond vgcm_bond_of(const struct vgcm_law *law, double kn)
{
    struct vgcm_bond_lanes all;
    vgcm_lanes_bond(&all, law, brc_lanes_all(kn));
    return (struct vgcm_bond){
        .law = law, .kn = kn, .ks = all.ks[0], .u0 = all.u0[0], .wn = all.wn[0], .ws = all.ws[0]};
}

VGCM_INLINE brc_lanes vgcm_lanes_damage(const struct vgcm_point_lanes *p)
{
    return brc_lanes_min(p->dn + p->ds, brc_lanes_all(1));
}

static inline double vgcm_law_damage(const struct vgcm_point *p)
{
    return fmin(p->dn + p->ds, 1);
}

/* Where points of the damage d are not broken. */
VGCM_INLINE brc_mask vgcm_lanes_whole(brc_lanes d)
{
    return brc_lanes_less(d, brc_lanes_all(1));
}

/* Part of the elastic tension that is left at the damage d: tension follows the secant to the
 * strength at the largest opening u0 + dn wn. */
VGCM_INLINE brc_lanes vgcm_lanes_left(const struct vgcm_law *law,
                                      const struct vgcm_bond_lanes *bond, int flags, brc_lanes dn,
                                      brc_lanes d)
{
    brc_lanes left = brc_lanes_all(1);
    if (!(flags & VGCM_BRITTLE))
        left = bond->u0 / (bond->u0 + dn * bond->wn) * vgcm_lanes_strength(law, d); /* eq:vgcm:32 */
    return brc_lanes_where(vgcm_lanes_whole(d), left);
}

/* Normal force over area [Pa]: compression is never weakened. */
VGCM_INLINE brc_lanes vgcm_lanes_normal(const struct vgcm_bond_lanes *bond, brc_lanes un,
                                        brc_lanes left)
{
    brc_lanes elastic = bond->kn * un;
    return brc_lanes_pick(brc_lanes_less(brc_lanes_all(0), un), elastic * left, elastic);
}

/* Shear strength [N] under the normal force fn at the damage d. */
VGCM_INLINE brc_lanes vgcm_lanes_limit(const struct vgcm_law *law, int flags, brc_lanes area,
                                       brc_lanes fn, brc_lanes d)
{
    brc_lanes left = flags & VGCM_BRITTLE ? brc_lanes_where(vgcm_lanes_whole(d), brc_lanes_all(1))
                                          : vgcm_lanes_strength(law, d);
    brc_lanes limit = law->tau * left * area - law->mu * fn; /* eq:vgcm:33 */
    return brc_lanes_max(limit, brc_lanes_all(0));
}

/* Opening by dun: eqs 14, 15, 17 with the secant; damage grows past the largest opening so far.
 * left: see vgcm_lanes_left, of the state before on entry. Returns where the damage grew. */
VGCM_INLINE brc_mask vgcm_lanes_open(const struct vgcm_law *law, const struct vgcm_bond_lanes *bond,
                                     int flags, brc_lanes area, brc_lanes dun,
                                     struct vgcm_point_lanes *p, brc_lanes *left)
{
    p->un += dun; /* eq:vgcm:14 */
    brc_mask grew =
        vgcm_lanes_whole(vgcm_lanes_damage(p)) & brc_lanes_less(bond->u0 + p->dn * bond->wn, p->un);
    if (brc_lanes_any(grew)) {
        brc_lanes dn = flags & VGCM_BRITTLE ? brc_lanes_all(1) : (p->un - bond->u0) / bond->wn;
        p->dn = brc_lanes_pick(grew, brc_lanes_max(dn, p->dn), p->dn);
        *left = vgcm_lanes_left(law, bond, flags, p->dn, vgcm_lanes_damage(p));
    }
    p->fn = area * vgcm_lanes_normal(bond, p->un, *left); /* eq:vgcm:17 */
    return grew;
}

/* Shear: trial force, then back to the strength, which falls with the slip. In terms of the
 * displacement past the peak the damage grows by excess/(ks ws) on both branches, because
 * ks (slip) = ks ws dD + tau (fall of the strength). Returns where the force was cut. */
VGCM_INLINE brc_mask vgcm_lanes_slide(const struct vgcm_law *law,
                                      const struct vgcm_bond_lanes *bond, int flags, brc_lanes area,
                                      const brc_lanes du[3], struct vgcm_point_lanes *p)
{
    brc_lanes k = bond->ks * area, d = vgcm_lanes_damage(p);
    p->fs -= k * du[1]; /* eq:vgcm:16, eq:vgcm:18 */
    p->ft -= k * du[2];
    brc_lanes limit = vgcm_lanes_limit(law, flags, area, p->fn, d);
    brc_lanes force2 = p->fs * p->fs + p->ft * p->ft;
    brc_mask cut = brc_lanes_less(limit * limit, force2), weakened = cut & vgcm_lanes_whole(d);
    if (!brc_lanes_any(cut))
        return cut;
    brc_lanes force = brc_lanes_sqrt(force2);
    if (brc_lanes_any(weakened)) {
        brc_lanes ds =
            flags & VGCM_BRITTLE ? brc_lanes_all(1) : p->ds + (force - limit) / (k * bond->ws);
        p->ds = brc_lanes_pick(weakened, ds, p->ds);
        d = vgcm_lanes_damage(p);
        limit = vgcm_lanes_limit(law, flags, area, p->fn, d);
        brc_lanes left = vgcm_lanes_left(law, bond, flags, p->dn, d);
        p->fn = area * vgcm_lanes_normal(bond, p->un, left);
    }
    brc_lanes part = brc_lanes_pick(cut, limit / force, brc_lanes_all(1));
    p->fs *= part;
    p->ft *= part;
    return cut;
}

/* Energies of a step from the state before (old) and the trial shear force's cut; trapezoid rule
 * for each force, see common/ledger.h. */
VGCM_INLINE void vgcm_lanes_account(const struct vgcm_law *law, const struct vgcm_bond_lanes *bond,
                                    brc_lanes area, const brc_lanes du[3],
                                    const struct vgcm_point_lanes *old, struct vgcm_point_lanes *p,
                                    struct vgcm_energy_lanes *e)
{
    brc_lanes none = brc_lanes_all(0), k = bond->ks * area;
    brc_lanes inv = brc_lanes_where(brc_lanes_less(none, k), 1 / k);
    brc_lanes d_old = vgcm_lanes_damage(old), d = vgcm_lanes_damage(p);
    brc_mask was = vgcm_lanes_whole(d_old), is = vgcm_lanes_whole(d);
    brc_lanes stored = p->fn * p->un / 2, stored_old = old->fn * old->un / 2;
    brc_lanes shear = (p->fs * p->fs + p->ft * p->ft) * inv / 2;
    brc_lanes shear_old = (old->fs * old->fs + old->ft * old->ft) * inv / 2;
    brc_lanes work = (old->fn + p->fn) / 2 * du[0];
    brc_lanes loss = brc_lanes_where(brc_lanes_less(d_old, d), work - (stored - stored_old));
    brc_lanes slip_s = (old->fs - k * du[1] - p->fs) * inv;
    brc_lanes slip_t = (old->ft - k * du[2] - p->ft) * inv;
    brc_lanes slid = ((old->fs + p->fs) * slip_s + (old->ft + p->ft) * slip_t) / 2;
    brc_lanes push = brc_lanes_max(-p->fn, none);
    brc_lanes rub = law->mu * push * brc_lanes_sqrt(slip_s * slip_s + slip_t * slip_t);
    rub = brc_lanes_pick(brc_lanes_less(rub, slid), rub, brc_lanes_max(slid, none));
    rub = brc_lanes_pick(was, rub, slid);
    p->lost += brc_lanes_where(was, loss + slid);
    e->damage += loss + slid - rub;
    e->friction += rub;
    e->bond += brc_lanes_pick(is, work - loss + shear - shear_old,
                              brc_lanes_where(was, -(stored_old + shear_old)));
    e->normal += brc_lanes_where(~is, brc_lanes_pick(was, stored, work));
    e->shear += brc_lanes_where(~is, shear - brc_lanes_where(~was, shear_old));
}

/* One step of four points: du = opening and slip along s and t in this step. p holds the state
 * before on entry except fn, which is formed here, and the state after on return. Returns where the
 * damage or the energy lost may have changed. */
VGCM_INLINE brc_mask vgcm_lanes_step(const struct vgcm_law *law, const struct vgcm_bond_lanes *bond,
                                     int flags, brc_lanes area, const brc_lanes du[3],
                                     struct vgcm_point_lanes *p, struct vgcm_energy_lanes *e)
{
    struct vgcm_point_lanes old = *p;
    brc_lanes d_old = vgcm_lanes_damage(p);
    brc_lanes left_old = vgcm_lanes_left(law, bond, flags, p->dn, d_old), left = left_old;
    brc_mask changed = vgcm_lanes_open(law, bond, flags, area, du[0], p, &left);
    changed |= vgcm_lanes_slide(law, bond, flags, area, du, p);
    changed &= vgcm_lanes_whole(d_old);
    if ((flags & VGCM_LEDGER) || brc_lanes_any(changed)) {
        old.fn = area * vgcm_lanes_normal(bond, old.un, left_old);
        vgcm_lanes_account(law, bond, area, du, &old, p, e);
    }
    return changed;
}

/* One point alone. */
static inline void vgcm_law_step(const struct vgcm_bond *bond, int flags, double area,
                                 const double du[3], struct vgcm_point *p, struct vgcm_energy *e)
{
    const struct vgcm_bond_lanes all = {brc_lanes_all(bond->kn), brc_lanes_all(bond->ks),
                                        brc_lanes_all(bond->u0), brc_lanes_all(bond->wn),
                                        brc_lanes_all(bond->ws)};
    const brc_lanes move[3] = {brc_lanes_all(du[0]), brc_lanes_all(du[1]), brc_lanes_all(du[2])};
    struct vgcm_point_lanes q = {.un = brc_lanes_all(p->un),
                                 .fs = brc_lanes_all(p->fs),
                                 .ft = brc_lanes_all(p->ft),
                                 .dn = brc_lanes_all(p->dn),
                                 .ds = brc_lanes_all(p->ds),
                                 .lost = brc_lanes_all(p->lost)};
    struct vgcm_energy_lanes sum = {.bond = brc_lanes_all(0)};
    vgcm_lanes_step(bond->law, &all, flags, brc_lanes_all(area), move, &q, &sum);
    *p = (struct vgcm_point){q.un[0], q.fn[0], q.fs[0], q.ft[0], q.dn[0], q.ds[0], q.lost[0]};
    e->bond += sum.bond[0];
    e->normal += sum.normal[0];
    e->shear += sum.shear[0];
    e->damage += sum.damage[0];
    e->friction += sum.friction[0];
}

/* Normal force of one point [N]. */
static inline double vgcm_law_normal(const struct vgcm_bond *bond, int flags, double area,
                                     const struct vgcm_point *p)
{
    const struct vgcm_bond_lanes all = {.kn = brc_lanes_all(bond->kn),
                                        .u0 = brc_lanes_all(bond->u0),
                                        .wn = brc_lanes_all(bond->wn)};
    brc_lanes left = vgcm_lanes_left(bond->law, &all, flags, brc_lanes_all(p->dn),
                                     brc_lanes_all(vgcm_law_damage(p)));
    return area * vgcm_lanes_normal(&all, brc_lanes_all(p->un), left)[0];
}

#endif
