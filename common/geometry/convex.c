/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A box that half-spaces cut one by one. Each vertex is classed once a cut and each cut edge has
 * one new vertex, so that neighbouring faces cannot disagree about a point within rounding of the
 * plane. Far from the origin the work is done near the body's middle, where no digits are lost.
 *
 * Lists are searched from end to end: a cut meets few edges, and a hash would cost more than it
 * saves for faces of five or six sides. Prisms of a thousand sides, the most that a case may ask
 * for, are made once a run. */
#include "common/geometry/convex.h"

#include "common/base/grow.h"
#include "common/geometry/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_IN = -1, SIDE_ON = 0, SIDE_OUT = 1 };
/* label of the starting box of brc_convex_from_planes */
enum { BOX_ID = INT32_MIN };
/* from_planes treats vertices within this part of the half-width as lying on a plane, or where the
 * place is far from the origin, within this many units of rounding there */
static const double plane_tolerance = 1e-12, rounding_units = 16;
/* Vertices that are as far from a plane as the tolerance may be told apart in a way that closes no
 * body; then the next one is tried: the last is 1e-12 * 4^7, still far below any detail. */
static const double next_tolerance = 4;
enum { MAX_TOLERANCES = 8 };
/* a body that is farther from the origin than this many of its sizes is worked on near its middle
 */
static const double far_sizes = 8;
/* a body of unknown place is looked for within this many times the planes' largest distance */
static const double search_width = 1e3;

/* Directed edge, or a cut edge (low, high) and its new vertex. */
struct edge {
    int32_t from, to, vertex;
};

/* What a clip finds out about a vertex. */
struct vertex {
    double height;  /* distance from the plane, positive outside */
    int32_t side;   /* SIDE_IN, SIDE_ON, SIDE_OUT */
    int32_t number; /* in the clipped body, -1: gone */
};

/* Work space of a clip; kept between calls, as a body is clipped by tens of planes. */
struct scratch {
    size_t cap_vertices, cap_edges, cap_cuts, n_edges, n_cuts;
    struct vertex *vertex;
    struct edge *edges, *cuts;
    struct brc_convex clipped; /* the body that takes the place of the one being clipped */
};

void brc_convex_free(struct brc_convex *c)
{
    struct scratch *s = c->scratch;
    if (s) {
        free(s->vertex);
        free(s->edges);
        free(s->cuts);
        brc_convex_free(&s->clipped);
        free(s);
    }
    free(c->vertex);
    free(c->plane);
    free(c->first);
    free(c->loop);
    *c = (struct brc_convex){0};
}

int brc_convex_reserve(struct brc_context *ctx, struct brc_convex *c, size_t vertices, size_t faces,
                       size_t loop)
{
    size_t cap = c->cap_faces;
    BRC_GROW(ctx, c->vertex, c->cap_vertices, vertices);
    BRC_GROW(ctx, c->plane, cap, faces + 1);
    BRC_GROW(ctx, c->first, c->cap_faces, faces + 1);
    BRC_GROW(ctx, c->loop, c->cap_loop, loop);
    return 0;
}

