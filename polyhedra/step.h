/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One row and one point at a time, for platens and for what is rare: forces of a point, work of a
 * row. Grain pairs have the same in lanes (kernels.h). */
#ifndef POLY_STEP_H
#define POLY_STEP_H

#include "poly.h"

/* Force on b and its moment about the centre of a. */
struct poly_wrench {
    double f[3], m[3];
};

/* Motion of a row in the step that has been made. */
struct poly_motion {
    const double *xa, *xb, *va, *vb, *wa, *wb;
    double x[3]; /* from a to b, now */
    double dt;
};

struct poly_spring_law {
    double kn, kt; /* N/m */
    double mu;
    double gn, gt; /* N s/m: viscosity x effective mass */
};

/* Of grain pairs, without viscosity. */
static inline struct poly_spring_law poly_pair_law(const struct brc_sim *sim)
{
    const struct poly_params *p = poly_params_of(sim);
    return (struct poly_spring_law){.kn = poly_pair_stiffness(p->kn, p->kn),
                                    .kt = poly_pair_stiffness(p->kt, p->kt),
                                    .mu = p->mu};
}

/* Sums over a row. */
struct poly_sums {
    struct poly_wrench normal, shear, viscous;
    double k[3];
    double gap;
};

static inline void poly_push(struct poly_wrench *w, const double f[3], const double arm[3])
{
    double m[3];
    brc_cross(m, arm, f);
    brc_add(w->f, w->f, f);
    brc_add(w->m, w->m, m);
}

static inline void poly_start_motion(struct poly_motion *m, const struct brc_sim *sim, int32_t a,
                                     int32_t b)
{
    const struct brc_bodies *bodies = &sim->bodies;
    *m = (struct poly_motion){.xa = bodies->x[a],
                              .xb = bodies->x[b],
                              .va = bodies->v[a],
                              .vb = bodies->v[b],
                              .wa = bodies->w[a],
                              .wb = bodies->w[b],
                              .dt = sim->dt};
    brc_sub(m->x, m->xb, m->xa);
}

/* Arm at the middle of the step of a point that is at r at its end. */
static inline void poly_middle_arm(double r[3], const double w[3], double dt)
{
    double turn[3];
    brc_cross(turn, w, r);
    brc_axpy(r, -0.5 * dt, turn);
}

/* Velocity of b relative to a at x. With the arms at the middle of the step, a pair that turns as
 * one body does not slip but for the third order of the step's angle. */
static inline void poly_slip(double u[3], const struct poly_motion *m, const double x[3])
{
    double ra[3], rb[3], ua[3], ub[3];
    brc_sub(ra, x, m->xa);
    brc_sub(rb, x, m->xb);
    poly_middle_arm(ra, m->wa, m->dt);
    poly_middle_arm(rb, m->wb, m->dt);
    brc_point_velocity(ua, m->va, m->wa, ra);
    brc_point_velocity(ub, m->vb, m->wb, rb);
    brc_sub(u, ub, ua);
}

/* Power of force and moments of a wrench on both bodies, for the offset x of the centres. */
static inline double poly_power(const double w[6], const struct poly_motion *m, const double x[3])
{
    double du[3], tb[3];
    brc_sub(du, m->vb, m->va);
    brc_cross(tb, x, w);
    brc_sub(tb, w + 3, tb);
    return brc_dot(w, du) - brc_dot(w + 3, m->wa) + brc_dot(tb, m->wb);
}

/* Work taken up by the source of a wrench over the step, by the trapezoid rule of ledger.h; the
 * wrench becomes the old one. */
static inline double poly_work(double old[6], const struct poly_wrench *w,
                               const struct poly_motion *m)
{
    double now[6], x_old[3];
    for (int k = 0; k < 3; k++) {
        now[k] = w->f[k];
        now[3 + k] = w->m[k];
        x_old[k] = m->x[k] - (m->vb[k] - m->va[k]) * m->dt;
    }
    double work = -0.5 * m->dt * (poly_power(old, m, x_old) + poly_power(now, m, m->x));
    for (int k = 0; k < 6; k++)
        old[k] = now[k];
    return work;
}

