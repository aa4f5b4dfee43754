/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Near vertices become one, facets without width go, their vertices stay in order on both sides,
 * and vertices in the middle of an edge go.
 *
 * Why at all: seeds that are nearly regular (a grid without jitter, a cut that just misses a
 * vertex) have edges and facets of the size of rounding. Their normals are noise, contacts over
 * them are stiff springs between wrong points, and vertices on both of their sides are one vertex
 * to any model. Dropping such a facet alone would leave its cells open, so its long sides are
 * closed like a zip: all cells around it see the same edges afterwards. Called before the cuts,
 * whose decisions it makes safe, and after them, since cuts make new near vertices. */
#include "common/specimen/cell_complex.h"

#include "common/base/grow.h"
#include "common/base/tuples.h"
#include "common/geometry/grid.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

/* Each pass closes one narrow facet at least, and far more where they do not touch. */
enum { MAX_PASSES = 1000 };

/* An edge low-high that gets further vertices, in order from low to high. Kept by the edge and not
 * by the facet, since all facets around it must get the same ones. */
struct split {
    int32_t low, high;
    int32_t n, first; /* range in splits.vertex */
};

struct splits {
    struct split *list;
    size_t n, cap;
    int32_t *vertex;
    size_t n_vertex, cap_vertex;
};

struct merger {
    struct brc_cell_complex *c;
    double tolerance;
    int32_t *to;    /* [n_vertices] the vertex that this one becomes; -1: no facet has it */
    int32_t *claim; /* [n_vertices] the last pass that changed facets at the vertex */
    int32_t *loop;  /* work: a loop under construction */
    size_t cap_loop;
    double *t; /* work: positions along a narrow facet */
    size_t cap_t;
    struct splits splits;
    struct brc_pool pool; /* owns the arrays with a stated length */
};

/* A vertex becomes the first one kept within the tolerance, or is kept itself. Kept vertices are
 * farther apart than the tolerance, so that no chain of small steps can join distant ones. */
static int join_vertices(struct brc_context *ctx, struct merger *w)
{
    struct brc_cell_complex *c = w->c;
    w->to = brc_pool_alloc(ctx, &w->pool, c->n_vertices, sizeof *w->to);
    w->claim = brc_pool_alloc(ctx, &w->pool, c->n_vertices, sizeof *w->claim);
    if (w->pool.is_failed)
        return BRC_ERR_MEMORY;
    memset(w->to, 0xff, c->n_vertices * sizeof *w->to);
    for (size_t f = 0; f < c->n_facets; f++)
        for (int32_t i = 0; i < c->facet[f].n; i++) {
            int32_t v = c->loop[c->facet[f].first + (size_t)i];
            w->to[v] = v;
        }
    return brc_grid_join(ctx, (const double(*)[3])c->vertex, c->n_vertices, w->tolerance, w->to);
}

/* Removes repeated neighbours (x x) and spikes (x y x) from a closed loop, also across its end;
 * returns its length. Both come of vertices that have become one: an edge of no length, and an edge
 * there and back. */
static int32_t tidy_loop(int32_t *loop, int32_t n)
{
    int32_t m = 0, from = 0;
    for (int32_t i = 0; i < n; i++) {
        if (m > 0 && loop[m - 1] == loop[i])
            continue;
        if (m > 1 && loop[m - 2] == loop[i])
            m--;
        else
            loop[m++] = loop[i];
    }
    while (m - from > 2) {
        if (loop[from] == loop[m - 1])
            m--;
        else if (loop[from] == loop[m - 2])
            m -= 2;
        else if (loop[from + 1] == loop[m - 1])
            m--, from++;
        else
            break;
    }
    memmove(loop, loop + from, (size_t)(m - from) * sizeof *loop);
    return m - from;
}

/* Position of the first vertex that comes again later in the loop, -1: none; *again is where. */
static int32_t find_repeat(const int32_t *loop, int32_t n, int32_t *again)
{
    for (int32_t i = 0; i < n; i++)
        for (*again = i + 1; *again < n; ++*again)
            if (loop[i] == loop[*again])
                return i;
    return -1;
}

/* Gives facet f the loop in w->loop, tidied; a loop that touches itself becomes two facets, as two
 * polygons that share a vertex are what each cell has there. */
static int set_loop(struct brc_context *ctx, struct merger *w, size_t f, int32_t n)
{
    struct brc_cell_complex *c = w->c;
    n = tidy_loop(w->loop, n);
    int32_t again, at = n < 3 ? -1 : find_repeat(w->loop, n, &again);
    if (at >= 0) {
        struct brc_cell_complex_facet part = c->facet[f];
        part.n = tidy_loop(w->loop + at, again - at);
        BRC_TRY(brc_cell_complex_add_facet(ctx, c, &part, w->loop + at));
        memmove(w->loop + at, w->loop + again, (size_t)(n - again) * sizeof *w->loop);
        return set_loop(ctx, w, f, n - (again - at));
    }
    return brc_cell_complex_set_loop(ctx, c, f, w->loop, n < 3 ? 0 : n);
}

