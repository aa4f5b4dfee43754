/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags. Facets are taken two
 * at a time, for the processor's pairs of doubles. */
#include "vgcm/contact.h"

struct loop {
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    struct vgcm_energy energy;
    vgcm_two stored; /* J, by affine contacts */
    double viscous;  /* J, dissipated by viscous forces */
};

/* Facet rows that wait to be done together. */
struct couple {
    size_t row[2];
    int n;
};

/* Viscosity per area of contact i, over dt: force = this times area times increment. */
static double drag_of(const struct loop *l, size_t i)
{
    const double *mass = l->sim->bodies.true_mass;
    double ma = mass[l->c->a[i]], mb = mass[l->c->b[i]], dt = l->sim->dt;
    if (dt == 0)
        return 0;
    return l->law->viscous * ma * mb / (ma + mb) / (l->f->moment[i][VGCM_A] * dt);
}

/* Adds the viscous part to the generalised force and its dissipation to the ledger. */
static void add_drag(struct loop *l, size_t i, int flags, const double du[VGCM_N_MOTION],
                     const double drag[VGCM_N_MOTION], double sum[VGCM_N_MOTION])
{
    double mean[VGCM_N_MOTION];
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (l->f->drag[i][k] + drag[k]);
        l->f->drag[i][k] = drag[k];
        sum[k] += drag[k];
    }
    if (flags & VGCM_LEDGER)
        l->viscous += vgcm_force_work(mean, du);
}

static void add_drag_affine(struct loop *l, const struct couple *rows, int flags,
                            const struct vgcm_motion_two *m, vgcm_two sum[VGCM_N_MOTION])
{
    vgcm_two moment[VGCM_N_MOMENTS], drag[VGCM_N_MOTION];
    size_t i = rows->row[0], j = rows->row[1];
    vgcm_two c = vgcm_two_of(drag_of(l, i), drag_of(l, j));
    vgcm_two_load6(moment, l->f->moment, i, j);
    vgcm_force_affine(drag, c, c, moment, m->du);
    for (int lane = 0; lane < rows->n; lane++) {
        double du[VGCM_N_MOTION], part[VGCM_N_MOTION], whole[VGCM_N_MOTION];
        for (int k = 0; k < VGCM_N_MOTION; k++) {
            du[k] = m->du[k][lane];
            part[k] = drag[k][lane];
            whole[k] = sum[k][lane];
        }
        add_drag(l, rows->row[lane], flags, du, part, whole);
        for (int k = 0; k < VGCM_N_MOTION; k++)
            sum[k][lane] = whole[k];
    }
}

/* Whether each point of row i stays within its strengths under the affine field u. */
static bool points_hold(const struct loop *l, size_t i, const double u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    double kn = l->f->kn[i], ks = law->eta * kn;
    for (size_t j = (size_t)l->c->p0[i], end = j + (size_t)l->c->np[i]; j < end; j++) {
        double at[3];
        vgcm_motion_at(at, u, l->p->s[j], l->p->t[j]);
        double limit = law->tau - law->mu * kn * at[0];
        if (kn * at[0] > law->sigma_t || limit < 0 ||
            ks * ks * (at[1] * at[1] + at[2] * at[2]) > limit * limit)
            return false;
    }
    return true;
}

/* Bounds over the facets first; a row that fails them is looked at point by point. */
VGCM_INLINE bool affine_holds(const struct loop *l, const struct couple *rows, vgcm_two kn,
                              const vgcm_two u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    vgcm_two rim = vgcm_two_of(l->f->rim[rows->row[0]], l->f->rim[rows->row[1]]);
    vgcm_two bend = vgcm_two_abs(u[VGCM_BEND_S]) + vgcm_two_abs(u[VGCM_BEND_T]);
    vgcm_two pull = kn * (u[VGCM_OPEN] + rim * bend), ks = law->eta * kn;
    vgcm_two left = law->tau - law->mu * pull - ks * rim * vgcm_two_abs(u[VGCM_TWIST]);
    vgcm_two slip2 = ks * ks * (u[VGCM_S] * u[VGCM_S] + u[VGCM_T] * u[VGCM_T]);
    for (int lane = 0; lane < rows->n; lane++) {
        if (pull[lane] <= law->sigma_t && left[lane] >= 0 && slip2[lane] <= left[lane] * left[lane])
            continue;
        double one[VGCM_N_MOTION];
        for (int k = 0; k < VGCM_N_MOTION; k++)
            one[k] = u[k][lane];
        if (!points_hold(l, rows->row[lane], one))
            return false;
    }
    return true;
}

