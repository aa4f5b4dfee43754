/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Largest eigenvalue of M^-1/2 K M^-1/2 by power iteration on the springs that the model lists: no
 * matrix is built, so a network of any size costs a pass over its springs an iteration. Called by
 * sim.c, in the dynamic regime and for small mass margins, and by models that see a pair close
 * between two estimates (foresee); it knows nothing of laws.
 *
 * The bound by sums of k (mass_scaling.c) needs no iteration, but a pack of many neighbours bears
 * far more: 8000 bonded spheres 0.39 of those masses (docs/numerics.md). */
#include "common/engine/stability.h"

#include "common/base/grow.h"
#include "common/base/invariant.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* The iteration comes from below: what it stops short of the limit is covered by the margins of the
 * step (dt_margin is below 1, and 0.5 by default; MASS_LIMIT of sim.c is 0.9). */
enum { MAX_ITERATIONS = 200 };
static const double CONVERGED = 1e-4; /* relative change of the eigenvalue between iterations */

int brc_springs_add(struct brc_context *ctx, struct brc_springs *s, const struct brc_spring *spring)
{
    BRC_GROW(ctx, s->spring, s->cap, s->n + 1);
    s->spring[s->n++] = *spring;
    return 0;
}

void brc_springs_free(struct brc_springs *s)
{
    free(s->spring);
    *s = (struct brc_springs){0};
}

/* f += K u for generalised displacements u = (translation, rotation) of each body. */
static void apply_spring(const struct brc_spring *s, const double (*u)[6], double (*f)[6])
{
    double ua[3], ub[3], du[3], fn[3], m[3], dw[3];
    brc_point_velocity(ua, u[s->a], u[s->a] + 3, s->ra);
    brc_point_velocity(ub, u[s->b], u[s->b] + 3, s->rb);
    brc_sub(du, ub, ua);
    brc_scale(fn, du, s->ks);
    brc_axpy(fn, (s->kn - s->ks) * brc_dot(du, s->n), s->n);
    brc_axpy(f[s->b], 1, fn);
    brc_axpy(f[s->a], -1, fn);
    brc_cross(m, s->rb, fn);
    brc_axpy(f[s->b] + 3, 1, m);
    brc_cross(m, s->ra, fn);
    brc_axpy(f[s->a] + 3, -1, m);
    brc_sub(dw, u[s->b] + 3, u[s->a] + 3);
    double torsion = s->kt * brc_dot(dw, s->n);
    brc_axpy(f[s->b] + 3, torsion, s->n);
    brc_axpy(f[s->a] + 3, -torsion, s->n);
}

/* Square roots of a body's inverse masses; the smallest moment stands for all three (a bound). */
static void inverse_masses(const struct brc_sim *sim, size_t i, double root[2])
{
    const struct brc_bodies *b = &sim->bodies;
    bool rotates = sim->model.flags & BRC_MODEL_ROTATES;
    double least = fmin(b->inertia[i][0], fmin(b->inertia[i][1], b->inertia[i][2]));
    root[0] = i < b->n_grains && b->mass[i] > 0 ? 1 / sqrt(b->mass[i]) : 0;
    root[1] = i < b->n_grains && rotates && least > 0 ? 1 / sqrt(least) : 0;
}

static void scale(double (*u)[6], const double (*root)[2], size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] *= root[i][k / 3];
}

/* Returns the length before. Its sum is exact: the step that follows from it must not depend on the
 * numbering of bodies. term: room for n values. */
static double normalise(double (*u)[6], double *term, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        term[i] = 0;
        for (int k = 0; k < 6; k++)
            term[i] += u[i][k] * u[i][k];
    }
    double length = sqrt(brc_sum_exact(term, n));
    for (size_t i = 0; length > 0 && i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] /= length;
    return length;
}

/* |A u| for unit u grows towards the largest eigenvalue. The start is a fixed series of random
 * numbers: a regular one may be orthogonal to the mode that is looked for, and one by clock would
 * give another step each time. */
static int largest_eigenvalue(struct brc_context *ctx, const struct brc_springs *springs,
                              const double (*root)[2], size_t n, double *value)
{
    double(*u)[6] = brc_alloc(ctx, n, sizeof *u);
    double(*f)[6] = brc_alloc(ctx, n, sizeof *f);
    double *term = brc_alloc(ctx, n, sizeof *term);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int code = u && f && term && rng ? 0 : BRC_ERR_MEMORY;
    *value = 0;
    for (size_t s = 0; s < springs->n; s++)
        BRC_ASSERT((size_t)springs->spring[s].a < n && (size_t)springs->spring[s].b < n);
    for (size_t i = 0; code == 0 && i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] = gsl_rng_uniform(rng) - 0.5;
    for (int it = 0; code == 0 && it < MAX_ITERATIONS; it++) {
        normalise(u, term, n);
        scale(u, root, n);
        memset(f, 0, n * sizeof *f);
        for (size_t s = 0; s < springs->n; s++)
            apply_spring(&springs->spring[s], u, f);
        scale(f, root, n);
        double before = *value;
        *value = normalise(f, term, n);
        double(*swap)[6] = u;
        u = f;
        f = swap;
        if (fabs(*value - before) <= CONVERGED * *value)
            break;
    }
    gsl_rng_free(rng);
    free(u);
    free(f);
    free(term);
    return code;
}