/* Renames the vertices of all facets. */
static int rename_vertices(struct brc_context *ctx, struct merger *w)
{
    struct brc_cell_complex *c = w->c;
    for (size_t f = 0; f < c->n_facets; f++) {
        int32_t n = c->facet[f].n;
        bool changed = false;
        BRC_GROW(ctx, w->loop, w->cap_loop, (size_t)n);
        for (int32_t i = 0; i < n; i++) {
            int32_t v = c->loop[c->facet[f].first + (size_t)i];
            w->loop[i] = w->to[v];
            changed |= w->to[v] != v;
        }
        if (changed)
            BRC_TRY(set_loop(ctx, w, f, n));
    }
    return 0;
}

/* Position in the loop of the vertex farthest from vertex v. From any vertex it is one end of a
 * narrow facet, and from there the other end. */
static int32_t farthest(const struct merger *w, const int32_t *loop, int32_t n, int32_t v)
{
    double(*x)[3] = w->c->vertex;
    int32_t best = 0;
    for (int32_t i = 1; i < n; i++)
        if (brc_distance(x[loop[i]], x[v]) > brc_distance(x[loop[best]], x[v]))
            best = i;
    return best;
}

/* Tells whether a facet is narrower than the tolerance. Then w->loop is its loop from one end,
 * *tip the position of the other end, and w->t the positions along the line between them. The area
 * is asked first, as it tells for nearly all facets that they are wide. */
static bool is_narrow(struct merger *w, const struct brc_cell_complex_facet *facet, int32_t *tip)
{
    double(*x)[3] = w->c->vertex;
    const int32_t *loop = w->c->loop + facet->first;
    int32_t n = facet->n;
    double centroid[3], line[3];
    double area = brc_polygon_area(x, loop, (size_t)n, facet->normal, centroid);
    int32_t begin = farthest(w, loop, n, loop[0]);
    if (fabs(area) > 4 * w->tolerance * brc_distance(x[loop[begin]], x[loop[0]]))
        return false;
    for (int32_t i = 0; i < n; i++)
        w->loop[i] = loop[(begin + i) % n];
    *tip = farthest(w, w->loop, n, w->loop[0]);
    brc_sub(line, x[w->loop[*tip]], x[w->loop[0]]);
    brc_normalise(line, line);
    for (int32_t i = 0; i < n; i++) {
        double r[3];
        brc_sub(r, x[w->loop[i]], x[w->loop[0]]);
        w->t[i] = brc_dot(r, line);
        brc_axpy(r, -w->t[i], line);
        if (brc_norm(r) > w->tolerance)
            return false;
    }
    return true;
}

/* Adds to the edge at position i of w->loop (from low t to high t when rising) the vertices of the
 * other side, positions begin..end, that lie between its ends. Places along the facet decide, not
 * distances across it, which are below the tolerance and mean nothing. */
static int split_edge(struct brc_context *ctx, struct merger *w, int32_t i, int32_t n,
                      const int32_t range[2])
{
    struct splits *s = &w->splits;
    int32_t j = (i + 1) % n, u = w->loop[i], v = w->loop[j];
    bool rising = w->t[i] < w->t[j], forward = u < v;
    double low = rising ? w->t[i] : w->t[j], high = rising ? w->t[j] : w->t[i];
    struct split split = {forward ? u : v, forward ? v : u, 0, (int32_t)s->n_vertex};
    BRC_GROW(ctx, s->vertex, s->cap_vertex, s->n_vertex + (size_t)n);
    /* the other side runs against this edge; the list runs from the low to the high vertex */
    for (int32_t k = 0; k < range[1] - range[0]; k++) {
        int32_t at = forward ? range[1] - 1 - k : range[0] + k;
        if (w->t[at] > low && w->t[at] < high)
            s->vertex[s->n_vertex + (size_t)split.n++] = w->loop[at];
    }
    if (split.n == 0)
        return 0;
    BRC_GROW(ctx, s->list, s->cap, s->n + 1);
    s->list[s->n++] = split;
    s->n_vertex += (size_t)split.n;
    return 0;
}

/* Marks the vertices of a loop as used in this pass; false when one was used before. Splits of one
 * pass then never touch the same edge, and their order does not matter. */
static bool claim_loop(struct merger *w, int32_t n, int32_t pass)
{
    for (int32_t i = 0; i < n; i++)
        if (w->claim[w->loop[i]] == pass)
            return false;
    for (int32_t i = 0; i < n; i++)
        w->claim[w->loop[i]] = pass;
    return true;
}

/* Removes narrow facets: both long sides get the vertices of each other, and so become one. Facets
 * that share a vertex with one removed in this pass wait for the next: their loops change, and
 * whether they are still narrow is asked anew. */
