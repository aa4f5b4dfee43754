/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags so that it sheds what
 * they turn off, and compiled for each instruction set by the files that include this one. Called
 * once a step through the model's table; all time of a run is spent here. Contacts of one phase are
 * taken four at a time: those that are affine and follow each other at once, the others from
 * queues, since a branch on the phase within four lanes would make all of them take every way.
 *
 * A contact's phase may end within the step. Then its lane has no result, its state is still that
 * before the step, and it goes to the queue of points; so the queues are worked off in the order
 * affine, loose, points. */
#ifndef VGCM_FORCES_KERNELS_H
#define VGCM_FORCES_KERNELS_H

#include "vgcm/damaged_kernels.inc.h"

#include <string.h>

/* ---- affine and loose contacts -----------------------------------------------------------------
 */

/* Whether each point of contact i stays within its strengths under the affine field u. The last
 * point is repeated in lanes that are left over. A negative limit counts as a failure by itself,
 * since its square would not. */
static bool vgcm_points_stay_elastic(const struct vgcm_loop *l, size_t i,
                                     const double u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    double kn = l->f->kn[i], ks = law->eta * kn;
    brc_lanes field[VGCM_N_MOTION], place[4], at[3];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        field[k] = brc_lanes_all(u[k]);
    for (int32_t k = 0, last = l->c->np[i] - 1; k <= last; k += BRC_LANES) {
        const double *point[BRC_LANES];
        for (int lane = 0; lane < BRC_LANES; lane++)
            point[lane] = l->p->law[l->c->p0[i] + (k + lane < last ? k + lane : last)];
        brc_lanes_gather4(place, point);
        vgcm_motion_at(at, field, place[VGCM_AT_S], place[VGCM_AT_T]);
        brc_lanes limit = law->tau - law->mu * kn * at[0];
        if (brc_lanes_any(brc_lanes_less(brc_lanes_all(law->sigma_t), kn * at[0]) |
                          brc_lanes_less(limit, brc_lanes_all(0)) |
                          brc_lanes_less(limit * limit, ks * ks * (at[1] * at[1] + at[2] * at[2]))))
            return false;
    }
    return true;
}

/* Where some point of a contact leaves the elastic range. Bounds over the facets first; a
 * contact that fails them is looked at point by point. The bound takes the largest opening and
 * the largest slip, wherever they are: it costs about what two points do, and a facet has seven. */
VGCM_INLINE brc_mask vgcm_affine_fails(const struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    const struct vgcm_law *law = l->law;
    const brc_lanes *u = x->u;
    brc_lanes kn = vgcm_at(l->f->kn, &x->index), ks = law->eta * kn, range[2];
    brc_lanes facet_radius = vgcm_at(l->f->facet_radius, &x->index);
    vgcm_openings(range, u, facet_radius);
    brc_lanes normal_force = kn * range[1], tension_left = law->sigma_t - kn * u[VGCM_OPEN],
              bending = kn * facet_radius;
    brc_lanes bend2 = u[VGCM_BEND_S] * u[VGCM_BEND_S] + u[VGCM_BEND_T] * u[VGCM_BEND_T];
    brc_lanes shear_left =
        law->tau - law->mu * normal_force - ks * facet_radius * brc_lanes_abs(u[VGCM_TWIST]);
    brc_lanes slip2 = ks * ks * (u[VGCM_S] * u[VGCM_S] + u[VGCM_T] * u[VGCM_T]);
    brc_mask fails =
        x->live & (brc_lanes_less(brc_lanes_min(tension_left, shear_left), brc_lanes_all(0)) |
                   brc_lanes_less(tension_left * tension_left, bending * bending * bend2) |
                   brc_lanes_less(shear_left * shear_left, slip2));
    if (!brc_lanes_any(fails))
        return fails;
    for (int k = 0; k < BRC_LANES; k++) {
        double one[VGCM_N_MOTION];
        for (int m = 0; m < VGCM_N_MOTION; m++)
            one[m] = u[m][k];
        if (fails[k] && vgcm_points_stay_elastic(l, (size_t)x->index.at[k], one))
            fails[k] = 0;
    }
    return fails;
}