int brc_convex_box(struct brc_context *ctx, struct brc_convex *c, const double low[3],
                   const double high[3])
{
    /* vertex number: bit 0 = x high, bit 1 = y high, bit 2 = z high */
    static const int32_t loops[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    BRC_TRY(brc_convex_reserve(ctx, c, 8, 6, 24));
    c->n_vertices = 8;
    c->n_faces = 6;
    for (int v = 0; v < 8; v++)
        for (int k = 0; k < 3; k++)
            c->vertex[v][k] = v >> k & 1 ? high[k] : low[k];
    for (int f = 0; f < 6; f++) {
        int k = f / 2;
        struct brc_plane p = {{0, 0, 0}, f % 2 ? high[k] : -low[k], f};
        p.n[k] = f % 2 ? 1 : -1;
        c->plane[f] = p;
        c->first[f] = 4 * (size_t)f;
        memcpy(c->loop + 4 * f, loops[f], sizeof loops[f]);
    }
    c->first[6] = 24;
    return 0;
}

static int scratch_reserve(struct brc_context *ctx, struct brc_convex *c)
{
    if (!c->scratch) {
        c->scratch = brc_alloc(ctx, 1, sizeof(struct scratch));
        if (!c->scratch)
            return BRC_ERR_MEMORY;
    }
    struct scratch *s = c->scratch;
    size_t n_loop = c->first[c->n_faces], n_faces = c->n_faces + 1;
    /* a clip adds at most one vertex an edge and one face of at most as many vertices as edges */
    size_t vertices = c->n_vertices + n_loop, loop = 3 * n_loop + c->n_vertices;
    BRC_GROW(ctx, s->vertex, s->cap_vertices, vertices);
    BRC_GROW(ctx, s->edges, s->cap_edges, loop);
    BRC_GROW(ctx, s->cuts, s->cap_cuts, n_loop);
    s->n_edges = s->n_cuts = 0;
    BRC_TRY(brc_convex_reserve(ctx, &s->clipped, vertices, n_faces, loop));
    s->clipped.n_faces = s->clipped.first[0] = 0;
    return brc_convex_reserve(ctx, c, vertices, n_faces, loop);
}

/* The place is computed from the lower to the higher vertex, whichever way the face runs, so that
 * it has the same bits when the neighbouring face asks first. Number of the vertex where the plane
 * cuts the edge u-v; made at the first call. */
static int32_t cut_vertex(struct brc_convex *c, struct scratch *s, int32_t u, int32_t v)
{
    int32_t low = u < v ? u : v, high = u < v ? v : u;
    for (size_t i = 0; i < s->n_cuts; i++)
        if (s->cuts[i].from == low && s->cuts[i].to == high)
            return s->cuts[i].vertex;
    int32_t new = (int32_t)c->n_vertices++;
    double t = s->vertex[low].height / (s->vertex[low].height - s->vertex[high].height);
    for (int k = 0; k < 3; k++)
        c->vertex[new][k] = c->vertex[low][k] + t * (c->vertex[high][k] - c->vertex[low][k]);
    s->vertex[new].side = SIDE_ON;
    s->cuts[s->n_cuts++] = (struct edge){low, high, new};
    return new;
}

/* The clipped body's next face; its loop lies behind those before it and ends at end. */
static void add_face(struct brc_convex *clipped, const struct brc_plane *plane, size_t end)
{
    clipped->plane[clipped->n_faces++] = *plane;
    clipped->first[clipped->n_faces] = end;
}

/* Adds the part of face f inside the plane, and its edges in the plane. A face with no vertex
 * strictly inside goes, also where it lies in the plane: the new face takes its place there. */
static void clip_face(struct brc_convex *c, struct scratch *s, size_t f)
{
    size_t begin = s->clipped.first[s->clipped.n_faces], end = begin;
    size_t n = c->first[f + 1] - c->first[f];
    const int32_t *loop = c->loop + c->first[f];
    int32_t *clipped = s->clipped.loop;
    bool is_kept = false;
    for (size_t i = 0; i < n; i++) {
        int32_t u = loop[i], v = loop[i + 1 < n ? i + 1 : 0];
        int32_t side = s->vertex[u].side;
        if (side != SIDE_OUT)
            clipped[end++] = u;
        if (side * s->vertex[v].side < 0)
            clipped[end++] = cut_vertex(c, s, u, v);
        is_kept = is_kept || side == SIDE_IN;
    }
    if (!is_kept)
        return;
    for (size_t i = begin; i < end; i++) {
        int32_t u = clipped[i], v = clipped[i + 1 < end ? i + 1 : begin];
        if (s->vertex[u].side == SIDE_ON && s->vertex[v].side == SIDE_ON)
            s->edges[s->n_edges++] = (struct edge){u, v, 0};
    }
    add_face(&s->clipped, &c->plane[f], end);
}

/* Removes pairs of opposite edges: these have a kept face on both sides. So it is where the plane
 * only touches the body along an edge. */
static void cancel_edges(struct scratch *s)
{
    for (size_t i = 0; i < s->n_edges; i++)
        for (size_t j = i + 1; j < s->n_edges; j++)
            if (s->edges[i].from == s->edges[j].to && s->edges[i].to == s->edges[j].from) {
                s->edges[j] = s->edges[--s->n_edges];
                s->edges[i] = s->edges[--s->n_edges];
                i--;
                break;
            }
}

/* The open edges, walked backwards, bound the new face. They fail to do so only where vertices
 * within the tolerance were classed in a way that no convex body has; the caller then tries another
 * one. */
static int close_with_face(struct brc_context *ctx, struct scratch *s,
                           const struct brc_plane *plane)
{
    cancel_edges(s);
    if (s->n_edges < 3)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "clipping a convex cell leaves an open face of %zu edges",
                 s->n_edges);
    size_t end = s->clipped.first[s->clipped.n_faces], n = s->n_edges;
    int32_t at = s->edges[0].to;
    for (size_t k = 0; k < n; k++) {
        size_t i = 0;
        while (i < s->n_edges && s->edges[i].to != at)
            i++;
        if (i == s->n_edges)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "clipping a convex cell leaves a face in two parts");
        s->clipped.loop[end++] = at;
        at = s->edges[i].from;
        s->edges[i] = s->edges[--s->n_edges];
    }
    add_face(&s->clipped, plane, end);
    return 0;
}

