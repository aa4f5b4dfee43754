/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of the integrator over bodies, four at a time, compiled for each instruction set by the
 * files that include this one. Lanes are bodies, so no sum goes across them and each body has the
 * bits that a loop over single ones would give it. Tables hold a multiple of four rows (table.h):
 * what lies past the last body is read and written, but never counted. */
#ifndef BRC_INTEGRATE_KERNELS_H
#define BRC_INTEGRATE_KERNELS_H

#include "common/engine/integrate.h"
#include "common/engine/rotation.h"
#include "common/base/lanes.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

BRC_LANES_INLINE brc_lanes brc_norm_of_lanes(const brc_lanes v[3])
{
    return brc_lanes_sqrt(brc_lanes_dot(v, v));
}

/* Platens move, too. path_length grows by a bound of what any point of the body has moved: what the
 * neighbour search and sleeping contacts rely on. */
static void brc_drift_loop(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    double dt = sim->dt;
    for (size_t i = 0; i < b->n; i += BRC_LANES) { /* rows past the last are room, of zeros */
        brc_lanes x[3], v[3], w[3];
        brc_lanes_at3(x, b->x + i);
        brc_lanes_at3(v, b->v + i);
        brc_lanes_at3(w, b->w + i);
        for (int k = 0; k < 3; k++)
            x[k] += dt * v[k];
        brc_lanes_put3(b->x + i, x);
        brc_lanes path = dt * (brc_norm_of_lanes(v) +
                               brc_lanes_at(b->bounding_radius + i) * brc_norm_of_lanes(w));
        brc_lanes_put(b->path_length + i, brc_lanes_at(b->path_length + i) + path);
    }
}

/* A velocity below this part of what the force adds to it in the step has the direction of
 * round-off: so have the spins of a test that has just begun. */
#define BRC_AT_REST 1e-6

/* Local non-viscous damping of a force (or moment) f against the velocity v; add: velocity that a
 * unit of f adds in the step. As printed it acts on each Cartesian component, so it depends on how
 * the specimen lies; along the velocity it does not. A body at rest is not damped: a sign of zero
 * would push it. */
BRC_LANES_INLINE void brc_local_damping(const struct brc_sim *sim, brc_lanes d[3],
                                        const brc_lanes f[3], const brc_lanes v[3], brc_lanes add)
{
    double alpha = sim->damping_alpha;
    if (sim->run.damping == BRC_DAMPING_CARTESIAN) {
        for (int k = 0; k < 3; k++) { /* eq:vgcm:3 eq:vgcm:5 */
            brc_mask moves = brc_lanes_less(brc_lanes_all(0), brc_lanes_abs(v[k]));
            d[k] = brc_lanes_where(moves, -alpha * brc_lanes_sign(f[k], v[k]));
        }
        return;
    }
    brc_lanes speed = brc_norm_of_lanes(v), size = brc_norm_of_lanes(f);
    brc_mask moves = brc_lanes_less(BRC_AT_REST * add * size, speed);
    brc_lanes part = brc_lanes_where(moves, -alpha * size / speed);
    for (int k = 0; k < 3; k++)
        d[k] = part * v[k];
}

/* Energies of four bodies. */
struct brc_kick_sums {
    brc_lanes kinetic;       /* m v- . v+ / 2 */
    brc_lanes damping;       /* work of the damping force over the half step before the kick */
    brc_lanes damping_ahead; /* and over the half step after it */
};

/* Four bodies' force or moment, its damping, and v or w before and after. */
struct brc_kick {
    brc_lanes f[3], d[3], old[3], now[3];
};

/* Without a ledger nothing is summed but kinetic energy. */
BRC_LANES_INLINE void brc_kick_account(const struct brc_sim *sim, brc_mask live, double dt,
                                       const struct brc_kick *p, struct brc_kick_sums *sums)
{
    if (!BRC_OPTION(sim->run.ledger))
        return;
    sums->damping -= brc_lanes_where(live, 0.5 * dt * brc_lanes_dot(p->d, p->old));
    sums->damping_ahead -= brc_lanes_where(live, 0.5 * dt * brc_lanes_dot(p->d, p->now));
}

/* What local damping acts against: the motion, or what it differs from its mean by. At the start
 * there is no mean to speak of yet, so the whole motion is damped until it is steady. */
BRC_LANES_INLINE void brc_damped_motion(const struct brc_sim *sim, brc_lanes v[3],
                                        const brc_lanes old[3], double (*mean)[3])
{
    brc_lanes spared[3];
    brc_lanes_at3(spared, mean);
    bool is_spared = sim->damp_fluctuation && sim->rig.is_steady;
    for (int k = 0; k < 3; k++)
        v[k] = is_spared ? old[k] - spared[k] : old[k];
}

/* What pushes bodies i to i + 3: v or w before, force or moment, damping. Translation and rotation
 * are alike so far, and share it. */
BRC_LANES_INLINE void brc_kick_begin(const struct brc_sim *sim, double (*v)[3], double (*f)[3],
                                     double (*mean)[3], brc_lanes add, struct brc_kick *p)
{
    brc_lanes damped[3];
    brc_lanes_at3(p->old, v);
    brc_lanes_at3(p->f, f);
    for (int k = 0; k < 3; k++)
        p->d[k] = brc_lanes_all(0);
    if (BRC_OPTION(sim->damping_alpha > 0)) {
        brc_damped_motion(sim, damped, p->old, mean);
        brc_local_damping(sim, p->d, p->f, damped, add); /* eq:vgcm:4 */
    }
}

/* Exponential mean over the memory of the damping: it needs one value a body, where a mean over the
 * last steps would need all of them. */