/* Where some point of a loose contact may close. By the same bound that has let them become
 * loose. */
VGCM_INLINE brc_mask vgcm_loose_fails(const struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    brc_lanes range[2];
    vgcm_openings(range, x->u, vgcm_at(l->f->facet_radius, &x->index));
    return x->live & ~brc_lanes_less(brc_lanes_all(0), range[0]);
}

/* Generalised forces of affine fields. From the total field, not from the increment: nothing is
 * added up that could drift. */
VGCM_INLINE void vgcm_affine_forces(struct vgcm_loop *l, int flags, struct vgcm_contact4 *x)
{
    brc_lanes moment[VGCM_N_MOMENTS];
    brc_lanes kn = vgcm_at(l->f->kn, &x->index), ks = l->law->eta * kn;
    brc_lanes_gather6(moment, l->f->moment, x->index.at);
    vgcm_force_affine(x->sum, kn, ks, moment, x->u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_LEDGER) { /* by the force halfway, which is linear in the field */
        brc_lanes work = vgcm_force_work(x->sum, x->m.du);
        work -= 0.5 * vgcm_energy_affine(kn, ks, moment, x->m.du);
        x->energy.bond = work;
    }
    if (flags & VGCM_VISCOUS) {
        brc_lanes viscous[VGCM_N_MOTION], c = vgcm_viscosity(l, &x->index);
        vgcm_force_affine(viscous, c, c, moment, x->m.du);
        vgcm_contact4_viscous(l, x, viscous);
    }
}

/* Four affine contacts from end to end, if all of them stay so; else nothing is done. Returns
 * those that leave the elastic range. All or none: a contact that fails has to be done by its
 * points, from the state before the step. */
VGCM_INLINE brc_mask vgcm_contact4_affine(struct vgcm_loop *l, int flags, struct vgcm_contact4 *x)
{
    vgcm_contact4_move(l, x);
    brc_mask fails = vgcm_affine_fails(l, x);
    if (brc_lanes_any(fails))
        return fails;
    vgcm_contact4_write(l, x);
    vgcm_affine_forces(l, flags, x);
    vgcm_contact4_apply(l, x, flags & VGCM_LEDGER && flags & VGCM_VISCOUS);
    return fails;
}

/* The same for loose contacts, whose forces are 0 already. */
VGCM_INLINE brc_mask vgcm_contact4_loose(const struct vgcm_loop *l, struct vgcm_contact4 *x)
{
    vgcm_contact4_move(l, x);
    brc_mask fails = vgcm_loose_fails(l, x);
    if (!brc_lanes_any(fails))
        vgcm_contact4_write(l, x);
    return fails;
}

/* Four contacts of which some have left their phase: these wait as contacts of points, the others
 * in the queue of their phase. */
static __attribute__((noinline)) void vgcm_requeue(struct vgcm_loop *l,
                                                   const struct vgcm_contact4 *x, brc_mask fails,
                                                   enum vgcm_phase phase)
{
    for (int k = 0; k < BRC_LANES; k++) {
        if (!x->live[k])
            continue;
        if (fails[k])
            l->f->phase[x->index.at[k]] = VGCM_POINTS;
        vgcm_queue_add(&l->queue[fails[k] ? VGCM_POINTS : phase], x->index.at[k]);
    }
}

/* ---- contacts of spheres -----------------------------------------------------------------------
 */

/* Viscous force of a sphere contact, whose normal force is fn. */
VGCM_INLINE void vgcm_sphere_viscous(struct vgcm_loop *l, struct vgcm_contact4 *x, double area,
                                     const struct vgcm_point *q)
{
    brc_lanes none = brc_lanes_all(0), viscous[VGCM_N_MOTION] = {none};
    brc_lanes c = vgcm_viscosity(l, &x->index) * area;
    brc_mask closed = brc_lanes_less(brc_lanes_all(q->un), none);
    brc_lanes normal = brc_lanes_min(c * x->m.du[VGCM_OPEN], brc_lanes_all(-q->fn));
    viscous[VGCM_OPEN] = brc_lanes_where(closed, normal);
    viscous[VGCM_S] = brc_lanes_where(closed, -c * x->m.du[VGCM_S]);
    viscous[VGCM_T] = brc_lanes_where(closed, -c * x->m.du[VGCM_T]);
    vgcm_contact4_viscous(l, x, viscous);
}

