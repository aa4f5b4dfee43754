/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy stored in bonds and springs, from the state alone: what the ledger is checked against. */
#include "polyhedra/platen_geometry.h"

struct store {
    double kn, kt;
    const struct poly_points *points;
    double (*of_grain)[BRC_N_ACCOUNTS];
};

static void add_point(const struct store *s, int32_t a, const struct poly_geometry *t, size_t p)
{
    double *stored = s->of_grain[a];
    stored[BRC_ACCOUNT_NORMAL] += 0.5 * s->kn * t->weight * t->delta * t->delta;
    stored[BRC_ACCOUNT_SHEAR] += 0.5 * s->kt * t->weight * brc_norm2(poly_xi(s->points, p));
}

static void add_active(void *user, const struct poly_active *active)
{
    add_point(user, active->a, &active->geometry, active->point);
}

/* Also those of linearised contacts are taken from the pose: the ledger shows by this what
 * linearising leaves out. */
static void add_bonds(const struct store *s, const struct brc_sim *sim, const struct poly_state *st,
                      const struct brc_contacts *c)
{
    struct poly_bond bond;
    for (size_t row = 0; row < c->n; row++)
        if (c->status[row] == BRC_INTACT && poly_bond_of_contact(&bond, sim, st, c, row))
            s->of_grain[c->a[row]][BRC_ACCOUNT_BOND] += bond.energy;
}

void poly_energy(const struct brc_sim *sim, const void *state, double (*of_grain)[BRC_N_ACCOUNTS])
{
    const struct poly_state *st = state;
    const struct poly_params *p = poly_params_of(sim);
    const struct brc_contacts *c = &sim->platens;
    struct store s = {poly_pair_stiffness(p->kn, p->kn), poly_pair_stiffness(p->kt, p->kt),
                      sim->pairs.point_columns, of_grain};
    poly_each_active(sim, st, add_active, &s);
    s.points = c->point_columns;
    for (size_t row = 0; row < c->n; row++)
        for (size_t q = (size_t)c->p0[row], end = q + (size_t)c->np[row]; q < end; q++) {
            struct poly_geometry t;
            if (poly_platen_contact(&t, sim, st, row, q, 0))
                add_point(&s, c->a[row], &t, q);
        }
    add_bonds(&s, sim, st, &sim->pairs);
    add_bonds(&s, sim, st, c);
}
