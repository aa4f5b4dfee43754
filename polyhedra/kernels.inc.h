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

/* --- sums of contacts
 * ----------------------------------------------------------------------------- */

/* The points' sums of the contacts of a four. Sums are kept contact by contact, since points add to
 * whichever contact is theirs; four contacts side by side are their transpose. */
BRC_LANES_INLINE void poly_sums_of_four(brc_lanes r[POLY_SUMS], const struct poly_batch *batch,
                                        int32_t four, int n)
{
    for (int i = 0; i < n; i += BRC_LANES) {
        for (int lane = 0; lane < BRC_LANES; lane++)
            r[i + lane] = brc_lanes_at(&batch->sum[BRC_LANES * four + lane][i]);
        brc_lanes_transpose(r + i);
    }
}

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
                                         const struct poly_wrench4 *sticky, const bool viscous)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    double dt = batch->sim->dt;
    g->work_normal = poly_work(columns->normal_old, normal, g, contact, dt);
    g->work_bond = poly_work(columns->bond_old, &g->bond, g, contact, dt);
    if (viscous)
        g->work_viscous = poly_work(columns->viscous_old, sticky, g, contact, dt);
}

/* Forces and moments of the contacts of a four, and what else they need. Where contacts may be
 * linearised, one work is booked for all that acts, since the tangent does not tell bond and
 * springs apart; otherwise each source has its own. */
BRC_LANES_INLINE void poly_finish_four(struct poly_batch *batch, int32_t four, const bool ledger,
                                       const bool viscous, const bool linearised)
{
    const struct brc_contacts *c = batch->contacts;
    struct poly_contact4 *g = &batch->four[four];
    const int32_t *contact = batch->contact + BRC_LANES * four;
    brc_lanes s[POLY_SUMS];
    struct poly_wrench4 normal, sticky, all;
    poly_sums_of_four(s, batch, four, viscous ? POLY_SUMS : POLY_SUM_SLID + 4);
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
    if (ledger && linearised) {
        g->work_normal = poly_work_of_four(c, &all, g, contact, batch->sim->dt) - g->slid;
        g->work_bond = brc_lanes_all(0);
    } else if (ledger) {
        poly_works_of_four(batch, g, contact, &normal, &sticky, viscous);
    }
    poly_put_wrenches(c, &all, g, contact);
}

BRC_LANES_INLINE void poly_finish_kernel(struct poly_batch *batch, const bool ledger,
                                         const bool viscous, const bool linearised)
{
    for (int32_t four = 0; BRC_LANES * four < batch->n_contacts; four++)
        poly_finish_four(batch, four, ledger, viscous, linearised);
}

/* --- choice ----------------------------------------------------------------------------------- */

/* One function for each set of options. With options as variables the loop over points takes
 * branches for each four, and the compiler keeps what no option needs. */
#define KERNEL(name, call)                                              \
    __attribute__((flatten)) static void name(struct poly_batch *batch) \
    {                                                                   \
        call;                                                           \
    }
