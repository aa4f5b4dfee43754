/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy stored in bonds and springs, from the state alone: what the ledger is checked against.
 * Called by common/ when somebody asks how far the ledger has drifted, so it may be slow. It shares
 * the laws with the loop, but not one sum, list or tangent. */
#include "polyhedra/poly.h"

struct store {
    double kn, kt;
    const struct poly_points *points;
    double (*of_grain)[BRC_N_ACCOUNTS];
};

/* On the account of a, as the loop books it. */
static void add_touch(void *user, const struct poly_active *active)
{
    const struct store *s = user;
    const struct poly_geometry *t = &active->geometry;
    double *stored = s->of_grain[active->a];
    stored[BRC_ACCOUNT_NORMAL] += 0.5 * s->kn * t->weight * t->delta * t->delta;
    stored[BRC_ACCOUNT_SHEAR] +=
        0.5 * s->kt * t->weight * brc_norm2(s->points->spring[active->point] + POLY_XI);
}

/* Also those of linearised contacts are taken from the pose: the ledger shows by this what
 * linearising leaves out. */
static void add_bonds(const struct store *s, const struct brc_sim *sim, const struct poly_state *st,
                      const struct brc_contacts *c)
{
    struct poly_bond bond;
    for (size_t contact = 0; contact < c->n; contact++)
        if (c->status[contact] == BRC_INTACT && poly_bond_of_contact(&bond, sim, st, c, contact))
            s->of_grain[c->a[contact]][BRC_ACCOUNT_BOND] += bond.energy;
}

void poly_energy(const struct brc_sim *sim, const void *state, double (*of_grain)[BRC_N_ACCOUNTS])
{
    const struct poly_state *st = state;
    const struct poly_params *p = poly_params_of(sim);
    const struct brc_contacts *c = &sim->platens;
    struct store s = {poly_pair_stiffness(p->kn, p->kn), poly_pair_stiffness(p->kt, p->kt),
                      sim->pairs.point_columns, of_grain};
    poly_each_active(sim, st, add_touch, &s);
    s.points = c->point_columns;
    for (size_t contact = 0; contact < c->n; contact++)
        poly_each_touch(sim, st, c, contact, 0, add_touch, &s);
    add_bonds(&s, sim, st, &sim->pairs);
    add_bonds(&s, sim, st, c);
}