/* Both rows as affine fields; false, with nothing changed, when a point leaves the elastic range.
 */
VGCM_INLINE bool affine_rows(struct loop *l, const struct couple *rows, int flags,
                             const struct vgcm_motion_two *m)
{
    size_t i = rows->row[0], j = rows->row[1];
    vgcm_two u[VGCM_N_MOTION], old[VGCM_N_MOTION], moment[VGCM_N_MOMENTS], sum[VGCM_N_MOTION];
    vgcm_two kn = vgcm_two_of(l->f->kn[i], l->f->kn[j]), ks = l->law->eta * kn;
    vgcm_two_load6(old, l->f->u, i, j);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        u[k] = old[k] + m->du[k]; /* eq:vgcm:14 */
    if (!affine_holds(l, rows, kn, u))
        return false;
    vgcm_two_load6(moment, l->f->moment, i, j);
    if (flags & VGCM_LEDGER) {
        for (int k = 0; k < VGCM_N_MOTION; k++)
            old[k] += 0.5 * m->du[k];
        vgcm_force_affine(sum, kn, ks, moment, old);
        vgcm_two work = vgcm_two_work(sum, m->du);
        l->stored += rows->n == 2 ? work : vgcm_two_of(work[0], 0);
    }
    vgcm_force_affine(sum, kn, ks, moment, u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_VISCOUS)
        add_drag_affine(l, rows, flags, m, sum);
    vgcm_force_apply_two(l->c, i, j, m, sum);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        l->f->u[j][k] = u[k][1];
        l->f->u[i][k] = u[k][0];
    }
    l->c->gap[j] = u[VGCM_OPEN][1];
    l->c->gap[i] = u[VGCM_OPEN][0];
    return true;
}

/* Gives each point its own state, that of the affine field so far. */
static __attribute__((noinline)) void leave_affine(struct loop *l, size_t i)
{
    double ks = l->law->eta * l->f->kn[i];
    for (size_t j = (size_t)l->c->p0[i], end = j + (size_t)l->c->np[i]; j < end; j++) {
        double at[3];
        vgcm_motion_at(at, l->f->u[i], l->p->s[j], l->p->t[j]);
        l->p->un[j] = at[0];
        l->p->fs[j] = -ks * l->p->area[j] * at[1];
        l->p->ft[j] = -ks * l->p->area[j] * at[2];
    }
    for (int k = 0; k < VGCM_N_MOTION; k++)
        l->f->u[i][k] = 0;
    l->f->phase[i] = VGCM_POINTS;
}

static __attribute__((noinline)) void add_event(struct loop *l, size_t i, size_t j,
                                                const struct vgcm_motion *m)
{
    const struct brc_contacts *c = l->c;
    struct brc_event event = {.a = c->a[i],
                              .b = c->b[i],
                              .facet = c->facet[i],
                              .point = (int32_t)(j - (size_t)c->p0[i]),
                              .mode =
                                  l->p->dn[j] >= l->p->ds[j] ? BRC_MODE_TENSION : BRC_MODE_SHEAR,
                              .area = l->p->area[j],
                              .energy = l->p->lost[j]};
    brc_copy(event.n, m->n);
    brc_copy(event.x, l->sim->bodies.x[c->a[i]]);
    brc_axpy(event.x, m->h, m->n);
    brc_axpy(event.x, l->p->s[j], m->s);
    brc_axpy(event.x, l->p->t[j], m->t);
    brc_events_add(l->sim->ctx, &l->sim->events, l->sim->step, &event);
}

