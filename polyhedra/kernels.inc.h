/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the loop over contacts does four at a time. Each kernel is written once, with constant
 * options, and compiled for each instruction set by the files that include this one. Options are
 * arguments that are literal where they are called; files of the folder know the kernels by their
 * tables alone (struct poly_kernels). */
#ifndef POLY_KERNELS_INC_H
#define POLY_KERNELS_INC_H

#include "polyhedra/linearised_kernels.inc.h"
#include "polyhedra/listing_kernels.inc.h"
#include "polyhedra/point_kernels.inc.h"

#include <string.h>

/* --- sums of contacts ------------------------------------------------------------------------- */

/* Work taken up by the source of a wrench over the step, by the trapezoid rule of ledger.h; the
 * wrench becomes the old one. */
BRC_LANES_INLINE brc_lanes poly_work(double (*old)[6], const struct poly_wrench4 *now,
                                     const struct poly_contact4 *g,
                                     const int32_t contact[BRC_LANES], double dt)
{
    struct poly_wrench4 w;
    brc_lanes x_old[3], all[6];
    brc_lanes_gather6(all, old, contact);
    poly_set3(w.f, all[0], all[1], all[2]);
    poly_set3(w.m, all[3], all[4], all[5]);
    for (int k = 0; k < 3; k++)
        x_old[k] = g->x[k] - g->dv[k] * dt;
    poly_set3(all, now->f[0], now->f[1], now->f[2]);
    poly_set3(all + 3, now->m[0], now->m[1], now->m[2]);
    brc_lanes_scatter6(old, contact, all);
    return -0.5 * dt * (poly_power(&w, g, x_old) + poly_power(now, g, g->x));
}

BRC_LANES_INLINE void poly_works_of_four(struct poly_batch *batch, struct poly_contact4 *g,
                                         const int32_t *contact, const struct poly_wrench4 *normal,
                                         const struct poly_wrench4 *sticky, const int flags)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    double dt = batch->sim->dt;
    g->work_normal = poly_work(columns->normal_old, normal, g, contact, dt);
    g->work_bond = poly_work(columns->bond_old, &g->bond, g, contact, dt);
    if (flags & POLY_VISCOUS)
        g->work_viscous = poly_work(columns->viscous_old, sticky, g, contact, dt);
}

/* Forces and moments of the contacts of a four, and what else they need. Where contacts may be
 * linearised, one work is booked for all that acts, since the tangent does not tell bond and
 * springs apart; otherwise each source has its own. */
BRC_LANES_INLINE void poly_finish_four(struct poly_batch *batch, int32_t four, const int flags)
{
    const bool ledger = flags & POLY_LEDGER, viscous = flags & POLY_VISCOUS;
    const struct brc_contacts *c = batch->contacts;
    struct poly_contact4 *g = &batch->four[four];
    const int32_t *contact = batch->contact + BRC_LANES * four;
    brc_lanes s[POLY_SUMS];
    struct poly_wrench4 normal, sticky, all;
    /* kept contact by contact, since points add to whichever contact is theirs */
    poly_gather_rows(s, batch->sum[BRC_LANES * four], POLY_SUMS, poly_in_turn,
                     viscous ? POLY_SUMS : POLY_SUM_SLID + BRC_LANES);
    poly_set3(normal.f, s[0], s[1], s[2]);
    poly_set3(normal.m, s[3], s[4], s[5]);
    poly_set3(sticky.f, s[POLY_SUM_VISCOUS], s[POLY_SUM_VISCOUS + 1], s[POLY_SUM_VISCOUS + 2]);
    for (int k = 0; k < 3; k++) {
        sticky.m[k] = viscous ? s[POLY_SUM_VISCOUS + 3 + k] : brc_lanes_all(0);
        all.f[k] = g->bond.f[k] + normal.f[k] + s[POLY_SUM_SHEAR + k];
        all.m[k] = g->bond.m[k] + normal.m[k] + s[POLY_SUM_SHEAR + 3 + k];
        if (viscous) {
            all.f[k] += sticky.f[k];
            all.m[k] += sticky.m[k];
        }
        g->k[k] += s[POLY_SUM_K + k];
    }
    g->gap = brc_lanes_min(g->gap, brc_lanes_at(batch->nearest + BRC_LANES * four));
    g->stored = s[POLY_SUM_STORED];
    g->slid = s[POLY_SUM_SLID];
    if (ledger && flags & POLY_TANGENTS) {
        g->work_normal = poly_work_of_four(c, &all, g, contact, batch->sim->dt) - g->slid;
        g->work_bond = brc_lanes_all(0);
    } else if (ledger) {
        poly_works_of_four(batch, g, contact, &normal, &sticky, flags);
    }
    poly_put_wrenches(c, &all, g, contact);
}

