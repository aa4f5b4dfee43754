/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motion and bonds of the rows of a block, four at a time. */
#ifndef POLY_MOTION_H
#define POLY_MOTION_H

#include "polyhedra/world.h"

#include <string.h>

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

/* What points want of a row. */
struct frames {
    brc_lanes xa[3], gn, x[3], gt;
    /* b moves at slip + slope . arm relative to a, arm from a; turn is a quarter of the sum of both
     * turns in the step */
    brc_lanes slip[3], none;
    struct {
        brc_lanes slope[3], turn;
    } along[3];
};

/* Velocity of b relative to a with arms at the middle of the step, so that a pair that turns as one
 * body does not slip but for the third order of the step's angle: for an arm r from a,
 * dv + (wb - h wb wb)(r - x) - (wa - h wa wa) r, with cross products for products and h = dt / 2.
 */
BRC_LANES_INLINE void slip_of_row(struct frames *f, const struct poly_row_group *g, double dt)
{
    const brc_lanes *wa = g->wa, *wb = g->wb, h = brc_lanes_all(0.5 * dt);
    brc_lanes dw[3], c[3];
    brc_lanes_cross(c, wb, g->x);
    sub(f->slip, g->dv, c);
    add_double_cross(f->slip, h, wb, g->x);
    sub(dw, wb, wa);
    brc_lanes widen = h * (brc_lanes_dot(wb, wb) - brc_lanes_dot(wa, wa));
    for (int i = 0; i < 3; i++) {
        brc_lanes *slope = f->along[i].slope;
        for (int j = 0; j < 3; j++)
            slope[j] = -h * (wb[i] * wb[j] - wa[i] * wa[j]);
        slope[i] += widen;
        slope[(i + 1) % 3] -= dw[(i + 2) % 3];
        slope[(i + 2) % 3] += dw[(i + 1) % 3];
        f->along[i].turn = brc_lanes_all(0.25 * dt) * (wa[i] + wb[i]);
    }
}

