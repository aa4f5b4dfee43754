/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of one local point, written once, for four side by side; what tests and energy.c ask of
 * one point alone goes through the same lines. Called by the loops and by nothing outside the
 * folder; it may not know contacts, bodies or the time step, so that it can be tested by hand
 * values alone.
 *
 * The law: linear elastic, then damage in tension and shear under one scalar
 * damage, then compression and Coulomb friction. Opening and tension are positive here. The shear
 * force is the one on b, so it points against the slip.
 *
 * Damage by opening dn and by slip ds are displacements past the peak over those at the end. What
 * is left of both strengths is the curve at D = min(1, dn + ds), vgcm_lanes_strength(D); or, with
 * `damage: strength`, 1 less the losses of the curve at dn and at ds. Tension unloads along the
 * secant, shear elastically. */
#ifndef VGCM_LAW_H
#define VGCM_LAW_H

#include "common/base/lanes.h"

/* for functions that are called with literal flags: the loops shed what the flags turn off */
#define VGCM_INLINE BRC_LANES_INLINE

/* literal flags of the specialised loops */
enum vgcm_flags {
    VGCM_BRITTLE = 1,
    VGCM_LEDGER = 2,
    VGCM_VISCOUS = 4,
    VGCM_LOSSES = 8, /* losses of strength add, not parts of displacements; not with VGCM_BRITTLE */
    VGCM_N_LOOPS = 16
};

/* What all contacts of a case share. */
struct vgcm_law {
    double e_bar, eta, mu;
    double sigma_t, tau;   /* Pa, peak strengths */
    double g_fn, g_fs;     /* J/m2, fracture energies */
    int is_brittle;        /* no softening branch; g_fn and g_fs are not used */
    int adds_losses;       /* of strength by opening and by slip, not parts of displacements */
    int is_post_peak;      /* g_fn and g_fs count from the peak on, not from zero */
    double kink, slope[2]; /* damage at the kink; fall of the strength per damage, either side */
    double wc;             /* end of softening past the peak, in (post-peak energy)/strength */
    double viscous;        /* 1/s */
};

/* What the points of one contact share; stiffness per unit area. */
struct vgcm_bond {
    const struct vgcm_law *law;
    double kn, ks; /* Pa/m */
    double per_ks; /* m/Pa, 0 without shear stiffness */
};

/* For who asks about one point; the loops keep another form (vgcm.h), in which nothing that follows
 * from the contact is repeated. */
struct vgcm_point {
    double un;         /* m, opening */
    double fn;         /* N, normal force, tension positive */
    double fs, ft;     /* N, shear force on b in the contact frame */
    double dn, ds;     /* damage by opening and by slip */
    double dissipated; /* J, dissipated until the damage was 1 */
};

/* What the law wants to know of a bond, without a division left for its points. Divisions take
 * as long as a dozen multiplications, and a contact has 7 points: so they are made once a
 * contact, and forces are counted per area and stiffness until they are summed up. */
enum vgcm_bond_parts {
    VGCM_U0,      /* m, opening at the tensile strength */
    VGCM_PER_WN,  /* 1/m, damage per opening past it */
    VGCM_WN_U0,   /* wn/u0 */
    VGCM_E0,      /* m, elastic slip at the shear strength */
    VGCM_PER_WS,  /* 1/m, damage per slip past it */
    VGCM_HALF_KN, /* Pa/m, half the stiffnesses: energy per area and square of a displacement */
    VGCM_HALF_KS,
    VGCM_N_BOND
};

/* Points of four contacts side by side: the law is written for these, in three parts that hand on
 * what is listed here. Forces are those per area and stiffness, so that they are displacements,
 * too. */
struct vgcm_point_lanes {
    brc_lanes dn, ds;                         /* damage by opening and by slip */
    brc_lanes slip_s, slip_t;                 /* m, plastic slip */
    brc_lanes un, un_old;                     /* m, opening, before the step */
    brc_lanes damage_old;                     /* dn + ds before the step */
    brc_mask was_intact;                      /* not broken before the step */
    brc_lanes normal_force_old, normal_force; /* m, tension positive */
    brc_lanes secant;                         /* m, tension at the peak strength, by the secant */
    brc_lanes s_old, t_old;                   /* m, shear force on b before the step */
    brc_lanes s, t;                           /* m, trial shear force on b */
    brc_lanes force2, force;                  /* m2, m: its square and size */
    brc_lanes shear_ratio;                    /* what the strength leaves of it */
    bool slides;                              /* some of them do; else force is not set */
    brc_mask loose;                           /* were broken and open before the step */
};

