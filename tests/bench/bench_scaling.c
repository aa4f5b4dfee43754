/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cost per contact from 1e2 grains to 1e5 (BENCH_GRAINS=1e6: to more, as far as there is memory),
 * beside the machine's bandwidth for as much memory; memory per grain; time of a tessellation.
 * Voronoi cells of jittered seeds, bonded, in compression. */
#include "common/rigs/rigs.h"
#include "bench.h"

#include <malloc.h>
#include <math.h>
#include <unistd.h>

extern const struct brc_model brc_model_polyhedra, brc_model_vgcm;

enum { REPEATS = 7 };

/* Bytes that the process holds. */
static double resident(void)
{
    long total = 0, held = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld %ld", &total, &held) != 2)
        held = 0;
    if (file)
        fclose(file);
    return (double)held * (double)sysconf(_SC_PAGESIZE);
}

static size_t bytes_of(const struct brc_table *t)
{
    size_t row = 0;
    for (int k = 0; k < t->set.n; k++)
        row += brc_field_size(&t->set.fields[k]);
    return row * t->n;
}

/* Bytes of the tables that a step walks through. */
static size_t working_set(const struct brc_sim *sim)
{
    const struct brc_contacts *c = &sim->pairs;
    return bytes_of(&sim->bodies.table) + bytes_of(&sim->bodies.model) + bytes_of(&c->table) +
           bytes_of(&c->model) + bytes_of(&c->points);
}

static void make(struct brc_context *ctx, const struct brc_model *model,
                 const struct brc_specimen *specimen, struct brc_sim *sim)
{
    struct brc_test_params t;
    struct brc_run_params r;
    void *params = calloc(1, model->params.owner_size);
    must(ctx, brc_params_defaults(ctx, model->params, params));
    if (model == &brc_model_polyhedra)
        set_table_1(ctx, model->params, params);
    must(ctx, brc_params_defaults(ctx, brc_test_param_list, &t));
    must(ctx, brc_params_defaults(ctx, brc_run_param_list, &r));
    set(ctx, brc_test_param_list, &t, "loading", "fixed");
    set(ctx, brc_test_param_list, &t, "rate", "1e-7 1/s");
    const struct brc_test rig = brc_rigs_test(&t, NULL);
    must(ctx, brc_sim_create(ctx, sim, model, params, specimen, &rig, &r));
    free(params);
}

/* Seconds of a step, median over repeats of enough steps to be timed. */
static double step_seconds(struct brc_sim *sim)
{
    struct bench_times t = {.n = 0};
    int steps = (int)fmax(2, 2e5 / (double)sim->pairs.n);
    for (int repeat = 0; repeat <= REPEATS; repeat++) {
        double begin = cpu_seconds();
        for (int i = 0; i < steps; i++)
            must(sim->ctx, brc_sim_step(sim));
        if (repeat > 0)
            bench_note(&t, (cpu_seconds() - begin) / steps);
    }
    return bench_quantile(&t, 0.5);
}

static void report(const char *model, const char *what, int exponent, double value,
                   const char *unit)
{
    char name[96];
    snprintf(name, sizeof name, "%s_1e%d_%s", model, exponent, what);
    bench_report(&(struct bench_value){name, value, unit, 0, 0, 0});
}

/* a_grain: bytes a grain, of the size before on entry. */
static void scale(struct brc_context *ctx, const struct brc_model *model,
                  const struct brc_specimen *specimen, int exponent, double *a_grain)
{
    struct brc_sim sim;
    double grains = (double)specimen->facets.n_cells;
    malloc_trim(0);
    double before = resident(),
           free_memory = (double)sysconf(_SC_AVPHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (1.5 * *a_grain * grains > free_memory) {
        printf("%s: 1e%d grains left out, they need about %.0f GB\n", model->name, exponent,
               1e-9 * *a_grain * grains);
        return;
    }
    make(ctx, model, specimen, &sim);
    double seconds = step_seconds(&sim), contacts = (double)sim.pairs.n;
    double held = resident() - before, size = (double)working_set(&sim);
    report(model->name, "ns_contact", exponent, 1e9 * seconds / contacts, "ns");
    report(model->name, "working_set", exponent, 1e-6 * size, "MB");
    *a_grain = held / grains;
    report(model->name, "memory_grain", exponent, 1e-3 * *a_grain, "kB");
    brc_sim_free(&sim);
    report(model->name, "triad", exponent, bench_triad((size_t)fmax(size / 8, 4096)), "GB/s");
}

int main(void)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    double most = getenv("BENCH_GRAINS") ? atof(getenv("BENCH_GRAINS")) : 1e5, a_grain[2] = {0, 0};
    ctx.quiet = 1;
    for (int exponent = 2; pow(10, exponent) <= most; exponent++) {
        struct brc_specimen_params s;
        struct brc_specimen specimen;
        char cells[64], size[64];
        int n = (int)lround(pow(10, exponent / 3.0));
        must(&ctx, brc_params_defaults(&ctx, brc_specimen_param_list, &s));
        snprintf(cells, sizeof cells, "%d, %d, %d", n, n, n);
        snprintf(size, sizeof size, "%d mm, %d mm, %d mm", 10 * n, 10 * n, 10 * n);
        set(&ctx, brc_specimen_param_list, &s, "shape", "box");
        set(&ctx, brc_specimen_param_list, &s, "grains", "grid");
        set(&ctx, brc_specimen_param_list, &s, "size", size);
        set(&ctx, brc_specimen_param_list, &s, "cells", cells);
        double begin = cpu_seconds();
        must(&ctx, brc_specimen_create(&ctx, &s, &specimen));
        report("specimen", "seconds_per_8000", exponent,
               (cpu_seconds() - begin) * 8000 / (double)specimen.facets.n_cells, "s");
        scale(&ctx, &brc_model_vgcm, &specimen, exponent, &a_grain[0]);
        scale(&ctx, &brc_model_polyhedra, &specimen, exponent, &a_grain[1]);
        brc_specimen_free(&specimen);
    }
    return 0;
}