/* Viscous force of one point. A broken point that is open has none, and one that is closed is never
 * pulled by it. */
static inline void point_drag(double drag[VGCM_N_MOTION], double c, const double du[3],
                              const struct vgcm_point *q, const double at[2])
{
    double fn = c * du[0];
    if (vgcm_law_damage(q) >= 1) {
        if (q->un >= 0)
            return;
        fn = fn < -q->fn ? fn : -q->fn;
    }
    vgcm_force_add(drag, fn, -c * du[1], -c * du[2], at);
}

/* What the points of a row add up to. */
struct row_sums {
    double force[VGCM_N_MOTION], drag[VGCM_N_MOTION];
    double opening; /* m, the smallest */
    int n_whole;    /* points that are not broken */
};

VGCM_INLINE void step_point(struct loop *l, size_t i, size_t j, int flags,
                            const struct vgcm_bond *bond, const struct vgcm_motion *m,
                            struct row_sums *sums)
{
    struct vgcm_points *p = l->p;
    double place[2] = {p->s[j], p->t[j]}, area = p->area[j], du[3];
    struct vgcm_point q = {p->un[j], 0, p->fs[j], p->ft[j], p->dn[j], p->ds[j], p->lost[j]};
    bool was_whole = vgcm_law_damage(&q) < 1;
    vgcm_motion_at(du, m->du, place[0], place[1]);
    vgcm_law_step(bond, flags, area, du, &q, &l->energy);
    bool is_whole = vgcm_law_damage(&q) < 1;
    p->un[j] = q.un;
    p->fs[j] = q.fs;
    p->ft[j] = q.ft;
    if (was_whole) {
        p->dn[j] = q.dn;
        p->ds[j] = q.ds;
        p->lost[j] = q.lost;
    }
    vgcm_force_add(sums->force, q.fn, q.fs, q.ft, place);
    if (flags & VGCM_VISCOUS)
        point_drag(sums->drag, drag_of(l, i) * area, du, &q, place);
    sums->opening = q.un < sums->opening ? q.un : sums->opening;
    sums->n_whole += is_whole;
    if (was_whole && !is_whole)
        add_event(l, i, j, m);
}

VGCM_INLINE void points_row(struct loop *l, size_t i, int flags, const struct vgcm_motion *m)
{
    struct vgcm_bond bond = vgcm_bond_of(l->law, l->f->kn[i]);
    struct row_sums sums = {.opening = HUGE_VAL};
    for (size_t j = (size_t)l->c->p0[i], end = j + (size_t)l->c->np[i]; j < end; j++)
        step_point(l, i, j, flags, &bond, m, &sums);
    if (flags & VGCM_VISCOUS)
        add_drag(l, i, flags, m->du, sums.drag, sums.force);
    vgcm_force_apply(l->c, i, m, sums.force);
    l->c->gap[i] = sums.opening;
    l->c->status[i] = sums.n_whole > 0 ? BRC_INTACT : BRC_BROKEN;
}

