/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time of vgcm's force loop a local point and step, one core: undamaged, and through failure. Lines
 * of "name value unit", user CPU time. */
#include "bench.h"

#include "vgcm/vgcm.h"

#include <math.h>

extern const struct brc_model brc_model_vgcm;

static size_t count_points(const struct brc_sim *sim)
{
    size_t n = 0;
    for (size_t i = 0; i < sim->pairs.n; i++)
        if (vgcm_columns(&sim->pairs)->phase[i] != VGCM_SPHERE)
            n += (size_t)sim->pairs.np[i];
    return n;
}

static void report(const char *name, const char *what, double value, const char *unit)
{
    printf("vgcm_%s_%s %.4g %s\n", name, what, value, unit);
}

/* Shares of rows that keep points of their own, and of points that are broken. */
static void report_state(const struct brc_sim *sim, const char *name)
{
    const struct brc_contacts *c = &sim->pairs;
    size_t n_facets = 0, n_points = 0;
    for (size_t i = 0; i < c->n; i++) {
        n_facets += vgcm_columns(c)->phase[i] != VGCM_SPHERE;
        n_points += vgcm_columns(c)->phase[i] == VGCM_POINTS;
    }
    report(name, "points_per_contact", (double)count_points(sim) / (double)n_facets, "1");
    report(name, "sphere_rows", (double)(c->n - n_facets) / (double)n_facets, "1");
    report(name, "contacts_with_damage", (double)n_points / (double)n_facets, "1");
    report(name, "points_broken", (double)sim->events.table.n / (double)count_points(sim), "1");
}

/* Least time of a call over batches of a few calls: other work on the machine only adds to it. */
static double least_time(struct brc_sim *sim, void (*call)(struct brc_sim *), int batches)
{
    double least = HUGE_VAL;
    for (int k = 0; k < batches; k++) {
        double begin = cpu_seconds();
        for (int i = 0; i < 5; i++)
            call(sim);
        least = fmin(least, (cpu_seconds() - begin) / 5);
    }
    return least;
}

static void call_step(struct brc_sim *sim)
{
    must(sim->ctx, brc_sim_step(sim));
}

/* The loop over the contacts once more at the present state, without a displacement. */
static void call_forces(struct brc_sim *sim)
{
    double dt = sim->dt;
    sim->dt = 0;
    sim->model.forces(sim, sim->state);
    sim->dt = dt;
}

static void time_steps(struct brc_sim *sim, const char *name)
{
    double points = (double)count_points(sim);
    report(name, "step", 1e9 * least_time(sim, call_step, 40) / points, "ns/point");
    report(name, "forces", 1e9 * least_time(sim, call_forces, 40) / points, "ns/point");
    report_state(sim, name);
}

static void run(struct brc_context *ctx, const struct brc_specimen *specimen, const char *name,
                const char *ledger, int before)
{
    struct vgcm_params p;
    struct brc_test_params t;
    struct brc_run_params r;
    struct brc_sim sim;
    must(ctx, brc_params_defaults(ctx, brc_model_vgcm.params, &p));
    must(ctx, brc_params_defaults(ctx, brc_test_param_list, &t));
    must(ctx, brc_params_defaults(ctx, brc_run_param_list, &r));
    set(ctx, brc_model_vgcm.params, &p, "interaction", "all");
    set(ctx, brc_test_param_list, &t, "loading", "fixed");
    set(ctx, brc_test_param_list, &t, "rate", "2e-6 1/s");
    set(ctx, brc_run_param_list, &r, "ledger", ledger);
    must(ctx, brc_sim_create(ctx, &sim, &brc_model_vgcm, &p, specimen, &t, &r));
    for (int i = 0; i < before; i++)
        must(ctx, brc_sim_step(&sim));
    time_steps(&sim, name);
    brc_sim_free(&sim);
}

int main(void)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_specimen_params s;
    struct brc_specimen specimen;
    ctx.quiet = 1;
    must(&ctx, brc_params_defaults(&ctx, brc_specimen_param_list, &s));
    set(&ctx, brc_specimen_param_list, &s, "shape", "box");
    set(&ctx, brc_specimen_param_list, &s, "grains", "grid");
    set(&ctx, brc_specimen_param_list, &s, "size", "5 cm, 5 cm, 5 cm");
    set(&ctx, brc_specimen_param_list, &s, "cells", "10, 10, 10");
    must(&ctx, brc_specimen_create(&ctx, &s, &specimen));
    run(&ctx, &specimen, "elastic", "off", 10);
    run(&ctx, &specimen, "elastic_ledger", "on", 10);
    run(&ctx, &specimen, "failure", "off", 2500);
    run(&ctx, &specimen, "failure_ledger", "on", 2500);
    brc_specimen_free(&specimen);
    return 0;
}