/* The same for points without a bond: opening, normal force, shear force on b. */
struct vgcm_friction_lanes {
    brc_lanes un, normal_force, s, t; /* m */
};

/* Changes of what is stored, and what was dissipated, added up over steps [J]. */
struct vgcm_energy_lanes {
    brc_lanes bond, normal, shear, damage, friction;
};

/* beta: strength left at the kink (fraction of the peak); w1: its place past the peak in units of
 * (post-peak energy)/strength. The end follows from the areas under both branches, which have to
 * sum to the post-peak energy. */
static inline void vgcm_law_softening(struct vgcm_law *law, double beta, double w1)
{
    law->wc = (2 - w1) / beta;
    law->kink = w1 / law->wc;
    law->slope[0] = (1 - beta) / law->kink;
    law->slope[1] = beta / (1 - law->kink);
}

/* Strength at a damage over the peak strength: 1 at 0, beta at the kink, 0 from 1 on. The
 * greater of two lines, or the lesser where the curve bulges out (slope[1] > slope[0]): no
 * branch on which of them holds. */
VGCM_INLINE brc_lanes vgcm_lanes_strength(const struct vgcm_law *law, int flags, brc_lanes damage)
{
    brc_lanes none = brc_lanes_all(0), one = brc_lanes_all(1);
    if (flags & VGCM_BRITTLE)
        return brc_lanes_where(brc_lanes_less(damage, one), one);
    brc_lanes steep = 1 - law->slope[0] * damage, flat = law->slope[1] - law->slope[1] * damage;
    brc_lanes left =
        law->slope[1] <= law->slope[0] ? brc_lanes_max(steep, flat) : brc_lanes_min(steep, flat);
    return brc_lanes_max(left, none);
}

/* What damage by opening and by slip leaves of the peak strengths. Either way each of them alone
 * falls along its curve, so that the return to the curve in vgcm_lanes_slide is exact in both. */
VGCM_INLINE brc_lanes vgcm_lanes_left(const struct vgcm_law *law, int flags, brc_lanes dn,
                                      brc_lanes ds)
{
    if (!(flags & VGCM_LOSSES))
        return vgcm_lanes_strength(law, flags, dn + ds);
    brc_lanes left = vgcm_lanes_strength(law, flags, dn) + vgcm_lanes_strength(law, flags, ds) - 1;
    return brc_lanes_max(left, brc_lanes_all(0));
}

/* Where points are not broken. Where losses of strength add, nothing may be left though the parts
 * of the damage sum to less than 1: so the strength is asked, not the damage. */
VGCM_INLINE brc_mask vgcm_lanes_whole(const struct vgcm_law *law, int flags, brc_lanes dn,
                                      brc_lanes ds)
{
    if (flags & VGCM_LOSSES)
        return brc_lanes_less(brc_lanes_all(0), vgcm_lanes_left(law, flags, dn, ds));
    return brc_lanes_less(dn + ds, brc_lanes_all(1));
}

/* The law's part of them alone: whether the ledger is kept and viscous forces act is a matter of
 * the run (model.c). */
