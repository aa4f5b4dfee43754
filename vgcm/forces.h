/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags, and compiled for each
 * instruction set by the files that include this one. Rows are taken four at a time. */
#ifndef VGCM_FORCES_H
#define VGCM_FORCES_H

#include "vgcm/contact.h"

struct loop {
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
};

/* What the ledger gets, four sums side by side [J]. */
struct booked {
    struct vgcm_energy_lanes points;
    brc_lanes affine, viscous; /* stored by affine contacts; dissipated by viscous forces */
};

/* What the points of four rows add up to: one row's four partial sums each. */
struct row_sums {
    brc_lanes force[VGCM_N_MOTION][BRC_LANES], drag[VGCM_N_MOTION][BRC_LANES];
    brc_lanes opening[BRC_LANES]; /* m, the smallest */
};

/* ---- viscous forces ------------------------------------------------------------------------ */

/* Viscosity per area of rows i to i + 3, over dt: force = this times area times increment. */
VGCM_INLINE brc_lanes drag_of(const struct loop *l, size_t i)
{
    brc_lanes c = brc_lanes_all(0);
    double dt = l->sim->dt;
    const double *mass = l->sim->bodies.true_mass;
    for (int k = 0; k < BRC_LANES; k++) {
        double ma = mass[l->c->a[i + k]], mb = mass[l->c->b[i + k]];
        c[k] =
            dt > 0 ? l->law->viscous * ma * mb / (ma + mb) / (l->f->moment[i + k][VGCM_A] * dt) : 0;
    }
    return c;
}

/* Adds the viscous part to the generalised forces of the rows of the mask, and its dissipation to
 * what is booked. */
VGCM_INLINE void add_drag(struct loop *l, size_t i, int flags, brc_mask rows,
                          const brc_lanes du[VGCM_N_MOTION], const brc_lanes drag[VGCM_N_MOTION],
                          brc_lanes sum[VGCM_N_MOTION], brc_lanes *viscous)
{
    brc_lanes old[VGCM_N_MOTION], mean[VGCM_N_MOTION], now[VGCM_N_MOTION];
    brc_lanes_at6(old, l->f->drag + i);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (old[k] + drag[k]);
        now[k] = brc_lanes_pick(rows, drag[k], old[k]);
        sum[k] += brc_lanes_where(rows, drag[k]);
    }
    brc_lanes_put6(l->f->drag + i, now);
    if (flags & VGCM_LEDGER)
        *viscous += brc_lanes_where(rows, vgcm_force_work(mean, du));
}

/* Viscous force of four points. A broken point that is open has none, and one that is closed is
 * never pulled by it. */
VGCM_INLINE void point_drag(brc_lanes drag[VGCM_N_MOTION], brc_lanes c, const brc_lanes du[3],
                            const struct vgcm_point_lanes *q, brc_lanes s, brc_lanes t)
{
    brc_mask broken = ~vgcm_lanes_whole(vgcm_lanes_damage(q));
    brc_mask acts = ~broken | brc_lanes_less(q->un, brc_lanes_all(0));
    brc_lanes fn = c * du[0];
    fn = brc_lanes_pick(broken, brc_lanes_min(fn, -q->fn), fn);
    vgcm_force_add(drag, brc_lanes_where(acts, fn), brc_lanes_where(acts, -c * du[1]),
                   brc_lanes_where(acts, -c * du[2]), s, t);
}

/* ---- affine rows --------------------------------------------------------------------------- */

