/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bond of one contact alone, for events, energy and springs: the lanes of the loop with the
 * same contact in each. */
#include "polyhedra/motion_kernels.inc.h"

/* Four times the work of one bond, for what is asked seldom: a scalar twin of the law would be a
 * second place to be wrong in. */
bool poly_bond_of_contact(struct poly_bond *r, const struct brc_sim *sim,
                          const struct poly_state *st, const struct brc_contacts *c, size_t contact)
{
    int32_t n = (int32_t)contact, a = c->a[contact], b = c->b[contact];
    const struct poly_index4 i = {{n, n, n, n}, {a, a, a, a}, {b, b, b, b}};
    struct poly_bonds4 bonds;
    struct poly_bond_pose4 pose;
    struct poly_bond_state4 all;
    brc_lanes xa[3], x[3];
    poly_all3(xa, sim->bodies.x[a]);
    poly_all3(x, sim->bodies.x[b]);
    poly_sub3(x, x, xa);
    int own = poly_params_of(sim)->torsion ? POLY_TORSION : 0;
    brc_mask intact = poly_bonds_of_four(&bonds, &pose, sim, st, c, &i, x,
                                         c == &sim->platens ? POLY_PLATENS : own);
    poly_bond_law(&all, &bonds, &pose);
    *r = (struct poly_bond){
        .kn = bonds.kn[0], .kt = bonds.kt[0], .ktheta = bonds.ktheta[0], .energy = all.energy[0]};
    poly_lane3(r->n, pose.n, 0);
    poly_lane3(r->x, pose.arm, 0);
    brc_add(r->x, r->x, sim->bodies.x[a]);
    poly_lane3(r->term, all.term, 0);
    return intact[0] != 0;
}

/* The largest part of the limit names the mode of an event; the paper has no modes. */
int poly_bond_mode(const struct poly_bond *bond)
{
    int mode = bond->term[1] > bond->term[0] ? 1 : 0;
    return bond->term[2] > bond->term[mode] ? 2 : mode;
}
