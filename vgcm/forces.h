/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags, and compiled for each
 * instruction set by the files that include this one. Rows are taken four at a time. */
#ifndef VGCM_FORCES_H
#define VGCM_FORCES_H

#include "vgcm/hold.h"

#include <string.h>

/* ---- affine rows --------------------------------------------------------------------------- */

/* Whether each point of row i stays within its strengths under the affine field u. */
static bool points_hold(const struct loop *l, size_t i, const double u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    double kn = l->f->kn[i], ks = law->eta * kn;
    brc_wide field[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++)
        field[k] = brc_wide_all(u[k]);
    for (int32_t k = 0; k < l->c->np[i]; k += BRC_WIDE) {
        size_t j = (size_t)(l->c->p0[i] + k);
        brc_wide at[3];
        vgcm_motion_at(at, field, brc_wide_at(l->p->s + j), brc_wide_at(l->p->t + j));
        brc_wide limit = law->tau - law->mu * kn * at[0];
        brc_wide_mask fails =
            brc_wide_less(brc_wide_all(law->sigma_t), kn * at[0]) |
            brc_wide_less(limit, brc_wide_all(0)) |
            brc_wide_less(limit * limit, ks * ks * (at[1] * at[1] + at[2] * at[2]));
        if (brc_wide_any(brc_wide_both(fails, brc_wide_first(l->c->np[i] - k))))
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

/* Generalised forces of the rows of the mask as affine fields. */
VGCM_INLINE void affine_forces(struct loop *l, size_t i, int flags, brc_mask rows,
                               const struct vgcm_motion *m, const brc_lanes u[VGCM_N_MOTION],
                               brc_lanes sum[VGCM_N_MOTION], struct booked *booked)
{
    brc_lanes middle[VGCM_N_MOTION], moment[VGCM_N_MOMENTS];
    brc_lanes kn = brc_lanes_at(l->f->kn + i), ks = l->law->eta * kn;
    brc_lanes_at6(moment, l->f->moment + i);
    if (flags & VGCM_LEDGER) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            middle[k] = u[k] - 0.5 * m->du[k];
        vgcm_force_affine(sum, kn, ks, moment, middle);
        booked->affine += brc_lanes_where(rows, vgcm_force_work(sum, m->du));
    }
    vgcm_force_affine(sum, kn, ks, moment, u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_VISCOUS) {
        brc_lanes drag[VGCM_N_MOTION], c = drag_of(l, i);
        vgcm_force_affine(drag, c, c, moment, m->du);
        add_drag(l, i, flags, rows, m->du, drag, sum, &booked->viscous);
    }
}

/* The rows of the mask that stay affine, with their forces; those in which a point leaves the
 * elastic range become rows of points. */
VGCM_INLINE brc_mask affine_rows(struct loop *l, size_t i, int flags, brc_mask rows,
                                 struct block *b, struct booked *booked)
{
    brc_mask fails = affine_fails(l, i, rows, brc_lanes_at(l->f->kn + i), b->u);
    if (brc_lanes_any(fails)) {
        for (int k = 0; k < BRC_LANES; k++)
            if (fails[k])
                l->f->phase[i + (size_t)k] = VGCM_POINTS;
        rows &= ~fails;
    }
    affine_forces(l, i, flags, rows, &b->m, b->u, b->sum, booked);
    return rows;
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
    struct vgcm_point q = vgcm_point_at(l->p, j, c->gap[i] - du[0], bond.ks * area);
    vgcm_law_rub(&bond, area, du, &q, energy);
    vgcm_point_put(l->p, j, bond.ks * area, &q);
    sum[VGCM_OPEN] = brc_lanes_all(q.fn);
    sum[VGCM_S] = brc_lanes_all(q.fs);
    sum[VGCM_T] = brc_lanes_all(q.ft);
    if (flags & VGCM_VISCOUS) {
        brc_lanes drag[VGCM_N_MOTION] = {none}, c_area = drag_of(l, first) * area;
        brc_mask closed = brc_lanes_less(brc_lanes_all(q.un), none);
        brc_lanes pull = brc_lanes_min(c_area * m.du[VGCM_OPEN], brc_lanes_all(-q.fn));
        drag[VGCM_OPEN] = brc_lanes_where(closed, pull);
        drag[VGCM_S] = brc_lanes_where(closed, -c_area * m.du[VGCM_S]);
        drag[VGCM_T] = brc_lanes_where(closed, -c_area * m.du[VGCM_T]);
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
    sphere_forces(l, i, flags, &booked->spheres, &booked->viscous);
}

/* ---- all rows ------------------------------------------------------------------------------ */

/* The fields of the facets after the step, and their frames. */
VGCM_INLINE void move_facets(const struct loop *l, size_t i, brc_mask facet,
                             const struct vgcm_motion *m, brc_lanes u[VGCM_N_MOTION])
{
    brc_lanes old[3];
    brc_lanes_at3(old, l->f->n + i);
    for (int k = 0; k < 3; k++)
        old[k] = brc_lanes_pick(facet, m->n[k], old[k]);
    brc_lanes_put3(l->f->n + i, old);
    brc_lanes_at3(old, l->f->s + i);
    for (int k = 0; k < 3; k++)
        old[k] = brc_lanes_pick(facet, m->s[k], old[k]);
    brc_lanes_put3(l->f->s + i, old);
    brc_lanes_at6(u, l->f->u + i);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] += brc_lanes_where(facet, m->du[k]); /* eq:vgcm:14 */
    brc_lanes_put6(l->f->u + i, u);
}

VGCM_INLINE void fetch_lines(const void *at, size_t size)
{
    for (size_t k = 0; k < size; k += 64)
        __builtin_prefetch((const char *)at + k);
}

/* Asks for what the rows AHEAD of row i will want: with points they have more columns than machines
 * follow by themselves. What tells where the points are is wanted twice as early. */
VGCM_INLINE void fetch_ahead(const struct loop *l, size_t i)
{
    const struct brc_contacts *c = l->c;
    const struct vgcm_contacts *f = l->f;
    const struct vgcm_points *p = l->p;
    size_t k = i + AHEAD, far = k + AHEAD;
    if (far + BRC_LANES > c->n || !brc_lanes_any(brc_lanes_equal(f->phase + k, VGCM_POINTS)))
        return;
    const int32_t *const numbers[] = {c->a, c->b, c->p0, c->np};
    const double *const scalars[] = {f->kn, f->plane, f->rim, c->gap};
    double(*const vectors[])[3] = {f->n, f->s, c->f, c->ta, c->tb};
    const double *const places[] = {p->s,  p->t,      p->area,   p->dn,
                                    p->ds, p->slip_s, p->slip_t, p->lost};
    for (int m = 0; m < 4; m++)
        fetch_lines(numbers[m] + far, BRC_LANES * sizeof(int32_t));
    fetch_lines(f->slack + far, BRC_LANES * sizeof(double));
    for (int m = 0; m < 4; m++)
        fetch_lines(scalars[m] + k, BRC_LANES * sizeof(double));
    for (int m = 0; m < 5; m++)
        fetch_lines(vectors[m] + k, BRC_LANES * sizeof *vectors[m]);
    fetch_lines(f->u + k, BRC_LANES * sizeof *f->u);
    fetch_lines(f->moment + k, BRC_LANES * sizeof *f->moment);
    for (size_t row = k; row < k + BRC_LANES; row++) {
        if (f->phase[row] != VGCM_POINTS)
            continue;
        if (f->slack[row] > 0 && c->status[row] != BRC_BROKEN)
            fetch_lines(f->held[row], sizeof f->held[row]);
        for (int m = 0; f->slack[row] == 0 && m < 8; m++)
            fetch_lines(places[m] + c->p0[row], BRC_EIGHT * sizeof(double));
    }
}

/* Moves a block of rows, and forms the forces of its affine ones. */
VGCM_INLINE void begin_block(struct loop *l, size_t i, int flags, brc_mask facet, brc_mask affine,
                             struct batch *batch, struct booked *booked)
{
    struct block *b = &batch->block[batch->n_blocks++];
    b->i = i;
    b->facet = facet;
    vgcm_motion_of(&l->sim->bodies, l->c, i, l->sim->dt, &b->m);
    move_facets(l, i, facet, &b->m, b->u);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        b->sum[k] = brc_lanes_all(0);
    if (brc_lanes_any(affine))
        affine = affine_rows(l, i, flags, affine, b, booked);
    b->points = facet & ~affine;
    if (!(flags & VGCM_VISCOUS) && brc_lanes_any(b->points))
        b->points &= ~resting_rows(l, i, flags, b, booked);
    if (brc_lanes_any(b->points))
        list_items(l, flags, batch, b, booked);
}

/* Four rows that are affine and stay so, from end to end; false where one does not, with nothing
 * done. */
VGCM_INLINE bool affine_block(struct loop *l, size_t i, int flags, struct booked *booked)
{
    const brc_mask all = {-1, -1, -1, -1};
    struct vgcm_motion m;
    brc_lanes u[VGCM_N_MOTION], sum[VGCM_N_MOTION];
    vgcm_motion_of(&l->sim->bodies, l->c, i, l->sim->dt, &m);
    brc_lanes_at6(u, l->f->u + i);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] += m.du[k]; /* eq:vgcm:14 */
    if (brc_lanes_any(affine_fails(l, i, all, brc_lanes_at(l->f->kn + i), u)))
        return false;
    brc_lanes_put3(l->f->n + i, m.n);
    brc_lanes_put3(l->f->s + i, m.s);
    brc_lanes_put6(l->f->u + i, u);
    brc_lanes_put(l->c->gap + i, u[VGCM_OPEN]);
    affine_forces(l, i, flags, all, &m, u, sum, booked);
    vgcm_force_apply(l->c, i, &m, sum);
    return true;
}

