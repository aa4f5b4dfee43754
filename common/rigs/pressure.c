/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sides of the specimen as a surface of triangles, and a pressure on it. Called by tests with a
 * confined specimen; it knows bodies and facets, and no model.
 *
 * A vertex is the mean of where its grains would carry it, and the force on it goes to them in
 * equal parts, each at the place where it carries it: so the forces are the derivative of -p V by
 * the grains' places and turns, the sum of forces and moments on the closed surface is zero, and
 * the work is -p dV, whatever the grains do. The ends are closed by the platens, which push with
 * what the test asks of them. Rejected: facets that move with their own grain alone, which open
 * gaps and overlaps between them, so that pressure would drive a specimen about. */
#include "common/rigs/pressure.h"

#include "common/base/lanes.h"
#include "common/base/pool.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"
#include "common/rigs/outside.h"

#include <stdlib.h>
#include <string.h>

/* Steps from one look at where the sides are to the next. In a slow test they move by next to
 * nothing in so many steps; a look at each step made a step of vgcm half as dear again. */
enum { FIND_STEPS = 32 };

/* Places and areas here are lanes of x, y, z and 0, as a surface has too many of them for sums of
 * three. A grain that carries a vertex: */
struct share {
    int32_t vertex, grain; /* in the lists of the surface */
    double arm[4];         /* from the grain's centre, in its principal axes */
    double now[4];         /* in space */
};

struct grain {
    int32_t body;
    bool has_left;
    double diameter;              /* m, of a sphere of its volume */
    double centre[4], axes[3][4]; /* now */
    double area[4], moment[4];    /* m2, m3: force and moment of a unit pressure */
    double last[6];               /* N, N m: what the pressure did to it in the last step */
};

struct facet {
    int32_t in_specimen, grain;
    double arm[4];    /* to the mean of its corners from the grain's centre, in its axes */
    double middle[4]; /* mean of its corners now */
};

struct brc_pressure {
    size_t n_facets, n_vertices, n_grains, n_shares;
    struct grain *grain; /* ascending by body */
    struct facet *facet;
    size_t *first;          /* [n_facets + 1] range in corner */
    int32_t *corner;        /* vertices, counter-clockwise from outside */
    size_t *shares_of;      /* [n_vertices + 1] range in share */
    struct share *share;    /* by vertex, then by grain */
    double (*vertex)[4];    /* [n_vertices] m, now */
    double (*on_vertex)[4]; /* [n_vertices] m2 */
    double *weight;         /* [n_vertices] 1 over the number of its grains that have not left */
    double area;            /* m2, of all facets at the start */
    struct brc_pool pool;
};

/* --- building ----------------------------------------------------------------------------------
 */

/* Facets of the sides, and the numbers of their grains and vertices in the lists here, -1: none. */
struct sides {
    bool *is_side;
    int32_t *grain, *vertex;
};

static int find_sides(struct brc_sim *sim, struct brc_pool *pool, struct sides *out)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct brc_facing *facing;
    size_t n;
    out->is_side = brc_pool_alloc(sim->ctx, pool, f->n_facets, sizeof *out->is_side);
    out->grain = brc_pool_alloc(sim->ctx, pool, f->n_cells, sizeof *out->grain);
    out->vertex = brc_pool_alloc(sim->ctx, pool, f->n_vertices, sizeof *out->vertex);
    if (pool->is_failed)
        return BRC_ERR_MEMORY;
    BRC_TRY(brc_platens_facing(sim, &facing, &n));
    for (size_t i = 0; i < f->n_facets; i++)
        out->is_side[i] = f->cell[i][1] < 0;
    for (size_t i = 0; i < n; i++)
        out->is_side[facing[i].facet] = false;
    free(facing);
    return 0;
}

/* Numbers those that have a mark, in their order, and -1 for the others; returns how many. */
static size_t number(int32_t *mark, size_t n)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        mark[i] = mark[i] ? (int32_t)count++ : -1;
    return count;
}

static void count_parts(const struct brc_facets *f, struct sides *sides, struct brc_pressure *s)
{
    for (size_t i = 0; i < f->n_facets; i++) {
        if (!sides->is_side[i])
            continue;
        s->n_facets++;
        s->n_shares += f->first[i + 1] - f->first[i];
        sides->grain[f->cell[i][0]] = 1;
        for (size_t k = f->first[i]; k < f->first[i + 1]; k++)
            sides->vertex[f->loop[k]] = 1;
    }
    s->n_grains = number(sides->grain, f->n_cells);
    s->n_vertices = number(sides->vertex, f->n_vertices);
}

