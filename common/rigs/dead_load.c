/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dead load, spread over an end: no plate hands it on. Called by tests; it knows bodies and
 * facets, and no model.
 *
 * Platens do not turn (platens.h), so a plate on a bending end would clamp it: its load is spread
 * over the facets instead, which may turn as the end does. A grain's facets carry a part of the
 * load in proportion to their area; as all parts point the same way, they are one force at the
 * middle of that area. */
#include "common/rigs/dead_load.h"

#include "common/base/pool.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"
#include "common/rigs/outside.h"

#include <stdlib.h>

struct brc_dead_load {
    size_t n;            /* loaded grains */
    int32_t *body;       /* [n] ascending */
    double *part;        /* [n] of the load, sum 1 */
    double (*place)[3];  /* [n] m, middle of the loaded area, at the start */
    double (*last)[6];   /* [n] N, N m: what the load did to the grain in the last step */
    double middle[3];    /* m, mean place */
    double direction[3]; /* of the load at the start */
    double outward[3];   /* along the axis, out of the specimen */
    bool is_followed;
    struct brc_pool pool;
};

/* Facets are sorted by their grain, so that those of one follow each other. */
static void collect(const struct brc_sim *sim, struct brc_end end, double area,
                    struct brc_dead_load *d)
{
    const struct brc_facets *f = &sim->specimen->facets;
    for (size_t i = 0; i < f->n_facets; i++) {
        if (!brc_end_has(sim->specimen, end, i))
            continue;
        if (d->n == 0 || d->body[d->n - 1] != f->cell[i][0])
            d->body[d->n++] = f->cell[i][0];
        d->part[d->n - 1] += f->area[i] / area;
        brc_axpy(d->place[d->n - 1], f->area[i] / area, f->centroid[i]);
        brc_axpy(d->middle, f->area[i] / area, f->centroid[i]);
    }
    for (size_t i = 0; i < d->n; i++)
        brc_scale(d->place[i], d->place[i], 1 / d->part[i]);
}

int brc_dead_load_create(struct brc_sim *sim, struct brc_end end, const double direction[3],
                         bool is_followed, struct brc_dead_load **out)
{
    struct brc_dead_load *d = *out = brc_alloc(sim->ctx, 1, sizeof *d);
    struct brc_end_face face;
    size_t n = sim->bodies.n_grains;
    if (!d)
        return BRC_ERR_MEMORY;
    d->body = brc_pool_alloc(sim->ctx, &d->pool, n, sizeof *d->body);
    d->part = brc_pool_alloc(sim->ctx, &d->pool, n, sizeof *d->part);
    d->place = brc_pool_alloc(sim->ctx, &d->pool, n, sizeof *d->place);
    d->last = brc_pool_alloc(sim->ctx, &d->pool, n, sizeof *d->last);
    if (d->pool.is_failed) {
        brc_dead_load_free(d);
        *out = NULL;
        return BRC_ERR_MEMORY;
    }
    brc_copy(d->direction, direction);
    d->outward[end.axis] = end.sense;
    d->is_followed = is_followed;
    brc_end_face_measure(sim->specimen, end, (end.axis + 1) % 3, &face);
    collect(sim, end, face.area, d);
    return 0;
}

void brc_dead_load_free(void *load)
{
    struct brc_dead_load *d = load;
    if (d)
        brc_pool_free(&d->pool);
    free(d);
}

static void mean_place(const struct brc_sim *sim, const struct brc_dead_load *d, double mean[3])
{
    brc_set(mean, 0, 0, 0);
    for (size_t i = 0; i < d->n; i++) {
        double now[3];
        brc_bodies_carry(&sim->bodies, (size_t)d->body[i], d->place[i], now);
        brc_axpy(mean, d->part[i], now);
    }
}

double brc_dead_load_way(const struct brc_sim *sim, const struct brc_dead_load *d)
{
    double mean[3];
    mean_place(sim, d, mean);
    brc_sub(mean, mean, d->middle);
    return brc_dot(mean, d->direction);
}

/* The rotation of the plane that fits the places of the grains best, which is exact where the end
 * stays flat, whatever the angle. */
double brc_dead_load_turn(const struct brc_sim *sim, const struct brc_dead_load *d)
{
    double mean[3], sine = 0, cosine = 0;
    mean_place(sim, d, mean);
    for (size_t i = 0; i < d->n; i++) {
        double first[3], now[3];
        brc_sub(first, d->place[i], d->middle);
        brc_bodies_carry(&sim->bodies, (size_t)d->body[i], d->place[i], now);
        brc_sub(now, now, mean);
        double lever = d->part[i] * brc_dot(first, d->direction);
        cosine += lever * brc_dot(now, d->direction);
        sine -= lever * brc_dot(now, d->outward);
    }
    return atan2(sine, cosine);
}

/* The end turns towards the load: so does the load, towards where the end looked away from. */
static void find_force(const struct brc_sim *sim, const struct brc_dead_load *d, double newtons,
                       double force[3])
{
    brc_scale(force, d->direction, newtons);
    if (!d->is_followed)
        return;
    double turn = brc_dead_load_turn(sim, d);
    brc_scale(force, d->direction, newtons * cos(turn));
    brc_axpy(force, -newtons * sin(turn), d->outward);
}

/* What a force on the whole end does to its grain i. */
static void load_of(const struct brc_sim *sim, const struct brc_dead_load *d, size_t i,
                    const double force[3], double load[6])
{
    double at[3];
    brc_bodies_carry(&sim->bodies, (size_t)d->body[i], d->place[i], at);
    brc_sub(at, at, sim->bodies.x[d->body[i]]);
    brc_scale(load, force, d->part[i]);
    brc_cross(load + 3, at, load);
}

void brc_dead_load_apply(struct brc_sim *sim, struct brc_dead_load *d, double newtons)
{
    const struct brc_bodies *b = &sim->bodies;
    double force[3], load[6];
    for (size_t i = 0; i < d->n; i++)
        brc_outside_turn(sim, d->body[i]);
    find_force(sim, d, newtons, force);
    for (size_t i = 0; i < d->n; i++) {
        load_of(sim, d, i, force, load);
        b->terms[i] = brc_outside_push(sim, d->body[i], load, d->last[i]);
    }
    sim->ledger.boundary += brc_sum_exact_of(b->terms, d->n, b->n_grains);
}

void brc_dead_load_restore(struct brc_sim *sim, struct brc_dead_load *d, double newtons)
{
    double force[3];
    find_force(sim, d, newtons, force);
    for (size_t i = 0; i < d->n; i++)
        load_of(sim, d, i, force, d->last[i]);
}
