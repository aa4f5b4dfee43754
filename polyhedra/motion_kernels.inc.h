/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motion and bonds of the contacts of a batch, four at a time. Included by kernels.inc.h and, for
 * one contact alone, by bond_of_contact.c. Knows contacts as pairs of bodies with a bond, and no
 * point of theirs; the frames that it makes are all that points see of the motion. */
#ifndef POLY_MOTION_KERNELS_H
#define POLY_MOTION_KERNELS_H

#include "polyhedra/pose_kernels.inc.h"

#include <string.h>

/* The contacts of a four, as gathers want them. */
struct poly_index4 {
    int32_t contact[BRC_LANES], a[BRC_LANES], b[BRC_LANES];
};

BRC_LANES_INLINE void poly_index_of(struct poly_index4 *i, const struct poly_batch *batch,
                                    int32_t four)
{
    memcpy(i->contact, batch->contact + BRC_LANES * four, sizeof i->contact);
    memcpy(i->a, batch->a + BRC_LANES * four, sizeof i->a);
    memcpy(i->b, batch->b + BRC_LANES * four, sizeof i->b);
}

/* r += s (w x (w x a)) */
BRC_LANES_INLINE void poly_add_double_cross(brc_lanes r[3], brc_lanes s, const brc_lanes w[3],
                                            const brc_lanes a[3])
{
    brc_lanes c[3];
    brc_lanes_cross(c, w, a);
    brc_lanes_cross(c, w, c);
    poly_axpy3(r, s, c);
}

/* What points want of a contact. */
struct poly_frame4 {
    brc_lanes xa[3], gn, x[3], gt;
    /* b moves at slip + slope . arm relative to a, arm from a; turn is a quarter of the sum of both
     * turns in the step */
    brc_lanes slip[3], limit;
    struct {
        brc_lanes slope[3], turn;
    } along[3];
};

/* Velocity of b relative to a with arms at the middle of the step, so that a pair that turns as one
 * body does not slip but for the third order of the step's angle: for an arm r from a,
 * dv + (wb - h wb wb)(r - x) - (wa - h wa wa) r, with cross products for products and h = dt / 2.
 */
