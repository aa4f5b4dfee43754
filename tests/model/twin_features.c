/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "twin_features.h"

#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

void twin_core_from(struct twin_core *core, const struct brc_convex *c)
{
    size_t n_loop = c->first[c->n_faces];
    *core = (struct twin_core){.n_vertices = c->n_vertices, .n_faces = c->n_faces};
    core->vertex = calloc(c->n_vertices, sizeof *core->vertex);
    core->edge = calloc(n_loop, sizeof *core->edge);
    core->first = calloc(c->n_faces + 1, sizeof *core->first);
    core->loop = calloc(n_loop, sizeof *core->loop);
    core->normal = calloc(c->n_faces, sizeof *core->normal);
    memcpy(core->vertex, c->vertex, c->n_vertices * sizeof *core->vertex);
    memcpy(core->first, c->first, (c->n_faces + 1) * sizeof *core->first);
    memcpy(core->loop, c->loop, n_loop * sizeof *core->loop);
    for (size_t f = 0; f < c->n_faces; f++) {
        brc_copy(core->normal[f], c->plane[f].n);
        size_t n = c->first[f + 1] - c->first[f];
        for (size_t j = 0; j < n; j++) {
            int32_t v = c->loop[c->first[f] + j], w = c->loop[c->first[f] + (j + 1) % n];
            if (v < w) { /* each edge is met once in each direction */
                core->edge[core->n_edges][0] = v;
                core->edge[core->n_edges++][1] = w;
            }
        }
    }
}

void twin_core_free(struct twin_core *core)
{
    free(core->vertex);
    free(core->edge);
    free(core->first);
    free(core->loop);
    free(core->normal);
    *core = (struct twin_core){0};
}

/* Counts a pair of closest points pa on a and pb on b. */
static void count(struct twin_sum *sum, const double pa[3], const double pb[3], double rest,
                  bool force)
{
    double d[3], middle[3], m[3], distance;
    brc_sub(d, pb, pa);
    distance = brc_normalise(d, d);
    sum->closed += distance < rest - sum->doubt;
    sum->doubtful += fabs(distance - rest) <= sum->doubt;
    if (!force || distance == 0)
        return;
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (pa[k] + pb[k]);
    brc_axpy(sum->overlap, rest - distance, d);
    brc_cross(m, middle, d);
    brc_axpy(sum->moment, rest - distance, m);
    sum->closest = fmin(sum->closest, distance);
}

/* Closest point of a segment to p; returns where it lies, 0 to 1. */
static double on_segment(double r[3], const double p[3], const double u[3], const double v[3])
{
    double e[3], d[3];
    brc_sub(e, v, u);
    brc_sub(d, p, u);
    double t = fmin(fmax(brc_dot(d, e) / brc_norm2(e), 0), 1);
    brc_copy(r, u);
    brc_axpy(r, t, e);
    return t;
}

/* Foot of p on a face's plane; true when it is inside the polygon by every side. */
static bool on_face(double r[3], const struct twin_core *c, size_t face, const double p[3])
{
    const double *n = c->normal[face], *origin = c->vertex[c->loop[c->first[face]]];
    size_t count_sides = c->first[face + 1] - c->first[face];
    double d[3];
    bool inside = true;
    brc_sub(d, p, origin);
    brc_copy(r, p);
    brc_axpy(r, -brc_dot(d, n), n);
    for (size_t j = 0; j < count_sides; j++) {
        const double *u = c->vertex[c->loop[c->first[face] + j]];
        const double *v = c->vertex[c->loop[c->first[face] + (j + 1) % count_sides]];
        double e[3], out[3];
        brc_sub(e, v, u);
        brc_sub(d, r, u);
        brc_cross(out, e, d); /* counter-clockwise: along n when r is to the left */
        inside &= brc_dot(out, n) > 0;
    }
    return inside;
}

static double distance(const double p[3], const double q[3])
{
    double d[3];
    brc_sub(d, p, q);
    return brc_norm(d);
}

/* An edge of a runs through a face of b, or a vertex of a is inside b. */
static bool pierces(const struct twin_core *a, const struct twin_core *b)
{
    for (size_t e = 0; e < a->n_edges; e++)
        for (size_t f = 0; f < b->n_faces; f++) {
            const double *u = a->vertex[a->edge[e][0]], *v = a->vertex[a->edge[e][1]];
            const double *n = b->normal[f], *origin = b->vertex[b->loop[b->first[f]]];
            double du[3], dv[3], p[3], r[3];
            brc_sub(du, u, origin);
            brc_sub(dv, v, origin);
            double hu = brc_dot(du, n), hv = brc_dot(dv, n);
            if ((hu > 0) == (hv > 0))
                continue;
            for (int k = 0; k < 3; k++)
                p[k] = (hu * v[k] - hv * u[k]) / (hu - hv);
            if (on_face(r, b, f, p))
                return true;
        }
    bool inside = true;
    for (size_t f = 0; f < b->n_faces; f++) {
        double d[3];
        brc_sub(d, a->vertex[0], b->vertex[b->loop[b->first[f]]]);
        inside &= brc_dot(d, b->normal[f]) <= 0;
    }
    return inside;
}

bool twin_overlap(const struct twin_core *a, const struct twin_core *b)
{
    return pierces(a, b) || pierces(b, a);
}

