/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facets of a cell that lie in one plane are gathered first and moved as one face: planes that
 * differ in their last digits would cut slivers off each other. The core is then made anew from the
 * moved planes, rather than by moving vertices: edges and faces vanish as a cell erodes, and
 * clipping finds out which. */
#include "common/specimen/erosion.h"

#include "common/base/grow.h"
#include "common/geometry/vec.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Facets whose planes differ by less than this part of the distance from them are one face: far
 * above what rounding makes of one plane, far below any angle that matters to a contact. */
static const double coplanar_angle = 1e-9;
/* A facet's plane is known to the digits of its vertices, worse with distance from a small one. */
static const double digits_margin = 8;
/* Normals farther apart than this are of two planes, whatever the digits say. */
static const double least_cosine = 1 - 1e-4;
enum { BISECTIONS = 40 };

void brc_erosion_free(struct brc_erosion *e)
{
    brc_convex_free(&e->cell);
    brc_convex_free(&e->core);
    free(e->plane);
    free(e->facet);
    free(e->polygon);
    memset(e, 0, sizeof *e);
}

static size_t facet_of(const struct brc_erosion *e, size_t k)
{
    return (size_t)e->facets->cell_facet[e->facets->cell_first[e->index] + k];
}

/* Whether the cell's k-th facet lies in the plane of the i-th, which is no smaller. By its vertices
 * and not by its normal, which means little for a small facet; what may be off grows with the
 * distance from the larger one, whose plane is known to its digits over its width. */
static bool is_in_plane(const struct brc_erosion *e, size_t i, size_t k)
{
    const struct brc_facets *f = e->facets;
    const double *n = e->plane[i].n;
    size_t own = facet_of(e, i), other = facet_of(e, k);
    if (brc_dot(n, e->plane[k].n) < least_cosine)
        return false;
    double digits = digits_margin * fmax(f->precision, DBL_EPSILON * brc_norm(f->centroid[own]));
    double slope = coplanar_angle + digits / brc_facets_width(f, own);
    for (size_t v = f->first[other]; v < f->first[other + 1]; v++) {
        double r[3];
        brc_sub(r, f->vertex[f->loop[v]], f->centroid[own]);
        if (fabs(brc_dot(n, r)) > digits + slope * brc_norm(r))
            return false;
    }
    return true;
}

/* The largest facet without a leader, n when there is none. Largest first, since a plane is known
 * the better the wider its facet is. */
static size_t next_leader(const struct brc_erosion *e)
{
    size_t best = e->n;
    for (size_t k = 0; k < e->n; k++)
        if (e->facet[k].leader < 0 &&
            (best == e->n || e->facets->area[facet_of(e, k)] > e->facets->area[facet_of(e, best)]))
            best = k;
    return best;
}

/* The plane of i becomes that of all facets it leads, weighted by their areas: planes of small
 * facets count for as little as they are known. */
static void average_plane(struct brc_erosion *e, size_t i)
{
    double n[3] = {0, 0, 0}, at[3] = {0, 0, 0}, area = 0;
    for (size_t k = 0; k < e->n; k++) {
        size_t facet = facet_of(e, k);
        double r[3];
        if (e->facet[k].leader != (int32_t)i)
            continue;
        brc_sub(r, e->facets->centroid[facet], e->facets->centroid[facet_of(e, i)]);
        brc_axpy(n, e->facets->area[facet], e->plane[k].n);
        brc_axpy(at, e->facets->area[facet], r);
        area += e->facets->area[facet];
    }
    brc_normalise(e->plane[i].n, n);
    brc_scale(at, at, 1 / area);
    brc_add(at, at, e->facets->centroid[facet_of(e, i)]);
    e->plane[i].d = brc_dot(e->plane[i].n, at);
}

/* Groups are found greedily. To lie in one plane is not transitive where limits are involved, and
 * the largest facet is the one whose plane the others must fit. */
static void group_facets(struct brc_erosion *e)
{
    for (size_t k = 0; k < e->n; k++) {
        e->facet[k].leader = -1;
        e->facet[k].share = 0;
    }
    for (size_t i; (i = next_leader(e)) < e->n;) {
        for (size_t k = 0; k < e->n; k++)
            if (e->facet[k].leader < 0 && (k == i || is_in_plane(e, i, k))) {
                e->facet[k].leader = (int32_t)i;
                e->facet[i].share++;
            }
        if (e->facet[i].share > 1)
            average_plane(e, i);
    }
}

/* Planes have room twice: as the cell has them, and behind these as they are moved for a radius, of
 * which brc_erosion_inscribed tries many on one cell. */
int brc_erosion_begin(struct brc_context *ctx, struct brc_erosion *e, const struct brc_facets *f,
                      size_t cell)
{
    e->facets = f;
    e->index = cell;
    e->n = f->cell_first[cell + 1] - f->cell_first[cell];
    BRC_GROW(ctx, e->plane, e->cap_plane, 2 * e->n);
    BRC_GROW(ctx, e->facet, e->cap_facet, e->n);
    BRC_TRY(brc_facets_cell(ctx, f, cell, &e->cell));
    brc_facets_cell_planes(f, cell, e->plane);
    group_facets(e);
    return 0;
}