VGCM_INLINE void finish_block(struct loop *l, int flags, struct block *b, struct booked *booked)
{
    double *gap = l->c->gap + b->i;
    if (brc_lanes_any(b->points)) {
        sum_points(l, flags, b, booked);
        if (!(flags & VGCM_VISCOUS))
            hold_rows(l, flags, b);
    }
    for (int k = 0; k < VGCM_N_MOTION; k++)
        b->sum[k] = brc_lanes_where(b->facet, b->sum[k]);
    vgcm_force_apply(l->c, b->i, &b->m, b->sum);
    brc_lanes_put(gap, brc_lanes_pick(b->facet, b->u[VGCM_OPEN], brc_lanes_at(gap)));
}

VGCM_INLINE void finish_batch(struct loop *l, int flags, struct batch *batch, struct booked *booked)
{
    if (batch->n_items > 0)
        l->items(l, batch, booked);
    for (int k = 0; k < batch->n_blocks; k++)
        finish_block(l, flags, &batch->block[k], booked);
    batch->n_blocks = 0;
}

VGCM_INLINE bool are_affine(const struct loop *l, size_t i)
{
    static const uint8_t affine[BRC_LANES] = {VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE, VGCM_AFFINE};
    return i + BRC_LANES <= l->c->n && memcmp(l->f->phase + i, affine, sizeof affine) == 0;
}