BRC_LANES_INLINE void brc_mean_follow(const struct brc_sim *sim, brc_mask live, double (*mean)[3],
                                      const struct brc_kick *p)
{
    brc_lanes at[3];
    if (!BRC_OPTION(sim->tracks_mean))
        return;
    brc_lanes_at3(at, mean);
    for (int k = 0; k < 3; k++)
        at[k] += brc_lanes_where(live, (p->now[k] - at[k]) / sim->run.damping_memory);
    brc_lanes_put3(mean, at);
}

/* Lanes that are not live keep what they had: platens among them, whose velocities belong to the
 * test. */
BRC_LANES_INLINE void brc_kick_put(brc_mask live, double (*v)[3], const struct brc_kick *p)
{
    brc_lanes put[3];
    for (int k = 0; k < 3; k++)
        put[k] = brc_lanes_pick(live, p->now[k], p->old[k]);
    brc_lanes_put3(v, put);
}

/* v += dt (f + damping) / m, with the sums for the ledger. */
BRC_LANES_INLINE void brc_kick_translation(const struct brc_sim *sim, size_t i, brc_mask live,
                                           double dt, struct brc_kick_sums *sums)
{
    const struct brc_bodies *b = &sim->bodies;
    struct brc_kick p;
    brc_lanes mass = brc_lanes_at(b->mass + i);
    brc_kick_begin(sim, b->v + i, b->f + i, b->v_mean + i, dt / mass, &p);
    for (int k = 0; k < 3; k++)
        p.now[k] = p.old[k] + dt * (p.f[k] + p.d[k]) / mass; /* eq:vgcm:1 */
    brc_kick_put(live, b->v + i, &p);
    brc_mean_follow(sim, live, b->v_mean + i, &p);
    sums->kinetic += brc_lanes_where(live, 0.5 * mass * brc_lanes_dot(p.old, p.now));
    brc_kick_account(sim, live, dt, &p, sums);
}

/* Grains with unequal moments of inertia, one after the other: their spin follows from the angular
 * momentum by way of the orientation. */
static __attribute__((noinline)) void brc_kick_spin(const struct brc_bodies *b, size_t i,
                                                    brc_mask live, double dt, struct brc_kick *p,
                                                    struct brc_kick_sums *sums)
{
    for (int k = 0; k < BRC_LANES; k++) {
        size_t n = i + (size_t)k;
        if (!live[k])
            continue;
        double lold[3],
            sum[3] = {p->f[0][k] + p->d[0][k], p->f[1][k] + p->d[1][k], p->f[2][k] + p->d[2][k]};
        brc_copy(lold, b->l[n]);
        brc_axpy(b->l[n], dt, sum);
        brc_rotation_spin(b->w[n], b->q[n], b->l[n], b->inertia[n]);
        sums->kinetic[k] += 0.5 * brc_dot(lold, b->w[n]);
    }
    brc_lanes_at3(p->now, b->w + i);
}

/* w and l from the moments; for equal moments of inertia l is left alone. */
BRC_LANES_INLINE void brc_kick_rotation(const struct brc_sim *sim, size_t i, brc_mask live,
                                        double dt, struct brc_kick_sums *sums)
{
    const struct brc_bodies *b = &sim->bodies;
    struct brc_kick p;
    brc_lanes inertia[3];
    brc_lanes_at3(inertia, b->inertia + i);
    brc_kick_begin(sim, b->w + i, b->t + i, b->w_mean + i, dt / inertia[0], &p);
    brc_mask unequal =
        live & (brc_lanes_less(inertia[0], inertia[1]) | brc_lanes_less(inertia[1], inertia[0]) |
                brc_lanes_less(inertia[1], inertia[2]) | brc_lanes_less(inertia[2], inertia[1]));
    brc_mask equal = live & ~unequal;
    for (int k = 0; k < 3; k++)
        p.now[k] = p.old[k] + dt / inertia[0] * (p.f[k] + p.d[k]); /* eq:vgcm:2 */
    brc_kick_put(equal, b->w + i, &p);
    sums->kinetic += brc_lanes_where(equal, 0.5 * inertia[0] * brc_lanes_dot(p.old, p.now));
    if (brc_lanes_any(unequal))
        brc_kick_spin(b, i, unequal, dt, &p, sums);
    brc_mean_follow(sim, live, b->w_mean + i, &p);
    brc_kick_account(sim, live, dt, &p, sums);
}

/* Grains alone. The terms of the ledger's sums are stored for each body, as the exact sums over
 * them are made afterwards. */
static void brc_kick_loop(struct brc_sim *sim, double dt)
{
    const struct brc_bodies *b = &sim->bodies;
    bool rotates = sim->model.flags & BRC_MODEL_ROTATES;
    for (size_t i = 0; i < sim->bodies.n_grains; i += BRC_LANES) {
        brc_mask live = brc_lanes_first((int64_t)(sim->bodies.n_grains - i));
        struct brc_kick_sums sums = {.kinetic = brc_lanes_all(0)};
        brc_kick_translation(sim, i, live, dt, &sums);
        if (rotates)
            brc_kick_rotation(sim, i, live, dt, &sums);
        brc_lanes_put(b->terms + i, sums.kinetic); /* rows of platens may be written, too */
        if (BRC_OPTION(sim->run.ledger)) {
            brc_lanes_put(b->damping + i, brc_lanes_at(b->damping + i) +
                                              brc_lanes_at(b->damping_ahead + i) + sums.damping);
            brc_lanes_put(b->damping_ahead + i, sums.damping_ahead);
        }
    }
}

#endif