/* Takes over the clipped faces, with the vertices that they use in the order in which they were,
 * and keeps the old body's memory for the next clip. */
static void adopt(struct brc_convex *c, struct scratch *s)
{
    struct brc_convex *clipped = &s->clipped, old = *c;
    size_t n_loop = clipped->first[clipped->n_faces];
    int32_t n = 0;
    for (size_t v = 0; v < c->n_vertices; v++)
        s->vertex[v].number = -1;
    for (size_t i = 0; i < n_loop; i++)
        s->vertex[clipped->loop[i]].number = 0;
    for (size_t v = 0; v < c->n_vertices; v++)
        if (s->vertex[v].number == 0) {
            brc_copy(clipped->vertex[n], c->vertex[v]);
            s->vertex[v].number = n++;
        }
    for (size_t i = 0; i < n_loop; i++)
        clipped->loop[i] = s->vertex[clipped->loop[i]].number;
    clipped->n_vertices = (size_t)n;
    *c = *clipped;
    c->scratch = s;
    old.scratch = NULL;
    *clipped = old;
}

int brc_convex_clip(struct brc_context *ctx, struct brc_convex *c, const struct brc_plane *plane,
                    double tolerance, bool *changed)
{
    size_t n_in = 0, n_out = 0;
    *changed = false;
    if (c->n_faces == 0)
        return 0;
    BRC_TRY(scratch_reserve(ctx, c));
    struct scratch *s = c->scratch;
    for (size_t v = 0; v < c->n_vertices; v++) {
        double h = brc_dot(plane->n, c->vertex[v]) - plane->d;
        int32_t side = h > tolerance ? SIDE_OUT : h < -tolerance ? SIDE_IN : SIDE_ON;
        s->vertex[v] = (struct vertex){h, side, 0};
        n_in += side == SIDE_IN;
        n_out += side == SIDE_OUT;
    }
    if (n_out == 0)
        return 0;
    *changed = true;
    if (n_in == 0) {
        c->n_faces = c->n_vertices = 0;
        return 0;
    }
    for (size_t f = 0; f < c->n_faces; f++)
        clip_face(c, s, f);
    BRC_TRY(close_with_face(ctx, s, plane));
    adopt(c, s);
    return 0;
}

static int clip_box(struct brc_context *ctx, struct brc_convex *c, const struct brc_plane *planes,
                    size_t n, const double centre[3], double half_width, double tolerance)
{
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = centre[k] - half_width;
        high[k] = centre[k] + half_width;
    }
    BRC_TRY(brc_convex_box(ctx, c, low, high));
    for (size_t f = 0; f < 6; f++)
        c->plane[f].id = BOX_ID;
    bool changed;
    for (size_t i = 0; i < n; i++)
        BRC_TRY(brc_convex_clip(ctx, c, &planes[i], tolerance, &changed));
    return 0;
}

/* Failures go to a context of their own, as all but the last are no failures of the caller. The
 * labels of the box tell whether the planes alone bound the body. */