/* One term of the points' energies. */
VGCM_INLINE double booked_of(const struct booked *booked, size_t term)
{
    brc_wide halves[BRC_HALVES];
    for (int k = 0; k < BRC_HALVES; k++)
        halves[k] = *(const brc_wide *)((const char *)&booked->points[k] + term);
    return brc_lanes_sum(brc_wide_fold(halves, 1));
}

#define POINTS(term) booked_of(&booked, offsetof(struct vgcm_energy_wide, term))

VGCM_INLINE void forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags,
                             void (*items)(struct loop *, struct batch *, struct booked *))
{
    struct loop l = {.sim = sim,
                     .items = items,
                     .law = law,
                     .c = &sim->pairs,
                     .f = vgcm_columns(&sim->pairs),
                     .p = vgcm_point_columns(&sim->pairs)};
    struct booked booked = {.spheres = {0}};
    struct batch batch;
    bool has_spheres = false;
    batch.n_blocks = batch.n_items = 0;
    for (size_t i = 0; i < l.c->n; i += BRC_LANES) {
        fetch_ahead(&l, i);
        if (are_affine(&l, i) && affine_block(&l, i, flags, &booked))
            continue;
        brc_mask inside = brc_lanes_first((int64_t)(l.c->n - i));
        brc_mask facet = inside & ~brc_lanes_equal(l.f->phase + i, VGCM_SPHERE);
        brc_mask affine = inside & brc_lanes_equal(l.f->phase + i, VGCM_AFFINE);
        if (brc_lanes_any(facet))
            begin_block(&l, i, flags, facet, affine, &batch, &booked);
        has_spheres |= brc_lanes_any(inside & ~facet);
        if (batch.n_blocks == BLOCKS)
            finish_batch(&l, flags, &batch, &booked);
    }
    finish_batch(&l, flags, &batch, &booked);
    for (size_t i = 0; has_spheres && i < l.c->n; i++)
        if (l.f->phase[i] == VGCM_SPHERE)
            sphere_row(&l, i, flags, &booked);
    if (flags & VGCM_LEDGER) {
        const struct vgcm_energy *spheres = &booked.spheres;
        sim->ledger.bond += POINTS(bond) + brc_lanes_sum(booked.affine);
        sim->ledger.contact_normal += POINTS(normal) + spheres->normal;
        sim->ledger.contact_shear += POINTS(shear) + spheres->shear;
        sim->ledger.damage += POINTS(damage);
        sim->ledger.friction += POINTS(friction) + spheres->friction;
        sim->ledger.viscous += brc_lanes_sum(booked.viscous);
    }
}

#undef POINTS
#define LOOP(n)                                                                          \
    static __attribute__((noinline)) void items_##n(struct loop *l, struct batch *batch, \
                                                    struct booked *booked)               \
    {                                                                                    \
        step_items(l, n, batch, booked);                                                 \
    }                                                                                    \
    static void forces_##n(struct brc_sim *sim, const struct vgcm_law *law)              \
    {                                                                                    \
        forces_loop(sim, law, n, items_##n);                                             \
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
