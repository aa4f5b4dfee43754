/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "features.h"

#include <stdlib.h>
#include <string.h>

void poly_list_free(struct poly_list *l)
{
    free(l->feature);
    free(l->height);
    free(l->near);
    memset(l, 0, sizeof *l);
}

/* One body of a pair as seen from the other: its vertices in the other's frame. */
struct side {
    const struct poly_core *own, *other;
    const double (*v)[3]; /* own vertices in space */
    const double *x;      /* the other's pose */
    const double (*r)[3];
    double *height;    /* [n_vertices of own][n_faces of other] above the planes */
    bool *near_vertex; /* may come within reach of the other core */
    bool *near_edge;
};

static int reserve(struct brc_context *ctx, struct poly_list *l, size_t heights, size_t nears)
{
    if (heights > l->cap_height) {
        double *grown = brc_realloc(ctx, l->height, 2 * heights, sizeof *grown);
        if (grown == NULL)
            return BRC_ERR_MEMORY;
        l->height = grown;
        l->cap_height = 2 * heights;
    }
    if (nears > l->cap_near) {
        bool *grown = brc_realloc(ctx, l->near, 2 * nears, sizeof *grown);
        if (grown == NULL)
            return BRC_ERR_MEMORY;
        l->near = grown;
        l->cap_near = 2 * nears;
    }
    return 0;
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

static const int32_t none_near[POLY_NEAR] = {POLY_NONE_NEAR, POLY_NONE_NEAR, POLY_NONE_NEAR,
                                             POLY_NONE_NEAR};

/* Vertex v of the own core and a face or place of the other. */
static int add_vertex(struct brc_context *ctx, struct poly_list *l, bool of_b, int32_t v,
                      int32_t place, const int32_t near[POLY_NEAR], double gap)
{
    struct poly_feature f = {.free = gap,
                             .i = of_b ? place : v,
                             .j = of_b ? v : place,
                             .kind = of_b ? POLY_VERTEX_B : POLY_VERTEX_A};
    memcpy(f.near, near, sizeof f.near);
    return poly_list_add(ctx, l, &f);
}

/* Heights of the own vertices above the other's planes. Returns the largest gap along one of these
 * planes: a lower bound of the distance of the cores. */
static double measure_heights(struct side *s)
{
    int32_t n_faces = s->other->n_faces;
    double gap = -HUGE_VAL;
    for (int32_t v = 0; v < s->own->n_vertices; v++) {
        double q[3];
        poly_to_body(q, s->r, s->x, s->v[v]);
        for (int32_t f = 0; f < n_faces; f++)
            s->height[v * n_faces + f] = poly_height(&s->other->face[f], q);
    }
    for (int32_t f = 0; f < n_faces; f++) {
        double lowest = HUGE_VAL;
        for (int32_t v = 0; v < s->own->n_vertices; v++)
            lowest = poly_least(lowest, s->height[v * n_faces + f]);
        gap = poly_most(gap, lowest);
    }
    return gap;
}

/* A vertex or edge that lies beyond reach of one of the other's planes cannot touch. */
static void find_near(struct side *s, double reach)
{
    int32_t n_faces = s->other->n_faces;
    for (int32_t v = 0; v < s->own->n_vertices; v++) {
        double highest = -HUGE_VAL;
        for (int32_t f = 0; f < n_faces; f++)
            highest = poly_most(highest, s->height[v * n_faces + f]);
        s->near_vertex[v] = highest < reach;
    }
    for (int32_t e = 0; e < s->own->n_edges; e++) {
        const double *h0 = s->height + s->own->end[e][0] * n_faces;
        const double *h1 = s->height + s->own->end[e][1] * n_faces;
        double highest = -HUGE_VAL;
        for (int32_t f = 0; f < n_faces; f++)
            highest = poly_most(highest, poly_least(h0[f], h1[f]));
        s->near_edge[e] = highest < reach;
    }
}

/* Path of q before it can touch a face of the core c. */
static double path_to_face(const struct poly_core *c, int32_t face, const double q[3],
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

/* Faces of the other core within reach of a vertex; all of them when it is inside. */
static int list_faces(struct brc_context *ctx, struct poly_list *l, const struct side *s, bool of_b,
                      int32_t v, const struct poly_pair *p, enum poly_rule rule, double skin)
{
    double q[3], highest;
    poly_to_body(q, s->r, s->x, s->v[v]);
    poly_highest(s->other, q, &highest);
    for (int32_t f = 0; f < s->other->n_faces; f++) {
        if (fabs(s->height[v * s->other->n_faces + f]) >= p->rest + skin && highest > 0)
            continue;
        double path = path_to_face(s->other, f, q, rule, p->rest);
        if (path < skin)
            BRC_TRY(add_vertex(ctx, l, of_b, v, f, none_near, path));
    }
    return 0;
}

/* Vertices of the other core (q: of the own one in its frame) that may come within the range where
 * they lower the weight. */
static void near_vertices(int32_t near[POLY_NEAR], const struct poly_core *other, const double q[3],
                          double range)
{
    int32_t n = 0;
    memcpy(near, none_near, sizeof none_near);
    for (int32_t u = 0; u < other->n_vertices; u++) {
        double r[3];
        brc_sub(r, q, other->vertex[u]);
        if (brc_norm2(r) >= range * range)
            continue;
        if (n < POLY_NEAR)
            near[n] = u;
        n++;
    }
    if (n > POLY_NEAR)
        near[0] = POLY_MANY_NEAR;
}

static int list_vertices(struct brc_context *ctx, struct poly_list *l, const struct side *s,
                         const struct poly_pair *p, enum poly_rule rule, double skin)
{
    bool of_b = s->own == &p->b;
    double range = sqrt(p->rest * p->rest + p->ell * p->ell) + skin;
    for (int32_t v = 0; v < s->own->n_vertices; v++) {
        if (!s->near_vertex[v])
            continue;
        if (rule != POLY_MERGED) {
            BRC_TRY(list_faces(ctx, l, s, of_b, v, p, rule, skin));
            continue;
        }
        double q[3], h;
        struct poly_foot foot;
        poly_to_body(q, s->r, s->x, s->v[v]);
        poly_foot_walk(&foot, s->other, q, poly_place(poly_highest(s->other, q, &h), POLY_ON_FACE));
        if (foot.s >= p->rest + skin)
            continue;
        int32_t near[POLY_NEAR];
        near_vertices(near, s->other, q, range);
        BRC_TRY(add_vertex(ctx, l, of_b, v, foot.place, near, foot.s - p->rest));
    }
    return 0;
}

/* From a point to the closest point of an edge with the unit direction dir. */
static void to_edge(double r[3], const double x[3], const double e[2][3], const double dir[3])
{
    double along[3], back[3];
    brc_sub(along, e[1], e[0]);
    brc_sub(back, x, e[0]);
    brc_sub(r, e[0], x);
    brc_axpy(r, poly_clamp(brc_dot(back, dir), brc_dot(along, dir)), dir);
}

/* Returns the path that may bring the foot of the common perpendicular on edge p to the given end
 * of p, which it is beyond. With unit directions a (of p, out of this end) and b (of q), and r from
 * the end to a point of q, the foot is beyond the end while r . out > 0, where out = a - (a . b) b.
 * A relative path of the bodies by s, which turns them by at most s / radius, changes r by at most
 * s and out by at most s / radius. */
static double path_to_end(const double p[2][3], const double q[2][3], int end, double radius,
                          double skin)
{
    double a[3], b[3], out[3], r[3];
    brc_sub(a, p[end], p[1 - end]);
    brc_sub(b, q[1], q[0]);
    brc_normalise(a, a);
    brc_normalise(b, b);
    brc_copy(out, a);
    brc_axpy(out, -brc_dot(a, b), b);
    to_edge(r, p[end], q, b);
    return brc_dot(r, out) / (brc_norm(out) + (brc_norm(r) + skin) / radius);
}

/* Relative path that may bring both feet inside their edges. */
static double path_to_inside(const double ends[4][3], double radius, double skin)
{
    double most = 0;
    for (int k = 0; k < 4; k++)
        most =
            poly_most(most, path_to_end(ends + (k & 2), ends + (2 - (k & 2)), k & 1, radius, skin));
    return most;
}

/* Relative path before edges i and j can touch; right for paths up to skin. */
static double path_to_edges(const struct poly_pair *p, int32_t i, int32_t j, enum poly_rule rule,
                            double skin)
{
    double ends[4][3];
    for (int k = 0; k < 2; k++) {
        brc_copy(ends[k], p->va[p->a.end[i][k]]);
        brc_copy(ends[2 + k], p->vb[p->b.end[j][k]]);
    }
    double path = poly_edge_distance(ends[0], ends[1], ends[2], ends[3]) - p->rest;
    if (rule == POLY_CLOSED || path >= skin)
        return path;
    return poly_most(path, path_to_inside(ends, p->reach, skin));
}

static int list_edges(struct brc_context *ctx, struct poly_list *l, const struct side sides[2],
                      const struct poly_pair *p, enum poly_rule rule, double skin)
{
    for (int32_t i = 0; i < p->a.n_edges; i++)
        for (int32_t j = 0; j < p->b.n_edges && sides[0].near_edge[i]; j++) {
            if (!sides[1].near_edge[j])
                continue;
            struct poly_feature f = {
                .free = path_to_edges(p, i, j, rule, skin),
                .i = i,
                .j = j,
                .kind = POLY_EDGES,
            };
            if (f.free < skin)
                BRC_TRY(poly_list_add(ctx, l, &f));
        }
    return 0;
}

int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance)
{
    size_t ha = (size_t)p->a.n_vertices * (size_t)p->b.n_faces;
    size_t hb = (size_t)p->b.n_vertices * (size_t)p->a.n_faces;
    size_t na = (size_t)p->a.n_vertices + (size_t)p->a.n_edges;
    size_t nb = (size_t)p->b.n_vertices + (size_t)p->b.n_edges;
    double reach = p->rest + skin;
    l->n = 0;
    BRC_TRY(reserve(ctx, l, ha + hb, na + nb));
    struct side sides[2] = {
        {&p->a, &p->b, p->va, p->xb, p->rb, l->height, l->near, l->near + p->a.n_vertices},
        {&p->b, &p->a, p->vb, p->xa, p->ra, l->height + ha, l->near + na,
         l->near + na + p->b.n_vertices}};
    double gap = poly_most(measure_heights(&sides[0]), measure_heights(&sides[1]));
    *allowance = poly_most(skin, gap - p->rest);
    if (gap >= reach)
        return 0;
    for (int k = 0; k < 2; k++) {
        find_near(&sides[k], reach);
        BRC_TRY(list_vertices(ctx, l, &sides[k], p, rule, skin));
    }
    return list_edges(ctx, l, sides, p, rule, skin);
}

double poly_free_path(const struct poly_pair *p, const struct poly_feature *f, enum poly_rule rule,
                      double most)
{
    if (f->kind == POLY_EDGES)
        return path_to_edges(p, f->i, f->j, rule, most);
    bool of_b = f->kind == POLY_VERTEX_B;
    const struct poly_core *c = of_b ? &p->a : &p->b;
    double q[3];
    poly_to_body(q, of_b ? p->ra : p->rb, of_b ? p->xa : p->xb, of_b ? p->vb[f->j] : p->va[f->i]);
    return path_to_face(c, of_b ? f->i : f->j, q, rule, p->rest);
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
