/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over the contacts of grains: one body, called with literal flags. */
#include "vgcm/contact.h"

struct loop {
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    struct vgcm_energy energy;
    double viscous; /* J, dissipated by viscous forces */
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
static inline void add_drag(struct loop *l, size_t i, int flags, const double du[VGCM_N_MOTION],
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

/* Whether every point stays within its strengths under the affine field u: first by bounds over the
 * facet, then point by point. */
static inline bool affine_holds(const struct loop *l, size_t i, const double u[VGCM_N_MOTION])
{
    const struct vgcm_law *law = l->law;
    double kn = l->f->kn[i], ks = law->eta * kn, rim = l->f->rim[i];
    double bend = sqrt(u[VGCM_BEND_S] * u[VGCM_BEND_S] + u[VGCM_BEND_T] * u[VGCM_BEND_T]);
    double slip = sqrt(u[VGCM_S] * u[VGCM_S] + u[VGCM_T] * u[VGCM_T]);
    double pull = kn * (u[VGCM_OPEN] + rim * bend);
    double shear = ks * (slip + rim * fabs(u[VGCM_TWIST]));
    if (pull <= law->sigma_t && shear <= law->tau - law->mu * pull)
        return true;
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

static inline bool affine_row(struct loop *l, size_t i, int flags, const struct vgcm_motion *m)
{
    double u[VGCM_N_MOTION], middle[VGCM_N_MOTION], sum[VGCM_N_MOTION];
    double kn = l->f->kn[i], ks = l->law->eta * kn;
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        u[k] = l->f->u[i][k] + m->du[k]; /* eq:vgcm:14 */
        middle[k] = l->f->u[i][k] + 0.5 * m->du[k];
    }
    if (!affine_holds(l, i, u))
        return false;
    if (flags & VGCM_LEDGER) {
        vgcm_force_affine(sum, kn, ks, l->f->moment[i], middle);
        l->energy.bond += vgcm_force_work(sum, m->du);
    }
    vgcm_force_affine(sum, kn, ks, l->f->moment[i], u); /* eq:vgcm:15 eq:vgcm:17 */
    if (flags & VGCM_VISCOUS) {
        double drag[VGCM_N_MOTION], c = drag_of(l, i);
        vgcm_force_affine(drag, c, c, l->f->moment[i], m->du);
        add_drag(l, i, flags, m->du, drag, sum);
    }
    vgcm_force_apply(l->c, i, m, sum);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        l->f->u[i][k] = u[k];
    l->c->gap[i] = u[VGCM_OPEN];
    return true;
}

/* Gives each point its own state, that of the affine field so far. */
static void leave_affine(struct loop *l, size_t i)
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

static void add_event(struct loop *l, size_t i, size_t j, const struct vgcm_motion *m)
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
    double area, moment; /* of the springs that count: for the stable step */
    double opening;      /* m, the smallest */
    int n_whole;         /* points that are not broken */
};

static inline void step_point(struct loop *l, size_t i, size_t j, int flags,
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
    if (is_whole || q.un < bond->u0) {
        sums->area += area;
        sums->moment += area * (place[0] * place[0] + place[1] * place[1]);
    }
    sums->opening = q.un < sums->opening ? q.un : sums->opening;
    sums->n_whole += is_whole;
    if (was_whole && !is_whole)
        add_event(l, i, j, m);
}

/* Stiffness sums of row i, written when they have changed. */
static void set_stiffness(struct loop *l, size_t i, const struct vgcm_motion *m, double area,
                          double moment)
{
    double kn = l->f->kn[i], k = kn > l->law->eta * kn ? kn : l->law->eta * kn;
    double h = m->h, g = m->d - m->h;
    if (l->c->k[i][0] == k * area)
        return;
    brc_set(l->c->k[i], k * area, k * (area * h * h + moment), k * (area * g * g + moment));
    l->c->k_version++;
}

static inline void points_row(struct loop *l, size_t i, int flags, const struct vgcm_motion *m)
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
    set_stiffness(l, i, m, sums.area, sums.moment);
}

/* Two spheres without a bond: one point that is broken from the start, with the total overlap. */
static void sphere_row(struct loop *l, size_t i, int flags)
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
    set_stiffness(l, i, &m, c->gap[i] < 0 ? area : 0, 0);
}

static inline __attribute__((always_inline)) void
forces_loop(struct brc_sim *sim, const struct vgcm_law *law, const int flags)
{
    struct loop l = {.sim = sim,
                     .law = law,
                     .c = &sim->pairs,
                     .f = vgcm_columns(&sim->pairs),
                     .p = vgcm_point_columns(&sim->pairs)};
    struct vgcm_motion m;
    for (size_t i = 0; i < l.c->n; i++) {
        if (l.f->phase[i] == VGCM_SPHERE) {
            sphere_row(&l, i, flags);
            continue;
        }
        vgcm_motion_of(&sim->bodies, l.c, i, sim->dt, &m);
        brc_copy(l.f->n[i], m.n);
        brc_copy(l.f->s[i], m.s);
        if (l.f->phase[i] == VGCM_AFFINE) {
            if (affine_row(&l, i, flags, &m))
                continue;
            leave_affine(&l, i);
        }
        points_row(&l, i, flags, &m);
    }
    if (flags & VGCM_LEDGER) {
        sim->ledger.bond += l.energy.bond;
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