BRC_LANES_INLINE void poly_finish_kernel(struct poly_batch *batch, const int flags)
{
    for (int32_t four = 0; BRC_LANES * four < batch->n_contacts; four++)
        poly_finish_four(batch, four, flags);
}

/* --- choice ----------------------------------------------------------------------------------- */

/* One function for each set of flags (enum poly_flags) that is met. With options as variables the
 * loop over points takes branches for each four, and the compiler keeps what no option needs.
 * Tangents go without viscosity, and without friction springs have no work to book. */
#define MOTIONS(X)    X(motion, 0) X(motion, 8) X(motion, 16) X(motion, 24) X(motion, 32)
#define LINEARISED(X) X(linearised, 0) X(linearised, 1)
#define PLATENS(X)    X(platens, 0) X(platens, 1) X(platens, 2) X(platens, 3)

#define FINISHES(X) X(finish, 0) X(finish, 1) X(finish, 2) X(finish, 3) X(finish, 8) X(finish, 9)

#define LITERAL(X, rule) X(rule, 0) X(rule, 2) X(rule, 4) X(rule, 5) X(rule, 6) X(rule, 7)
#define POINTS(X, rule)  LITERAL(X, rule) X(rule, 8) X(rule, 12) X(rule, 13)

#define KERNEL(name, flags)                                                       \
    __attribute__((flatten)) static void name##_##flags(struct poly_batch *batch) \
    {                                                                             \
        poly_##name##_kernel(batch, flags);                                       \
    }
#define ENTRY(name, flags) [flags] = name##_##flags,
MOTIONS(KERNEL)
FINISHES(KERNEL)
PLATENS(KERNEL)
LINEARISED(KERNEL)
POINTS(KERNEL, closed)
POINTS(KERNEL, strict)
POINTS(KERNEL, merged)

/* Platens have the literal loop in either case. */
static struct poly_kernels poly_choose_kernels(const struct brc_sim *sim)
{
    static poly_kernel *const motion[] = {MOTIONS(ENTRY)}, *const finish[] = {FINISHES(ENTRY)};
    static poly_kernel *const platens[] = {PLATENS(ENTRY)}, *const moves[] = {LINEARISED(ENTRY)};
    static poly_kernel *const closed[] = {POINTS(ENTRY, closed)};
    static poly_kernel *const strict[] = {POINTS(ENTRY, strict)};
    static poly_kernel *const merged[] = {POINTS(ENTRY, merged)};
    static poly_kernel *const *const points[] = {closed, strict, merged};
    const struct poly_params *p = poly_params_of(sim);
    int ledger = BRC_OPTION(sim->run.ledger) ? POLY_LEDGER : 0;
    int viscous = BRC_OPTION(poly_is_viscous(sim)) ? POLY_VISCOUS : 0;
    int springs = BRC_OPTION(p->mu > 0 && p->kt > 0) ? POLY_FRICTION | ledger : 0;
    int torsion = BRC_OPTION(p->torsion) ? POLY_TORSION : 0;
    int tangents = poly_is_linearised(sim) ? POLY_TANGENTS : 0, own = tangents ? tangents : viscous;
    return (struct poly_kernels){
        .pose = poly_pose_cores,
        .list = poly_list_all,
        .pairs = {motion[torsion | tangents], points[p->features][own | springs],
                  finish[own | ledger]},
        .platens = {motion[POLY_PLATENS], platens[viscous | ledger], finish[viscous | ledger]},
        .linearised = tangents ? moves[ledger] : NULL};
}

#endif