int brc_convex_from_planes(struct brc_context *ctx, struct brc_convex *c,
                           const struct brc_plane *planes, size_t n, const double centre[3],
                           double half_width)
{
    double tolerance = fmax(plane_tolerance * half_width,
                            rounding_units * DBL_EPSILON * (brc_norm(centre) + half_width));
    int code = BRC_ERR_GEOMETRY;
    struct brc_context own;
    for (int i = 0; i < MAX_TOLERANCES && code == BRC_ERR_GEOMETRY; i++) {
        own = (struct brc_context)BRC_CONTEXT_INIT;
        code = clip_box(&own, c, planes, n, centre, half_width, tolerance);
        tolerance *= next_tolerance;
    }
    if (code != 0)
        BRC_FAIL(ctx, code, "%s", own.message);
    for (size_t f = 0; f < c->n_faces; f++)
        if (c->plane[f].id == BOX_ID)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                     "%zu planes do not bound a body within %g m of (%g, %g, %g)", n, half_width,
                     centre[0], centre[1], centre[2]);
    return 0;
}

/* In long double: d and n . by may nearly cancel, and what is left must have the digits of the body
 * and not those of its distance. */
void brc_planes_shift(struct brc_plane *plane, size_t n, const double by[3])
{
    for (size_t i = 0; i < n; i++) {
        long double d = plane[i].d;
        for (int k = 0; k < 3; k++)
            d += (long double)plane[i].n[k] * by[k];
        plane[i].d = (double)d;
    }
}

void brc_convex_shift(struct brc_convex *c, const double by[3])
{
    for (size_t v = 0; v < c->n_vertices; v++)
        brc_add(c->vertex[v], c->vertex[v], by);
    brc_planes_shift(c->plane, c->n_faces, by);
}

/* Nearer than eight sizes, a move would gain three of the 53 binary digits at most. */
void brc_convex_origin(const double middle[3], double reach, double origin[3])
{
    brc_set(origin, 0, 0, 0);
    if (!(brc_norm(middle) > far_sizes * reach))
        return;
    /* a multiple of a power of two near the size: differences to it are exact */
    double step = exp2(ceil(log2(reach)));
    for (int k = 0; k < 3; k++)
        origin[k] = step * nearbyint(middle[k] / step);
}

/* Whether two planes differ by less than the tolerance within reach of the middle. Equal normals
 * and distances are not asked for: files round both, and what counts is where the planes run within
 * the body. */
static bool is_same_plane(const struct brc_plane *p, const struct brc_plane *q,
                          const double middle[3], double reach, double tolerance)
{
    double turn[3];
    brc_sub(turn, p->n, q->n);
    double apart = brc_dot(turn, middle) - (p->d - q->d);
    return fabs(apart) + reach * brc_norm(turn) <= tolerance;
}

/* Drops planes that come again; returns the number of those that stay. A surface of triangles has
 * each of its planes many times, and cuts by all of them would leave slivers as wide as their
 * differences. */
static size_t unique_planes(struct brc_plane *plane, size_t n, const double middle[3], double reach,
                            double tolerance)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        bool is_new = true;
        for (size_t k = 0; k < m && is_new; k++)
            is_new = !is_same_plane(&plane[k], &plane[i], middle, reach, tolerance);
        if (is_new)
            plane[m++] = plane[i];
    }
    return m;
}

/* The first body is made in a box that holds whatever the planes may enclose, with a tolerance to
 * match, and tells only where it is and how large; the second has the digits. */