/* Lane i to the frame of row i. */
BRC_LANES_INLINE void put_frames(double (*to)[POLY_FRAME], struct frames *f)
{
    brc_lanes *part = (brc_lanes *)f;
    f->none = brc_lanes_all(0);
    for (int k = 0; k < POLY_FRAME; k += BRC_LANES) {
        brc_lanes_transpose(part + k);
        for (int i = 0; i < BRC_LANES; i++)
            brc_lanes_put(to[i] + k, part[k + i]);
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

BRC_LANES_INLINE void viscosities(struct frames *f, const struct poly_block *block,
                                  const struct numbers *i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    brc_lanes ma = gather(block->sim->bodies.true_mass, i->a);
    brc_lanes mb = gather(block->sim->bodies.true_mass, i->b);
    brc_lanes effective = ma * mb / (ma + mb);
    f->gn = p->gn * effective;
    f->gt = p->gt * effective;
}

BRC_LANES_INLINE void motion_of_group(const struct poly_block *block, struct poly_row_group *g,
                                      struct frames *f, const struct numbers *i)
{
    const struct brc_bodies *bodies = &block->sim->bodies;
    brc_lanes xa[3], xb[3], va[3], vb[3];
    brc_lanes_gather3(xa, bodies->x, i->a);
    brc_lanes_gather3(xb, bodies->x, i->b);
    brc_lanes_gather3(va, bodies->v, i->a);
    brc_lanes_gather3(vb, bodies->v, i->b);
    brc_lanes_gather3(g->wa, bodies->w, i->a);
    brc_lanes_gather3(g->wb, bodies->w, i->b);
    sub(g->x, xb, xa);
    sub(g->dv, vb, va);
    set(f->xa, xa[0], xa[1], xa[2]);
    set(f->x, g->x[0], g->x[1], g->x[2]);
    slip_of_row(f, g, block->sim->dt);
    f->gn = f->gt = brc_lanes_all(0);
    if (block->viscous)
        viscosities(f, block, i);
    g->path = relative_path(g, gather(bodies->bounding_radius, i->a),
                            gather(bodies->bounding_radius, i->b) + block->rest, block->sim->dt);
}

/* Values first and on of what each of four rows has in its column, as fours. */
BRC_LANES_INLINE void gather_fours(brc_lanes *r, const double *const from[BRC_LANES], int n)
{
    for (int k = 0; k < n; k += BRC_LANES) {
        const double *const p[BRC_LANES] = {from[0] + k, from[1] + k, from[2] + k, from[3] + k};
        brc_lanes_gather4(r + k, p);
    }
}

/* Four bonds, as POLY_BOND has them. */
struct halves {
    brc_lanes ca[3], area, cb[3], length, na[3], none_na, nb[3], none_nb, ta[3], none_ta, tb[3],
        none_tb;
};

/* Constants of the bonds of four rows, as poly_bond_of; zero stiffness where there is none. */
struct bonds {
    brc_lanes kn, kt, ktheta, length;
    brc_mask intact;
};

BRC_LANES_INLINE void bonds_of_group(struct bonds *bonds, const struct poly_block *block,
                                     const struct halves *halves, const struct numbers *i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    const struct brc_contacts *c = &block->sim->pairs;
    const uint8_t status[BRC_LANES] = {c->status[i->row[0]], c->status[i->row[1]],
                                       c->status[i->row[2]], c->status[i->row[3]]};
    bonds->intact = brc_lanes_equal(status, BRC_INTACT);
    brc_lanes area = halves->area, length = halves->length;
    brc_lanes stiff = brc_lanes_where(bonds->intact, area / length);
    brc_lanes arm = p->torsion_length > 0 ? brc_lanes_all(p->torsion_length) : length;
    bonds->kn = p->bn * stiff;
    bonds->kt = p->bt * stiff;
    bonds->ktheta = brc_lanes_where(bonds->intact, p->bm * area * arm);
    bonds->length = length;
}

/* Rotation matrices of four bodies. */
BRC_LANES_INLINE void gather_turn(brc_lanes r[9], double (*turn)[3][3], const int32_t i[BRC_LANES])
{
    const double *const from[BRC_LANES] = {turn[i[0]][0], turn[i[1]][0], turn[i[2]][0],
                                           turn[i[3]][0]};
    gather_fours(r, from, 8);
    r[8] = (brc_lanes){from[0][8], from[1][8], from[2][8], from[3][8]};
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
    /* the series of the arc tangent: what it leaves out is below t^10 / 11 */
    brc_lanes t = y / x, t2 = t * t;
    brc_lanes angle = t * (1 - t2 * (1.0 / 3 - t2 * (1.0 / 5 - t2 * (1.0 / 7 - t2 * (1.0 / 9)))));
    brc_mask small = positive(x) & brc_lanes_less(brc_lanes_abs(t), brc_lanes_all(0.03));
    if (brc_lanes_any(~small))
        for (int k = 0; k < BRC_LANES; k++)
            angle[k] = small[k] ? angle[k] : atan2(y[k], x[k]);
    return angle;
}

/* poly_bond_law of four bonds into the group: wrench, energy, stiffness, breaking. */
BRC_LANES_INLINE void bond_law(struct poly_row_group *g, const struct bonds *bond,
                               const struct poly_params *p, const brc_lanes pa[3],
                               const brc_lanes pb[3], const brc_lanes n[3], brc_lanes twisted)
{
    brc_lanes arm[3], back[3], u[3], ut[3], c[3];
    sub(u, pb, pa);
    brc_lanes un = brc_lanes_dot(u, n);
    set(ut, u[0] - un * n[0], u[1] - un * n[1], u[2] - un * n[2]);
    brc_lanes open = brc_lanes_max(un, brc_lanes_all(0)); /* eq:gt12:12 */
    g->opening = un;
    for (int k = 0; k < 3; k++) {
        g->bond.f[k] = -bond->kn * open * n[k]; /* eq:gt12:11 */
        g->bond.f[k] -= bond->kt * ut[k];       /* eq:gt12:13 */
        arm[k] = 0.5 * (pa[k] + pb[k]);
    }
    brc_lanes limit = bond->length * p->eps_th;
    brc_lanes slip = brc_lanes_sqrt(brc_lanes_dot(ut, ut));
    g->broken = open / limit + slip / limit;    /* eq:gt12:15 */
    brc_lanes moment = -bond->ktheta * twisted; /* eq:gt12:14 */
    g->bond_stored =
        0.5 * (bond->kn * open * open + bond->kt * slip * slip + bond->ktheta * twisted * twisted);
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
    const double *const from[BRC_LANES] = {rows->bond[i->row[0]], rows->bond[i->row[1]],
                                           rows->bond[i->row[2]], rows->bond[i->row[3]]};
    brc_lanes ra[9], rb[9], pa[3], pb[3], na[3], nb[3], ta[3], tb[3], n[3];
    struct halves halves;
    struct bonds bonds;
    gather_fours((brc_lanes *)&halves, from, torsion ? POLY_BOND : POLY_BOND_TA);
    bonds_of_group(&bonds, block, &halves, i);
    gather_turn(ra, block->st->turn, i->a);
    gather_turn(rb, block->st->turn, i->b);
    /* material points relative to the centre of a */
    body_to_space(pa, ra, halves.ca);
    body_to_space(pb, rb, halves.cb);
    add(pb, pb, g->x);
    body_to_space(na, ra, halves.na);
    body_to_space(nb, rb, halves.nb);
    sub(n, na, nb);
    scale(n, n, 1 / brc_lanes_sqrt(brc_lanes_dot(n, n)));
    mask(n, bonds.intact, n);
    brc_lanes twisted = brc_lanes_all(0);
    if (torsion) {
        body_to_space(ta, ra, halves.ta);
        body_to_space(tb, rb, halves.tb);
        twisted = twist(n, ta, tb, bonds.intact);
    } else {
        bonds.ktheta = brc_lanes_all(0);
    }
    bond_law(g, &bonds, poly_params_of(block->sim), pa, pb, n, twisted);
    g->broken = brc_lanes_where(bonds.intact, g->broken);
}

/* What rows have used of their room, `used` since they were looked at last; calm rows have nothing
 * to decide in this step. */
BRC_LANES_INLINE void rooms_of_group(struct poly_block *block, struct poly_row_group *g,
                                     brc_lanes used, int32_t group)
{
    const struct brc_bodies *bodies = &block->sim->bodies;
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    for (int32_t k = 0, i = BRC_LANES * group; k < BRC_LANES && i < block->n_rows; k++, i++) {
        size_t row = (size_t)block->row[i];
        double travel = bodies->path_length[block->a[i]], wake = rows->wake[row];
        g->gap[k] = wake - travel - bodies->path_length[block->b[i]];
        if (block->listed[i]) {
            rows->room[row] -= used[k];
            block->calm[i] = rows->ready[row] && rows->room[row] > rows->calm[row];
        } else {
            block->calm[i] = travel + bodies->path_length[block->b[i]] < wake;
        }
        block->calm[i] &= !(g->broken[k] > 1);
    }
}

/* The rows' columns: force on b and moments about both centres of a wrench about that of a. */
BRC_LANES_INLINE void put_wrenches(const struct brc_contacts *c, const struct poly_wrenches *w,
                                   const struct poly_row_group *g, const int32_t row[BRC_LANES])
{
    brc_lanes ta[3], tb[3];
    brc_lanes_cross(tb, g->x, w->f);
    for (int k = 0; k < 3; k++) {
        ta[k] = -w->m[k];
        tb[k] = -ta[k] - tb[k];
    }
    brc_lanes_scatter3(c->f, row, w->f);
    brc_lanes_scatter3(c->ta, row, ta);
    brc_lanes_scatter3(c->tb, row, tb);
}

/* --- condensed rows --------------------------------------------------------------------------- */

/* Motion of four rows since they were computed literally, as POLY_SHIFT has it. */
struct shifts {
    brc_lanes d[3], path, turn[3], end, both[3], stored;
};

BRC_LANES_INLINE void gather_shifts(struct shifts *s, const struct poly_rows *rows,
                                    const int32_t row[BRC_LANES])
{
    const double *const from[BRC_LANES] = {rows->shift[row[0]], rows->shift[row[1]],
                                           rows->shift[row[2]], rows->shift[row[3]]};
    gather_fours((brc_lanes *)s, from, POLY_SHIFT);
}

BRC_LANES_INLINE void put_shifts(const struct poly_rows *rows, const int32_t row[BRC_LANES],
                                 struct shifts *s)
{
    brc_lanes *part = (brc_lanes *)s;
    for (int k = 0; k < POLY_SHIFT; k += BRC_LANES) {
        brc_lanes_transpose(part + k);
        for (int i = 0; i < BRC_LANES; i++)
            brc_lanes_put(rows->shift[row[i]] + k, part[k + i]);
    }
}

/* Adds the motion of the step. */
BRC_LANES_INLINE void add_shifts(struct shifts *s, const struct frames *f,
                                 const struct poly_row_group *g, double dt)
{
    for (int k = 0; k < 3; k++) {
        s->d[k] += dt * f->slip[k];
        s->turn[k] += dt * (g->wb[k] - g->wa[k]);
        s->both[k] += f->along[k].turn;
    }
    s->path += g->path;
}

/* Makes the frames of rows that are computed literally those of the motion since they were computed
 * last: slip and slope are displacements. Returns the path of that motion. */
BRC_LANES_INLINE brc_lanes shift_frames(const struct poly_block *block, struct frames *f,
                                        const struct poly_row_group *g, const struct numbers *i)
{
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    const brc_lanes none = brc_lanes_all(0);
    struct shifts s;
    gather_shifts(&s, rows, i->row);
    add_shifts(&s, f, g, block->sim->dt);
    for (int k = 0; k < 3; k++) {
        f->slip[k] = s.d[k];
        f->along[k].turn = s.both[k];
    }
    set(f->along[0].slope, none, -s.turn[2], s.turn[1]);
    set(f->along[1].slope, s.turn[2], none, -s.turn[0]);
    set(f->along[2].slope, -s.turn[1], s.turn[0], none);
    return s.path;
}

BRC_LANES_INLINE void motion_kernel(struct poly_block *block, const bool torsion,
                                    const bool condensed)
{
    const struct brc_contacts *c = &block->sim->pairs;
    clear((brc_lanes *)block->sum, sizeof block->sum);
    for (int32_t group = 0; BRC_LANES * group < block->n_rows; group++) {
        struct poly_row_group *g = &block->group[group];
        struct numbers i;
        struct frames f;
        bool has_bond = false;
        numbers_of(&i, block, group);
        motion_of_group(block, g, &f, &i);
        brc_lanes used = g->path;
        if (condensed)
            used = shift_frames(block, &f, g, &i);
        for (int k = 0; k < BRC_LANES; k++)
            has_bond |= c->status[i.row[k]] == BRC_INTACT;
        g->k[0] = g->k[1] = g->k[2] = g->broken = g->bond_stored = brc_lanes_all(0);
        clear((brc_lanes *)&g->bond, sizeof g->bond);
        if (has_bond)
            bond_of_group(block, g, &i, torsion);
        rooms_of_group(block, g, used, group);
        put_frames(block->frame + BRC_LANES * group, &f);
    }
}

#endif
