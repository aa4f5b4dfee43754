/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clipping decides by vertex and cuts by edge. The cut edges are sorted and each gets one new
 * vertex, so two cells that share an edge get the same vertex, bit for bit, and no crack opens
 * between them.
 *
 * A loop that grows goes to the end of the pool, and the old one stays as a gap: loops never move
 * while others are read, and the complex lives for one tessellation only. */
#include "common/specimen/cell_complex.h"

#include "common/base/invariant.h"
#include "common/base/grow.h"
#include "common/base/tuples.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE_IN = -1, SIDE_ON = 0, SIDE_OUT = 1 };
enum { HAS_IN = 1, HAS_ON = 2, HAS_OUT = 4 };

/* Directed edge of a cell in the clipping plane, or (cell = 0, from = low) a cut edge. Sorted by
 * its first four members. */
struct edge {
    int32_t cell, low, high, from, to;
};

struct edges {
    struct edge *list;
    size_t n, cap;
};

/* Work space of one clip. */
struct clip {
    struct brc_cell_complex *c;
    const struct brc_plane *plane;
    size_t n_old; /* vertices before the cut */
    struct vertex {
        double height; /* signed distance from the plane */
        int32_t side;
    } * vertex; /* [n_old] */
    struct cell {
        bool is_hit;   /* it lost something */
        bool is_alive; /* it keeps something */
    } * cell;          /* [n_cells] */
    uint8_t *state;    /* [n_facets] which sides the facet's vertices are on, see enum */
    int32_t *work;     /* one loop under construction */
    size_t cap_work;
    struct edges cut, open;
    struct brc_pool pool; /* owns the arrays with a stated length */
};

void brc_cell_complex_free(struct brc_cell_complex *c)
{
    free(c->vertex);
    free(c->facet);
    free(c->loop);
    *c = (struct brc_cell_complex){0};
}

/* The limit of int32_t is an error and not an invariant, since a case decides on the number. */
int brc_cell_complex_add_vertex(struct brc_context *ctx, struct brc_cell_complex *c,
                                const double x[3])
{
    if (c->n_vertices >= INT32_MAX)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "more than %d vertices; use fewer grains", INT32_MAX);
    BRC_GROW(ctx, c->vertex, c->cap_vertices, c->n_vertices + 1);
    brc_copy(c->vertex[c->n_vertices++], x);
    return 0;
}

/* What a facet leaves behind as its loop grows is not used again: a list of gaps would be kept for
 * memory that is freed when the tessellation is made. */
int brc_cell_complex_set_loop(struct brc_context *ctx, struct brc_cell_complex *c, size_t f,
                              const int32_t *loop, int32_t n)
{
    struct brc_cell_complex_facet *facet = &c->facet[f];
    if (n > facet->n) {
        BRC_GROW(ctx, c->loop, c->cap_loop, c->n_loop + (size_t)n);
        facet->first = c->n_loop;
        c->n_loop += (size_t)n;
    }
    facet->n = n;
    memcpy(c->loop + facet->first, loop, (size_t)n * sizeof *loop);
    return 0;
}

/* Numbers are asserted and not checked: CGAL, the mesh of a disc and the reader of files have
 * judged theirs. A loop below three vertices is what merging leaves of a facet that touches itself;
 * to pass over it here spares each caller the question. */
int brc_cell_complex_add_facet(struct brc_context *ctx, struct brc_cell_complex *c,
                               const struct brc_cell_complex_facet *facet, const int32_t *loop)
{
    for (int32_t k = 0; k < facet->n; k++)
        BRC_ASSERT(loop[k] >= 0 && (size_t)loop[k] < c->n_vertices);
    BRC_ASSERT(facet->cell[0] >= 0 && facet->cell[0] < (int32_t)c->n_cells);
    if (facet->n < 3)
        return 0;
    BRC_GROW(ctx, c->facet, c->cap_facets, c->n_facets + 1);
    c->facet[c->n_facets] = *facet;
    c->facet[c->n_facets].n = 0;
    return brc_cell_complex_set_loop(ctx, c, c->n_facets++, loop, facet->n);
}