/* The box that the planes cut is twice as wide as the cell reaches: nothing of it may be left, as
 * its faces stem from no facet. */
int brc_erosion_core(struct brc_context *ctx, struct brc_erosion *e, double radius,
                     const double centre[3])
{
    struct brc_plane *moved = e->plane + e->n;
    size_t n = 0;
    for (size_t k = 0; k < e->n; k++)
        if (e->facet[k].leader == (int32_t)k) {
            moved[n] = e->plane[k];
            moved[n++].d -= radius;
        }
    return brc_convex_from_planes(ctx, &e->core, moved, n, centre,
                                  2 * brc_convex_reach(&e->cell, centre));
}

/* Keeps the part of a polygon on the inner side of a facet's edge u-v; returns its length. One edge
 * after the other, this is Sutherland and Hodgman's intersection of two convex polygons. */
static size_t cut_polygon(const double (*from)[3], size_t n, const double u[3], const double v[3],
                          const double normal[3], double (*to)[3])
{
    double along[3], in[3];
    size_t m = 0;
    brc_sub(along, v, u);
    brc_cross(in, normal, along);
    for (size_t i = 0; i < n; i++) {
        const double *p = from[i], *q = from[i + 1 < n ? i + 1 : 0];
        double dp[3], dq[3], step[3];
        brc_sub(dp, p, u);
        brc_sub(dq, q, u);
        double hp = brc_dot(in, dp), hq = brc_dot(in, dq);
        if (hp >= 0) {
            brc_copy(to[m], p);
            m++;
        }
        if ((hp < 0) == (hq < 0))
            continue;
        brc_sub(step, q, p);
        brc_copy(to[m], p);
        brc_axpy(to[m], hp / (hp - hq), step);
        m++;
    }
    return m;
}

/* Area over a facet of the polygon of n vertices that begins the work space, which has room for
 * twice `room`: its halves take turns. */
static double area_over(struct brc_erosion *e, size_t facet, size_t n, size_t room)
{
    const struct brc_facets *f = e->facets;
    double(*now)[3] = e->polygon, (*next)[3] = e->polygon + room, sum[3] = {0, 0, 0};
    for (size_t i = f->first[facet]; i < f->first[facet + 1]; i++) {
        size_t j = i + 1 < f->first[facet + 1] ? i + 1 : f->first[facet];
        n = cut_polygon((const double(*)[3])now, n, f->vertex[f->loop[i]], f->vertex[f->loop[j]],
                        f->normal[facet], next);
        double(*swap)[3] = now;
        now = next;
        next = swap;
    }
    for (size_t i = 1; i + 1 < n; i++) {
        double p[3], q[3], cross[3];
        brc_sub(p, now[i], now[0]);
        brc_sub(q, now[i + 1], now[0]);
        brc_cross(cross, p, q);
        brc_axpy(sum, 0.5, cross);
    }
    return brc_norm(sum);
}

/* A plane with one facet has the whole face of the core. Where several share it, each gets what
 * lies over it: the eroded areas of bonds then sum to the face, with no gap and nothing twice. */
static int face_area(struct brc_context *ctx, struct brc_erosion *e, size_t k, double *area)
{
    const struct brc_convex *core = &e->core;
    size_t leader = (size_t)e->facet[k].leader, facet = facet_of(e, k);
    size_t i = brc_convex_face(core, (int32_t)facet_of(e, leader));
    double unused[3];
    *area = 0;
    if (i == core->n_faces)
        return 0;
    const int32_t *loop = core->loop + core->first[i];
    size_t n = core->first[i + 1] - core->first[i];
    *area = brc_polygon_area(core->vertex, loop, n, core->plane[i].n, unused);
    if (e->facet[leader].share == 1)
        return 0;
    /* a cut by an edge of the facet adds one vertex at most */
    size_t room = n + e->facets->first[facet + 1] - e->facets->first[facet];
    BRC_GROW(ctx, e->polygon, e->cap_polygon, 2 * room);
    for (size_t v = 0; v < n; v++)
        brc_copy(e->polygon[v], core->vertex[loop[v]]);
    *area = area_over(e, facet, n, room);
    return 0;
}

/* A facet belongs to two cells, which erode it on their own, so that it has two areas. */
int brc_erosion_areas(struct brc_context *ctx, struct brc_erosion *e, double (*area)[2])
{
    for (size_t k = 0; k < e->n; k++) {
        size_t facet = facet_of(e, k);
        BRC_TRY(face_area(ctx, e, k, &area[facet][e->facets->cell[facet][0] != (int32_t)e->index]));
    }
    return 0;
}

/* Bisection, for a message alone: the exact radius would need a linear program, and 40 halvings
 * give it to more digits than are printed. */
double brc_erosion_inscribed(struct brc_erosion *e, double high)
{
    double low = 0;
    for (int i = 0; i < BISECTIONS; i++) {
        /* what fails here is not a failure of the caller */
        struct brc_context own = BRC_CONTEXT_INIT;
        double middle = 0.5 * (low + high);
        int code = brc_erosion_core(&own, e, middle, e->facets->centre[e->index]);
        if (code == 0 && e->core.n_faces > 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}