/* Whether each point of row i stays within its strengths under the affine field u. */
static bool points_hold(const struct loop *l, size_t i, const double u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    double kn = l->f->kn[i], ks = law->eta * kn;
    brc_lanes field[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        field[k] = brc_lanes_all(u[k]);
    for (int32_t k = 0; k < l->c->np[i]; k += BRC_LANES) {
        size_t j = (size_t)(l->c->p0[i] + k);
        brc_lanes at[3];
        vgcm_motion_at(at, field, brc_lanes_at(l->p->s + j), brc_lanes_at(l->p->t + j));
        brc_lanes limit = law->tau - law->mu * kn * at[0];
        brc_mask fails = brc_lanes_less(brc_lanes_all(law->sigma_t), kn * at[0]) |
                         brc_lanes_less(limit, brc_lanes_all(0)) |
                         brc_lanes_less(limit * limit, ks * ks * (at[1] * at[1] + at[2] * at[2]));
        if (brc_lanes_any(fails & brc_lanes_first(l->c->np[i] - k)))
            return false;
    }
    return true;
}

/* Where some point of a row leaves the elastic range. Bounds over the facets first; a row that
 * fails them is looked at point by point. */
VGCM_INLINE brc_mask affine_fails(const struct loop *l, size_t i, brc_mask rows, brc_lanes kn,
                                  const brc_lanes u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    brc_lanes rim = brc_lanes_at(l->f->rim + i), ks = law->eta * kn;
    brc_lanes bend = brc_lanes_abs(u[VGCM_BEND_S]) + brc_lanes_abs(u[VGCM_BEND_T]);
    brc_lanes pull = kn * (u[VGCM_OPEN] + rim * bend);
    brc_lanes left = law->tau - law->mu * pull - ks * rim * brc_lanes_abs(u[VGCM_TWIST]);
    brc_lanes slip2 = ks * ks * (u[VGCM_S] * u[VGCM_S] + u[VGCM_T] * u[VGCM_T]);
    brc_mask fails =
        rows & (brc_lanes_less(brc_lanes_all(law->sigma_t), pull) |
                brc_lanes_less(left, brc_lanes_all(0)) | brc_lanes_less(left * left, slip2));
    if (!brc_lanes_any(fails))
        return fails;
    for (int k = 0; k < BRC_LANES; k++) {
        double one[VGCM_N_MOTION];
        for (int m = 0; m < VGCM_N_MOTION; m++)
            one[m] = u[m][k];
        if (fails[k] && points_hold(l, i + (size_t)k, one))
            fails[k] = 0;
    }
    return fails;
}

/* Gives each point its own state, that of the affine field so far. */
static __attribute__((noinline)) void leave_affine(const struct loop *l, size_t i)
{
    double ks = l->law->eta * l->f->kn[i], *u = l->f->u[i];
    for (size_t j = (size_t)l->c->p0[i], end = j + (size_t)l->c->np[i]; j < end; j++) {
        double s = l->p->s[j], t = l->p->t[j];
        l->p->un[j] = u[VGCM_OPEN] - u[VGCM_BEND_T] * s + u[VGCM_BEND_S] * t;
        l->p->fs[j] = -ks * l->p->area[j] * (u[VGCM_S] - u[VGCM_TWIST] * t);
        l->p->ft[j] = -ks * l->p->area[j] * (u[VGCM_T] + u[VGCM_TWIST] * s);
    }
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] = 0;
    l->f->phase[i] = VGCM_POINTS;
}

/* The rows of the mask as affine fields: generalised forces and openings. Rows in which a point
 * leaves the elastic range become rows of points and are taken out of the mask. */
VGCM_INLINE brc_mask affine_rows(struct loop *l, size_t i, int flags, brc_mask rows,
                                 const struct vgcm_motion *m, brc_lanes sum[VGCM_N_MOTION],
                                 brc_lanes *opening, struct booked *booked)
{
    brc_lanes u[VGCM_N_MOTION], old[VGCM_N_MOTION], moment[VGCM_N_MOMENTS];
    brc_lanes kn = brc_lanes_at(l->f->kn + i), ks = l->law->eta * kn;
    brc_lanes_at6(old, l->f->u + i);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] = old[k] + m->du[k]; /* eq:vgcm:14 */
    brc_mask fails = affine_fails(l, i, rows, kn, u);
    if (brc_lanes_any(fails)) {
        for (int k = 0; k < BRC_LANES; k++)
            if (fails[k])
                leave_affine(l, i + (size_t)k);
        rows &= ~fails;
    }
    brc_lanes_at6(moment, l->f->moment + i);
    if (flags & VGCM_LEDGER) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            old[k] += 0.5 * m->du[k];
        vgcm_force_affine(sum, kn, ks, moment, old);
        booked->affine += brc_lanes_where(rows, vgcm_force_work(sum, m->du));
    }
    vgcm_force_affine(sum, kn, ks, moment, u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_VISCOUS) {
        brc_lanes drag[VGCM_N_MOTION], c = drag_of(l, i);
        vgcm_force_affine(drag, c, c, moment, m->du);
        add_drag(l, i, flags, rows, m->du, drag, sum, &booked->viscous);
    }
    *opening = u[VGCM_OPEN];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] = brc_lanes_where(rows, u[k]); /* 0 in rows of points */
    brc_lanes_put6(l->f->u + i, u);
    return rows;
}

/* ---- rows of points ------------------------------------------------------------------------ */

