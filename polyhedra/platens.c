/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Platens: rigid planes against the rounded vertices of the cores, and the holds of grips. */
#include "step.h"

bool poly_touch_platen(struct poly_touch *t, const double v[3], const struct brc_platen *platen,
                       const double at[3], double radius)
{
    double d[3];
    brc_sub(d, v, at);
    double height = brc_dot(d, platen->n);
    if (height >= radius || fabs(brc_dot(d, platen->across)) > platen->half_width)
        return false;
    poly_touch_begin(t, radius - height); /* eq:gt12:5 */
    brc_scale(t->n, platen->n, -1);
    brc_copy(t->x, v);
    brc_axpy(t->x, -0.5 * height, platen->n);
    return true;
}

void poly_hold_law(struct poly_bond_result *r, const struct brc_sim *sim,
                   const struct poly_state *st, size_t row, struct poly_bond *bond)
{
    const struct brc_contacts *c = &sim->platens;
    struct poly_bond_pose pose;
    *bond = poly_bond_of(poly_params_of(sim), c->model_columns, row);
    bond->ktheta = 0;
    if (brc_sim_platen(sim, c->b[row])->bonding == BRC_BONDING_GRIP)
        bond->kt = 0;
    poly_pose_bond(&pose, c, row, st, &sim->bodies, false);
    /* the platen is rigid and does not turn: its normal is the hold's */
    brc_scale(pose.na, pose.nb, -1);
    poly_bond_law(r, bond, &pose, false);
}

static void points_row(struct brc_sim *sim, const struct poly_state *st, size_t row,
                       struct poly_sums *s, const struct poly_motion *m, bool viscous)
{
    const struct poly_params *p = poly_params_of(sim);
    struct brc_contacts *c = &sim->platens;
    const struct poly_points *points = c->point_columns;
    const struct brc_platen *platen = brc_sim_platen(sim, c->b[row]);
    struct brc_ledger *ledger = BRC_OPTION(sim->run.ledger) ? &sim->ledger : NULL;
    double mass = sim->bodies.true_mass[c->a[row]];
    struct poly_spring_law law = {.kn = poly_pair_stiffness(p->kn, p->kn),
                                  .kt = poly_pair_stiffness(p->kt, p->kt),
                                  .mu = platen->friction,
                                  .gn = p->gn * mass,
                                  .gt = p->gt * mass};
    bool friction = law.mu > 0 && law.kt > 0;
    const double(*world)[3] = (const double(*)[3])(st->world + st->shapes.vertex_first[c->a[row]]);
    for (int32_t k = 0; k < c->np[row]; k++) {
        size_t q = (size_t)c->p0[row] + (size_t)k;
        struct poly_touch t;
        if (poly_touch_platen(&t, world[points->i[q]], platen, m->xb, p->radius)) {
            poly_act(ledger, s, &t, &law, m, points, q, friction, viscous);
            if (-t.delta < s->gap)
                s->gap = -t.delta;
            points->active[q] = 1;
        } else if (points->active[q]) {
            if (friction)
                poly_release(ledger, &law, m, poly_xi(points, q), *poly_weight(points, q));
            *poly_weight(points, q) = 0;
            points->active[q] = 0;
        }
    }
}

void poly_platens(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    struct brc_contacts *c = &sim->platens;
    bool viscous = BRC_OPTION(poly_is_viscous(sim));
    const struct poly_rows *rows = c->model_columns;
    for (size_t row = 0; row < c->n; row++) {
        if (poly_is_awake(sim, c, row) &&
            (poly_list_wall(sim, st, row) != 0 || poly_foresee(sim, st, row, true) != 0))
            return;
        if (poly_is_idle(c, row))
            continue;
        struct poly_motion m;
        poly_start_motion(&m, sim, c->a[row], c->b[row]);
        struct poly_sums s = {.gap = rows->wake[row] - sim->bodies.path_length[c->a[row]] -
                                     sim->bodies.path_length[c->b[row]]};
        struct poly_wrench hold = {0};
        if (c->status[row] == BRC_INTACT) {
            struct poly_bond bond;
            struct poly_bond_result r;
            poly_hold_law(&r, sim, st, row, &bond);
            poly_push_bond(&hold, s.k, &r, &bond, &m);
        }
        if (c->np[row] > 0)
            points_row(sim, st, row, &s, &m, viscous);
        poly_finish_row(c, row, &s, &hold, &m);
        poly_store_k(c, row, s.k);
        if (BRC_OPTION(sim->run.ledger))
            poly_account(&sim->ledger, rows, row, &s, &hold, &m, viscous);
    }
}
