/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time of a step of the 1000 bonded Voronoi cells of cases/gt12_block.yaml, at the start and
 * at about half of the peak load in unconfined compression, one core. Lines of "name value unit",
 * user CPU time. */
#include "bench.h"

#include "polyhedra/poly.h"

#include <math.h>

extern const struct brc_model brc_model_polyhedra;

static void count(void *user, const struct poly_active *active)
{
    (void)active;
    *(size_t *)user += 1;
}

/* Least time of a step over batches of 5: other work on the machine only adds to it. */
static void time_steps(struct brc_sim *sim, const char *rule, const char *when)
{
    double least = HUGE_VAL;
    size_t active = 0;
    for (int k = 0; k < 20; k++) {
        double begin = cpu_seconds();
        for (int i = 0; i < 5; i++)
            must(sim->ctx, brc_sim_step(sim));
        least = fmin(least, (cpu_seconds() - begin) / 5);
    }
    poly_each_active(sim, sim->state, count, &active);
    printf("polyhedra_%s_%s_step %.4g ms\n", rule, when, 1e3 * least);
    printf("polyhedra_%s_%s_active %zu 1\n", rule, when, active);
    printf("polyhedra_%s_%s_stress %.4g MPa\n", rule, when,
           1e-6 * sim->rig.force / sim->rig.section);
}

static void run(struct brc_context *ctx, const struct brc_specimen *specimen, const char *rule)
{
    struct poly_params p;
    struct brc_test_params t;
    struct brc_run_params r;
    struct brc_sim sim;
    must(ctx, brc_params_defaults(ctx, brc_model_polyhedra.params, &p));
    must(ctx, brc_params_defaults(ctx, brc_test_param_list, &t));
    must(ctx, brc_params_defaults(ctx, brc_run_param_list, &r));
    set(ctx, brc_model_polyhedra.params, &p, "features", rule);
    set(ctx, brc_test_param_list, &t, "loading", "fixed");
    set(ctx, brc_test_param_list, &t, "rate", "1e-5 1/s");
    must(ctx, brc_sim_create(ctx, &sim, &brc_model_polyhedra, &p, specimen, &t, &r));
    time_steps(&sim, rule, "start");
    for (int i = 0; i < 900; i++)
        must(ctx, brc_sim_step(&sim));
    time_steps(&sim, rule, "half_peak");
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
    set(&ctx, brc_specimen_param_list, &s, "size", "10 cm, 10 cm, 10 cm");
    set(&ctx, brc_specimen_param_list, &s, "cells", "10, 10, 10");
    must(&ctx, brc_specimen_create(&ctx, &s, &specimen));
    run(&ctx, &specimen, "merged");
    run(&ctx, &specimen, "strict");
    run(&ctx, &specimen, "closed");
    brc_specimen_free(&specimen);
    return 0;
}