/* Vertex p of one core against a face of the other. */
static void vertex_face(struct twin_sum *sum, const double p[3], const struct twin_core *c,
                        size_t face, double rest, bool strict, bool of_b)
{
    double r[3], best[3] = {0, 0, 0}, nearest = HUGE_VAL;
    bool inside = on_face(r, c, face, p);
    if (inside) {
        sum->vertex_face += distance(p, r) < rest;
        count(sum, of_b ? r : p, of_b ? p : r, rest, distance(p, r) < rest);
    }
    if (inside || strict)
        return;
    size_t n = c->first[face + 1] - c->first[face];
    for (size_t j = 0; j < n; j++) {
        on_segment(r, p, c->vertex[c->loop[c->first[face] + j]],
                   c->vertex[c->loop[c->first[face] + (j + 1) % n]]);
        if (distance(p, r) < nearest) {
            nearest = distance(p, r);
            brc_copy(best, r);
        }
    }
    count(sum, of_b ? best : p, of_b ? p : best, rest, nearest < rest);
}

/* Parallel edges by the rule: where the middle of the part of a that faces b is closest to b. False
 * when they are not parallel. */
static bool parallel(const double (*a)[3], const double (*b)[3], double ra[3], double rb[3])
{
    double u[3], v[3], w[3], middle = 0;
    brc_sub(u, a[1], a[0]);
    brc_sub(v, b[1], b[0]);
    brc_cross(w, u, v);
    if (brc_norm2(w) > 1e-12 * brc_norm2(u) * brc_norm2(v))
        return false;
    for (int i = 0; i < 2; i++) {
        brc_sub(w, b[i], a[0]);
        middle += 0.5 * fmin(fmax(brc_dot(w, u) / brc_norm2(u), 0), 1);
    }
    brc_copy(ra, a[0]);
    brc_axpy(ra, middle, u);
    on_segment(rb, ra, b[0], b[1]);
    return true;
}

/* Closest points of the lines through two edges, true when both are strictly inside the edges. */
static bool crossing(const double (*a)[3], const double (*b)[3], double ra[3], double rb[3])
{
    double u[3], v[3], w[3];
    brc_sub(u, a[1], a[0]);
    brc_sub(v, b[1], b[0]);
    brc_sub(w, a[0], b[0]);
    double uu = brc_norm2(u), uv = brc_dot(u, v), vv = brc_norm2(v);
    double uw = brc_dot(u, w), vw = brc_dot(v, w), det = uu * vv - uv * uv;
    if (det <= 1e-12 * uu * vv)
        return false;
    double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
    brc_copy(ra, a[0]);
    brc_axpy(ra, s, u);
    brc_copy(rb, b[0]);
    brc_axpy(rb, t, v);
    return s > 0 && s < 1 && t > 0 && t < 1;
}

static void edge_edge(struct twin_sum *sum, const double (*a)[3], const double (*b)[3], double rest,
                      bool strict)
{
    double ra[3] = {0}, rb[3] = {0}, r[3], nearest = HUGE_VAL;
    if (crossing(a, b, ra, rb)) {
        sum->edge_edge += distance(ra, rb) < rest;
        count(sum, ra, rb, rest, distance(ra, rb) < rest);
        return;
    }
    if (strict)
        return;
    if (parallel(a, b, ra, rb)) {
        count(sum, ra, rb, rest, distance(ra, rb) < rest);
        return;
    }
    for (int i = 0; i < 2; i++) { /* the closest pair has an end of one of them */
        on_segment(r, a[i], b[0], b[1]);
        if (distance(a[i], r) < nearest) {
            nearest = distance(a[i], r);
            brc_copy(ra, a[i]);
            brc_copy(rb, r);
        }
        on_segment(r, b[i], a[0], a[1]);
        if (distance(b[i], r) < nearest) {
            nearest = distance(b[i], r);
            brc_copy(ra, r);
            brc_copy(rb, b[i]);
        }
    }
    count(sum, ra, rb, rest, nearest < rest);
}

static void vertex_edges(struct twin_sum *sum, const struct twin_core *a, const struct twin_core *b,
                         double rest)
{
    for (size_t i = 0; i < a->n_vertices; i++)
        for (size_t e = 0; e < b->n_edges; e++) {
            double r[3],
                t = on_segment(r, a->vertex[i], b->vertex[b->edge[e][0]], b->vertex[b->edge[e][1]]);
            sum->vertex_edge += t > 0 && t < 1 && distance(a->vertex[i], r) < rest;
        }
}

void twin_compare(const struct twin_core *a, const struct twin_core *b, double rest, bool strict,
                  struct twin_sum *sum)
{
    for (size_t i = 0; i < a->n_vertices; i++)
        for (size_t f = 0; f < b->n_faces; f++)
            vertex_face(sum, a->vertex[i], b, f, rest, strict, false);
    for (size_t i = 0; i < b->n_vertices; i++)
        for (size_t f = 0; f < a->n_faces; f++)
            vertex_face(sum, b->vertex[i], a, f, rest, strict, true);
    for (size_t i = 0; i < a->n_edges; i++)
        for (size_t j = 0; j < b->n_edges; j++) {
            double ea[2][3], eb[2][3];
            for (int k = 0; k < 2; k++) {
                brc_copy(ea[k], a->vertex[a->edge[i][k]]);
                brc_copy(eb[k], b->vertex[b->edge[j][k]]);
            }
            edge_edge(sum, ea, eb, rest, strict);
        }
    vertex_edges(sum, a, b, rest);
    vertex_edges(sum, b, a, rest);
    for (size_t i = 0; i < a->n_vertices; i++)
        for (size_t j = 0; j < b->n_vertices; j++)
            sum->vertex_vertex += distance(a->vertex[i], b->vertex[j]) < rest;
}
