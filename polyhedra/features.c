/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One feature pair at a time. It walks over the features of a core, so the loop comes here only
 * for a vertex whose closest feature is not sure. It computes nothing that the laws do not: it
 * finds the feature, and hands the distance on. */
#include "polyhedra/features.h"

#include "polyhedra/listing_kernels.inc.h"

int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance)
{
    return poly_list_all(ctx, l, p, rule, skin, allowance);
}

/* --- vertices --------------------------------------------------------------------------------- */

/* The other core's vertices near v lower its weight. The same lines as in the loop
 * (poly_fade_vertices), with other places to read vertices from: one law, so that a contact may go
 * over from here to there without a jump. */
static void fade_vertex(struct poly_geometry4 *t, const struct poly_pair *p, bool of_b,
                        const brc_lanes v[3], brc_lanes sign, const int32_t near[POLY_NEAR])
{
    const struct poly_lengths len = {.contact_distance = p->contact_distance, .fade = p->fade};
    const double(*u)[3] = of_b ? p->va : p->vb;
    bool all = near[0] == POLY_MANY_NEAR;
    int32_t n = all ? (of_b ? p->a.n_vertices : p->b.n_vertices) : POLY_NEAR;
    struct poly_fading f;
    poly_fading_begin(&f);
    for (int32_t i = 0; i < n && (all || near[i] != POLY_NONE_NEAR); i++) {
        brc_lanes r[3];
        poly_all3(r, u[all ? i : near[i]]);
        poly_sub3(r, v, r);
        poly_fading_add(&f, r, brc_lanes_first(BRC_LANES), &len);
    }
    poly_weigh_vertex(t, v, sign, &f);
}

/* The vertex of a feature pair in the frame of the other core, which is returned. */
static const struct poly_core *vertex_in_body(double q[3], const struct poly_pair *p,
                                              const struct poly_feature *f)
{
    bool of_b = f->kind == POLY_VERTEX_B;
    poly_to_body(q, of_b ? p->ra : p->rb, of_b ? p->xa : p->xb, of_b ? p->vb[f->j] : p->va[f->i]);
    return of_b ? &p->a : &p->b;
}

int32_t poly_feature_of_face(const struct poly_pair *p, struct poly_feature *f)
{
    double q[3];
    const struct poly_core *c = vertex_in_body(q, p, f);
    struct poly_closest at;
    poly_closest_on_face(&at, c, *poly_remembered(f), q);
    return at.feature;
}

/* Vertex of one body against a face of the other, or its core (`merged`). */
static bool touch_vertex(struct poly_geometry *t, const struct poly_pair *p, struct poly_feature *f,
                         double *margin, enum poly_rule rule)
{
    bool of_b = f->kind == POLY_VERTEX_B;
    const double(*rm)[3] = of_b ? p->ra : p->rb;
    const double *v = of_b ? p->vb[f->j] : p->va[f->i];
    double q[3], out[3];
    const struct poly_core *c = vertex_in_body(q, p, f);
    int32_t *feature = poly_remembered(f);
    struct poly_closest at;
    *margin = 0;
    if (rule == POLY_MERGED) {
        poly_closest_walk(&at, c, q, *feature);
        *margin = poly_closest_margin(c, &at, q);
        *feature = at.feature;
    } else if (!poly_closest_of_rule(&at, c, *feature, q, rule == POLY_STRICT,
                                     p->contact_distance)) {
        t->delta = -poly_path_to_face(c, *feature, q, rule == POLY_STRICT, p->contact_distance);
        return false;
    } else if (rule == POLY_CLOSED) {
        *margin = poly_closest_margin_of_face(c, *feature, &at, q);
    } else if (poly_height(&c->face[*feature], q) > 0) {
        *margin = poly_closest_margin(c, &at, q);
    }
    struct poly_geometry4 all;
    brc_lanes vertex[3], normal[3], sign = brc_lanes_all(of_b ? 1 : -1);
    /* The distance is that of the walk, in the body frame. The loop has it from the planes and
     * vertices in space; both are right to round-off, and a contact goes over to the loop as
     * soon as its feature is sure. */
    brc_set(out, brc_dot(rm[0], at.n), brc_dot(rm[1], at.n), brc_dot(rm[2], at.n));
    poly_all3(vertex, v);
    poly_all3(normal, out);
    brc_mask touches =
        poly_vertex_geometry(&all, vertex, brc_lanes_all(at.s), normal, sign, p->contact_distance);
    if (rule == POLY_MERGED && f->near[0] != POLY_NONE_NEAR)
        fade_vertex(&all, p, of_b, vertex, sign, f->near);
    poly_geometry_lane(t, &all, 0);
    return touches[0];
}

/* --- edges ------------------------------------------------------------------------------------ */

/* In space, as the loop has it: the body frame of either core would prefer one of the two. */
static void ends_of_edges(brc_lanes ends[4][3], const struct poly_pair *p,
                          const struct poly_feature *f)
{
    for (int k = 0; k < 2; k++) {
        poly_all3(ends[k], p->va[p->a.end[f->i][k]]);
        poly_all3(ends[2 + k], p->vb[p->b.end[f->j][k]]);
    }
}

double poly_closed_gap(const struct poly_pair *p, struct poly_feature *f)
{
    struct poly_crossings x;
    brc_lanes ends[4][3];
    double q[3];
    if (f->kind != POLY_EDGES) {
        const struct poly_core *c = vertex_in_body(q, p, f);
        return poly_path_to_face(c, *poly_remembered(f), q, false, p->contact_distance);
    }
    ends_of_edges(ends, p, f);
    poly_cross_edges(&x, ends);
    return poly_edge_gap(&x, p->contact_distance)[0];
}

static bool touch_edges(struct poly_geometry *t, const struct poly_pair *p,
                        const struct poly_feature *f, uint8_t *active, enum poly_rule rule)
{
    /* path_to_inside is right for paths up to the skin: none is longer than the reach */
    const struct poly_lengths len = {p->contact_distance, p->fade, p->reach};
    struct poly_geometry4 all;
    brc_lanes ends[4][3], side = brc_lanes_all(*active == 1 ? 1 : *active == 2 ? -1 : 0);
    ends_of_edges(ends, p, f);
    brc_mask touches = poly_edge_geometry(&all, &len, ends, &side, brc_lanes_all(p->reach), rule);
    /* 3: edges of `closed` that touch without crossing have no side to remember. */
    *active = !touches[0] ? 0 : side[0] < 0 ? 2 : side[0] > 0 ? 1 : 3;
    poly_geometry_lane(t, &all, 0);
    return *active != 0;
}

bool poly_find_contact(struct poly_geometry *t, const struct poly_pair *p, struct poly_feature *f,
                       uint8_t *active, double *margin, enum poly_rule rule)
{
    *margin = 0;
    if (f->kind == POLY_EDGES)
        return touch_edges(t, p, f, active, rule);
    *active = touch_vertex(t, p, f, margin, rule);
    return *active;
}