BRC_LANES_INLINE void poly_slip_of_four(struct poly_frame4 *f, const struct poly_contact4 *g,
                                        double dt)
{
    const brc_lanes *wa = g->wa, *wb = g->wb, h = brc_lanes_all(0.5 * dt);
    brc_lanes dw[3], c[3];
    brc_lanes_cross(c, wb, g->x);
    poly_sub3(f->slip, g->dv, c);
    poly_add_double_cross(f->slip, h, wb, g->x);
    poly_sub3(dw, wb, wa);
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

/* What b moves relative to a at an arm from the centre of a. Affine in the arm, so that a point
 * needs a product of matrix and vector and nothing of either body. */
BRC_LANES_INLINE void poly_slip_at(brc_lanes u[3], const struct poly_frame4 *f,
                                   const brc_lanes arm[3])
{
    for (int k = 0; k < 3; k++)
        u[k] = brc_lanes_dot(f->along[k].slope, arm);
    poly_add3(u, u, f->slip);
}

/* Power of force and moments of a wrench on both bodies, for the offset x of the centres. */
BRC_LANES_INLINE brc_lanes poly_power(const struct poly_wrench4 *w, const struct poly_contact4 *g,
                                      const brc_lanes x[3])
{
    brc_lanes tb[3];
    brc_lanes_cross(tb, x, w->f);
    poly_sub3(tb, w->m, tb);
    return brc_lanes_dot(w->f, g->dv) - brc_lanes_dot(w->m, g->wa) + brc_lanes_dot(tb, g->wb);
}

/* Values 0 to n - 1 of what stands at four places, as fours. */
BRC_LANES_INLINE void poly_gather_fours(brc_lanes *r, const double *const from[BRC_LANES], int n)
{
    for (int k = 0; k < n; k += BRC_LANES)
        brc_lanes_gather4(
            r + k, (const double *const[]){from[0] + k, from[1] + k, from[2] + k, from[3] + k});
}

/* Places of four rows of a column of that width. */
BRC_LANES_INLINE void poly_rows(double *at[BRC_LANES], double *column, int32_t width,
                                const int32_t row[BRC_LANES])
{
    for (int i = 0; i < BRC_LANES; i++)
        at[i] = column + (ptrdiff_t)width * row[i];
}

/* Values 0 to n - 1 of four rows, as fours. */
BRC_LANES_INLINE void poly_gather_rows(brc_lanes *r, double *column, int32_t width,
                                       const int32_t row[BRC_LANES], int n)
{
    double *from[BRC_LANES];
    poly_rows(from, column, width, row);
    poly_gather_fours(r, (const double *const *)from, n);
}

/* From fours, which are lost, to four rows. Row by row, since a point wants all of one contact, and
 * its neighbours in the lanes belong to others. */
BRC_LANES_INLINE void poly_put_rows(double *column, int32_t width, const int32_t row[BRC_LANES],
                                    brc_lanes *r, int n)
{
    double *to[BRC_LANES];
    poly_rows(to, column, width, row);
    for (int k = 0; k < n; k += BRC_LANES) {
        brc_lanes_transpose(r + k);
        for (int i = 0; i < BRC_LANES; i++)
            brc_lanes_put(to[i] + k, r[k + i]);
    }
}

/* Adds them, one lane after the other: rows may be the same. */
BRC_LANES_INLINE void poly_add_rows(double *column, int32_t width, const int32_t row[BRC_LANES],
                                    brc_lanes *r, int n)
{
    double *to[BRC_LANES];
    poly_rows(to, column, width, row);
    for (int k = 0; k < n; k += BRC_LANES) {
        brc_lanes_transpose(r + k);
        for (int i = 0; i < BRC_LANES; i++)
            brc_lanes_put(to[i] + k, brc_lanes_at(to[i] + k) + r[k + i]);
    }
}

/* Rows that follow each other. */
static const int32_t poly_in_turn[BRC_LANES] = {0, 1, 2, 3};

/* Bound of the path that points of b have made in the frame of a in this step. Motions that both
 * share, turns included, do not count; the last term is of second order in the turn. a's vertices
 * near b move with it too, so its reach is taken larger by the range of a contact. */
BRC_LANES_INLINE brc_lanes poly_relative_path(const struct poly_contact4 *g,
                                              const brc_lanes reach_a, const brc_lanes reach_b,
                                              double dt)
{
    brc_lanes u[3], dw[3];
    brc_lanes_cross(u, g->x, g->wa);
    poly_add3(u, u, g->dv);
    poly_sub3(dw, g->wb, g->wa);
    brc_lanes speed =
        brc_lanes_sqrt(brc_lanes_dot(u, u)) + reach_b * brc_lanes_sqrt(brc_lanes_dot(dw, dw));
    return 1.1 * dt * speed + dt * dt * brc_lanes_dot(g->wa, g->wa) * (reach_a + 2 * reach_b);
}

/* Viscosity and friction. A platen does not give way: the mass that swings at it is the grain's. */
BRC_LANES_INLINE void poly_laws_of_four(struct poly_frame4 *f, const struct poly_batch *batch,
                                        const struct poly_index4 *i, const bool is_platens)
{
    const struct poly_params *p = poly_params_of(batch->sim);
    f->gn = f->gt = brc_lanes_all(0);
    f->limit = brc_lanes_all(batch->law.limit);
    if (batch->viscous) {
        brc_lanes ma = poly_gather(batch->sim->bodies.true_mass, i->a), effective = ma;
        if (!is_platens) {
            brc_lanes mb = poly_gather(batch->sim->bodies.true_mass, i->b);
            effective = ma * mb / (ma + mb);
        }
        f->gn = p->gn * effective;
        f->gt = p->gt * effective;
    }
    for (int k = 0; is_platens && k < BRC_LANES; k++)
        f->limit[k] = batch->law.kt > 0 ? brc_sim_platen(batch->sim, i->b[k])->friction *
                                              batch->law.kn / batch->law.kt
                                        : 0;
}

BRC_LANES_INLINE void poly_motion_of_four(const struct poly_batch *batch, struct poly_contact4 *g,
                                          struct poly_frame4 *f, const struct poly_index4 *i,
                                          const bool is_platens)
{
    const struct brc_bodies *bodies = &batch->sim->bodies;
    brc_lanes xa[3], xb[3], va[3], vb[3];
    brc_lanes_gather3(xa, bodies->x, i->a);
    brc_lanes_gather3(xb, bodies->x, i->b);
    brc_lanes_gather3(va, bodies->v, i->a);
    brc_lanes_gather3(vb, bodies->v, i->b);
    brc_lanes_gather3(g->wa, bodies->w, i->a);
    brc_lanes_gather3(g->wb, bodies->w, i->b);
    poly_sub3(g->x, xb, xa);
    poly_sub3(g->dv, vb, va);
    poly_set3(f->xa, xa[0], xa[1], xa[2]);
    poly_set3(f->x, g->x[0], g->x[1], g->x[2]);
    poly_slip_of_four(f, g, batch->sim->dt);
    poly_laws_of_four(f, batch, i, is_platens);
    if (!is_platens)
        g->path = poly_relative_path(g, poly_gather(bodies->bounding_radius, i->a),
                                     poly_gather(bodies->bounding_radius, i->b) +
                                         batch->len.contact_distance,
                                     batch->sim->dt);
}

/* Four bonds, as POLY_BOND has them. */
struct poly_halves4 {
    brc_lanes ca[3], area, cb[3], length, na[3], none_na, nb[3], none_nb, ta[3], none_ta, tb[3],
        none_tb;
};

/* Constants of the bonds; zero stiffness where there is none. By zero stiffness and not by a
 * branch: three of four contacts of a four may be intact. */
BRC_LANES_INLINE void poly_bond_constants(struct poly_bonds4 *bonds, const struct poly_params *p,
                                          const struct poly_halves4 *halves, brc_mask intact,
                                          const bool torsion)
{
    brc_lanes area = halves->area, length = halves->length;
    brc_lanes stiff = brc_lanes_where(intact, area / length);
    brc_lanes arm = p->torsion_length > 0 ? brc_lanes_all(p->torsion_length) : length;
    bonds->kn = p->bn * stiff;
    bonds->kt = p->bt * stiff;
    bonds->ktheta = brc_lanes_all(0);
    if (torsion)
        bonds->ktheta = brc_lanes_where(intact, p->bm * area * arm);
    bonds->length = length;
    bonds->eps_th = p->eps_th;
    bonds->theta_th = p->theta_limit ? p->theta_th : HUGE_VAL;
}

/* Rotation matrices of four bodies. */
BRC_LANES_INLINE void poly_gather_rotation(brc_lanes r[9], double (*rotation)[3][3],
                                           const int32_t i[BRC_LANES])
{
    poly_gather_rows(r, rotation[0][0], 9, i, 8);
    r[8] = (brc_lanes){rotation[i[0]][2][2], rotation[i[1]][2][2], rotation[i[2]][2][2],
                       rotation[i[3]][2][2]};
}

/* The hold of a platen is half a bond: without torsion and, unless it holds in all directions,
 * without shear. The platen is rigid and does not turn: its normal is the hold's, and what is
 * stored changes with the grain's material point alone, so the force acts there. Half way to the
 * platen's, which a grain that slides along it leaves behind, it would have a moment that no energy
 * belongs to, and spin the grain. */
BRC_LANES_INLINE void poly_bonds_to_holds(struct poly_bonds4 *bonds, struct poly_bond_pose4 *pose,
                                          const struct brc_sim *sim, const struct poly_index4 *i,
                                          const brc_lanes nb[3])
{
    brc_lanes back[3];
    poly_scale3(back, nb, brc_lanes_all(-1));
    poly_mean_normal(pose->n, back, nb);
    poly_set3(pose->arm, pose->pa[0], pose->pa[1], pose->pa[2]);
    for (int k = 0; k < BRC_LANES; k++)
        if (brc_sim_platen(sim, i->b[k])->bonding != BRC_BONDING_FULL)
            bonds->kt[k] = 0;
}

/* Constants and poses of the bonds of four contacts whose centres are at x from a to b. Returns
 * where they are intact. */
BRC_LANES_INLINE brc_mask poly_bonds_of_four(struct poly_bonds4 *bonds,
                                             struct poly_bond_pose4 *pose,
                                             const struct brc_sim *sim, const struct poly_state *st,
                                             const struct brc_contacts *c,
                                             const struct poly_index4 *i, const brc_lanes x[3],
                                             const int flags)
{
    const bool torsion = flags & POLY_TORSION;
    const struct poly_contacts *columns = c->model_columns;
    const uint8_t status[BRC_LANES] = {c->status[i->contact[0]], c->status[i->contact[1]],
                                       c->status[i->contact[2]], c->status[i->contact[3]]};
    brc_mask intact = brc_lanes_equal(status, BRC_INTACT);
    brc_lanes ra[9], rb[9], na[3], nb[3], ta[3], tb[3];
    struct poly_halves4 halves;
    poly_gather_rows((brc_lanes *)&halves, columns->bond[0], POLY_BOND, i->contact,
                     torsion ? POLY_BOND : POLY_BOND_TA);
    poly_bond_constants(bonds, poly_params_of(sim), &halves, intact, torsion);
    poly_gather_rotation(ra, st->rotation, i->a);
    poly_gather_rotation(rb, st->rotation, i->b);
    poly_to_space4(pose->pa, ra, halves.ca);
    poly_to_space4(pose->pb, rb, halves.cb);
    poly_add3(pose->pb, pose->pb, x);
    poly_to_space4(nb, rb, halves.nb);
    if (flags & POLY_PLATENS) {
        poly_bonds_to_holds(bonds, pose, sim, i, nb);
    } else {
        poly_to_space4(na, ra, halves.na);
        poly_mean_normal(pose->n, na, nb);
        poly_arm_of_pair(pose);
    }
    poly_mask3(pose->n, intact, pose->n);
    pose->twist = brc_lanes_all(0);
    if (torsion) {
        poly_to_space4(ta, ra, halves.ta);
        poly_to_space4(tb, rb, halves.tb);
        pose->twist = poly_twist(pose->n, ta, tb, intact);
    }
    return intact;
}

/* Wrench, stiffness, energy and breaking of the bonds of four contacts. */
BRC_LANES_INLINE void poly_bond_forces(struct poly_batch *batch, struct poly_contact4 *g,
                                       const struct poly_index4 *i, const int flags)
{
    struct poly_bonds4 bonds;
    struct poly_bond_pose4 pose;
    struct poly_bond_state4 r;
    brc_lanes back[3], c[3];
    brc_mask intact =
        poly_bonds_of_four(&bonds, &pose, batch->sim, batch->st, batch->contacts, i, g->x, flags);
    poly_bond_law(&r, &bonds, &pose);
    g->opening = r.opening;
    g->bond_stored = r.energy;
    g->broken = brc_lanes_where(intact, poly_bond_use(&r));
    poly_set3(g->bond.f, r.f[0], r.f[1], r.f[2]);
    brc_lanes_cross(c, pose.arm, r.f);
    poly_scale3(g->bond.m, pose.n, r.m);
    poly_add3(g->bond.m, g->bond.m, c);
    poly_sub3(back, pose.arm, g->x);
    brc_lanes stiff = brc_lanes_max(bonds.kn, bonds.kt);
    g->k[0] = stiff;
    g->k[1] = stiff * brc_lanes_dot(pose.arm, pose.arm) + bonds.ktheta;
    g->k[2] = stiff * brc_lanes_dot(back, back) + bonds.ktheta;
    if (!(flags & POLY_TANGENTS))
        return;
    g->bond_kn = brc_lanes_where(poly_positive(r.opening), bonds.kn);
    g->bond_kt = bonds.kt;
    g->bond_ktheta = bonds.ktheta;
    poly_set3(g->bond_n, pose.n[0], pose.n[1], pose.n[2]);
    poly_set3(g->bond_arm, pose.arm[0], pose.arm[1], pose.arm[2]);
}

/* What contacts have used of their skin, `used` since they were looked at last; stable contacts
 * have nothing to decide in this step. One contact after the other, since these columns are read at
 * scattered places and hardly anything is computed with them. */
BRC_LANES_INLINE void poly_skins_of_four(struct poly_batch *batch, struct poly_contact4 *g,
                                         brc_lanes used, int32_t four)
{
    const struct brc_bodies *bodies = &batch->sim->bodies;
    const struct poly_contacts *columns = batch->contacts->model_columns;
    for (int32_t k = 0, i = BRC_LANES * four; k < BRC_LANES && i < batch->n_contacts; k++, i++) {
        size_t contact = (size_t)batch->contact[i];
        double path_a = bodies->path_length[batch->a[i]], rebuild_at = columns->rebuild_at[contact];
        g->gap[k] = rebuild_at - path_a - bodies->path_length[batch->b[i]];
        if (batch->listed[i]) {
            columns->skin_left[contact] -= used[k];
            batch->is_stable[i] = columns->ready[contact] &&
                                  columns->skin_left[contact] > columns->stable_above[contact];
        } else {
            batch->is_stable[i] = path_a + bodies->path_length[batch->b[i]] < rebuild_at;
        }
        batch->is_stable[i] &= !(g->broken[k] > 1);
    }
}

/* The contacts' columns: force on b and moments about both centres of a wrench about that of a. */
BRC_LANES_INLINE void poly_put_wrenches(const struct brc_contacts *c, const struct poly_wrench4 *w,
                                        const struct poly_contact4 *g,
                                        const int32_t contact[BRC_LANES])
{
    brc_lanes ta[3], tb[3];
    brc_lanes_cross(tb, g->x, w->f);
    for (int k = 0; k < 3; k++) {
        ta[k] = -w->m[k];
        tb[k] = -ta[k] - tb[k];
    }
    brc_lanes_scatter3(c->f, contact, w->f);
    brc_lanes_scatter3(c->ta, contact, ta);
    brc_lanes_scatter3(c->tb, contact, tb);
}

/* --- linearised contacts
 * --------------------------------------------------------------------------- */

/* Motion of four contacts since they were computed literally, as POLY_MOTION has it. */
struct poly_motion4 {
    brc_lanes d[3], path, turn[3], end, both[3], stored;
};

/* Adds the motion of the step. */
BRC_LANES_INLINE void poly_motion_add_step(struct poly_motion4 *s, const struct poly_frame4 *f,
                                           const struct poly_contact4 *g, double dt)
{
    for (int k = 0; k < 3; k++) {
        s->d[k] += dt * f->slip[k];
        s->turn[k] += dt * (g->wb[k] - g->wa[k]);
        s->both[k] += f->along[k].turn;
    }
    s->path += g->path;
}

/* Makes the frames of contacts that are computed literally those of the motion since they were
 * computed last: slip and slope are displacements. Returns the path of that motion. Tangential
 * springs have stood still while their contact was moved by its tangent: they get all of its motion
 * in one increment now. */
BRC_LANES_INLINE brc_lanes poly_frames_since(const struct poly_batch *batch, struct poly_frame4 *f,
                                             const struct poly_contact4 *g,
                                             const struct poly_index4 *i)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    const brc_lanes none = brc_lanes_all(0);
    struct poly_motion4 s;
    poly_gather_rows((brc_lanes *)&s, columns->motion[0], POLY_MOTION, i->contact, POLY_MOTION);
    poly_motion_add_step(&s, f, g, batch->sim->dt);
    for (int k = 0; k < 3; k++) {
        f->slip[k] = s.d[k];
        f->along[k].turn = s.both[k];
    }
    poly_set3(f->along[0].slope, none, -s.turn[2], s.turn[1]);
    poly_set3(f->along[1].slope, s.turn[2], none, -s.turn[0]);
    poly_set3(f->along[2].slope, -s.turn[1], s.turn[0], none);
    return s.path;
}

