/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "features.h"

#include "listing.h"

#include <stdlib.h>
#include <string.h>

void poly_list_free(struct poly_list *l)
{
    free(l->feature);
    free(l->work);
    free(l->edge);
    memset(l, 0, sizeof *l);
}

int poly_list_add(struct brc_context *ctx, struct poly_list *l, const struct poly_feature *f)
{
    if (l->n == l->cap) {
        size_t cap = l->cap > 0 ? 2 * l->cap : 64;
        struct poly_feature *grown = brc_realloc(ctx, l->feature, cap, sizeof *grown);
        if (grown == NULL)
            return BRC_ERR_MEMORY;
        l->feature = grown;
        l->cap = cap;
    }
    l->feature[l->n++] = *f;
    return 0;
}

double poly_path_to_face(const struct poly_core *c, int32_t face, const double q[3],
                         enum poly_rule rule, double rest)
{
    struct poly_foot foot;
    double highest;
    poly_highest(c, q, &highest);
    if (highest <= 0)
        return 0;
    poly_foot_closed(&foot, c, face, q);
    double path = foot.s - rest;
    int32_t out = rule == POLY_STRICT ? poly_outside(c, &c->face[face], q) : -1;
    return out < 0 ? path : poly_most(path, brc_dot(c->side[out].m, q) - c->side[out].off);
}

int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance)
{
    return list_features(ctx, l, p, rule, skin, allowance);
}

double poly_free_path(const struct poly_pair *p, const struct poly_feature *f, enum poly_rule rule,
                      double most)
{
    if (f->kind == POLY_EDGES) {
        const struct edge_pairs at = {.i = {f->i, f->i, f->i, f->i}, .j = {f->j, f->j, f->j, f->j}};
        return paths_of_edges(p, &at, rule, most)[0];
    }
    bool of_b = f->kind == POLY_VERTEX_B;
    const struct poly_core *c = of_b ? &p->a : &p->b;
    double q[3];
    poly_to_body(q, of_b ? p->ra : p->rb, of_b ? p->xa : p->xb, of_b ? p->vb[f->j] : p->va[f->i]);
    return poly_path_to_face(c, of_b ? f->i : f->j, q, rule, p->rest);
}

/* --- feet ------------------------------------------------------------------------------------- */

double poly_foot_margin(const struct poly_core *c, const struct poly_foot *foot, const double q[3])
{
    int32_t index = foot->place >> 2;
    double margin = foot->s, along[3], d[3];
    if ((foot->place & 3) == POLY_ON_FACE) {
        const struct poly_face *f = &c->face[index];
        for (int32_t k = f->first; k < f->first + f->n_sides; k++)
            margin = poly_least(margin, c->side[k].off - brc_dot(c->side[k].m, q));
    } else if ((foot->place & 3) == POLY_ON_EDGE) {
        const struct poly_edge *e = &c->edge[index];
        double t = poly_along_edge(c, index, q, along), length = brc_norm(along);
        margin = poly_least(margin, poly_least(t, 1 - t) * length);
        for (int k = 0; k < 2; k++) {
            const struct poly_side *side = &c->side[e->side[k]];
            margin = poly_least(margin, brc_dot(side->m, q) - side->off);
        }
    } else {
        brc_sub(d, q, c->vertex[index]);
        for (int32_t k = c->star_first[index]; k < c->star_first[index + 1]; k++) {
            const int32_t *end = c->end[c->star[k]];
            brc_sub(along, c->vertex[end[0] + end[1] - index], c->vertex[index]);
            margin = poly_least(margin, -brc_dot(d, along) / brc_norm(along));
        }
    }
    return margin;
}

double poly_find_foot(struct poly_foot *foot, const struct poly_core *c, const double q[3],
                      int32_t place)
{
    poly_foot_walk(foot, c, q, place);
    return poly_foot_margin(c, foot, q);
}