int brc_convex_enclosed(struct brc_context *ctx, struct brc_convex *c,
                        const struct brc_plane *planes, size_t n, double digits)
{
    const double zero[3] = {0, 0, 0};
    double far = 0, low[3], high[3], middle[3], origin[3], back[3];
    for (size_t i = 0; i < n; i++)
        far = fmax(far, fabs(planes[i].d));
    BRC_TRY(brc_convex_from_planes(ctx, c, planes, n, zero, search_width * far));
    if (c->n_faces == 0)
        return 0;
    brc_box_of(low, high, c->vertex, c->n_vertices);
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * low[k] + 0.5 * high[k];
    double reach = brc_convex_reach(c, middle), tolerance = digits * (brc_norm(middle) + reach);
    struct brc_plane *plane = brc_alloc(ctx, n, sizeof *plane);
    if (!plane)
        return BRC_ERR_MEMORY;
    brc_convex_origin(middle, reach, origin);
    brc_scale(back, origin, -1);
    memcpy(plane, planes, n * sizeof *plane);
    brc_planes_shift(plane, n, back);
    brc_sub(middle, middle, origin);
    n = unique_planes(plane, n, middle, reach, tolerance);
    int code = brc_convex_from_planes(ctx, c, plane, n, middle, 2 * reach);
    free(plane);
    if (code == 0)
        brc_convex_shift(c, origin);
    return code;
}

size_t brc_convex_face(const struct brc_convex *c, int32_t id)
{
    size_t f = 0;
    while (f < c->n_faces && c->plane[f].id != id)
        f++;
    return f;
}

double brc_convex_reach(const struct brc_convex *c, const double from[3])
{
    double reach = 0;
    for (size_t v = 0; v < c->n_vertices; v++)
        reach = fmax(reach, brc_distance(c->vertex[v], from));
    return reach;
}

/* Adds the tetrahedron (origin, a, b, c): volume, first and second moments about the origin. */
static void add_tetrahedron(const double a[3], const double b[3], const double c[3], double *volume,
                            double first[3], double second[3][3])
{
    double bc[3], sum[3];
    brc_cross(bc, b, c);
    double v = brc_dot(a, bc) / 6;
    brc_add(sum, a, b);
    brc_add(sum, sum, c);
    *volume += v;
    brc_axpy(first, v / 4, sum);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            second[i][j] += v / 20 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j]);
}

void brc_convex_mass(const struct brc_convex *c, double *volume, double centroid[3],
                     double inertia[3][3])
{
    double first[3] = {0, 0, 0}, second[3][3] = {{0}}, origin[3] = {0, 0, 0};
    *volume = 0;
    for (size_t v = 0; v < c->n_vertices; v++)
        brc_axpy(origin, 1.0 / (double)c->n_vertices, c->vertex[v]);
    for (size_t f = 0; f < c->n_faces; f++)
        for (size_t i = c->first[f] + 1; i + 1 < c->first[f + 1]; i++) {
            double p[3], q[3], r[3];
            brc_sub(p, c->vertex[c->loop[c->first[f]]], origin);
            brc_sub(q, c->vertex[c->loop[i]], origin);
            brc_sub(r, c->vertex[c->loop[i + 1]], origin);
            add_tetrahedron(p, q, r, volume, first, second);
        }
    brc_scale(first, first, *volume > 0 ? 1 / *volume : 0);
    brc_add(centroid, origin, first);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            second[i][j] -= *volume * first[i] * first[j];
    double trace = second[0][0] + second[1][1] + second[2][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inertia[i][j] = (i == j ? trace : 0) - second[i][j];
}

/* A fan about the first vertex, and relative to it: neighbours see the same polygon with the same
 * digits, wherever it is. */
double brc_polygon_area(double (*vertex)[3], const int32_t *loop, size_t n, const double normal[3],
                        double centroid[3])
{
    double area = 0, moment[3] = {0, 0, 0}, mean[3] = {0, 0, 0};
    const double *o = vertex[loop[0]];
    for (size_t i = 1; i + 1 < n; i++) {
        double p[3], q[3], cross[3];
        brc_sub(p, vertex[loop[i]], o);
        brc_sub(q, vertex[loop[i + 1]], o);
        brc_cross(cross, p, q);
        double a = brc_dot(cross, normal) / 2;
        area += a;
        brc_axpy(moment, a / 3, p);
        brc_axpy(moment, a / 3, q);
    }
    for (size_t i = 1; i < n; i++) {
        double p[3];
        brc_sub(p, vertex[loop[i]], o);
        brc_axpy(mean, 1.0 / (double)n, p);
    }
    /* a polygon without area has its mean vertex as its centre */
    brc_scale(moment, moment, area > 0 ? 1 / area : 0);
    brc_add(centroid, o, area > 0 ? moment : mean);
    return area;
}