/* Point j of row i has just broken. */
static __attribute__((noinline)) void add_event(const struct loop *l, size_t i, size_t j)
{
    const struct brc_contacts *c = l->c;
    double t[3], branch[3], *xa = l->sim->bodies.x[c->a[i]];
    struct brc_event event = {.a = c->a[i],
                              .b = c->b[i],
                              .facet = c->facet[i],
                              .point = (int32_t)(j - (size_t)c->p0[i]),
                              .mode =
                                  l->p->dn[j] >= l->p->ds[j] ? BRC_MODE_TENSION : BRC_MODE_SHEAR,
                              .area = l->p->area[j],
                              .energy = l->p->lost[j]};
    brc_sub(branch, l->sim->bodies.x[c->b[i]], xa);
    brc_cross(t, l->f->n[i], l->f->s[i]);
    brc_copy(event.n, l->f->n[i]);
    brc_copy(event.x, xa);
    brc_axpy(event.x, 0.5 * brc_norm(branch) + l->f->plane[i], l->f->n[i]);
    brc_axpy(event.x, l->p->s[j], l->f->s[i]);
    brc_axpy(event.x, l->p->t[j], t);
    brc_events_add(l->sim->ctx, &l->sim->events, l->sim->step, &event);
    bool is_whole = false;
    for (size_t k = (size_t)c->p0[i], end = k + (size_t)c->np[i]; k < end; k++)
        is_whole |= l->p->dn[k] + l->p->ds[k] < 1;
    c->status[i] = is_whole ? BRC_INTACT : BRC_BROKEN;
}

/* Points j to j + 3 of row i + lane, those of the mask `live`. */
VGCM_INLINE void step_points(struct loop *l, size_t i, int lane, size_t j, int flags, brc_mask live,
                             const struct vgcm_bond_lanes *bond,
                             const brc_lanes move[VGCM_N_MOTION], brc_lanes drag,
                             struct row_sums *sums, struct booked *booked)
{
    struct vgcm_points *p = l->p;
    brc_lanes s = brc_lanes_at(p->s + j), t = brc_lanes_at(p->t + j), du[3];
    brc_lanes area = brc_lanes_at(p->area + j);
    struct vgcm_point_lanes q = {.un = brc_lanes_at(p->un + j),
                                 .fs = brc_lanes_at(p->fs + j),
                                 .ft = brc_lanes_at(p->ft + j),
                                 .dn = brc_lanes_at(p->dn + j),
                                 .ds = brc_lanes_at(p->ds + j),
                                 .lost = brc_lanes_at(p->lost + j)};
    brc_mask was_whole = vgcm_lanes_whole(vgcm_lanes_damage(&q));
    vgcm_motion_at(du, move, s, t);
    brc_mask changed = vgcm_lanes_step(l->law, bond, flags, area, du, &q, &booked->points);
    brc_lanes_put(p->un + j, q.un);
    brc_lanes_put(p->fs + j, q.fs);
    brc_lanes_put(p->ft + j, q.ft);
    if (brc_lanes_any(changed & live)) {
        brc_lanes_put(p->dn + j, q.dn);
        brc_lanes_put(p->ds + j, q.ds);
        brc_lanes_put(p->lost + j, q.lost);
        brc_mask broke = live & was_whole & ~vgcm_lanes_whole(vgcm_lanes_damage(&q));
        for (int k = 0; k < BRC_LANES; k++)
            if (broke[k])
                add_event(l, i + (size_t)lane, j + (size_t)k);
    }
    brc_lanes force[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        force[k] = sums->force[k][lane];
    vgcm_force_add(force, q.fn, q.fs, q.ft, s, t);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        sums->force[k][lane] = force[k];
    if (flags & VGCM_VISCOUS) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            force[k] = sums->drag[k][lane];
        point_drag(force, drag * area, du, &q, s, t);
        for (int k = 0; k < VGCM_N_MOTION; k++)
            sums->drag[k][lane] = force[k];
    }
    brc_lanes opening = brc_lanes_pick(live, q.un, brc_lanes_all(HUGE_VAL));
    sums->opening[lane] = brc_lanes_min(sums->opening[lane], opening);
}