/* Raises *largest to the largest eigenvalue of springs between two bodies, with the two alone. Most
 * pairs lie far below it, and need no iteration: the sum of what each spring has is a bound. Their
 * numbers of bodies are lost. */
static int raise_to_pair(const struct brc_sim *sim, struct brc_spring *spring, size_t n,
                         double *largest)
{
    double root[2][2], bound = 0, value;
    const double *ra = root[0], *rb = root[1];
    inverse_masses(sim, (size_t)spring->a, root[0]);
    inverse_masses(sim, (size_t)spring->b, root[1]);
    for (size_t i = 0; i < n; i++) {
        struct brc_spring *s = &spring[i];
        double inverse = ra[0] * ra[0] + rb[0] * rb[0] + ra[1] * ra[1] * brc_norm2(s->ra) +
                         rb[1] * rb[1] * brc_norm2(s->rb);
        bound += fmax(s->kn, s->ks) * inverse;
        s->a = 0;
        s->b = 1;
    }
    if (bound <= *largest)
        return 0;
    const struct brc_springs springs = {.spring = spring, .n = n};
    BRC_TRY(largest_eigenvalue(sim->ctx, &springs, (const double(*)[2])root, 2, &value));
    *largest = fmax(*largest, value);
    return 0;
}

/* Takes the springs that may act into a list of their own: they are judged with their two bodies
 * alone, as most of them will not act in the step that comes. */
static int split_near(struct brc_context *ctx, struct brc_springs *springs,
                      struct brc_springs *near)
{
    size_t kept = 0;
    for (size_t i = 0; i < springs->n; i++) {
        if (springs->spring[i].is_near)
            BRC_TRY(brc_springs_add(ctx, near, &springs->spring[i]));
        else
            springs->spring[kept++] = springs->spring[i];
    }
    springs->n = kept;
    return 0;
}

/* The same over all pairs of the list. */
static int raise_to_near(const struct brc_sim *sim, struct brc_springs *near, double *largest)
{
    for (size_t first = 0, end; first < near->n; first = end) {
        const struct brc_spring pair = near->spring[first];
        for (end = first + 1; end < near->n; end++)
            if (near->spring[end].a != pair.a || near->spring[end].b != pair.b)
                break;
        BRC_TRY(raise_to_pair(sim, near->spring + first, end - first, largest));
    }
    return 0;
}

static double step_of(const struct brc_sim *sim, double eigenvalue)
{
    eigenvalue *= 1 + sim->damping_alpha;
    return eigenvalue > 0 ? 2 / sqrt(eigenvalue) : HUGE_VAL;
}

int brc_stability_limit(struct brc_sim *sim, double *dt_limit)
{
    struct brc_springs springs = {0}, near = {0};
    double eigenvalue = 0;
    double(*root)[2] = brc_alloc(sim->ctx, sim->bodies.n, sizeof *root);
    int code = root ? sim->model.springs(sim, sim->state, &springs) : BRC_ERR_MEMORY;
    if (code == 0)
        code = split_near(sim->ctx, &springs, &near);
    if (code == 0) {
        for (size_t i = 0; i < sim->bodies.n; i++)
            inverse_masses(sim, i, root[i]);
        code = largest_eigenvalue(sim->ctx, &springs, root, sim->bodies.n, &eigenvalue);
    }
    if (code == 0)
        code = raise_to_near(sim, &near, &eigenvalue);
    *dt_limit = step_of(sim, eigenvalue);
    brc_springs_free(&springs);
    brc_springs_free(&near);
    free(root);
    return code;
}

int brc_stability_foresee(struct brc_sim *sim, struct brc_springs *springs)
{
    double largest = 4 / (sim->dt_limit * sim->dt_limit) / (1 + sim->damping_alpha);
    if (springs->n == 0)
        return 0;
    BRC_TRY(raise_to_pair(sim, springs->spring, springs->n, &largest));
    sim->dt_limit = fmin(sim->dt_limit, step_of(sim, largest));
    return 0;
}