BRC_LANES_INLINE void poly_motion_kernel(struct poly_batch *batch, const int flags)
{
    const struct brc_contacts *c = batch->contacts;
    const bool is_platens = flags & POLY_PLATENS;
    poly_clear((brc_lanes *)batch->sum, sizeof batch->sum);
    for (int32_t four = 0; BRC_LANES * four < batch->n_contacts; four++) {
        struct poly_contact4 *g = &batch->four[four];
        struct poly_index4 i;
        struct poly_frame4 f;
        bool has_bond = false;
        poly_index_of(&i, batch, four);
        poly_motion_of_four(batch, g, &f, &i, is_platens);
        brc_lanes used = g->path;
        if (flags & POLY_TANGENTS)
            used = poly_frames_since(batch, &f, g, &i);
        for (int k = 0; k < BRC_LANES; k++)
            has_bond |= c->status[i.contact[k]] == BRC_INTACT;
        g->k[0] = g->k[1] = g->k[2] = g->broken = g->bond_stored = brc_lanes_all(0);
        poly_clear((brc_lanes *)&g->bond, sizeof g->bond);
        if (has_bond)
            poly_bond_forces(batch, g, &i, flags);
        if (!is_platens)
            poly_skins_of_four(batch, g, used, four);
        poly_put_rows(batch->frame[BRC_LANES * four], POLY_FRAME, poly_in_turn, (brc_lanes *)&f,
                      POLY_FRAME);
    }
}

#endif