VGCM_INLINE void points_row(struct loop *l, size_t i, int lane, int flags,
                            const struct vgcm_bond_lanes *bonds,
                            const brc_lanes moves[VGCM_N_MOTION], brc_lanes drags,
                            struct row_sums *sums, struct booked *booked)
{
    const struct vgcm_bond_lanes bond = {
        brc_lanes_all(bonds->kn[lane]), brc_lanes_all(bonds->ks[lane]),
        brc_lanes_all(bonds->u0[lane]), brc_lanes_all(bonds->wn[lane]),
        brc_lanes_all(bonds->ws[lane])};
    brc_lanes move[VGCM_N_MOTION], drag = brc_lanes_all(drags[lane]);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        move[k] = brc_lanes_all(moves[k][lane]);
    size_t first = (size_t)l->c->p0[i + (size_t)lane];
    int32_t n = l->c->np[i + (size_t)lane];
    for (int32_t k = 0; k < n; k += BRC_LANES)
        step_points(l, i, lane, first + (size_t)k, flags, brc_lanes_first(n - k), &bond, move, drag,
                    sums, booked);
}

/* Adds the rows of the mask by their points to the generalised forces and openings. */
VGCM_INLINE void points_rows(struct loop *l, size_t i, int flags, brc_mask rows,
                             const struct vgcm_motion *m, brc_lanes sum[VGCM_N_MOTION],
                             brc_lanes *opening, struct booked *booked)
{
    struct vgcm_bond_lanes bonds;
    struct row_sums sums;
    brc_lanes drag = flags & VGCM_VISCOUS ? drag_of(l, i) : brc_lanes_all(0);
    vgcm_lanes_bond(&bonds, l->law, brc_lanes_at(l->f->kn + i));
    for (int lane = 0; lane < BRC_LANES; lane++) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            sums.force[k][lane] = sums.drag[k][lane] = brc_lanes_all(0);
        sums.opening[lane] = brc_lanes_all(HUGE_VAL);
        if (rows[lane])
            points_row(l, i, lane, flags, &bonds, m->du, drag, &sums, booked);
    }
    for (int k = 0; k < VGCM_N_MOTION; k++)
        sum[k] = brc_lanes_pick(rows, brc_lanes_sums(sums.force[k]), sum[k]);
    *opening = brc_lanes_pick(rows, brc_lanes_mins(sums.opening), *opening);
    if (flags & VGCM_VISCOUS) {
        brc_lanes all[VGCM_N_MOTION];
        for (int k = 0; k < VGCM_N_MOTION; k++)
            all[k] = brc_lanes_sums(sums.drag[k]);
        add_drag(l, i, flags, rows, m->du, all, sum, &booked->viscous);
    }
}

/* ---- rows of spheres ----------------------------------------------------------------------- */

/* Forces of a sphere contact that touches or has just parted. */
static void sphere_forces(struct loop *l, size_t i, int flags, struct vgcm_energy *energy,
                          brc_lanes *viscous)
{
    struct brc_contacts *c = l->c;
    size_t first = vgcm_block(i), lane = i - first, j = (size_t)c->p0[i];
    struct vgcm_motion m;
    struct vgcm_bond bond = {.law = l->law, .kn = l->f->kn[i], .ks = l->law->eta * l->f->kn[i]};
    brc_lanes sum[VGCM_N_MOTION] = {brc_lanes_all(0)}, none = brc_lanes_all(0);
    double area = l->p->area[j];
    vgcm_motion_of(&l->sim->bodies, c, first, l->sim->dt, &m);
    brc_set(l->f->n[i], m.n[0][lane], m.n[1][lane], m.n[2][lane]);
    brc_set(l->f->s[i], m.s[0][lane], m.s[1][lane], m.s[2][lane]);
    double du[3] = {m.du[VGCM_OPEN][lane], m.du[VGCM_S][lane], m.du[VGCM_T][lane]};
    struct vgcm_point q = {c->gap[i] - du[0], 0, l->p->fs[j], l->p->ft[j], 1, 0, 0};
    vgcm_law_step(&bond, flags & ~VGCM_BRITTLE, area, du, &q, energy);
    l->p->un[j] = q.un;
    l->p->fs[j] = q.fs;
    l->p->ft[j] = q.ft;
    vgcm_force_add(sum, brc_lanes_all(q.fn), brc_lanes_all(q.fs), brc_lanes_all(q.ft), none, none);
    if (flags & VGCM_VISCOUS) {
        brc_lanes drag[VGCM_N_MOTION] = {none};
        struct vgcm_point_lanes all = {.un = brc_lanes_all(q.un), .fn = brc_lanes_all(q.fn)};
        all.dn = brc_lanes_all(1);
        point_drag(drag, drag_of(l, first) * area, m.du, &all, none, none);
        add_drag(l, first, flags,
                 brc_lanes_first((int64_t)lane + 1) & ~brc_lanes_first((int64_t)lane), m.du, drag,
                 sum, viscous);
    }
    brc_lanes f[3], ta[3], tb[3];
    vgcm_force_of(f, ta, tb, &m, sum);
    brc_set(c->f[i], f[0][lane], f[1][lane], f[2][lane]);
    brc_set(c->ta[i], ta[0][lane], ta[1][lane], ta[2][lane]);
    brc_set(c->tb[i], tb[0][lane], tb[1][lane], tb[2][lane]);
    double k = c->gap[i] < 0 ? fmax(bond.kn, bond.ks) * area : 0;
    double h = m.h[lane], g = m.d[lane] - h;
    if ((k > 0) != (c->k[i][0] > 0)) {
        brc_set(c->k[i], k, k * h * h, k * g * g);
        c->k_version++;
    }
}

