/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the loop over grain pairs does four at a time. Each kernel is written once, with constant
 * options, and compiled for each instruction set by the files that include this one. */
#ifndef POLY_KERNELS_H
#define POLY_KERNELS_H

#include "polyhedra/listing.h"

#include <string.h>

/* --- rows: motion and bonds ------------------------------------------------------------------- */

/* The rows of a group, as gathers want them. */
struct numbers {
    int32_t row[BRC_LANES], a[BRC_LANES], b[BRC_LANES];
};

BRC_LANES_INLINE void numbers_of(struct numbers *i, const struct poly_block *block, int32_t group)
{
    memcpy(i->row, block->row + BRC_LANES * group, sizeof i->row);
    memcpy(i->a, block->a + BRC_LANES * group, sizeof i->a);
    memcpy(i->b, block->b + BRC_LANES * group, sizeof i->b);
}

/* r += s (w x (w x a)) */
BRC_LANES_INLINE void add_double_cross(brc_lanes r[3], brc_lanes s, const brc_lanes w[3],
                                       const brc_lanes a[3])
{
    brc_lanes c[3];
    brc_lanes_cross(c, w, a);
    brc_lanes_cross(c, w, c);
    axpy(r, s, c);
}

/* Velocity of b relative to a with arms at the middle of the step, so that a pair that turns as one
 * body does not slip but for the third order of the step's angle: for an arm r from a,
 * dv + (wb - h wb wb)(r - x) - (wa - h wa wa) r, with cross products for products and h = dt / 2.
 */
BRC_LANES_INLINE void slip_of_row(struct poly_row_group *g, double dt)
{
    const brc_lanes *wa = g->wa, *wb = g->wb, h = brc_lanes_all(0.5 * dt);
    brc_lanes dw[3], c[3];
    brc_lanes_cross(c, wb, g->x);
    sub(g->slip, g->dv, c);
    add_double_cross(g->slip, h, wb, g->x);
    sub(dw, wb, wa);
    brc_lanes widen = h * (brc_lanes_dot(wb, wb) - brc_lanes_dot(wa, wa));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            g->slope[i][j] = -h * (wb[i] * wb[j] - wa[i] * wa[j]);
        g->slope[i][i] += widen;
        g->slope[i][(i + 1) % 3] -= dw[(i + 2) % 3];
        g->slope[i][(i + 2) % 3] += dw[(i + 1) % 3];
        g->turn[i] = brc_lanes_all(0.25 * dt) * (wa[i] + wb[i]);
    }
}

/* Bound of the path that points of b have made in the frame of a in this step. Motions that both
 * share, turns included, do not count; the last term is of second order in the turn. a's vertices
 * near b move with it too, so its reach is taken larger by the range of a contact. */
BRC_LANES_INLINE brc_lanes relative_path(const struct poly_row_group *g, const brc_lanes reach_a,
                                         const brc_lanes reach_b, double dt)
{
    brc_lanes u[3], dw[3];
    brc_lanes_cross(u, g->x, g->wa);
    add(u, u, g->dv);
    sub(dw, g->wb, g->wa);
    brc_lanes speed =
        brc_lanes_sqrt(brc_lanes_dot(u, u)) + reach_b * brc_lanes_sqrt(brc_lanes_dot(dw, dw));
    return 1.1 * dt * speed + dt * dt * brc_lanes_dot(g->wa, g->wa) * (reach_a + 2 * reach_b);
}

BRC_LANES_INLINE void motion_of_group(struct poly_block *block, struct poly_row_group *g,
                                      const struct numbers *i)
{
    const struct brc_bodies *bodies = &block->sim->bodies;
    brc_lanes xb[3], va[3], vb[3];
    brc_lanes_gather3(g->xa, bodies->x, i->a);
    brc_lanes_gather3(xb, bodies->x, i->b);
    brc_lanes_gather3(va, bodies->v, i->a);
    brc_lanes_gather3(vb, bodies->v, i->b);
    brc_lanes_gather3(g->wa, bodies->w, i->a);
    brc_lanes_gather3(g->wb, bodies->w, i->b);
    sub(g->x, xb, g->xa);
    sub(g->dv, vb, va);
    slip_of_row(g, block->sim->dt);
    g->path = relative_path(g, gather(bodies->reach, i->a),
                            gather(bodies->reach, i->b) + block->rest, block->sim->dt);
}