KERNEL(motion, poly_motion_kernel(batch, false, false, false))
KERNEL(motion_torsion, poly_motion_kernel(batch, true, false, false))
KERNEL(motion_linearised, poly_motion_kernel(batch, false, true, false))
KERNEL(motion_torsion_linearised, poly_motion_kernel(batch, true, true, false))
KERNEL(motion_platens, poly_motion_kernel(batch, false, false, true))
KERNEL(finish, poly_finish_kernel(batch, false, false, false))
KERNEL(finish_viscous, poly_finish_kernel(batch, false, true, false))
KERNEL(finish_ledger, poly_finish_kernel(batch, true, false, false))
KERNEL(finish_viscous_ledger, poly_finish_kernel(batch, true, true, false))
KERNEL(finish_linearised, poly_finish_kernel(batch, false, false, true))
KERNEL(finish_linearised_ledger, poly_finish_kernel(batch, true, false, true))
KERNEL(linearised, poly_linearised_kernel(batch, false))
KERNEL(linearised_ledger, poly_linearised_kernel(batch, true))
KERNEL(platens, poly_platens_kernel(batch, false, false))
KERNEL(platens_ledger, poly_platens_kernel(batch, false, true))
KERNEL(platens_viscous, poly_platens_kernel(batch, true, false))
KERNEL(platens_viscous_ledger, poly_platens_kernel(batch, true, true))
#define POINTS(name, ...)                                                      \
    KERNEL(closed_##name, poly_points_kernel(batch, POLY_CLOSED, __VA_ARGS__)) \
    LINEAR_POINTS(name, __VA_ARGS__)
#define LINEAR_POINTS(name, ...)                                               \
    KERNEL(strict_##name, poly_points_kernel(batch, POLY_STRICT, __VA_ARGS__)) \
    KERNEL(merged_##name, poly_points_kernel(batch, POLY_MERGED, __VA_ARGS__))
POINTS(plain, false, false, false, false)
POINTS(viscous, false, false, true, false)
POINTS(friction, false, true, false, false)
POINTS(friction_ledger, false, true, false, true)
POINTS(friction_viscous, false, true, true, false)
POINTS(friction_viscous_ledger, false, true, true, true)
LINEAR_POINTS(linearised, true, false, false, false)
LINEAR_POINTS(linearised_friction, true, true, false, false)
LINEAR_POINTS(linearised_friction_ledger, true, true, false, true)
#undef LINEAR_POINTS
#undef POINTS
#undef KERNEL

__attribute__((flatten)) static void pose(const struct brc_sim *sim, const struct poly_state *st)
{
    poly_pose_cores(sim, st);
}

__attribute__((flatten)) static int list(struct brc_context *ctx, struct poly_list *l,
                                         const struct poly_pair *p, enum poly_rule rule,
                                         double skin, double *allowance)
{
    return poly_list_all(ctx, l, p, rule, skin, allowance);
}

/* Without `closed`, whose springs change all the time, and without viscosity. */
static struct poly_loop poly_linearised_loop(const struct poly_params *p, bool friction,
                                             bool ledger)
{
    static poly_kernel *const points[2][2][2] = {
        {{strict_linearised, strict_linearised},
         {strict_linearised_friction, strict_linearised_friction_ledger}},
        {{merged_linearised, merged_linearised},
         {merged_linearised_friction, merged_linearised_friction_ledger}}};
    return (struct poly_loop){.motion = BRC_OPTION(p->torsion) ? motion_torsion_linearised
                                                               : motion_linearised,
                              .points = points[p->features == POLY_MERGED][friction][ledger],
                              .finish = ledger ? finish_linearised_ledger : finish_linearised};
}

static struct poly_loop poly_literal_loop(const struct poly_params *p, bool friction, bool viscous,
                                          bool ledger)
{
#define BY_OPTIONS(rule)                                                  \
    {                                                                     \
        {{rule##_plain, rule##_plain}, {rule##_viscous, rule##_viscous}}, \
            {{rule##_friction, rule##_friction_ledger},                   \
             {rule##_friction_viscous, rule##_friction_viscous_ledger}},  \
    }
    static poly_kernel *const points[3][2][2][2] = {BY_OPTIONS(closed), BY_OPTIONS(strict),
                                                    BY_OPTIONS(merged)};
#undef BY_OPTIONS
    static poly_kernel *const finishes[2][2] = {{finish, finish_ledger},
                                                {finish_viscous, finish_viscous_ledger}};
    return (struct poly_loop){.motion = BRC_OPTION(p->torsion) ? motion_torsion : motion,
                              .points = points[p->features][friction][viscous][ledger],
                              .finish = finishes[viscous][ledger]};
}

/* Platens have the literal loop in either case. */
static struct poly_kernels poly_choose_kernels(const struct brc_sim *sim)
{
    static poly_kernel *const at_platens[2][2] = {{platens, platens_ledger},
                                                  {platens_viscous, platens_viscous_ledger}};
    const struct poly_params *p = poly_params_of(sim);
    bool friction = BRC_OPTION(p->mu > 0 && p->kt > 0), ledger = BRC_OPTION(sim->run.ledger);
    bool viscous = BRC_OPTION(poly_is_viscous(sim)), linear = poly_is_linearised(sim);
    struct poly_loop literal = poly_literal_loop(p, friction, viscous, ledger);
    return (struct poly_kernels){
        .pose = pose,
        .list = list,
        .pairs = linear ? poly_linearised_loop(p, friction, ledger) : literal,
        .platens = {motion_platens, at_platens[viscous][ledger], literal.finish},
        .linearised = !linear  ? NULL
                      : ledger ? linearised_ledger
                               : linearised};
}

#endif