/* Forces of a sphere contact that touches or has just parted. With the stiffness while they overlap
 * alone: unlike a facet's points, spheres that have parted may never meet again. */
static void vgcm_sphere_forces(struct vgcm_loop *l, int32_t i, int flags)
{
    struct brc_contacts *c = l->c;
    struct vgcm_contact4 x = {.index = {.at = {i, i, i, i}}, .live = brc_lanes_first(1)};
    struct vgcm_bond bond = vgcm_springs_of(l->law, l->f->kn[i]);
    size_t j = (size_t)c->p0[i];
    double area = l->p->law[j][VGCM_AREA];
    vgcm_motion_of(&l->sim->bodies, c, &x.index, l->sim->dt, &x.m);
    vgcm_put3(l->f->n, &x.index, x.m.n);
    vgcm_put3(l->f->s, &x.index, x.m.s);
    double du[3] = {x.m.du[VGCM_OPEN][0], x.m.du[VGCM_S][0], x.m.du[VGCM_T][0]};
    struct vgcm_point q = vgcm_point_at(l->p, j, c->gap[i] - du[0], bond.ks * area);
    vgcm_law_friction(&bond, area, du, &q, &x.energy);
    vgcm_point_put(l->p, j, bond.per_ks / area, &q);
    x.sum[VGCM_OPEN] = brc_lanes_all(q.fn);
    x.sum[VGCM_S] = brc_lanes_all(q.fs);
    x.sum[VGCM_T] = brc_lanes_all(q.ft);
    if (flags & VGCM_VISCOUS)
        vgcm_sphere_viscous(l, &x, area, &q);
    vgcm_contact4_apply(l, &x, flags & VGCM_LEDGER);
    double k = c->gap[i] < 0 ? fmax(bond.kn, bond.ks) * area : 0;
    double h = x.m.h[0], g = x.m.d[0] - h;
    if ((k > 0) != (c->k[i][0] > 0)) {
        brc_set(c->k[i], k, k * h * h, k * g * g);
        c->k_version++;
    }
}

/* Two spheres without a bond: one point that is broken from the start, with the total overlap.
 * One at a time: they are few, and most of them do not touch. */
static __attribute__((noinline)) void vgcm_sphere_step(struct vgcm_loop *l, int32_t i, int flags)
{
    struct brc_contacts *c = l->c;
    double branch[3], gap_old = c->gap[i];
    brc_sub(branch, l->sim->bodies.x[c->b[i]], l->sim->bodies.x[c->a[i]]);
    c->gap[i] = brc_norm(branch) - l->f->contact_distance[i];
    if (c->gap[i] >= 0 && gap_old >= 0)
        return;
    if (gap_old >= 0) {
        double t[3];
        brc_normalise(l->f->n[i], branch);
        brc_frame(l->f->s[i], t, l->f->n[i]);
    }
    vgcm_sphere_forces(l, i, flags);
}

/* ---- all contacts ------------------------------------------------------------------------------
 */

/* Whether the four contacts from contact i on are affine. */
VGCM_INLINE bool vgcm_are_affine(const struct vgcm_loop *l, size_t i, size_t end)
{
    static const uint8_t affine[BRC_LANES] = {VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE};
    return i + BRC_LANES <= end && memcmp(l->f->phase + i, affine, sizeof affine) == 0;
}

/* Affine contacts that follow each other are done at once; all others join the queues. Where
 * viscous forces book energies, all of them wait. */