/* Two spheres without a bond: one point that is broken from the start, with the total overlap. */
static __attribute__((noinline)) void sphere_row(struct loop *l, size_t i, int flags)
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
    struct vgcm_motion m;
    struct row_sums sums = {0};
    struct vgcm_bond bond = {.law = l->law, .kn = l->f->kn[i], .ks = l->law->eta * l->f->kn[i]};
    size_t j = (size_t)c->p0[i];
    double area = l->p->area[j], place[2] = {0, 0};
    vgcm_motion_of(&l->sim->bodies, c, i, l->sim->dt, &m);
    brc_copy(l->f->n[i], m.n);
    brc_copy(l->f->s[i], m.s);
    double before = c->gap[i] - m.du[VGCM_OPEN];
    struct vgcm_point q = {before, 0, l->p->fs[j], l->p->ft[j], 1, 0, 0};
    vgcm_law_step(&bond, flags & ~VGCM_BRITTLE, area, m.du, &q, &l->energy);
    l->p->un[j] = q.un;
    l->p->fs[j] = q.fs;
    l->p->ft[j] = q.ft;
    vgcm_force_add(sums.force, q.fn, q.fs, q.ft, place);
    if (flags & VGCM_VISCOUS) {
        point_drag(sums.drag, drag_of(l, i) * area, m.du, &q, place);
        add_drag(l, i, flags, m.du, sums.drag, sums.force);
    }
    vgcm_force_apply(c, i, &m, sums.force);
    double k = c->gap[i] < 0 ? fmax(bond.kn, bond.ks) * area : 0, g = m.d - m.h;
    if ((k > 0) != (c->k[i][0] > 0)) {
        brc_set(c->k[i], k, k * m.h * m.h, k * g * g);
        c->k_version++;
    }
}

VGCM_INLINE void facet_row(struct loop *l, size_t i, int flags, const struct vgcm_motion_two *m,
                           int lane)
{
    struct couple alone = {{i, i}, 1};
    struct vgcm_motion_two twice;
    struct vgcm_motion one;
    vgcm_motion_pick(&one, m, lane);
    if (l->f->phase[i] == VGCM_AFFINE) {
        vgcm_motion_repeat(&twice, &one);
        if (affine_rows(l, &alone, flags, &twice))
            return;
        leave_affine(l, i);
    }
    points_row(l, i, flags, &one);
}

VGCM_INLINE void facet_rows(struct loop *l, struct couple *rows, int flags)
{
    size_t i = rows->row[0], j = rows->row[1];
    struct vgcm_motion_two m;
    vgcm_motion_of_two(&l->sim->bodies, l->c, i, j, l->sim->dt, &m);
    for (int k = 0; k < 3; k++) {
        l->f->n[j][k] = m.n[k][1];
        l->f->s[j][k] = m.s[k][1];
        l->f->n[i][k] = m.n[k][0];
        l->f->s[i][k] = m.s[k][0];
    }
    bool is_affine = l->f->phase[i] == VGCM_AFFINE && l->f->phase[j] == VGCM_AFFINE;
    if (!is_affine || !affine_rows(l, rows, flags, &m))
        for (int lane = 0; lane < rows->n; lane++)
            facet_row(l, rows->row[lane], flags, &m, lane);
    rows->n = 0;
}

VGCM_INLINE void forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags)
{
    struct loop l = {.sim = sim,
                     .law = law,
                     .c = &sim->pairs,
                     .f = vgcm_columns(&sim->pairs),
                     .p = vgcm_point_columns(&sim->pairs)};
    struct couple rows = {.n = 0};
    for (size_t i = 0; i < l.c->n; i++) {
        if (l.f->phase[i] == VGCM_SPHERE) {
            sphere_row(&l, i, flags);
            continue;
        }
        rows.row[rows.n++] = i;
        if (rows.n == 2)
            facet_rows(&l, &rows, flags);
    }
    if (rows.n == 1) {
        rows.row[1] = rows.row[0];
        facet_rows(&l, &rows, flags);
    }
    if (flags & VGCM_LEDGER) {
        sim->ledger.bond += l.energy.bond + l.stored[0] + l.stored[1];
        sim->ledger.contact_normal += l.energy.normal;
        sim->ledger.contact_shear += l.energy.shear;
        sim->ledger.damage += l.energy.damage;
        sim->ledger.friction += l.energy.friction;
        sim->ledger.viscous += l.viscous;
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

void (*const vgcm_forces_loops[VGCM_N_LOOPS])(struct brc_sim *, const struct vgcm_law *) = {
    forces_0, forces_1, forces_2, forces_3, forces_4, forces_5, forces_6, forces_7};
