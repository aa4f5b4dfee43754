/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability.h"

#include "sim.h"
#include "vec.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ITERATIONS = 200 };
static const double CONVERGED = 1e-4; /* relative change of the eigenvalue between iterations */

int brc_springs_add(struct brc_context *ctx, struct brc_springs *s, const struct brc_spring *spring)
{
    if (s->n == s->cap) {
        size_t cap = s->cap > 0 ? 2 * s->cap : 1024;
        struct brc_spring *grown = brc_realloc(ctx, s->spring, cap, sizeof *grown);
        if (!grown)
            return BRC_ERR_MEMORY;
        s->spring = grown;
        s->cap = cap;
    }
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

/* Square roots of the inverse masses; the smallest moment stands for all three (a bound). */
static void inverse_masses(const struct brc_sim *sim, double (*root)[2])
{
    const struct brc_bodies *b = &sim->bodies;
    bool rotates = sim->model.flags & BRC_MODEL_ROTATES;
    for (size_t i = 0; i < b->n; i++) {
        double least = fmin(b->inertia[i][0], fmin(b->inertia[i][1], b->inertia[i][2]));
        root[i][0] = i < b->n_grains && b->mass[i] > 0 ? 1 / sqrt(b->mass[i]) : 0;
        root[i][1] = i < b->n_grains && rotates && least > 0 ? 1 / sqrt(least) : 0;
    }
}

static void scale(double (*u)[6], const double (*root)[2], size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] *= root[i][k / 3];
}

static double normalise(double (*u)[6], size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 6; k++)
            sum += u[i][k] * u[i][k];
    double length = sqrt(sum);
    for (size_t i = 0; length > 0 && i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] /= length;
    return length;
}

/* Largest eigenvalue of M^-1/2 K M^-1/2 by power iteration: |A u| for unit u grows towards it. */
static int largest_eigenvalue(struct brc_context *ctx, const struct brc_springs *springs,
                              const double (*root)[2], size_t n, double *value)
{
    double(*u)[6] = brc_alloc(ctx, n, sizeof *u);
    double(*f)[6] = brc_alloc(ctx, n, sizeof *f);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int code = u && f && rng ? 0 : BRC_ERR_MEMORY;
    *value = 0;
    for (size_t i = 0; code == 0 && i < n; i++)
        for (int k = 0; k < 6; k++)
            u[i][k] = gsl_rng_uniform(rng) - 0.5;
    for (int it = 0; code == 0 && it < MAX_ITERATIONS; it++) {
        normalise(u, n);
        scale(u, root, n);
        memset(f, 0, n * sizeof *f);
        for (size_t s = 0; s < springs->n; s++)
            apply_spring(&springs->spring[s], u, f);
        scale(f, root, n);
        double before = *value;
        *value = normalise(f, n);
        double(*swap)[6] = u;
        u = f;
        f = swap;
        if (fabs(*value - before) <= CONVERGED * *value)
            break;
    }
    gsl_rng_free(rng);
    free(u);
    free(f);
    return code;
}

/* Takes the springs that do not act yet out of the list; returns the largest eigenvalue (a bound)
 * that one of them has with its two bodies alone. */
static double take_near(struct brc_springs *springs, const double (*root)[2])
{
    double largest = 0;
    size_t kept = 0;
    for (size_t i = 0; i < springs->n; i++) {
        const struct brc_spring *s = &springs->spring[i];
        const double *ra = root[s->a], *rb = root[s->b];
        if (!s->is_near) {
            springs->spring[kept++] = *s;
            continue;
        }
        double inverse = ra[0] * ra[0] + rb[0] * rb[0] + ra[1] * ra[1] * brc_norm2(s->ra) +
                         rb[1] * rb[1] * brc_norm2(s->rb);
        largest = fmax(largest, fmax(s->kn, s->ks) * inverse);
    }
    springs->n = kept;
    return largest;
}

int brc_stability_limit(struct brc_sim *sim, double *dt_limit)
{
    struct brc_springs springs = {0};
    double eigenvalue = 0;
    double(*root)[2] = brc_alloc(sim->ctx, sim->bodies.n, sizeof *root);
    int code = root ? sim->model.springs(sim, sim->state, &springs) : BRC_ERR_MEMORY;
    if (code == 0) {
        inverse_masses(sim, root);
        double near = take_near(&springs, root);
        code = largest_eigenvalue(sim->ctx, &springs, root, sim->bodies.n, &eigenvalue);
        eigenvalue = fmax(eigenvalue, near);
    }
    eigenvalue *= 1 + sim->damping_alpha;
    *dt_limit = eigenvalue > 0 ? 2 / sqrt(eigenvalue) : HUGE_VAL;
    brc_springs_free(&springs);
    free(root);
    return code;
}