VGCM_INLINE void vgcm_chunk_begin(struct vgcm_loop *l, int flags, size_t begin, size_t end)
{
    l->chunk.begin = begin;
    l->chunk.is_waiting = flags & VGCM_VISCOUS;
    for (size_t i = begin; i < end; i += BRC_LANES) {
        if (vgcm_are_affine(l, i, end)) {
            struct vgcm_contact4 x;
            vgcm_contact4_clear(&x);
            x.index.is_consecutive = true;
            for (int k = 0; k < BRC_LANES; k++)
                x.index.at[k] = (int32_t)i + k;
            x.live = brc_lanes_first(BRC_LANES);
            if (!brc_lanes_any(vgcm_contact4_affine(l, flags, &x)))
                continue;
        }
        l->chunk.is_waiting = true;
        for (size_t k = i; k < i + BRC_LANES && k < end; k++)
            vgcm_queue_add(&l->queue[l->f->phase[k]], (int32_t)k);
    }
}

/* Spheres come last and one by one. What all of them exert is added at the end, in the order of the
 * list. */
VGCM_INLINE void vgcm_chunk_finish(struct vgcm_loop *l, int flags, size_t end)
{
    struct vgcm_queue *q = l->queue;
    struct vgcm_contact4 x;
    while (q[VGCM_AFFINE].n > 0) {
        vgcm_fetch_ahead(l);
        vgcm_queue_next(&x, &q[VGCM_AFFINE]);
        brc_mask fails = vgcm_contact4_affine(l, flags, &x);
        if (brc_lanes_any(fails))
            vgcm_requeue(l, &x, fails, VGCM_AFFINE);
    }
    while (q[VGCM_LOOSE].n > 0) {
        vgcm_fetch_ahead(l);
        vgcm_queue_next(&x, &q[VGCM_LOOSE]);
        brc_mask fails = vgcm_contact4_loose(l, &x);
        if (brc_lanes_any(fails))
            vgcm_requeue(l, &x, fails, VGCM_LOOSE);
    }
    vgcm_queue_sort(&q[VGCM_POINTS], l->c->np);
    while (q[VGCM_POINTS].n > 0) {
        vgcm_fetch_ahead(l);
        vgcm_queue_next(&x, &q[VGCM_POINTS]);
        vgcm_contact4_damaged(l, flags, &x);
    }
    while (q[VGCM_SPHERE].n > 0)
        vgcm_sphere_step(l, q[VGCM_SPHERE].contact[--q[VGCM_SPHERE].n], flags);
    if (!VGCM_FREE_SUMS && l->chunk.is_waiting)
        vgcm_chunk_add(l, end);
}

/* By chunks, so that what contacts exert can wait for its turn in the first cache
 * (contact4_kernels.inc.h). */
VGCM_INLINE void vgcm_forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags)
{
    struct vgcm_loop l = {.sim = sim,
                          .law = law,
                          .c = &sim->pairs,
                          .f = vgcm_columns(&sim->pairs),
                          .p = vgcm_point_columns(&sim->pairs)};
    for (size_t i = 0; i < l.c->n; i += VGCM_CHUNK) {
        size_t end = i + VGCM_CHUNK < l.c->n ? i + VGCM_CHUNK : l.c->n;
        l.ahead = i + VGCM_CHUNK;
        vgcm_chunk_begin(&l, flags, i, end);
        vgcm_chunk_finish(&l, flags, end);
    }
}

/* Sets of flags that there are: brittle contacts have no losses of strength, as without a softening
 * branch there is nothing to add. */
#define VGCM_FLAGS(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(10) X(12) X(14)
#define VGCM_LOOP(n)                                                             \
    static void vgcm_forces_##n(struct brc_sim *sim, const struct vgcm_law *law) \
    {                                                                            \
        vgcm_forces_loop(sim, law, n);                                           \
    }
#define VGCM_ENTRY(n) [n] = vgcm_forces_##n,
VGCM_FLAGS(VGCM_LOOP)
#undef VGCM_LOOP

#define VGCM_LOOPS                                  \
    {                                               \
        {VGCM_FLAGS(VGCM_ENTRY)}, vgcm_platens_loop \
    }

#endif