static int make_lists(struct brc_context *ctx, struct brc_pressure *s)
{
    struct brc_pool *p = &s->pool;
    s->grain = brc_pool_alloc(ctx, p, s->n_grains, sizeof *s->grain);
    s->facet = brc_pool_alloc(ctx, p, s->n_facets, sizeof *s->facet);
    s->first = brc_pool_alloc(ctx, p, s->n_facets + 1, sizeof *s->first);
    s->corner = brc_pool_alloc(ctx, p, s->n_shares, sizeof *s->corner);
    s->shares_of = brc_pool_alloc(ctx, p, s->n_vertices + 1, sizeof *s->shares_of);
    s->share = brc_pool_alloc(ctx, p, s->n_shares, sizeof *s->share);
    s->vertex = brc_pool_alloc(ctx, p, s->n_vertices, sizeof *s->vertex);
    s->on_vertex = brc_pool_alloc(ctx, p, s->n_vertices, sizeof *s->on_vertex);
    s->weight = brc_pool_alloc(ctx, p, s->n_vertices, sizeof *s->weight);
    return p->is_failed ? BRC_ERR_MEMORY : 0;
}

/* From a grain's centre to a point of the specimen as it was made, in the grain's axes. */
static void arm_of(const struct brc_bodies *b, int32_t body, const double point[3], double arm[3])
{
    double m[3][3], d[3];
    brc_quat_matrix(m, b->q0[body]);
    brc_sub(d, point, b->x0[body]);
    brc_mat_mul_t(arm, m, d);
}

static int by_vertex(const void *p, const void *q)
{
    const struct share *a = p, *b = q;
    if (a->vertex != b->vertex)
        return a->vertex < b->vertex ? -1 : 1;
    return (a->grain > b->grain) - (a->grain < b->grain);
}

/* Two facets of one grain meet in most vertices of an edge of the domain: it counts once. */
static void drop_repeated(struct brc_pressure *s)
{
    size_t n = 0;
    qsort(s->share, s->n_shares, sizeof *s->share, by_vertex);
    for (size_t i = 0; i < s->n_shares; i++)
        if (i == 0 || by_vertex(&s->share[i], &s->share[i - 1]) != 0)
            s->share[n++] = s->share[i];
    s->n_shares = n;
    for (size_t i = 0; i < n; i++)
        s->shares_of[s->share[i].vertex + 1] = i + 1;
}

static void add_facet(const struct brc_sim *sim, const struct sides *sides, size_t facet, size_t i,
                      struct brc_pressure *s)
{
    const struct brc_facets *f = &sim->specimen->facets;
    int32_t cell = f->cell[facet][0], grain = sides->grain[cell];
    size_t n = f->first[facet + 1] - f->first[facet], at = s->first[i];
    double mean[3] = {0, 0, 0};
    s->facet[i] = (struct facet){.in_specimen = (int32_t)facet, .grain = grain};
    s->grain[grain].body = cell;
    s->grain[grain].diameter = 2 * cbrt(3 * f->volume[cell] / (4 * BRC_PI));
    s->area += f->area[facet];
    s->first[i + 1] = at + n;
    for (size_t k = 0; k < n; k++) {
        int32_t id = f->loop[f->first[facet] + k];
        s->corner[at + k] = sides->vertex[id];
        s->share[at + k] = (struct share){.vertex = sides->vertex[id], .grain = grain};
        arm_of(&sim->bodies, cell, f->vertex[id], s->share[at + k].arm);
        brc_axpy(mean, 1 / (double)n, f->vertex[id]);
    }
    arm_of(&sim->bodies, cell, mean, s->facet[i].arm);
}

static int fail_no_sides(struct brc_sim *sim)
{
    BRC_FAIL(
        sim->ctx, BRC_ERR_INPUT,
        "all of the specimen's surface faces a platen within 30 degrees, so there are no sides "
        "for test.kind: %s; use another shape",
        sim->rig.type->name);
}

