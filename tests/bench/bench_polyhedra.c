/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time of a whole step of polyhedra: the 1000 bonded Voronoi cells of cases/gt12_block.yaml at half
 * of their peak load by two rules, condensed and literal, in the authors' own reading at a strain
 * of 1e-3, condensed and literal, the same cells unbonded in isotropic compression, the 512
 * dodecahedra, a step in which many bonds break against the steps before it, and the part of a run
 * that goes into lists. */
#include "bench.h"

#include "common/rigs/rigs.h"
#include "common/geometry/grid.h"
#include "polyhedra/poly.h"
#include "tests/dodecahedra.h"
#include "tests/fixture.h"

#include <math.h>
#include <string.h>

extern const struct brc_model brc_model_polyhedra;

enum { REPEATS = 60, SETTLED = 30, PEAK_STEPS = 400, AFTERWARDS = 400 };

static const char *const strong_bonds[][2] = {{NULL, NULL}}, *const weak_bonds[][2] = {
                                                                 {"eps_th", "0.001"}, {NULL, NULL}};

static void count(void *user, const struct poly_active *active)
{
    (void)active;
    *(size_t *)user += 1;
}

static size_t count_active(const struct brc_sim *sim)
{
    size_t n = 0;
    poly_each_active(sim, sim->state, count, &n);
    return n;
}

static double step_seconds(struct brc_sim *sim)
{
    double begin = cpu_seconds();
    must(sim->ctx, brc_sim_step(sim));
    return cpu_seconds() - begin;
}

static void report_steps(struct bench_times *t, const struct brc_sim *sim, const char *name,
                         double bar)
{
    struct bench_value v = {.name = name,
                            .value = 1e3 * bench_quantile(t, 0.5),
                            .unit = "ms",
                            .bar = bar,
                            .spread = 1e3 * (bench_quantile(t, 0.75) - bench_quantile(t, 0.25))};
    bench_report(&v);
    printf("%s: %zu active springs, least %.4g ms\n", name, count_active(sim),
           1e3 * bench_quantile(t, 0));
}

static void make(struct brc_context *ctx, struct brc_sim *sim, const struct brc_specimen *specimen,
                 const char *const settings[][2], const char *kind, const char *rate)
{
    struct poly_params p;
    struct brc_test_params t;
    struct brc_run_params r;
    must(ctx, brc_params_defaults(ctx, brc_model_polyhedra.params, &p));
    must(ctx, brc_params_defaults(ctx, brc_test_param_list, &t));
    must(ctx, brc_params_defaults(ctx, brc_run_param_list, &r));
    set_table_1(ctx, brc_model_polyhedra.params, &p);
    for (int i = 0; settings[i][0]; i++)
        set(ctx, brc_model_polyhedra.params, &p, settings[i][0], settings[i][1]);
    set(ctx, brc_test_param_list, &t, "kind", kind);
    set(ctx, brc_test_param_list, &t, "loading", "fixed");
    set(ctx, brc_test_param_list, &t, "rate", rate);
    set(ctx, brc_test_param_list, &t, "strain_max", "0.99");
    if (getenv("BENCH_SIMD"))
        set(ctx, brc_run_param_list, &r, "simd", getenv("BENCH_SIMD"));
    const struct brc_test rig = brc_rigs_test(&t, NULL);
    must(ctx, brc_sim_create(ctx, sim, &brc_model_polyhedra, &p, specimen, &rig, &r));
}

/* From the rate that has brought the load about to one of the paper's own: 6.3 1/s times its step
 * of 1.58e-7 s. All velocities go along, so that nothing swings. */
static void slow_down(struct brc_sim *sim)
{
    const double part = 0.1;
    struct brc_bodies *b = &sim->bodies;
    sim->rig.rate *= part;
    for (size_t i = 0; i < b->n_grains; i++) {
        brc_scale(b->v[i], b->v[i], part);
        brc_scale(b->w[i], b->w[i], part);
    }
}

/* BENCH_ONLY names the one row that is wanted, for comparisons by turns. */
static bool is_left_out(const char *name)
{
    const char *only = getenv("BENCH_ONLY");
    return only && strcmp(only, name) != 0;
}

static void bonded(struct brc_context *ctx, const struct brc_specimen *specimen, const char *rule,
                   const char *evaluation, const char *name, double bar)
{
    if (is_left_out(name))
        return;
    const char *const settings[][2] = {
        {"features", rule}, {"evaluation", evaluation}, {NULL, NULL}};
    struct brc_sim sim;
    struct bench_times t = {.n = 0};
    make(ctx, &sim, specimen, settings, "compression", "1e-5 1/s");
    for (int i = 0; i < 1000; i++)
        must(ctx, brc_sim_step(&sim));
    slow_down(&sim);
    for (int i = 0; i < AFTERWARDS; i++)
        must(ctx, brc_sim_step(&sim));
    for (int i = 0; i < REPEATS; i++)
        bench_note(&t, step_seconds(&sim));
    report_steps(&t, &sim, name, bar);
    brc_sim_free(&sim);
}

