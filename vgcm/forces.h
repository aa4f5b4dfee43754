/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags, and compiled for each
 * instruction set by the files that include this one. Rows of one phase are taken four at a time:
 * those that are affine and follow each other at once, the others from queues. */
#ifndef VGCM_FORCES_H
#define VGCM_FORCES_H

#include "vgcm/damaged.h"

#include <string.h>

/* ---- affine and loose rows ----------------------------------------------------------------- */

/* Whether each point of row i stays within its strengths under the affine field u. */
static bool points_hold(const struct loop *l, size_t i, const double u[VGCM_N_MOTION])
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

/* Where some point of a row leaves the elastic range. Bounds over the facets first; a row that
 * fails them is looked at point by point. */
VGCM_INLINE brc_mask affine_fails(const struct loop *l, const struct four *x)
{
    const struct vgcm_law *law = l->law;
    const brc_lanes *u = x->u;
    brc_lanes kn = vgcm_at(l->f->kn, &x->rows), ks = law->eta * kn, range[2];
    brc_lanes rim = vgcm_at(l->f->rim, &x->rows);
    openings_of(range, u, rim);
    brc_lanes pull = kn * range[1], room = law->sigma_t - kn * u[VGCM_OPEN], reach = kn * rim;
    brc_lanes bend2 = u[VGCM_BEND_S] * u[VGCM_BEND_S] + u[VGCM_BEND_T] * u[VGCM_BEND_T];
    brc_lanes left = law->tau - law->mu * pull - ks * rim * brc_lanes_abs(u[VGCM_TWIST]);
    brc_lanes slip2 = ks * ks * (u[VGCM_S] * u[VGCM_S] + u[VGCM_T] * u[VGCM_T]);
    brc_mask fails = x->live & (brc_lanes_less(brc_lanes_min(room, left), brc_lanes_all(0)) |
                                brc_lanes_less(room * room, reach * reach * bend2) |
                                brc_lanes_less(left * left, slip2));
    if (!brc_lanes_any(fails))
        return fails;
    for (int k = 0; k < BRC_LANES; k++) {
        double one[VGCM_N_MOTION];
        for (int m = 0; m < VGCM_N_MOTION; m++)
            one[m] = u[m][k];
        if (fails[k] && points_hold(l, (size_t)x->rows.at[k], one))
            fails[k] = 0;
    }
    return fails;
}

/* Where some point of a loose row may close. */
VGCM_INLINE brc_mask loose_fails(const struct loop *l, const struct four *x)
{
    brc_lanes range[2];
    openings_of(range, x->u, vgcm_at(l->f->rim, &x->rows));
    return x->live & ~brc_lanes_less(brc_lanes_all(0), range[0]);
}

/* Generalised forces of affine fields. */
VGCM_INLINE void affine_forces(struct loop *l, int flags, struct four *x)
{
    brc_lanes moment[VGCM_N_MOMENTS];
    brc_lanes kn = vgcm_at(l->f->kn, &x->rows), ks = l->law->eta * kn;
    brc_lanes_gather6(moment, l->f->moment, x->rows.at);
    vgcm_force_affine(x->sum, kn, ks, moment, x->u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_LEDGER) { /* by the force halfway, which is linear in the field */
        brc_lanes work = vgcm_force_work(x->sum, x->m.du);
        work -= 0.5 * vgcm_energy_affine(kn, ks, moment, x->m.du);
        l->booked.affine += brc_lanes_where(x->live, work);
    }
    if (flags & VGCM_VISCOUS) {
        brc_lanes drag[VGCM_N_MOTION], c = drag_of(l, &x->rows);
        vgcm_force_affine(drag, c, c, moment, x->m.du);
        add_drag(l, x, flags, drag);
    }
}

/* Four affine rows from end to end, if all of them stay so; else nothing is done. Returns those
 * that leave the elastic range. */
VGCM_INLINE brc_mask affine_four(struct loop *l, int flags, struct four *x)
{
    move_four(l, x);
    brc_mask fails = affine_fails(l, x);
    if (brc_lanes_any(fails))
        return fails;
    write_motion(l, x);
    affine_forces(l, flags, x);
    apply_forces(l, x);
    return fails;
}

/* The same for loose rows, whose forces are 0 already. */
VGCM_INLINE brc_mask loose_four(const struct loop *l, struct four *x)
{
    move_four(l, x);
    brc_mask fails = loose_fails(l, x);
    if (!brc_lanes_any(fails))
        write_motion(l, x);
    return fails;
}