/* Elastic normal force of a touch (eq 4), with the gradient part under `merged`. */
static inline void poly_push_normal(struct poly_sums *s, const struct poly_touch *t, double kn,
                                    const double arm[3])
{
    double f[3];
    brc_scale(f, t->n, kn * t->weight * t->delta); /* eq:gt12:4 */
    if (t->graded) {
        double grade = -0.5 * kn * t->delta * t->delta;
        brc_axpy(f, grade, t->g);
        brc_axpy(s->normal.m, grade, t->c);
    }
    poly_push(&s->normal, f, arm);
}

/* Tangential spring of a point (eqs 8-9): xi and the normal of the last step become those of now.
 */
static inline void poly_push_shear(struct brc_ledger *ledger, struct poly_sums *s,
                                   const struct poly_touch *t, const struct poly_spring_law *law,
                                   const struct poly_motion *m, const double u[3], double xi[3],
                                   const double n_old[3], double weight_old, const double arm[3])
{
    double du[3], f[3], before[3] = {0, 0, 0};
    brc_scale(du, u, m->dt);
    if (weight_old > 0) {
        double spin[3];
        brc_add(spin, m->wa, m->wb);
        poly_turn(xi, n_old, t->n, 0.5 * m->dt * brc_dot(spin, t->n));
        brc_copy(before, xi);
    } else {
        brc_set(xi, 0, 0, 0);
    }
    poly_slide(xi, t->n, du, law->mu * law->kn * t->delta / law->kt);
    brc_scale(f, xi, -t->weight * law->kt); /* eq:gt12:8 */
    poly_push(&s->shear, f, arm);
    if (ledger == NULL)
        return;
    double work = 0,
           stored = 0.5 * law->kt * (t->weight * brc_norm2(xi) - weight_old * brc_norm2(before));
    for (int k = 0; k < 3; k++)
        work += 0.5 * law->kt * (weight_old * before[k] + t->weight * xi[k]) *
                (du[k] - brc_dot(du, t->n) * t->n[k]);
    ledger->contact_shear += stored;
    ledger->friction += work - stored;
}

/* A point that has come apart forgets xi; what its spring held has become friction. */
static inline void poly_release(struct brc_ledger *ledger, const struct poly_spring_law *law,
                                const struct poly_motion *m, double xi[3], double weight)
{
    if (ledger != NULL) {
        double x[3], u[3], stored = 0.5 * law->kt * weight * brc_norm2(xi);
        for (int k = 0; k < 3; k++)
            x[k] = 0.5 * (m->xa[k] + m->xb[k]);
        poly_slip(u, m, x);
        ledger->contact_shear -= stored;
        ledger->friction += stored + 0.5 * law->kt * weight * m->dt * brc_dot(xi, u);
    }
    brc_set(xi, 0, 0, 0);
}

static inline void poly_push_viscous(struct poly_sums *s, const struct poly_touch *t,
                                     const struct poly_spring_law *law, const double u[3],
                                     const double arm[3])
{
    double f[3];
    poly_viscous(f, t->n, u, t->weight * law->gn, t->weight * law->gt,
                 law->kn * t->weight * t->delta);
    poly_push(&s->viscous, f, arm);
}

/* The stiffness of a spring at x for mass scaling and the time step. */
static inline void poly_stiffen(double k[3], double stiffness, const double arm[3],
                                const double x[3])
{
    double rb[3];
    brc_sub(rb, arm, x);
    k[0] += stiffness;
    k[1] += stiffness * brc_norm2(arm);
    k[2] += stiffness * brc_norm2(rb);
}

/* Forces of an active point p into the sums. */
static inline void poly_act(struct brc_ledger *ledger, struct poly_sums *s,
                            const struct poly_touch *t, const struct poly_spring_law *law,
                            const struct poly_motion *m, const struct poly_points *points, size_t p,
                            const bool friction, const bool viscous)
{
    double arm[3], u[3];
    brc_sub(arm, t->x, m->xa);
    poly_push_normal(s, t, law->kn, arm);
    poly_stiffen(s->k, friction ? poly_most(law->kn, law->kt) : law->kn, arm, m->x);
    if (friction || viscous)
        poly_slip(u, m, t->x);
    if (friction) {
        poly_push_shear(ledger, s, t, law, m, u, poly_xi(points, p), poly_normal(points, p),
                        *poly_weight(points, p), arm);
        brc_copy(poly_normal(points, p), t->n);
    }
    if (viscous)
        poly_push_viscous(s, t, law, u, arm);
    *poly_weight(points, p) = t->weight;
}