static int build(struct brc_sim *sim, struct brc_pressure *s)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct brc_pool pool = {0};
    struct sides sides = {0};
    int code = find_sides(sim, &pool, &sides);
    if (code == 0) {
        count_parts(f, &sides, s);
        code = s->n_facets > 0 ? make_lists(sim->ctx, s) : fail_no_sides(sim);
    }
    for (size_t facet = 0, i = 0; code == 0 && facet < f->n_facets; facet++)
        if (sides.is_side[facet])
            add_facet(sim, &sides, facet, i++, s);
    if (code == 0)
        drop_repeated(s);
    brc_pool_free(&pool);
    return code;
}

int brc_pressure_create(struct brc_sim *sim, struct brc_pressure **out)
{
    struct brc_pressure *s = *out = brc_alloc(sim->ctx, 1, sizeof *s);
    if (!s)
        return BRC_ERR_MEMORY;
    int code = build(sim, s);
    if (code != 0) {
        brc_pressure_free(s);
        *out = NULL;
    }
    return code;
}

void brc_pressure_free(void *pressure)
{
    struct brc_pressure *s = pressure;
    if (s)
        brc_pool_free(&s->pool);
    free(s);
}

/* --- the surface now ---------------------------------------------------------------------------
 */

BRC_LANES_INLINE brc_lanes cross(brc_lanes a, brc_lanes b)
{
    brc_lanes a1 = __builtin_shufflevector(a, a, 1, 2, 0, 3);
    brc_lanes b1 = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    brc_lanes c = a * b1 - a1 * b;
    return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}

BRC_LANES_INLINE brc_lanes arm_now(const struct grain *g, const double arm[4])
{
    return brc_lanes_at(g->axes[0]) * arm[0] + brc_lanes_at(g->axes[1]) * arm[1] +
           brc_lanes_at(g->axes[2]) * arm[2];
}

static void place_grains(const struct brc_sim *sim, struct brc_pressure *s)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < s->n_grains; i++) {
        struct grain *g = &s->grain[i];
        double m[3][3];
        brc_quat_matrix(m, b->q[g->body]);
        brc_copy(g->centre, b->x[g->body]);
        for (int k = 0; k < 3; k++)
            brc_set(g->axes[k], m[0][k], m[1][k], m[2][k]);
        g->has_left = b->has_left[g->body];
    }
    for (size_t i = 0; i < s->n_shares; i++)
        brc_lanes_put(s->share[i].now, arm_now(&s->grain[s->share[i].grain], s->share[i].arm));
}

static void place_vertices(struct brc_pressure *s)
{
    for (size_t v = 0; v < s->n_vertices; v++) {
        brc_lanes sum = brc_lanes_all(0);
        int n = 0;
        for (size_t i = s->shares_of[v]; i < s->shares_of[v + 1]; i++) {
            const struct grain *g = &s->grain[s->share[i].grain];
            if (g->has_left)
                continue;
            sum += brc_lanes_at(g->centre) + brc_lanes_at(s->share[i].now);
            n++;
        }
        s->weight[v] = n > 0 ? 1 / (double)n : 0;
        brc_lanes_put(s->vertex[v], sum * s->weight[v]);
    }
    for (size_t i = 0; i < s->n_facets; i++) {
        brc_lanes sum = brc_lanes_all(0);
        for (size_t k = s->first[i]; k < s->first[i + 1]; k++)
            sum += brc_lanes_at(s->vertex[s->corner[k]]);
        brc_lanes_put(s->facet[i].middle, sum / (double)(s->first[i + 1] - s->first[i]));
    }
}

/* A grain that has left drags the surface no longer, and the pressure acts on it no longer: in a
 * laboratory the jacket closes behind it, or leaks. By a whole diameter, since a grain that only
 * stands out still belongs to the side. One at a time, the farthest first, as it has dragged its
 * neighbours' vertices along. */
static bool mark_left(const struct brc_sim *sim, struct brc_pressure *s)
{
    struct grain *farthest = NULL;
    double most = 1;
    for (size_t i = 0; i < s->n_facets; i++) {
        const struct facet *f = &s->facet[i];
        struct grain *g = &s->grain[f->grain];
        double way[4];
        brc_lanes_put(way, brc_lanes_at(g->centre) + arm_now(g, f->arm) - brc_lanes_at(f->middle));
        double part = brc_norm2(way) / (g->diameter * g->diameter);
        if (g->has_left || part <= most)
            continue;
        most = part;
        farthest = g;
    }
    if (farthest)
        sim->bodies.has_left[farthest->body] = farthest->has_left = true;
    return farthest;
}

/* --- pressure ----------------------------------------------------------------------------------
 */