static inline int vgcm_law_flags(const struct vgcm_law *law)
{
    return law->is_brittle ? VGCM_BRITTLE : law->adds_losses ? VGCM_LOSSES : 0;
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

/* Of four bonds at a time. Without shear stiffness the strength is out of reach. */
VGCM_INLINE void vgcm_lanes_bond(brc_lanes bond[VGCM_N_BOND], const struct vgcm_law *law,
                                 brc_lanes kn)
{
    double per_kn[2] = {law->is_post_peak ? 0 : vgcm_law_elastic_n(law, 1),
                        law->is_post_peak ? 0 : vgcm_law_elastic_s(law, 1)};
    brc_lanes inv = 1 / kn, ks = law->eta * kn; /* eq:vgcm:29 */
    brc_lanes wn = law->wc / law->sigma_t * (law->g_fn - per_kn[0] * inv);
    brc_lanes ws = law->wc / law->tau * (law->g_fs - per_kn[1] * inv);
    bond[VGCM_U0] = law->sigma_t * inv;
    bond[VGCM_PER_WN] = 1 / wn;
    bond[VGCM_WN_U0] = wn * (kn * (1 / law->sigma_t));
    bond[VGCM_E0] = law->eta > 0 ? law->tau / law->eta * inv : brc_lanes_all(1e150);
    bond[VGCM_PER_WS] = 1 / ws;
    bond[VGCM_HALF_KN] = 0.5 * kn;
    bond[VGCM_HALF_KS] = 0.5 * ks;
}

/* What one contact alone is asked by; vgcm_lanes_bond has the rest of its bond. */
static inline struct vgcm_bond vgcm_springs_of(const struct vgcm_law *law, double kn)
{
    double ks = law->eta * kn; /* eq:vgcm:29 */
    return (struct vgcm_bond){.law = law, .kn = kn, .ks = ks, .per_ks = ks > 0 ? 1 / ks : 0};
}

static inline bool vgcm_law_is_whole(const struct vgcm_law *law, int flags, double dn, double ds)
{
    return vgcm_lanes_whole(law, flags, brc_lanes_all(dn), brc_lanes_all(ds))[0] != 0;
}

/* Normal force: tension falls with the strength, compression is never weakened. */
VGCM_INLINE brc_lanes vgcm_lanes_normal_force(brc_lanes un, brc_lanes secant, brc_lanes strength)
{
    brc_lanes weak = secant * strength; /* eq:vgcm:32 */
    return brc_lanes_pick(brc_lanes_less(brc_lanes_all(0), un), weak, un);
}

/* Shear strength [m] under a normal force. In displacements, like all forces here, so that friction
 * has mu / eta in place of mu: the normal force is per kn, the limit per ks. Never below 0, since
 * it is compared by its square. */
VGCM_INLINE brc_lanes vgcm_lanes_limit(const struct vgcm_law *law, brc_lanes e0,
                                       brc_lanes normal_force, brc_lanes strength)
{
    double mu = law->eta > 0 ? law->mu / law->eta : 0;
    brc_lanes limit = e0 * strength - mu * normal_force; /* eq:vgcm:33 */
    return brc_lanes_max(limit, brc_lanes_all(0));
}

/* Opening goes first and slip second: each is the exact return to its own curve with the other's
 * damage as it is by then. Solving both at once would need an iteration in each point, for a change
 * of second order in the step. Damage grows with the opening past the largest so far; tension
 * follows the secant to the strength at the largest. One division serves the secants before and
 * now. */
VGCM_INLINE void vgcm_lanes_open(const struct vgcm_law *law, const brc_lanes bond[VGCM_N_BOND],
                                 int flags, struct vgcm_point_lanes *p)
{
    brc_lanes strength = vgcm_lanes_left(law, flags, p->dn, p->ds), old = p->un_old;
    brc_mask whole = vgcm_lanes_whole(law, flags, p->dn, p->ds);
    p->was_intact = whole;
    p->secant = p->un;
    if (flags & VGCM_BRITTLE) {
        brc_mask grew = brc_lanes_less(bond[VGCM_U0], p->un);
        p->dn = brc_lanes_pick(grew & whole, brc_lanes_all(1), p->dn);
    } else {
        brc_lanes dn = (p->un - bond[VGCM_U0]) * bond[VGCM_PER_WN];
        dn = brc_lanes_pick(whole, brc_lanes_max(dn, p->dn), p->dn);
        brc_lanes before = 1 + p->dn * bond[VGCM_WN_U0], after = 1 + dn * bond[VGCM_WN_U0];
        brc_lanes inv = 1 / (before * after);
        old *= inv * after;
        p->secant *= inv * before;
        p->dn = dn;
    }
    p->normal_force_old = vgcm_lanes_normal_force(p->un_old, old, strength);
}

/* Shear: trial force, then back to the strength, which falls with the slip. In terms of the
 * displacement past the peak the damage grows by excess/(ks ws) on both branches, because ks (slip)
 * = ks ws dD + tau (fall of the strength). Forms the normal force, too. Twice through the strength:
 * slip lowers it, and with it the tension that is left, by which the limit changes again. */
VGCM_INLINE void vgcm_lanes_slide(const struct vgcm_law *law, const brc_lanes bond[VGCM_N_BOND],
                                  int flags, struct vgcm_point_lanes *p)
{
    brc_lanes e0 = bond[VGCM_E0], strength = vgcm_lanes_left(law, flags, p->dn, p->ds);
    p->normal_force = vgcm_lanes_normal_force(p->un, p->secant, strength); /* eq:vgcm:17 */
    brc_lanes limit = vgcm_lanes_limit(law, e0, p->normal_force, strength);
    brc_mask cut = brc_lanes_less(limit * limit, p->force2);
    p->shear_ratio = brc_lanes_all(1);
    p->slides = brc_lanes_any(cut);
    if (!p->slides)
        return;
    brc_lanes force = brc_lanes_sqrt(p->force2), inv = 1 / force;
    brc_mask weakened = cut & vgcm_lanes_whole(law, flags, p->dn, p->ds);
    if (flags & VGCM_BRITTLE)
        p->ds = brc_lanes_pick(weakened, brc_lanes_all(1), p->ds);
    else
        p->ds += brc_lanes_where(weakened, (force - limit) * bond[VGCM_PER_WS]);
    strength = vgcm_lanes_left(law, flags, p->dn, p->ds);
    p->normal_force = vgcm_lanes_normal_force(p->un, p->secant, strength); /* eq:vgcm:17 */
    limit = vgcm_lanes_limit(law, e0, p->normal_force, strength);
    p->force = force;
    p->shear_ratio = brc_lanes_pick(cut, limit * inv, p->shear_ratio);
}

/* Energies of a step in which some point is broken: what the others keep in their bonds; contact
 * springs of the broken ones. work, kept: per area, by the normal force and in shear. */
VGCM_INLINE void vgcm_lanes_account_broken(brc_mask was, brc_mask is, brc_lanes area,
                                           brc_lanes kept_bond, const brc_lanes stored[2],
                                           const brc_lanes old[2], brc_lanes work,
                                           struct vgcm_energy_lanes *e)
{
    brc_lanes none = brc_lanes_all(0);
    brc_lanes gone = brc_lanes_where(was, -(old[0] + old[1]));
    e->bond += area * brc_lanes_pick(is, kept_bond, gone);
    e->normal += area * brc_lanes_pick(is, none, brc_lanes_pick(was, stored[0], work));
    e->shear += area * brc_lanes_pick(is, none, stored[1] - brc_lanes_pick(was, none, old[1]));
}

/* A bond that has been weakened gives back less than was put in: excess is what the trapezoid of
 * the forces takes up beyond what is stored. With damage that is dissipated; without it (unloading
 * along the secant, to rounding) it stays stored, so that no round-off is booked as fracture
 * energy. A point that slides while it is whole loses the friction's share to friction, the rest to
 * damage. Energies of a step, by the trapezoid rule for each force, see common/engine/ledger.h.
 * Returns what points that were whole have lost [J]. */
VGCM_INLINE brc_lanes vgcm_lanes_account(const struct vgcm_law *law,
                                         const brc_lanes bond[VGCM_N_BOND], int flags,
                                         brc_lanes area, const struct vgcm_point_lanes *p,
                                         struct vgcm_energy_lanes *e)
{
    brc_lanes none = brc_lanes_all(0), half_kn = bond[VGCM_HALF_KN], half_ks = bond[VGCM_HALF_KS];
    brc_lanes damage = p->dn + p->ds;
    brc_mask was = p->was_intact, is = vgcm_lanes_whole(law, flags, p->dn, p->ds);
    brc_lanes stored = half_kn * (p->normal_force * p->un),
              stored_old = half_kn * (p->normal_force_old * p->un_old);
    brc_lanes excess =
        half_kn * (p->normal_force_old * p->un - p->normal_force * p->un_old); /* work - stored */
    brc_mask weakened = was & brc_lanes_less(p->damage_old, damage);
    brc_lanes loss = brc_lanes_where(weakened, excess), dissipated = area * loss, left2 = p->force2;
    if (p->slides) {
        /* the plastic slip is along the trial force, of which 1 - shear_ratio is cut off */
        brc_lanes off = 1 - p->shear_ratio;
        left2 *= p->shear_ratio;
        brc_lanes slid = half_ks * (off * (p->s_old * p->s + p->t_old * p->t + left2));
        brc_lanes push = brc_lanes_max(-p->normal_force, none);
        brc_lanes friction = (2 * law->mu) * half_kn * (push * (off * p->force));
        friction =
            area * brc_lanes_pick(was, brc_lanes_min(friction, brc_lanes_max(slid, none)), slid);
        left2 *= p->shear_ratio;
        dissipated += area * slid;
        if (flags & VGCM_LEDGER) {
            e->damage -= friction;
            e->friction += friction;
        }
    }
    if (flags & VGCM_LEDGER) {
        brc_lanes shear = half_ks * left2;
        brc_lanes shear_old = half_ks * (p->s_old * p->s_old + p->t_old * p->t_old);
        brc_lanes kept = stored - stored_old + (excess - loss) + (shear - shear_old);
        e->damage += dissipated;
        if (brc_lanes_any(~is)) {
            const brc_lanes all[2] = {stored, shear}, old[2] = {stored_old, shear_old};
            vgcm_lanes_account_broken(was, is, area, kept, all, old, stored - stored_old + excess,
                                      e);
        } else {
            e->bond += area * kept;
        }
    }
    return brc_lanes_where(was, dissipated);
}

/* Points that are broken from the start: they push and slide with friction, and a platen may hold
 * them against opening (pulls), where no friction is left. un: after the step. */
VGCM_INLINE void vgcm_lanes_friction(const struct vgcm_bond *bond, bool pulls, brc_lanes area,
                                     const brc_lanes du[3], struct vgcm_friction_lanes *q,
                                     struct vgcm_energy_lanes *e)
{
    brc_lanes none = brc_lanes_all(0), un_old = q->un - du[0], s_old = q->s, t_old = q->t;
    brc_lanes s = s_old - du[1], t = t_old - du[2]; /* eq:vgcm:16, eq:vgcm:18 */
    brc_lanes force2 = s * s + t * t;
    brc_lanes normal_force_old = pulls ? un_old : brc_lanes_min(un_old, none);
    q->normal_force = pulls ? q->un : brc_lanes_min(q->un, none); /* eq:vgcm:17 */
    brc_lanes limit = vgcm_lanes_limit(bond->law, none, q->normal_force, none);
    brc_mask cut = brc_lanes_less(limit * limit, force2);
    brc_lanes ratio = brc_lanes_pick(cut, limit / brc_lanes_sqrt(force2), brc_lanes_all(1));
    q->s = ratio * s;
    q->t = ratio * t;
    brc_lanes half_kn = 0.5 * bond->kn * area, half_ks = 0.5 * bond->ks * area;
    e->normal += half_kn * ((normal_force_old + q->normal_force) * du[0]);
    e->shear += half_ks * (ratio * ratio * force2 - (s_old * s_old + t_old * t_old));
    e->friction += half_ks * ((1 - ratio) * (s_old * s + t_old * t + ratio * force2));
}

/* One of them alone, in all lanes. */
static inline void vgcm_law_friction(const struct vgcm_bond *bond, double area, const double du[3],
                                     struct vgcm_point *p, struct vgcm_energy_lanes *e)
{
    double kn = bond->kn * area, ks = bond->ks * area, inv = bond->per_ks / area;
    const brc_lanes all[3] = {brc_lanes_all(du[0]), brc_lanes_all(du[1]), brc_lanes_all(du[2])};
    struct vgcm_friction_lanes q = {.un = brc_lanes_all(p->un + du[0]),
                                    .s = brc_lanes_all(inv * p->fs),
                                    .t = brc_lanes_all(inv * p->ft)};
    vgcm_lanes_friction(bond, false, brc_lanes_all(area), all, &q, e);
    p->un = q.un[0];
    p->fn = kn * q.normal_force[0];
    p->fs = ks * q.s[0];
    p->ft = ks * q.t[0];
}

/* Normal force of one point [N]. */
static inline double vgcm_law_normal(const struct vgcm_bond *bond, int flags, double area,
                                     const struct vgcm_point *p)
{
    struct vgcm_point_lanes q = {.dn = brc_lanes_all(p->dn),
                                 .un = brc_lanes_all(p->un),
                                 .ds = brc_lanes_all(p->ds),
                                 .un_old = brc_lanes_all(p->un)};
    brc_lanes all[VGCM_N_BOND];
    vgcm_lanes_bond(all, bond->law, brc_lanes_all(bond->kn));
    vgcm_lanes_open(bond->law, all, flags, &q);
    return bond->kn * area * q.normal_force_old[0];
}

#endif