/* The number decides whether a tessellation has failed; which cells they are is asked for by its
 * message alone. */
size_t brc_cell_complex_empty_cells(const struct brc_cell_complex *c, uint8_t *is_empty)
{
    size_t n = c->n_cells;
    memset(is_empty, 1, c->n_cells);
    for (size_t f = 0; f < c->n_facets; f++)
        for (int k = 0; k < 2 && c->facet[f].n > 0; k++) {
            int32_t cell = c->facet[f].cell[k];
            if (cell >= 0 && is_empty[cell]) {
                is_empty[cell] = 0;
                n--;
            }
        }
    return n;
}

/* A vertex is inside, outside or on the plane from here on, whatever is later computed from its
 * place: each question is answered by these sides alone. */
static int clip_begin(struct brc_context *ctx, struct clip *w, double tolerance)
{
    struct brc_cell_complex *c = w->c;
    w->n_old = c->n_vertices;
    w->vertex = brc_pool_alloc(ctx, &w->pool, w->n_old, sizeof *w->vertex);
    w->cell = brc_pool_alloc(ctx, &w->pool, c->n_cells, sizeof *w->cell);
    w->state = brc_pool_alloc(ctx, &w->pool, c->n_facets, 1);
    if (w->pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t v = 0; v < w->n_old; v++) {
        double h = brc_dot(w->plane->n, c->vertex[v]) - w->plane->d;
        w->vertex[v] = (struct vertex){h, h > tolerance    ? SIDE_OUT
                                          : h < -tolerance ? SIDE_IN
                                                           : SIDE_ON};
    }
    return 0;
}

/* New vertices are on the plane. */
static int side_of(const struct clip *w, int32_t v)
{
    return (size_t)v < w->n_old ? w->vertex[v].side : SIDE_ON;
}

/* By its ends in order, by which facets find that they share it, and as the loop runs, by which new
 * loops are put together. */
static struct edge edge_of(int32_t cell, int32_t from, int32_t to)
{
    bool is_rising = from < to;
    return (struct edge){cell, is_rising ? from : to, is_rising ? to : from, from, to};
}

/* Lists grow, as how many edges a plane meets hangs on where the cells lie; most planes cut few of
 * them. */
static int push_edge(struct brc_context *ctx, struct edges *edges, struct edge e)
{
    BRC_GROW(ctx, edges->list, edges->cap, edges->n + 1);
    edges->list[edges->n++] = e;
    return 0;
}

/* Finds the edges that cross the plane, marks the cells that lose or keep something, and removes
 * the facets without a vertex inside. One that lies in the plane goes, too: its cell is closed anew
 * there, by a facet with the plane's label. */
static int find_cuts(struct brc_context *ctx, struct clip *w)
{
    struct brc_cell_complex *c = w->c;
    for (size_t f = 0; f < c->n_facets; f++) {
        struct brc_cell_complex_facet *facet = &c->facet[f];
        const int32_t *loop = c->loop + facet->first;
        static const uint8_t state[3] = {HAS_IN, HAS_ON, HAS_OUT};
        for (int32_t i = 0; i < facet->n; i++)
            w->state[f] |= state[w->vertex[loop[i]].side + 1];
        bool has_in = w->state[f] & HAS_IN, has_out = w->state[f] & HAS_OUT;
        for (int k = 0; k < 2 && facet->n > 0; k++)
            if (facet->cell[k] >= 0) {
                w->cell[facet->cell[k]].is_alive |= has_in;
                w->cell[facet->cell[k]].is_hit |= has_out || !has_in;
            }
        if (!has_in)
            facet->n = 0;
        for (int32_t i = 0; i < facet->n && has_out; i++) {
            int32_t u = loop[i], v = loop[i + 1 < facet->n ? i + 1 : 0];
            if (w->vertex[u].side * w->vertex[v].side < 0)
                BRC_TRY(push_edge(ctx, &w->cut, edge_of(0, u < v ? u : v, u < v ? v : u)));
        }
    }
    return 0;
}