/* Constants of the bonds of four rows, as poly_bond_of; zero stiffness where there is none. */
struct bonds {
    brc_lanes kn, kt, ktheta, length;
    brc_mask intact;
};

BRC_LANES_INLINE void bonds_of_group(struct bonds *bonds, const struct poly_block *block,
                                     const struct numbers *i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    const uint8_t status[BRC_LANES] = {c->status[i->row[0]], c->status[i->row[1]],
                                       c->status[i->row[2]], c->status[i->row[3]]};
    bonds->intact = brc_lanes_equal(status, BRC_INTACT);
    brc_lanes area = gather(rows->area, i->row), length = gather(rows->length, i->row);
    brc_lanes stiff = brc_lanes_where(bonds->intact, area / length);
    brc_lanes arm = p->torsion_length > 0 ? brc_lanes_all(p->torsion_length) : length;
    bonds->kn = p->bn * stiff;
    bonds->kt = p->bt * stiff;
    bonds->ktheta = brc_lanes_where(bonds->intact, p->bm * area * arm);
    bonds->length = length;
}

/* Four vectors of body frames in space; rotation matrices r, column of body vectors. */
BRC_LANES_INLINE void body_to_space(brc_lanes out[3], const brc_lanes r[3][3], double (*column)[3],
                                    const int32_t row[BRC_LANES])
{
    brc_lanes v[3];
    brc_lanes_gather3(v, column, row);
    set(out, brc_lanes_dot(r[0], v), brc_lanes_dot(r[1], v), brc_lanes_dot(r[2], v));
}

BRC_LANES_INLINE void gather_turn(brc_lanes r[3][3], double (*turn)[3][3],
                                  const int32_t i[BRC_LANES])
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            r[k][l] =
                (brc_lanes){turn[i[0]][k][l], turn[i[1]][k][l], turn[i[2]][k][l], turn[i[3]][k][l]};
}

/* poly_twist for four bonds. */
BRC_LANES_INLINE brc_lanes twist(const brc_lanes n[3], const brc_lanes ta[3], const brc_lanes tb[3],
                                 brc_mask intact)
{
    brc_lanes c[3];
    brc_lanes_cross(c, ta, tb);
    brc_lanes x = brc_lanes_dot(ta, tb) - brc_lanes_dot(ta, n) * brc_lanes_dot(tb, n);
    brc_lanes y = brc_lanes_where(intact, brc_lanes_dot(c, n));
    x = brc_lanes_pick(intact, x, brc_lanes_all(1));
    brc_lanes t = y / x, angle = t * (1 - t * t * (1.0 / 3 - t * t / 5));
    brc_mask small = positive(x) & brc_lanes_less(brc_lanes_abs(t), brc_lanes_all(1e-3));
    if (brc_lanes_any(~small))
        for (int k = 0; k < BRC_LANES; k++)
            angle[k] = small[k] ? angle[k] : atan2(y[k], x[k]);
    return angle;
}

/* poly_bond_law of four bonds into the group: wrench, stiffness, breaking. */
BRC_LANES_INLINE void bond_law(struct poly_row_group *g, const struct bonds *bond,
                               const struct poly_params *p, const brc_lanes pa[3],
                               const brc_lanes pb[3], const brc_lanes n[3], brc_lanes twisted)
{
    brc_lanes arm[3], back[3], u[3], ut[3], c[3];
    sub(u, pb, pa);
    brc_lanes un = brc_lanes_dot(u, n);
    set(ut, u[0] - un * n[0], u[1] - un * n[1], u[2] - un * n[2]);
    brc_lanes open = brc_lanes_max(un, brc_lanes_all(0)); /* eq:gt12:12 */
    for (int k = 0; k < 3; k++) {
        g->bond.f[k] = -bond->kn * open * n[k]; /* eq:gt12:11 */
        g->bond.f[k] -= bond->kt * ut[k];       /* eq:gt12:13 */
        arm[k] = 0.5 * (pa[k] + pb[k]);
    }
    brc_lanes limit = bond->length * p->eps_th;
    brc_lanes slip = brc_lanes_sqrt(brc_lanes_dot(ut, ut));
    g->broken = open / limit + slip / limit;    /* eq:gt12:15 */
    brc_lanes moment = -bond->ktheta * twisted; /* eq:gt12:14 */
    if (p->theta_limit)
        g->broken += brc_lanes_abs(twisted) / p->theta_th;
    sub(back, arm, g->x);
    brc_lanes_cross(c, arm, g->bond.f);
    scale(g->bond.m, n, moment);
    add(g->bond.m, g->bond.m, c);
    brc_lanes stiff = brc_lanes_max(bond->kn, bond->kt);
    g->k[0] = stiff;
    g->k[1] = stiff * brc_lanes_dot(arm, arm) + bond->ktheta;
    g->k[2] = stiff * brc_lanes_dot(back, back) + bond->ktheta;
}