/* Four rows of which some have left their phase: these wait as rows of points, the others in the
 * queue of their phase. */
static __attribute__((noinline)) void part(struct loop *l, const struct four *x, brc_mask fails,
                                           enum vgcm_phase phase)
{
    for (int k = 0; k < BRC_LANES; k++) {
        if (!x->live[k])
            continue;
        if (fails[k])
            l->f->phase[x->rows.at[k]] = VGCM_POINTS;
        wait_again(&l->queue[fails[k] ? VGCM_POINTS : phase], x->rows.at[k]);
    }
}

/* ---- rows of spheres ----------------------------------------------------------------------- */

/* Viscous force of a sphere contact, whose normal force is fn. */
VGCM_INLINE void sphere_drag(struct loop *l, int flags, struct four *x, double area,
                             const struct vgcm_point *q)
{
    brc_lanes none = brc_lanes_all(0), drag[VGCM_N_MOTION] = {none};
    brc_lanes c = drag_of(l, &x->rows) * area;
    brc_mask closed = brc_lanes_less(brc_lanes_all(q->un), none);
    brc_lanes pull = brc_lanes_min(c * x->m.du[VGCM_OPEN], brc_lanes_all(-q->fn));
    drag[VGCM_OPEN] = brc_lanes_where(closed, pull);
    drag[VGCM_S] = brc_lanes_where(closed, -c * x->m.du[VGCM_S]);
    drag[VGCM_T] = brc_lanes_where(closed, -c * x->m.du[VGCM_T]);
    add_drag(l, x, flags, drag);
}

/* Forces of a sphere contact that touches or has just parted. */
static void sphere_forces(struct loop *l, int32_t i, int flags)
{
    struct brc_contacts *c = l->c;
    struct four x = {.rows = {.at = {i, i, i, i}}, .live = brc_lanes_first(1)};
    struct vgcm_bond bond = vgcm_springs_of(l->law, l->f->kn[i]);
    size_t j = (size_t)c->p0[i];
    double area = l->p->law[j][VGCM_AREA];
    vgcm_motion_of(&l->sim->bodies, c, &x.rows, l->sim->dt, &x.m);
    vgcm_put3(l->f->n, &x.rows, x.m.n);
    vgcm_put3(l->f->s, &x.rows, x.m.s);
    double du[3] = {x.m.du[VGCM_OPEN][0], x.m.du[VGCM_S][0], x.m.du[VGCM_T][0]};
    struct vgcm_point q = vgcm_point_at(l->p, j, c->gap[i] - du[0], bond.ks * area);
    vgcm_law_rub(&bond, area, du, &q, &l->booked.spheres);
    vgcm_point_put(l->p, j, bond.per_ks / area, &q);
    x.sum[VGCM_OPEN] = brc_lanes_all(q.fn);
    x.sum[VGCM_S] = brc_lanes_all(q.fs);
    x.sum[VGCM_T] = brc_lanes_all(q.ft);
    if (flags & VGCM_VISCOUS)
        sphere_drag(l, flags, &x, area, &q);
    apply_forces(l, &x);
    double k = c->gap[i] < 0 ? fmax(bond.kn, bond.ks) * area : 0;
    double h = x.m.h[0], g = x.m.d[0] - h;
    if ((k > 0) != (c->k[i][0] > 0)) {
        brc_set(c->k[i], k, k * h * h, k * g * g);
        c->k_version++;
    }
}

/* Two spheres without a bond: one point that is broken from the start, with the total overlap. */
static __attribute__((noinline)) void sphere_row(struct loop *l, int32_t i, int flags)
{
    struct brc_contacts *c = l->c;
    double branch[3], gap_old = c->gap[i];
    brc_sub(branch, l->sim->bodies.x[c->b[i]], l->sim->bodies.x[c->a[i]]);
    c->gap[i] = brc_norm(branch) - l->f->rest[i];
    if (c->gap[i] >= 0 && gap_old >= 0)
        return;
    if (gap_old >= 0) {
        double t[3];
        brc_normalise(l->f->n[i], branch);
        brc_frame(l->f->s[i], t, l->f->n[i]);
    }
    sphere_forces(l, i, flags);
}

/* ---- all rows ------------------------------------------------------------------------------ */