/* One vertex for each cut edge; its number is n_old + position in the sorted list. An edge has been
 * found once from each facet around it, and sorting brings these together. */
static int make_vertices(struct brc_context *ctx, struct clip *w)
{
    struct edge *cut = w->cut.list;
    if (w->cut.n == 0)
        return 0;
    qsort(cut, w->cut.n, sizeof *cut, brc_tuple4_compare);
    size_t n = 1;
    for (size_t i = 1; i < w->cut.n; i++)
        if (brc_tuple4_compare(&cut[i], &cut[n - 1]) != 0)
            cut[n++] = cut[i];
    w->cut.n = n;
    for (size_t i = 0; i < n; i++) {
        int32_t u = cut[i].from, v = cut[i].to;
        double t = w->vertex[u].height / (w->vertex[u].height - w->vertex[v].height), x[3], e[3];
        brc_sub(e, w->c->vertex[v], w->c->vertex[u]);
        brc_copy(x, w->c->vertex[u]);
        brc_axpy(x, t, e);
        BRC_TRY(brc_cell_complex_add_vertex(ctx, w->c, x));
    }
    return 0;
}

/* The edge is in the list for certain: it was put there from this facet, too, and sides have not
 * changed since. */
static int32_t cut_vertex(const struct clip *w, int32_t u, int32_t v)
{
    struct edge key = edge_of(0, u < v ? u : v, u < v ? v : u);
    const struct edge *hit = bsearch(&key, w->cut.list, w->cut.n, sizeof key, brc_tuple4_compare);
    return (int32_t)(w->n_old + (size_t)(hit - w->cut.list));
}

/* Replaces the loop of a facet by its part inside. A
 * convex polygon leaves a half-plane once: one that does so twice has been bent by merging, and
 * would be two polygons. */
static int clip_facet(struct brc_context *ctx, struct clip *w, size_t f)
{
    struct brc_cell_complex *c = w->c;
    int32_t n = c->facet[f].n, n_new = 0, n_leave = 0;
    if (n == 0 || !(w->state[f] & HAS_OUT))
        return 0;
    BRC_GROW(ctx, w->work, w->cap_work, 2 * (size_t)n);
    for (int32_t i = 0; i < n; i++) {
        const int32_t *loop = c->loop + c->facet[f].first;
        int32_t u = loop[i], v = loop[i + 1 < n ? i + 1 : 0];
        if (w->vertex[u].side != SIDE_OUT)
            w->work[n_new++] = u;
        if (w->vertex[u].side * w->vertex[v].side < 0)
            w->work[n_new++] = cut_vertex(w, u, v);
        n_leave += w->vertex[u].side != SIDE_OUT && w->vertex[v].side == SIDE_OUT;
    }
    if (n_leave > 1)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "the facet between cells %d and %d is not convex where domain plane %d cuts it",
                 c->facet[f].cell[0], c->facet[f].cell[1], w->plane->id);
    return brc_cell_complex_set_loop(ctx, c, f, w->work, n_new);
}

/* Collects the edges in the plane of all facets of the cells that lost something; those of a
 * facet's second cell turned, as it sees the facet from behind. */
static int find_open_edges(struct brc_context *ctx, struct clip *w)
{
    struct brc_cell_complex *c = w->c;
    for (size_t f = 0; f < c->n_facets; f++) {
        struct brc_cell_complex_facet *facet = &c->facet[f];
        const int32_t *loop = c->loop + facet->first;
        for (int k = 0; k < 2 && (w->state[f] & (HAS_ON | HAS_OUT)); k++) {
            int32_t cell = facet->cell[k];
            if (cell < 0 || !w->cell[cell].is_hit)
                continue;
            for (int32_t i = 0; i < facet->n; i++) {
                int32_t u = loop[i], v = loop[i + 1 < facet->n ? i + 1 : 0];
                if (side_of(w, u) == SIDE_ON && side_of(w, v) == SIDE_ON)
                    BRC_TRY(push_edge(ctx, &w->open, edge_of(cell, k ? v : u, k ? u : v)));
            }
        }
    }
    return 0;
}