BRC_LANES_INLINE void bond_of_group(struct poly_block *block, struct poly_row_group *g,
                                    const struct numbers *i, const bool torsion)
{
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    brc_lanes ra[3][3], rb[3][3], pa[3], pb[3], na[3], nb[3], ta[3], tb[3], n[3];
    struct bonds bonds;
    bonds_of_group(&bonds, block, i);
    gather_turn(ra, block->st->turn, i->a);
    gather_turn(rb, block->st->turn, i->b);
    /* material points relative to the centre of a */
    body_to_space(pa, ra, rows->ca, i->row);
    body_to_space(pb, rb, rows->cb, i->row);
    add(pb, pb, g->x);
    body_to_space(na, ra, rows->na, i->row);
    body_to_space(nb, rb, rows->nb, i->row);
    sub(n, na, nb);
    scale(n, n, 1 / brc_lanes_sqrt(brc_lanes_dot(n, n)));
    mask(n, bonds.intact, n);
    brc_lanes twisted = brc_lanes_all(0);
    if (torsion) {
        body_to_space(ta, ra, rows->ta, i->row);
        body_to_space(tb, rb, rows->tb, i->row);
        twisted = twist(n, ta, tb, bonds.intact);
    } else {
        bonds.ktheta = brc_lanes_all(0);
    }
    bond_law(g, &bonds, poly_params_of(block->sim), pa, pb, n, twisted);
    g->broken = brc_lanes_where(bonds.intact, g->broken);
}

BRC_LANES_INLINE void viscosities(struct poly_block *block, struct poly_row_group *g,
                                  const struct numbers *i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    brc_lanes ma = gather(block->sim->bodies.true_mass, i->a);
    brc_lanes mb = gather(block->sim->bodies.true_mass, i->b);
    brc_lanes effective = ma * mb / (ma + mb);
    g->gn = p->gn * effective;
    g->gt = p->gt * effective;
}

BRC_LANES_INLINE void motion_kernel(struct poly_block *block, const bool torsion)
{
    const struct brc_contacts *c = &block->sim->pairs;
    for (int32_t group = 0; BRC_LANES * group < block->n_rows; group++) {
        struct poly_row_group *g = &block->group[group];
        struct numbers i;
        bool has_bond = false;
        numbers_of(&i, block, group);
        motion_of_group(block, g, &i);
        viscosities(block, g, &i);
        for (int k = 0; k < BRC_LANES; k++)
            has_bond |= c->status[i.row[k]] == BRC_INTACT;
        g->k[0] = g->k[1] = g->k[2] = g->broken = brc_lanes_all(0);
        clear((brc_lanes *)&g->bond, sizeof g->bond);
        if (has_bond)
            bond_of_group(block, g, &i, torsion);
        clear((brc_lanes *)&g->normal, sizeof g->normal);
        clear((brc_lanes *)&g->shear, sizeof g->shear);
        clear((brc_lanes *)&g->viscous, sizeof g->viscous);
        g->stored = g->slid = brc_lanes_all(0);
    }
}

/* --- forces of touches ------------------------------------------------------------------------ */

/* One row, the same in all lanes. */
struct row_of_points {
    brc_lanes xa[3], x[3], slip[3], slope[3][3], turn[3], gn, gt;
};

/* Sums over the points of a row. */
struct sums {
    struct poly_wrenches normal, shear, viscous;
    brc_lanes k[3], gap, stored, slid;
};

BRC_LANES_INLINE void push(struct poly_wrenches *w, const brc_lanes f[3], const brc_lanes arm[3])
{
    brc_lanes m[3];
    brc_lanes_cross(m, arm, f);
    add(w->f, w->f, f);
    add(w->m, w->m, m);
}

