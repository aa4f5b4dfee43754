/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies and pairs in space for the present poses; what the literal evaluation finds of them.
 * Forces, energy and springs begin by it. Nothing of it is state: a restart makes it anew from
 * positions and quaternions. */
#include "polyhedra/platen_geometry.h"

/* Rotation matrices of platens, too, since the hold of a platen is a bond whose halves are turned
 * like others. */
void poly_pose_bodies(const struct brc_sim *sim, const struct poly_state *st)
{
    for (size_t i = 0; i < sim->bodies.n; i++)
        brc_quat_matrix(st->rotation[i], sim->bodies.q[i]);
    st->kernels.pose(sim, st);
}

/* A view, nothing is copied: it is made for each pair that is looked at literally. Both radii are
 * R, as a case has one sphero-radius; they stand apart where the paper has R1 + R2. */
void poly_pair_of(struct poly_pair *p, const struct brc_sim *sim, const struct poly_state *st,
                  int32_t a, int32_t b)
{
    const struct poly_shapes *s = &st->shapes;
    double radius = poly_params_of(sim)->radius;
    *p = (struct poly_pair){.a = poly_core_of(s, (size_t)a),
                            .b = poly_core_of(s, (size_t)b),
                            .xa = sim->bodies.x[a],
                            .xb = sim->bodies.x[b],
                            .ra = (const double(*)[3])st->rotation[a],
                            .rb = (const double(*)[3])st->rotation[b],
                            .va = (const double(*)[3])(st->global_vertices + s->first[a].vertex),
                            .vb = (const double(*)[3])(st->global_vertices + s->first[b].vertex),
                            .contact_distance = radius + radius,
                            .fade = radius,
                            .reach = poly_core_reach(sim, a, b)};
}

/* By the literal functions throughout, so that what is found here is a check of the loop. What a
 * point remembers (side, closest feature) is copied: a question about the state must not change it.
 */
void poly_each_touch(const struct brc_sim *sim, const struct poly_state *st,
                     const struct brc_contacts *c, size_t contact, double skin,
                     void (*visit)(void *user, const struct poly_active *active), void *user)
{
    const struct poly_points *points = c->point_columns;
    enum poly_rule rule = (enum poly_rule)poly_params_of(sim)->features;
    struct poly_active t = {.a = c->a[contact], .b = c->b[contact], .contact = contact};
    struct poly_pair pair;
    bool is_platen = c == &sim->platens;
    if (!is_platen) {
        poly_pair_of(&pair, sim, st, t.a, t.b);
        pair.contact_distance += skin;
    }
    for (size_t p = (size_t)c->p0[contact], end = p + (size_t)c->np[contact]; p < end; p++) {
        uint8_t active = points->active[p];
        double margin;
        t.point = p;
        t.feature = poly_point(points, p);
        if (is_platen ? poly_platen_contact(&t.geometry, sim, st, contact, p, skin)
                      : poly_find_contact(&t.geometry, &pair, &t.feature, &active, &margin, rule))
            visit(user, &t);
    }
}

void poly_each_active(const struct brc_sim *sim, const struct poly_state *st,
                      void (*visit)(void *user, const struct poly_active *active), void *user)
{
    poly_pose_bodies(sim, st);
    for (size_t contact = 0; contact < sim->pairs.n; contact++)
        poly_each_touch(sim, st, &sim->pairs, contact, 0, visit, user);
}