/* Forces and moments of a row from its sums. */
static inline void poly_finish_row(struct brc_contacts *c, size_t row, const struct poly_sums *s,
                                   const struct poly_wrench *bond, const struct poly_motion *m)
{
    double lever[3];
    for (int k = 0; k < 3; k++) {
        c->f[row][k] = bond->f[k] + s->normal.f[k] + s->shear.f[k] + s->viscous.f[k];
        c->ta[row][k] = -(bond->m[k] + s->normal.m[k] + s->shear.m[k] + s->viscous.m[k]);
    }
    brc_cross(lever, m->x, c->f[row]);
    for (int k = 0; k < 3; k++)
        c->tb[row][k] = -c->ta[row][k] - lever[k];
    c->gap[row] = s->gap;
}

/* Room above the moments of stiffness, so that turning arms do not count as changes. */
#define POLY_K_ROOM 1.02

/* Stiffness of a row: k_version changes when it grows, or has fallen for good. */
static inline void poly_store_k(struct brc_contacts *c, size_t row, const double k[3])
{
    double *old = c->k[row];
    bool same = k[0] == old[0];
    for (int i = 1; i < 3; i++)
        same = same && k[i] <= old[i] && k[i] * POLY_K_ROOM * POLY_K_ROOM >= old[i];
    if (same)
        return;
    brc_set(old, k[0], k[1] * POLY_K_ROOM, k[2] * POLY_K_ROOM);
    c->k_version++;
}

/* True when the travel of a row's bodies calls for a new list. */
static inline bool poly_is_awake(const struct brc_sim *sim, const struct brc_contacts *c,
                                 size_t row)
{
    const struct poly_rows *rows = c->model_columns;
    return sim->bodies.path_length[c->a[row]] + sim->bodies.path_length[c->b[row]] >=
           rows->wake[row];
}

/* A row without bond and listed features, which had no spring in the last step either: its forces
 * and works are zero already. */
static inline bool poly_is_idle(const struct brc_contacts *c, size_t row)
{
    return c->np[row] == 0 && c->status[row] != BRC_INTACT && c->k[row][0] == 0;
}

/* Work of the row's forces into the ledger. */
static inline void poly_account(struct brc_ledger *ledger, const struct poly_rows *rows, size_t row,
                                const struct poly_sums *s, const struct poly_wrench *bond,
                                const struct poly_motion *m, const bool viscous)
{
    ledger->contact_normal += poly_work(rows->normal_old[row], &s->normal, m);
    ledger->bond += poly_work(rows->bond_old[row], bond, m);
    if (viscous)
        ledger->viscous += poly_work(rows->viscous_old[row], &s->viscous, m);
}

/* Constants of the bond of a row. */
static inline struct poly_bond poly_bond_of(const struct poly_params *p,
                                            const struct poly_rows *rows, size_t row)
{
    double stiff = *poly_bond_area(rows, row) / *poly_bond_length(rows, row);
    double arm = p->torsion_length > 0 ? p->torsion_length : *poly_bond_length(rows, row);
    return (struct poly_bond){.kn = p->bn * stiff,
                              .kt = p->bt * stiff,
                              .ktheta = p->torsion ? p->bm * *poly_bond_area(rows, row) * arm : 0,
                              .length = *poly_bond_length(rows, row),
                              .eps_th = p->eps_th,
                              .theta_th = p->theta_limit ? p->theta_th : HUGE_VAL};
}

/* Force and stiffness of an intact bond into wrench and k. */
static inline void poly_push_bond(struct poly_wrench *w, double k[3],
                                  const struct poly_bond_result *r, const struct poly_bond *bond,
                                  const struct poly_motion *m)
{
    double arm[3];
    brc_sub(arm, r->x, m->xa);
    poly_push(w, r->f, arm);
    brc_axpy(w->m, r->m, r->n);
    poly_stiffen(k, poly_most(bond->kn, bond->kt), arm, m->x);
    k[1] += bond->ktheta;
    k[2] += bond->ktheta;
}

#endif