/* The authors' reading: strains are those of the gap, five times as large, so that 1e-3 of the
 * whole is where the other rows are at 5e-3. At the paper's own rate from the start. */
static void authors(struct brc_context *ctx, const struct brc_specimen *specimen,
                    const char *evaluation, const char *name, double bar)
{
    if (is_left_out(name))
        return;
    const char *const settings[][2] = {{"features", "closed"},
                                       {"strain_length", "gap"},
                                       {"area", "eroded"},
                                       {"evaluation", evaluation},
                                       {NULL, NULL}};
    struct brc_sim sim;
    struct bench_times t = {.n = 0};
    make(ctx, &sim, specimen, settings, "compression", "1e-6 1/s");
    for (int i = 0; i < 1000; i++)
        must(ctx, brc_sim_step(&sim));
    for (int i = 0; i < REPEATS; i++)
        bench_note(&t, step_seconds(&sim));
    report_steps(&t, &sim, name, bar);
    brc_sim_free(&sim);
}

/* Every grain moves towards the middle. */
static void compress(struct brc_sim *sim, double rate)
{
    struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++)
        for (int k = 0; k < 3; k++)
            b->v[i][k] = -rate * (b->x[i][k] - 0.05);
}

static void unbonded(struct brc_context *ctx, const struct brc_specimen *specimen,
                     const char *evaluation, const char *name, double bar)
{
    if (is_left_out(name))
        return;
    const char *const settings[][2] = {{"bonds", "off"}, {"evaluation", evaluation}, {NULL, NULL}};
    struct brc_sim sim;
    struct bench_times t = {.n = 0};
    make(ctx, &sim, specimen, settings, "none", "1e-5 1/s");
    for (int i = 0; i < 300; i++) {
        compress(&sim, 1e-5);
        must(ctx, brc_sim_step(&sim));
    }
    for (int i = 0; i < REPEATS; i++) {
        compress(&sim, 1e-5);
        bench_note(&t, step_seconds(&sim));
    }
    report_steps(&t, &sim, name, bar);
    brc_sim_free(&sim);
}

/* Times of the steps of a compression with weaker bonds, and how many bonds break in each. */
static void break_bonds(struct brc_context *ctx, const struct brc_specimen *specimen,
                        struct bench_times *time, size_t *breaks)
{
    struct brc_sim sim;
    make(ctx, &sim, specimen, weak_bonds, "compression", "1.5e-5 1/s");
    for (int i = 0; i < PEAK_STEPS; i++) {
        size_t before = sim.events.table.n;
        bench_note(&time[i], step_seconds(&sim));
        breaks[i] = sim.events.table.n - before;
    }
    brc_sim_free(&sim);
}

/* Steps in an avalanche against the steps before it, in which as many springs act. Each run makes
 * the same steps, so that each has a median of its own. */
static void breaking(struct brc_context *ctx, const struct brc_specimen *specimen)
{
    enum { RUNS = 7 };
    static struct bench_times time[PEAK_STEPS], calm, avalanche;
    size_t breaks[PEAK_STEPS];
    for (int i = 0; i < RUNS; i++)
        break_bonds(ctx, specimen, time, breaks);
    for (int i = 0; i < PEAK_STEPS; i++) {
        if (breaks[i] >= 50)
            bench_note(&avalanche, bench_quantile(&time[i], 0.5));
        else if (i >= SETTLED && breaks[i] < 5 && avalanche.n == 0)
            bench_note(&calm, bench_quantile(&time[i], 0.5));
    }
    double quiet = bench_quantile(&calm, 0.5), loud = bench_quantile(&avalanche, 0.5);
    printf("polyhedra_break: %d steps of 50 breaks or more, %.4g ms, after %d calm ones, %.4g ms\n",
           avalanche.n, 1e3 * loud, calm.n, 1e3 * quiet);
    struct bench_value v = {
        .name = "polyhedra_break_step_ratio",
        .value = loud / quiet,
        .unit = "1",
        .bar = 1.3,
        .spread = (bench_quantile(&avalanche, 0.75) - bench_quantile(&avalanche, 0.25)) / quiet};
    if (avalanche.n > 0)
        bench_report(&v);
}

/* --- list work -------------------------------------------------------------------------------- */

/* Rows before a step, and when each would be listed anew. */
struct old_contacts {
    int32_t (*pair)[2];
    double *wake;
    size_t n;
};

static void remember(struct old_contacts *old, const struct brc_sim *sim)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct poly_contacts *columns = c->model_columns;
    free(old->pair);
    free(old->wake);
    *old = (struct old_contacts){malloc(c->n * sizeof *old->pair), malloc(c->n * sizeof *old->wake),
                                 c->n};
    for (size_t i = 0; i < c->n; i++) {
        old->pair[i][0] = c->a[i];
        old->pair[i][1] = c->b[i];
        old->wake[i] = columns->rebuild_at[i];
    }
}