static int close_narrow(struct brc_context *ctx, struct merger *w, int32_t pass, size_t *n_narrow)
{
    struct brc_cell_complex *c = w->c;
    *n_narrow = w->splits.n = w->splits.n_vertex = 0;
    for (size_t f = 0; f < c->n_facets; f++) {
        int32_t tip, n = c->facet[f].n;
        BRC_GROW(ctx, w->loop, w->cap_loop, (size_t)n);
        BRC_GROW(ctx, w->t, w->cap_t, (size_t)n);
        if (n == 0 || !is_narrow(w, &c->facet[f], &tip))
            continue;
        ++*n_narrow;
        if (!claim_loop(w, n, pass))
            continue;
        for (int32_t i = 0; i < n; i++) {
            int32_t range[2] = {i < tip ? tip + 1 : 1, i < tip ? n : tip};
            BRC_TRY(split_edge(ctx, w, i, n, range));
        }
        c->facet[f].n = 0;
    }
    if (w->splits.n > 1)
        qsort(w->splits.list, w->splits.n, sizeof *w->splits.list, brc_tuple2_compare);
    return 0;
}

/* Inserts the new vertices of split edges into all loops. */
static int apply_splits(struct brc_context *ctx, struct merger *w)
{
    struct brc_cell_complex *c = w->c;
    const struct splits *s = &w->splits;
    size_t n_facets = c->n_facets;
    for (size_t f = 0; f < n_facets && s->n > 0; f++) {
        int32_t n = c->facet[f].n, m = 0;
        BRC_GROW(ctx, w->loop, w->cap_loop, (size_t)n + s->n_vertex);
        for (int32_t i = 0; i < n; i++) {
            const int32_t *loop = c->loop + c->facet[f].first;
            int32_t u = loop[i], v = loop[i + 1 < n ? i + 1 : 0];
            struct split key = {u < v ? u : v, u < v ? v : u, 0, 0};
            const struct split *hit = bsearch(&key, s->list, s->n, sizeof key, brc_tuple2_compare);
            w->loop[m++] = u;
            for (int32_t k = 0; hit && k < hit->n; k++)
                w->loop[m++] = s->vertex[hit->first + (u < v ? k : hit->n - 1 - k)];
        }
        if (m > n)
            BRC_TRY(set_loop(ctx, w, f, m));
    }
    return 0;
}

/* Marks v as a neighbour of u; a third different one sets near[u][0] = -2. Three are enough to know
 * that u is a corner, so no longer list is kept. */
static void add_neighbour(int32_t (*near)[2], int32_t u, int32_t v)
{
    if (near[u][0] == -2 || near[u][0] == v || near[u][1] == v)
        return;
    if (near[u][0] == -1)
        near[u][0] = v;
    else if (near[u][1] == -1)
        near[u][1] = v;
    else
        near[u][0] = -2;
}

/* Removes the vertices that have only two neighbours: they lie in the middle of an edge, left there
 * by facets that are gone. All loops around the edge have them, so all lose them alike. */
static int drop_middle_vertices(struct brc_context *ctx, struct merger *w)
{
    struct brc_cell_complex *c = w->c;
    int32_t(*near)[2] = brc_pool_alloc(ctx, &w->pool, c->n_vertices, sizeof *near);
    if (!near)
        return BRC_ERR_MEMORY;
    memset(near, 0xff, c->n_vertices * sizeof *near);
    for (size_t f = 0; f < c->n_facets; f++)
        for (int32_t i = 0; i < c->facet[f].n; i++) {
            const int32_t *loop = c->loop + c->facet[f].first;
            int32_t u = loop[i], v = loop[i + 1 < c->facet[f].n ? i + 1 : 0];
            add_neighbour(near, u, v);
            add_neighbour(near, v, u);
        }
    for (size_t f = 0; f < c->n_facets; f++) {
        int32_t *loop = c->loop + c->facet[f].first, n = 0;
        for (int32_t i = 0; i < c->facet[f].n; i++)
            if (near[loop[i]][0] == -2)
                loop[n++] = loop[i];
        c->facet[f].n = n < 3 ? 0 : n;
    }
    return 0;
}

/* Passes go on until no facet is narrow: closing one may narrow its neighbours. */
static int merge_all(struct brc_context *ctx, struct merger *w)
{
    BRC_TRY(join_vertices(ctx, w));
    BRC_TRY(rename_vertices(ctx, w));
    size_t n_narrow = 1;
    for (int32_t pass = 1; n_narrow > 0; pass++) {
        if (pass > MAX_PASSES)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                     "%zu facets narrower than %g m cannot be closed; move the seeds by chance",
                     n_narrow, w->tolerance);
        BRC_TRY(close_narrow(ctx, w, pass, &n_narrow));
        BRC_TRY(apply_splits(ctx, w));
    }
    return drop_middle_vertices(ctx, w);
}

int brc_cell_complex_merge_vertices(struct brc_context *ctx, struct brc_cell_complex *c,
                                    double tolerance)
{
    struct merger w = {.c = c, .tolerance = tolerance};
    int code = merge_all(ctx, &w);
    brc_pool_free(&w.pool);
    free(w.loop);
    free(w.t);
    free(w.splits.list);
    free(w.splits.vertex);
    return code;
}
