/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy stored in bonds and springs, from the state alone: what the ledger is checked against. */
#include "polyhedra/platen_geometry.h"

struct store {
    double kn, kt;
    const struct poly_points *points;
    double *stored;
};

static void add_point(const struct store *s, double weight, double delta, size_t p)
{
    s->stored[1] += 0.5 * s->kn * weight * delta * delta;
    s->stored[2] += 0.5 * s->kt * weight * brc_norm2(poly_xi(s->points, p));
}

static void add_active(void *user, const struct poly_active *active)
{
    add_point(user, active->geometry.weight, active->geometry.delta, active->point);
}

/* Also those of linearised contacts are taken from the pose: the ledger shows by this what
 * linearising leaves out. */
static double bond_energy(const struct brc_sim *sim, const struct poly_state *st,
                          const struct brc_contacts *c)
{
    double energy = 0;
    struct poly_bond bond;
    for (size_t row = 0; row < c->n; row++)
        if (c->status[row] == BRC_INTACT && poly_bond_of_contact(&bond, sim, st, c, row))
            energy += bond.energy;
    return energy;
}

void poly_energy(const struct brc_sim *sim, const void *state, double stored[3])
{
    const struct poly_state *st = state;
    const struct poly_params *p = poly_params_of(sim);
    const struct brc_contacts *c = &sim->platens;
    struct store s = {poly_pair_stiffness(p->kn, p->kn), poly_pair_stiffness(p->kt, p->kt),
                      sim->pairs.point_columns, stored};
    brc_set(stored, 0, 0, 0);
    poly_each_active(sim, st, add_active, &s);
    s.points = c->point_columns;
    for (size_t row = 0; row < c->n; row++)
        for (size_t q = (size_t)c->p0[row], end = q + (size_t)c->np[row]; q < end; q++) {
            struct poly_geometry t;
            if (poly_platen_contact(&t, sim, st, row, q, 0))
                add_point(&s, t.weight, t.delta, q);
        }
    stored[0] = bond_energy(sim, st, &sim->pairs) + bond_energy(sim, st, c);
}