/* Drops pairs of opposite edges: there the cell has a facet on both sides. Sorting brings them next
 * to each other, as the key is the edge first and its direction last. */
static void cancel_edges(struct edges *open)
{
    size_t n = 0;
    qsort(open->list, open->n, sizeof *open->list, brc_tuple4_compare);
    for (size_t i = 0; i < open->n; i++) {
        struct edge e = open->list[i];
        const struct edge *last = n > 0 ? &open->list[n - 1] : NULL;
        if (last && last->cell == e.cell && last->from == e.to && last->to == e.from)
            n--;
        else
            open->list[n++] = e;
    }
    open->n = n;
}

/* Closes one cell: its n open edges, walked backwards, bound its new facets. Several loops are
 * facets of their own here; finish allows each cell one facet for each plane, and tells where there
 * are more. */
static int close_cell(struct brc_context *ctx, struct clip *w, struct edge *open, size_t n)
{
    struct brc_cell_complex_facet facet = {{open->cell, -1}, w->plane->id, 0, 0, {0, 0, 0}};
    brc_copy(facet.normal, w->plane->n);
    BRC_GROW(ctx, w->work, w->cap_work, n);
    while (n > 0) {
        struct edge e = open[--n];
        int32_t end = e.to;
        facet.n = 0;
        w->work[facet.n++] = e.to;
        while (e.from != end) {
            size_t i = 0;
            while (i < n && open[i].to != e.from)
                i++;
            if (i == n)
                BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "cell %d stays open where domain plane %d cuts it",
                         e.cell, w->plane->id);
            e = open[i];
            open[i] = open[--n];
            w->work[facet.n++] = e.to;
        }
        BRC_TRY(brc_cell_complex_add_facet(ctx, w->c, &facet, w->work));
    }
    return 0;
}

/* Sorting has brought the edges of a cell together. A cell of which nothing is inside is not
 * closed: it is an empty one from here on, and told as that when all planes have cut. */
static int close_cells(struct brc_context *ctx, struct clip *w)
{
    BRC_TRY(find_open_edges(ctx, w));
    if (w->open.n == 0)
        return 0;
    cancel_edges(&w->open);
    struct edge *open = w->open.list;
    for (size_t i = 0, end; i < w->open.n; i = end) {
        for (end = i; end < w->open.n && open[end].cell == open[i].cell; end++)
            continue;
        if (w->cell[open[i].cell].is_alive)
            BRC_TRY(close_cell(ctx, w, open + i, end - i));
    }
    return 0;
}

/* In this order, as each part reads what the one before has decided: sides, cuts, vertices, loops,
 * and at last the open cells. */
static int clip_all(struct brc_context *ctx, struct clip *w, double tolerance)
{
    BRC_TRY(clip_begin(ctx, w, tolerance));
    BRC_TRY(find_cuts(ctx, w));
    BRC_TRY(make_vertices(ctx, w));
    for (size_t f = 0; f < w->c->n_facets; f++)
        BRC_TRY(clip_facet(ctx, w, f));
    return close_cells(ctx, w);
}

/* Work space is that of one cut: vertices and facets have become more by the next, and their arrays
 * with them. */
int brc_cell_complex_clip(struct brc_context *ctx, struct brc_cell_complex *c,
                          const struct brc_plane *plane, double tolerance)
{
    struct clip w = {.c = c, .plane = plane};
    int code = clip_all(ctx, &w, tolerance);
    brc_pool_free(&w.pool);
    free(w.work);
    free(w.cut.list);
    free(w.open.list);
    return code;
}