/* Two spheres without a bond: one point that is broken from the start, with the total overlap. */
static __attribute__((noinline)) void sphere_row(struct loop *l, size_t i, int flags,
                                                 struct booked *booked)
{
    struct brc_contacts *c = l->c;
    struct vgcm_energy energy = {0};
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
    sphere_forces(l, i, flags, &energy, &booked->viscous);
    booked->points.normal[0] += energy.normal;
    booked->points.shear[0] += energy.shear;
    booked->points.friction[0] += energy.friction;
}

/* ---- all rows ------------------------------------------------------------------------------ */

VGCM_INLINE void facet_rows(struct loop *l, size_t i, int flags, brc_mask facet, brc_mask affine,
                            struct booked *booked)
{
    struct vgcm_motion m;
    brc_lanes old[3], sum[VGCM_N_MOTION] = {brc_lanes_all(0)}, opening = brc_lanes_all(0);
    vgcm_motion_of(&l->sim->bodies, l->c, i, l->sim->dt, &m);
    brc_lanes_at3(old, l->f->n + i);
    for (int k = 0; k < 3; k++)
        old[k] = brc_lanes_pick(facet, m.n[k], old[k]);
    brc_lanes_put3(l->f->n + i, old);
    brc_lanes_at3(old, l->f->s + i);
    for (int k = 0; k < 3; k++)
        old[k] = brc_lanes_pick(facet, m.s[k], old[k]);
    brc_lanes_put3(l->f->s + i, old);
    if (brc_lanes_any(affine))
        affine = affine_rows(l, i, flags, affine, &m, sum, &opening, booked);
    brc_mask points = facet & ~affine;
    if (brc_lanes_any(points))
        points_rows(l, i, flags, points, &m, sum, &opening, booked);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        sum[k] = brc_lanes_where(facet, sum[k]);
    vgcm_force_apply(l->c, i, &m, sum);
    brc_lanes_put(l->c->gap + i, brc_lanes_pick(facet, opening, brc_lanes_at(l->c->gap + i)));
}

VGCM_INLINE void forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags)
{
    struct loop l = {.sim = sim,
                     .law = law,
                     .c = &sim->pairs,
                     .f = vgcm_columns(&sim->pairs),
                     .p = vgcm_point_columns(&sim->pairs)};
    struct booked booked = {.affine = brc_lanes_all(0)};
    for (size_t i = 0; i < l.c->n; i += BRC_LANES) {
        brc_mask inside = brc_lanes_first((int64_t)(l.c->n - i));
        brc_mask facet = inside & ~brc_lanes_equal(l.f->phase + i, VGCM_SPHERE);
        brc_mask affine = inside & brc_lanes_equal(l.f->phase + i, VGCM_AFFINE);
        if (brc_lanes_any(facet))
            facet_rows(&l, i, flags, facet, affine, &booked);
        if (brc_lanes_any(inside & ~facet))
            for (size_t k = i; k < i + BRC_LANES && k < l.c->n; k++)
                if (l.f->phase[k] == VGCM_SPHERE)
                    sphere_row(&l, k, flags, &booked);
    }
    if (flags & VGCM_LEDGER) {
        sim->ledger.bond += brc_lanes_sum(booked.points.bond) + brc_lanes_sum(booked.affine);
        sim->ledger.contact_normal += brc_lanes_sum(booked.points.normal);
        sim->ledger.contact_shear += brc_lanes_sum(booked.points.shear);
        sim->ledger.damage += brc_lanes_sum(booked.points.damage);
        sim->ledger.friction += brc_lanes_sum(booked.points.friction);
        sim->ledger.viscous += brc_lanes_sum(booked.viscous);
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
#undef LOOP

#define VGCM_FORCES_LOOPS                                                              \
    {                                                                                  \
        forces_0, forces_1, forces_2, forces_3, forces_4, forces_5, forces_6, forces_7 \
    }

#endif