/* Elastic normal force (eq 4), with the gradient part under `merged`. */
BRC_LANES_INLINE void push_normal(struct sums *s, const struct poly_touches *t, double kn,
                                  const brc_lanes arm[3])
{
    brc_lanes f[3], grade = -0.5 * kn * t->delta * t->delta;
    scale(f, t->n, kn * t->weight * t->delta); /* eq:gt12:4 */
    axpy(f, grade, t->g);
    axpy(s->normal.m, grade, t->c);
    push(&s->normal, f, arm);
}

/* Old tangential displacement turned with the contact frame: tilt from the old to the new normal,
 * then twirl by the angle 2 t about it. The length is kept. */
BRC_LANES_INLINE void turn_spring(brc_lanes xi[3], const brc_lanes n_old[3], const brc_lanes n[3],
                                  brc_lanes t)
{
    brc_lanes r[3], a[3], per = 1 / (1 + t * t), c = brc_lanes_dot(n_old, n);
    brc_lanes_cross(r, n_old, n);
    brc_lanes along = brc_lanes_dot(r, xi) / (1 + c);
    brc_lanes_cross(a, r, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = c * xi[i] + a[i] + along * r[i];
    brc_lanes_cross(a, n, xi);
    for (int i = 0; i < 3; i++)
        xi[i] = ((1 - t * t) * xi[i] + 2 * t * a[i]) * per;
}

/* Adds the tangential part of du to xi and caps it (eqs 8-9): what is left over has slipped. */
BRC_LANES_INLINE void slide_spring(brc_lanes xi[3], const brc_lanes n[3], const brc_lanes du[3],
                                   brc_lanes limit)
{
    add(xi, xi, du); /* eq:gt12:9 */
    axpy(xi, -brc_lanes_dot(xi, n), n);
    brc_lanes xi2 = brc_lanes_dot(xi, xi);
    brc_lanes cap = brc_lanes_pick(brc_lanes_less(limit * limit, xi2), limit / brc_lanes_sqrt(xi2),
                                   brc_lanes_all(1));
    scale(xi, xi, cap); /* eq:gt12:8 */
}

/* Tangential springs: xi and the normals of the last step become those of now. */
BRC_LANES_INLINE void push_shear(const struct poly_block *block, struct sums *s,
                                 const struct poly_touches *t, const struct row_of_points *row,
                                 const brc_lanes du[3], const brc_lanes arm[3], const int32_t *p,
                                 const bool ledger)
{
    const struct poly_points *points = block->sim->pairs.point_columns;
    const struct poly_params *params = poly_params_of(block->sim);
    brc_lanes xi[3], n_old[3], before[3], f[3];
    brc_mask touches = positive(t->weight);
    brc_lanes old = brc_lanes_where(touches, gather(points->weight, p));
    brc_lanes_gather3(xi, points->xi, p);
    brc_lanes_gather3(n_old, points->n, p);
    turn_spring(xi, n_old, t->n, brc_lanes_dot(row->turn, t->n));
    mask(xi, positive(old), xi);
    set(before, xi[0], xi[1], xi[2]);
    slide_spring(xi, t->n, du, params->mu * block->kn / block->kt * t->delta);
    mask(xi, touches, xi);
    scale(f, xi, -block->kt * t->weight); /* eq:gt12:8 */
    push(&s->shear, f, arm);
    for (int i = 0; i < BRC_LANES; i++)
        for (int k = 0; k < 3 && t->weight[i] > 0; k++) {
            points->xi[p[i]][k] = xi[k][i];
            points->n[p[i]][k] = t->n[k][i];
        }
    if (!ledger)
        return;
    brc_lanes part[3], along = brc_lanes_dot(du, t->n);
    for (int k = 0; k < 3; k++)
        part[k] = (old * before[k] + t->weight * xi[k]);
    brc_lanes work = brc_lanes_dot(part, du) - along * brc_lanes_dot(part, t->n);
    s->slid += 0.5 * block->kt * work;
    s->stored +=
        0.5 * block->kt * (t->weight * brc_lanes_dot(xi, xi) - old * brc_lanes_dot(before, before));
}

BRC_LANES_INLINE void push_viscous(struct sums *s, const struct poly_touches *t,
                                   const struct row_of_points *row, double kn, const brc_lanes u[3],
                                   const brc_lanes arm[3])
{
    brc_lanes f[3], vn = brc_lanes_dot(u, t->n), gt = t->weight * row->gt;
    brc_lanes normal =
        brc_lanes_max(-t->weight * row->gn * vn, -kn * t->weight * t->delta); /* eq:gt12:10 */
    for (int i = 0; i < 3; i++)
        f[i] = normal * t->n[i] - gt * (u[i] - vn * t->n[i]);
    push(&s->viscous, f, arm);
}

BRC_LANES_INLINE void push_group(const struct poly_block *block, struct sums *s,
                                 const struct poly_touches *t, const struct row_of_points *row,
                                 const int32_t *p, const bool friction, const bool viscous,
                                 const bool ledger)
{
    brc_lanes arm[3], back[3], u[3], du[3];
    brc_mask touches = positive(t->weight);
    sub(arm, t->x, row->xa);
    sub(back, arm, row->x);
    push_normal(s, t, block->kn, arm);
    brc_lanes stiff = brc_lanes_where(touches, brc_lanes_all(block->stiff));
    s->k[0] += stiff;
    s->k[1] += stiff * brc_lanes_dot(arm, arm);
    s->k[2] += stiff * brc_lanes_dot(back, back);
    s->gap = brc_lanes_pick(touches, brc_lanes_min(s->gap, -t->delta), s->gap);
    for (int k = 0; k < 3; k++)
        u[k] = brc_lanes_dot(row->slope[k], arm);
    add(u, u, row->slip);
    if (friction) {
        scale(du, u, brc_lanes_all(block->sim->dt));
        push_shear(block, s, t, row, du, arm, p, ledger);
    }
    if (viscous)
        push_viscous(s, t, row, block->kn, u, arm);
}

BRC_LANES_INLINE void add_wrench(struct poly_wrenches *to, const struct poly_wrenches *w, int lane)
{
    for (int k = 0; k < 3; k++) {
        to->f[k][lane] += brc_lanes_sum(w->f[k]);
        to->m[k][lane] += brc_lanes_sum(w->m[k]);
    }
}

BRC_LANES_INLINE void points_of_row(struct poly_block *block, const struct poly_segment *segment,
                                    const bool friction, const bool viscous, const bool ledger)
{
    struct poly_row_group *g = &block->group[segment->row / BRC_LANES];
    int lane = segment->row % BRC_LANES;
    struct row_of_points row;
    struct sums s;
    clear((brc_lanes *)&s, sizeof s);
    s.gap = brc_lanes_all(g->gap[lane]);
    spread(row.xa, g->xa, lane);
    spread(row.x, g->x, lane);
    spread(row.slip, g->slip, lane);
    spread(row.turn, g->turn, lane);
    for (int k = 0; k < 3; k++)
        spread(row.slope[k], g->slope[k], lane);
    row.gn = brc_lanes_all(g->gn[lane]);
    row.gt = brc_lanes_all(g->gt[lane]);
    for (int32_t slot = segment->slot; slot < segment->slot + segment->n; slot += BRC_LANES)
        push_group(block, &s, &block->touch[slot / BRC_LANES], &row, block->point + slot, friction,
                   viscous, ledger);
    add_wrench(&g->normal, &s.normal, lane);
    if (friction)
        add_wrench(&g->shear, &s.shear, lane);
    if (viscous)
        add_wrench(&g->viscous, &s.viscous, lane);
    for (int k = 0; k < 3; k++)
        g->k[k][lane] += brc_lanes_sum(s.k[k]);
    g->gap[lane] = poly_least(poly_least(s.gap[0], s.gap[1]), poly_least(s.gap[2], s.gap[3]));
    g->stored[lane] += brc_lanes_sum(s.stored);
    g->slid[lane] += brc_lanes_sum(s.slid);
}

BRC_LANES_INLINE void points_kernel(struct poly_block *block, const bool friction,
                                    const bool viscous, const bool ledger)
{
    for (int32_t i = 0; i < block->n_segments; i++)
        points_of_row(block, &block->segment[i], friction, viscous, ledger);
}

/* --- sums of rows ----------------------------------------------------------------------------- */

/* Power of force and moments of a wrench on both bodies, for the offset x of the centres. */
BRC_LANES_INLINE brc_lanes power(const struct poly_wrenches *w, const struct poly_row_group *g,
                                 const brc_lanes x[3])
{
    brc_lanes tb[3];
    brc_lanes_cross(tb, x, w->f);
    sub(tb, w->m, tb);
    return brc_lanes_dot(w->f, g->dv) - brc_lanes_dot(w->m, g->wa) + brc_lanes_dot(tb, g->wb);
}

/* Work taken up by the source of a wrench over the step, by the trapezoid rule of ledger.h. */
BRC_LANES_INLINE brc_lanes work(const double (*old)[6], const struct poly_wrenches *now,
                                const struct poly_row_group *g, const int32_t row[BRC_LANES],
                                double dt)
{
    struct poly_wrenches w;
    brc_lanes x_old[3];
    for (int k = 0; k < 3; k++) {
        w.f[k] = (brc_lanes){old[row[0]][k], old[row[1]][k], old[row[2]][k], old[row[3]][k]};
        w.m[k] = (brc_lanes){old[row[0]][3 + k], old[row[1]][3 + k], old[row[2]][3 + k],
                             old[row[3]][3 + k]};
        x_old[k] = g->x[k] - g->dv[k] * dt;
    }
    return -0.5 * dt * (power(&w, g, x_old) + power(now, g, g->x));
}

BRC_LANES_INLINE void finish_kernel(struct poly_block *block, const bool ledger, const bool viscous)
{
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    double dt = block->sim->dt;
    for (int32_t group = 0; BRC_LANES * group < block->n_rows; group++) {
        struct poly_row_group *g = &block->group[group];
        const int32_t *row = block->row + BRC_LANES * group;
        for (int k = 0; k < 3; k++) {
            g->total.f[k] = g->bond.f[k] + g->normal.f[k] + g->shear.f[k] + g->viscous.f[k];
            g->total.m[k] = -(g->bond.m[k] + g->normal.m[k] + g->shear.m[k] + g->viscous.m[k]);
        }
        brc_lanes_cross(g->tb, g->x, g->total.f);
        for (int k = 0; k < 3; k++)
            g->tb[k] = -g->total.m[k] - g->tb[k];
        if (!ledger)
            continue;
        g->work_normal = work((const double(*)[6])rows->normal_old, &g->normal, g, row, dt);
        g->work_bond = work((const double(*)[6])rows->bond_old, &g->bond, g, row, dt);
        if (viscous)
            g->work_viscous = work((const double(*)[6])rows->viscous_old, &g->viscous, g, row, dt);
    }
}

/* --- choice ----------------------------------------------------------------------------------- */

#define KERNEL(name, call)                                              \
    __attribute__((flatten)) static void name(struct poly_block *block) \
    {                                                                   \
        call;                                                           \
    }
KERNEL(motion, motion_kernel(block, false))
KERNEL(motion_torsion, motion_kernel(block, true))
KERNEL(touch, touch_kernel(block, false))
KERNEL(touch_merged, touch_kernel(block, true))
KERNEL(finish, finish_kernel(block, false, false))
KERNEL(finish_ledger, finish_kernel(block, true, false))
KERNEL(finish_viscous, finish_kernel(block, true, true))
KERNEL(points_000, points_kernel(block, false, false, false))
KERNEL(points_010, points_kernel(block, false, true, false))
KERNEL(points_100, points_kernel(block, true, false, false))
KERNEL(points_101, points_kernel(block, true, false, true))
KERNEL(points_110, points_kernel(block, true, true, false))
KERNEL(points_111, points_kernel(block, true, true, true))
#undef KERNEL

__attribute__((flatten)) static int list(struct brc_context *ctx, struct poly_list *l,
                                         const struct poly_pair *p, enum poly_rule rule,
                                         double skin, double *allowance)
{
    return list_features(ctx, l, p, rule, skin, allowance);
}

static struct poly_kernels choose_kernels(const struct brc_sim *sim)
{
    static poly_kernel *const points[2][2][2] = {
        {{points_000, points_000}, {points_010, points_010}},
        {{points_100, points_101}, {points_110, points_111}}};
    const struct poly_params *p = poly_params_of(sim);
    bool friction = BRC_OPTION(p->mu > 0 && p->kt > 0), ledger = BRC_OPTION(sim->run.ledger);
    bool viscous = BRC_OPTION(sim->run.regime == BRC_DYNAMIC && (p->gn > 0 || p->gt > 0));
    return (struct poly_kernels){.list = list,
                                 .motion = BRC_OPTION(p->torsion) ? motion_torsion : motion,
                                 .touch = p->features == POLY_MERGED ? touch_merged : touch,
                                 .points = points[friction][viscous][ledger],
                                 .finish = !ledger   ? finish
                                           : viscous ? finish_viscous
                                                     : finish_ledger};
}

#endif