/* Makes the lists of the step that has been made once more; returns how long that takes. */
static double list_seconds(struct brc_sim *sim, const struct old_contacts *old, bool candidates)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct poly_contacts *columns = c->model_columns;
    struct brc_neighbours grains = {0}, platens = {0};
    size_t *listed = malloc(c->n * sizeof *listed), n = 0;
    for (size_t i = 0, k = 0; i < c->n; i++) {
        while (k < old->n && (old->pair[k][0] < c->a[i] ||
                              (old->pair[k][0] == c->a[i] && old->pair[k][1] < c->b[i])))
            k++;
        bool same = k < old->n && old->pair[k][0] == c->a[i] && old->pair[k][1] == c->b[i];
        if (!same || old->wake[k] != columns->rebuild_at[i])
            listed[n++] = i;
    }
    double begin = cpu_seconds();
    for (size_t i = 0; i < n; i++)
        must(sim->ctx, poly_list_contact(sim, sim->state, listed[i]));
    if (candidates) {
        const struct brc_bodies *b = &sim->bodies;
        must(sim->ctx, brc_grid_pairs(sim->ctx, (const double(*)[3])b->x, b->bounding_radius,
                                      b->n_grains, sim->skin, &grains));
        must(sim->ctx, brc_sim_near_platens(sim, &platens));
        must(sim->ctx, sim->model.pairs(sim, sim->state, &grains, &platens));
    }
    double time = cpu_seconds() - begin;
    brc_neighbours_free(&grains);
    brc_neighbours_free(&platens);
    free(listed);
    return time;
}

/* The part of a run that goes into lists of grain pairs and of their features, once they are made
 * for the first time. */
static void listing(struct brc_context *ctx, const struct brc_specimen *specimen,
                    const char *const settings[][2], const char *rate, const char *name)
{
    struct brc_sim sim;
    struct old_contacts old = {0};
    double steps = 0, lists = 0;
    make(ctx, &sim, specimen, settings, "compression", rate);
    for (int i = 0; i < PEAK_STEPS; i++) {
        int64_t listings = sim.n_rebuilds;
        remember(&old, &sim);
        double time = step_seconds(&sim);
        if (i < SETTLED)
            continue;
        steps += time;
        lists += list_seconds(&sim, &old, sim.n_rebuilds > listings);
    }
    struct bench_value v = {.name = name, .value = lists / steps, .unit = "1", .bar = 0.05};
    bench_report(&v);
    printf("%s: %zu breaks in %d steps\n", name, sim.events.table.n, PEAK_STEPS);
    free(old.pair);
    free(old.wake);
    brc_sim_free(&sim);
}

static void dodecahedra(const char *evaluation, const char *name)
{
    static struct dodecahedra d;
    static struct brc_convex cell[512];
    struct brc_plane planes[20], placed[12];
    struct bench_times t = {.n = 0};
    char settings[160];
    void *state;
    fixture_open(&state);
    struct fixture *f = state;
    dodecahedra_read(&d);
    dodecahedra_planes(&d, planes);
    for (size_t i = 0; i < 512; i++) {
        cell[i] = (struct brc_convex){0};
        dodecahedra_place(&d, i, planes, d.radius, placed);
        must(&f->ctx, brc_convex_from_planes(&f->ctx, &cell[i], placed, 12, d.x[i], 2));
    }
    fixture_loose(f, cell, NULL, 512);
    snprintf(settings, sizeof settings,
             "radius: %.17g m; features: strict; gn: 0 1/s; evaluation: %s", d.radius, evaluation);
    fixture_free_sim(f, &brc_model_polyhedra, settings, "dt: 1e-9 s");
    for (int i = 0; i < 10 * REPEATS; i++)
        bench_note(&t, step_seconds(&f->sim));
    report_steps(&t, &f->sim, name, 0.25);
    for (size_t i = 0; i < 512; i++)
        brc_convex_free(&cell[i]);
    fixture_close(&state);
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
    bonded(&ctx, &specimen, "merged", "auto", "polyhedra_bonded_1000_ms_step", 1.5);
    bonded(&ctx, &specimen, "merged", "literal", "polyhedra_bonded_literal_1000_ms_step", 1.5);
    bonded(&ctx, &specimen, "strict", "auto", "polyhedra_bonded_strict_1000_ms_step", 0);
    authors(&ctx, &specimen, "auto", "polyhedra_bonded_closed_1000_ms_step", 1.5);
    authors(&ctx, &specimen, "literal", "polyhedra_bonded_closed_literal_1000_ms_step", 4);
    unbonded(&ctx, &specimen, "auto", "polyhedra_unbonded_1000_ms_step", 3);
    unbonded(&ctx, &specimen, "literal", "polyhedra_unbonded_literal_1000_ms_step", 3);
    if (getenv("BENCH_ONLY"))
        return 0;
    breaking(&ctx, &specimen);
    listing(&ctx, &specimen, strong_bonds, "1e-5 1/s", "polyhedra_list_share_calm");
    listing(&ctx, &specimen, weak_bonds, "1.5e-5 1/s", "polyhedra_list_share");
    dodecahedra("condensed", "polyhedra_dodecahedra_512_ms_step");
    dodecahedra("literal", "polyhedra_dodecahedra_literal_512_ms_step");
    brc_specimen_free(&specimen);
    return 0;
}