/* Whether the four rows from row i on are affine. */
VGCM_INLINE bool are_affine(const struct loop *l, size_t i, size_t end)
{
    static const uint8_t affine[BRC_LANES] = {VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE};
    return i + BRC_LANES <= end && memcmp(l->f->phase + i, affine, sizeof affine) == 0;
}

/* Affine rows that follow each other are done at once; all others join the queues. */
VGCM_INLINE void begin_chunk(struct loop *l, int flags, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i += BRC_LANES) {
        if (are_affine(l, i, end)) {
            struct four x;
            for (int k = 0; k < BRC_LANES; k++)
                x.rows.at[k] = (int32_t)i + k;
            x.rows.is_run = true;
            x.live = brc_lanes_first(BRC_LANES);
            if (!brc_lanes_any(affine_four(l, flags, &x)))
                continue;
        }
        for (size_t k = i; k < i + BRC_LANES && k < end; k++)
            wait_again(&l->queue[l->f->phase[k]], (int32_t)k);
    }
}

VGCM_INLINE void finish_chunk(struct loop *l, int flags)
{
    struct queue *q = l->queue;
    struct four x;
    while (q[VGCM_AFFINE].n > 0) {
        fetch_ahead(l);
        next_four(&x, &q[VGCM_AFFINE]);
        brc_mask fails = affine_four(l, flags, &x);
        if (brc_lanes_any(fails))
            part(l, &x, fails, VGCM_AFFINE);
    }
    while (q[VGCM_LOOSE].n > 0) {
        fetch_ahead(l);
        next_four(&x, &q[VGCM_LOOSE]);
        brc_mask fails = loose_four(l, &x);
        if (brc_lanes_any(fails))
            part(l, &x, fails, VGCM_LOOSE);
    }
    sort_by_points(&q[VGCM_POINTS], l->c->np);
    while (q[VGCM_POINTS].n > 0) {
        fetch_ahead(l);
        next_four(&x, &q[VGCM_POINTS]);
        damaged_four(l, flags, &x);
    }
    while (q[VGCM_SPHERE].n > 0)
        sphere_row(l, q[VGCM_SPHERE].row[--q[VGCM_SPHERE].n], flags);
}

VGCM_INLINE void forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags)
{
    struct loop l = {.sim = sim,
                     .law = law,
                     .c = &sim->pairs,
                     .f = vgcm_columns(&sim->pairs),
                     .p = vgcm_point_columns(&sim->pairs)};
    for (size_t i = 0; i < l.c->n; i += CHUNK) {
        l.ahead = i + CHUNK;
        begin_chunk(&l, flags, i, i + CHUNK < l.c->n ? i + CHUNK : l.c->n);
        finish_chunk(&l, flags);
    }
    if (flags & VGCM_LEDGER) {
        const struct vgcm_energy_lanes *points = &l.booked.points;
        const struct vgcm_energy *spheres = &l.booked.spheres;
        sim->ledger.bond += brc_lanes_sum(points->bond) + brc_lanes_sum(l.booked.affine);
        sim->ledger.contact_normal += brc_lanes_sum(points->normal) + spheres->normal;
        sim->ledger.contact_shear += brc_lanes_sum(points->shear) + spheres->shear;
        sim->ledger.damage += brc_lanes_sum(points->damage);
        sim->ledger.friction += brc_lanes_sum(points->friction) + spheres->friction;
        sim->ledger.viscous += brc_lanes_sum(l.booked.viscous);
    }
}

#define LOOP(n)                                                             \
    static void forces_##n(struct brc_sim *sim, const struct vgcm_law *law) \
    {                                                                       \
        forces_loop(sim, law, n);                                           \
    }
LOOP(0)
LOOP(1)
LOOP(2)
LOOP(3)
LOOP(4)
LOOP(5)
LOOP(6)
LOOP(7)
LOOP(8)
LOOP(10)
LOOP(12)
LOOP(14)
#undef LOOP

#define VGCM_LOOPS                       \
    {                                    \
        {forces_0,                       \
         forces_1,                       \
         forces_2,                       \
         forces_3,                       \
         forces_4,                       \
         forces_5,                       \
         forces_6,                       \
         forces_7,                       \
         [VGCM_LOSSES] = forces_8,       \
         [VGCM_LOSSES + 2] = forces_10,  \
         [VGCM_LOSSES + 4] = forces_12,  \
         [VGCM_LOSSES + 6] = forces_14}, \
            platens_loop                 \
    }

#endif
