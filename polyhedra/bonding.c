/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bonds of a specimen at its start: of grains over the facets that they share, and the holds of
 * platens on the facets that lie on them. Called once, by sim.c; bonds come from nowhere else. What
 * a bond is made of stays as it is until the bond breaks; the law (bond.h) only reads it. */
#include "polyhedra/poly.h"

#include <stdlib.h>

/* Material points, normals and tangents of a contact's bond in the frames of its bodies; n from a.
 */
/* Points and directions are kept in both bodies rather than a displacement that is added up: rigid
 * motion of a pair gives no force then, whatever the angle, and nothing drifts. The tangents are
 * one in space at the start and are carried by a body each: what they have turned against each
 * other is the twist. */
static void fix_bond(const struct brc_sim *sim, const struct brc_contacts *c, size_t contact,
                     const double at[3], const double n[3])
{
    static const int part[2][3] = {{POLY_BOND_CA, POLY_BOND_NA, POLY_BOND_TA},
                                   {POLY_BOND_CB, POLY_BOND_NB, POLY_BOND_TB}};
    const struct poly_contacts *columns = c->model_columns;
    const int32_t body[2] = {c->a[contact], c->b[contact]};
    double *bond = columns->bond[contact], t[3], unused[3];
    brc_frame(t, unused, n);
    for (int k = 0; k < 2; k++) {
        double m[3][3], arm[3], out[3];
        brc_quat_matrix(m, sim->bodies.q[body[k]]);
        brc_sub(arm, at, sim->bodies.x[body[k]]);
        brc_scale(out, n, k == 0 ? 1 : -1);
        brc_mat_mul_t(bond + part[k][0], m, arm);
        brc_mat_mul_t(bond + part[k][1], m, out);
        brc_mat_mul_t(bond + part[k][2], m, t);
    }
}

/* Bond of two grains over a facet. */
static void open_bond(struct brc_sim *sim, struct poly_state *st, size_t contact, size_t facet)
{
    const struct brc_facets *f = &sim->specimen->facets;
    const struct poly_params *params = poly_params_of(sim);
    struct brc_contacts *c = &sim->pairs;
    struct poly_contacts *columns = c->model_columns;
    const double *xa = sim->bodies.x[c->a[contact]], *xb = sim->bodies.x[c->b[contact]];
    double ea = st->eroded[facet][0], eb = st->eroded[facet][1];
    c->facet[contact] = (int32_t)facet;
    /* Erosion may take away a small facet on one side or both. With the area of the facet it is
     * bonded all the same: the rock was bonded there. */
    st->n_removed += ea == 0 || eb == 0;
    columns->bond[contact][POLY_BOND_AREA] = f->area[facet];
    if (params->area == POLY_AREA_ERODED)
        columns->bond[contact][POLY_BOND_AREA] = ea == 0 || eb == 0 ? 0 : 0.5 * (ea + eb);
    columns->bond[contact][POLY_BOND_LENGTH] =
        params->strain_length == POLY_LENGTH_GAP ? 2 * params->radius : brc_distance(xa, xb);
    fix_bond(sim, c, contact, f->centroid[facet], f->normal[facet]);
    if (!params->bonds || columns->bond[contact][POLY_BOND_AREA] == 0)
        return;
    c->status[contact] = BRC_INTACT;
    st->n_bonds++;
    st->mean_area += columns->bond[contact][POLY_BOND_AREA];
    st->mean_length += columns->bond[contact][POLY_BOND_LENGTH];
}

/* Hold of a platen on a grain by its boundary facet: the grain's half of a bond, as stiff as the
 * distance of its centre (or the gap R) makes it. A platen has no half of its own, being rigid. Its
 * normal is that of its surface at the facet, so that a curved platen holds each facet along its
 * own line. */
static void open_hold(struct brc_sim *sim, struct poly_state *st, size_t contact,
                      const struct brc_platen *p, size_t facet)
{
    const struct brc_facets *f = &sim->specimen->facets;
    const struct poly_params *params = poly_params_of(sim);
    struct brc_contacts *c = &sim->platens;
    struct poly_contacts *columns = c->model_columns;
    const double *at = sim->bodies.x[p->body];
    double height, unused, n[3], back[3];
    brc_platen_height(p, at, sim->bodies.x[c->a[contact]], &height, n);
    brc_platen_height(p, at, f->centroid[facet], &unused, n);
    brc_scale(back, n, -1);
    c->facet[contact] = (int32_t)facet;
    columns->bond[contact][POLY_BOND_AREA] =
        params->area == POLY_AREA_FACET ? f->area[facet] : st->eroded[facet][0];
    columns->bond[contact][POLY_BOND_LENGTH] =
        params->strain_length == POLY_LENGTH_GAP ? params->radius : height;
    fix_bond(sim, c, contact, f->centroid[facet], back);
    if (p->bonding != BRC_BONDING_NONE && columns->bond[contact][POLY_BOND_AREA] > 0)
        c->status[contact] = BRC_INTACT;
}

/* Contacts with platens are those of the facets that lie on them, and hold where the platen does.
 */
static int open_platens(struct brc_sim *sim, struct poly_state *st)
{
    struct brc_facing *facing;
    size_t n_facing, n = 0;
    BRC_TRY(brc_platens_facing(sim, &facing, &n_facing));
    for (size_t i = 0; i < n_facing; i++)
        if (facing[i].is_on)
            facing[n++] = facing[i];
    int code = brc_contacts_open(sim->ctx, &sim->platens, facing, n);
    for (size_t i = 0; code == 0 && i < n; i++) {
        int64_t contact = brc_contacts_find(&sim->platens, facing[i].cell, facing[i].body);
        open_hold(sim, st, (size_t)contact, brc_sim_platen(sim, facing[i].body),
                  (size_t)facing[i].facet);
    }
    free(facing);
    return code;
}

/* Two grains have one facet at most, so contact i is that of the i-th one. */
int poly_open_bonds(struct brc_sim *sim, void *state)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct poly_state *st = state;
    struct brc_facing *facet = brc_alloc(sim->ctx, f->n_facets, sizeof *facet);
    size_t n = 0;
    if (facet == NULL)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < f->n_facets; i++)
        if (f->cell[i][1] >= 0 && f->is_contact[i])
            facet[n++] = (struct brc_facing){f->cell[i][0], f->cell[i][1], (int32_t)i, false};
    int code = brc_contacts_open(sim->ctx, &sim->pairs, facet, n);
    for (size_t i = 0; code == 0 && i < n; i++)
        open_bond(sim, st, i, (size_t)facet[i].facet);
    free(facet);
    if (st->n_bonds > 0) {
        st->mean_area /= (double)st->n_bonds;
        st->mean_length /= (double)st->n_bonds;
    }
    return code == 0 ? open_platens(sim, st) : code;
}