/* Each triangle of middle, corner and next corner has a third of its area on each; the middle is
 * the corners' mean and hands its part to them. */
static void press_facet(struct brc_pressure *s, size_t facet)
{
    size_t first = s->first[facet], n = s->first[facet + 1] - first;
    brc_lanes middle = brc_lanes_at(s->facet[facet].middle), on_middle = brc_lanes_all(0);
    brc_lanes a = brc_lanes_at(s->vertex[s->corner[first + n - 1]]) - middle;
    double *on_a = s->on_vertex[s->corner[first + n - 1]];
    for (size_t k = 0; k < n; k++) {
        int32_t v = s->corner[first + k];
        brc_lanes b = brc_lanes_at(s->vertex[v]) - middle;
        brc_lanes third = cross(a, b) * (-1.0 / 6); /* of the triangle's area, inward */
        brc_lanes_put(on_a, brc_lanes_at(on_a) + third);
        on_a = s->on_vertex[v];
        brc_lanes_put(on_a, brc_lanes_at(on_a) + third);
        on_middle += third;
        a = b;
    }
    on_middle /= (double)n;
    for (size_t k = 0; k < n; k++) {
        double *on = s->on_vertex[s->corner[first + k]];
        brc_lanes_put(on, brc_lanes_at(on) + on_middle);
    }
}

static void hand_to_grains(const struct brc_sim *sim, struct brc_pressure *s)
{
    for (size_t i = 0; i < s->n_grains; i++) {
        brc_lanes_put(s->grain[i].area, brc_lanes_all(0));
        brc_lanes_put(s->grain[i].moment, brc_lanes_all(0));
    }
    for (size_t i = 0; i < s->n_shares; i++) {
        const struct share *share = &s->share[i];
        struct grain *g = &s->grain[share->grain];
        brc_lanes part = brc_lanes_at(s->on_vertex[share->vertex]) * s->weight[share->vertex];
        if (g->has_left)
            continue;
        brc_lanes_put(g->area, brc_lanes_at(g->area) + part);
        brc_lanes_put(g->moment, brc_lanes_at(g->moment) + cross(brc_lanes_at(share->now), part));
    }
    for (size_t i = 0; i < s->n_grains; i++) {
        brc_copy(sim->bodies.side_area[s->grain[i].body], s->grain[i].area);
        brc_copy(sim->bodies.side_moment[s->grain[i].body], s->grain[i].moment);
    }
}

void brc_pressure_find(struct brc_sim *sim, struct brc_pressure *s)
{
    place_grains(sim, s);
    do
        place_vertices(s);
    while (mark_left(sim, s)); /* each round takes a grain, so there is an end */
    memset(s->on_vertex, 0, s->n_vertices * sizeof *s->on_vertex);
    for (size_t i = 0; i < s->n_facets; i++)
        if (!s->grain[s->facet[i].grain].has_left)
            press_facet(s, i);
    hand_to_grains(sim, s);
}

static void load_of(const struct brc_sim *sim, const struct grain *g, double p, double load[6])
{
    brc_scale(load, sim->bodies.side_area[g->body], p);
    brc_scale(load + 3, sim->bodies.side_moment[g->body], p);
}

void brc_pressure_apply(struct brc_sim *sim, struct brc_pressure *s, double p)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < s->n_grains; i++)
        brc_outside_turn(sim, s->grain[i].body);
    if (sim->step % FIND_STEPS == 0 || sim->step == 1)
        brc_pressure_find(sim, s);
    for (size_t i = 0; i < s->n_grains; i++) {
        double load[6];
        load_of(sim, &s->grain[i], p, load);
        b->terms[i] = brc_outside_push(sim, s->grain[i].body, load, s->grain[i].last);
    }
    sim->ledger.boundary += brc_sum_exact_of(b->terms, s->n_grains, b->n_grains);
}

void brc_pressure_restore(struct brc_sim *sim, struct brc_pressure *s, double p)
{
    for (size_t i = 0; i < s->n_grains; i++)
        load_of(sim, &s->grain[i], p, s->grain[i].last);
}

double brc_pressure_lost(const struct brc_sim *sim, const struct brc_pressure *s)
{
    double lost = 0;
    for (size_t i = 0; i < s->n_facets; i++)
        if (sim->bodies.has_left[s->grain[s->facet[i].grain].body])
            lost += sim->specimen->facets.area[s->facet[i].in_specimen];
    return lost / s->area;
}
