/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies and pairs in space for the present poses; what the literal evaluation finds of them. */
#include "polyhedra/poly.h"

void poly_pose_bodies(const struct brc_sim *sim, const struct poly_state *st)
{
    for (size_t i = 0; i < sim->bodies.n; i++)
        brc_quat_matrix(st->rotation[i], sim->bodies.q[i]);
    st->kernels.pose(sim, st);
}

/* A view, nothing is copied: it is made for each pair that is looked at literally. */
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
                            .va = (const double(*)[3])(st->global_vertices + s->vertex_first[a]),
                            .vb = (const double(*)[3])(st->global_vertices + s->vertex_first[b]),
                            .contact_distance = radius + radius,
                            .fade = radius,
                            .reach = poly_core_reach(sim, a, b)};
}

void poly_each_active(const struct brc_sim *sim, const struct poly_state *st,
                      void (*visit)(void *user, const struct poly_active *active), void *user)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct poly_points *points = c->point_columns;
    enum poly_rule rule = (enum poly_rule)poly_params_of(sim)->features;
    poly_pose_bodies(sim, st);
    for (size_t row = 0; row < c->n; row++) {
        struct poly_pair pair;
        poly_pair_of(&pair, sim, st, c->a[row], c->b[row]);
        for (int32_t k = 0; k < c->np[row]; k++) {
            size_t p = (size_t)c->p0[row] + (size_t)k;
            struct poly_active found = {.a = c->a[row],
                                        .b = c->b[row],
                                        .row = row,
                                        .point = p,
                                        .feature = poly_point(points, p)};
            uint8_t active = points->active[p];
            double margin;
            if (poly_find_contact(&found.geometry, &pair, &found.feature, &active, &margin, rule))
                visit(user, &found);
        }
    }
}
