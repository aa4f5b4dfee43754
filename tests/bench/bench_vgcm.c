/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time of a whole step of vgcm, a local point, over the compression of the paper's specimen of
 * about 8000 spheres through its peak: while elastic, with half of the points damaged, and on
 * average. Everything that a step does is in it. Beside them, what the machine allows. */
#include "common/rigs/rigs.h"
#include "bench.h"

#include "vgcm/vgcm.h"

#include <math.h>

extern const struct brc_model brc_model_vgcm;

enum { STEPS = 10, ELASTIC_REPEATS = 50 };
/* Bytes that an elastic step moves a contact (rows of bodies stay in the cache): a, b, phase, kn,
 * plane, rim, moment read; n, s, u read and written; f, gap written. */
static const double BYTES = 8 + 1 + 24 + 48 + 2 * 96 + 32;
/* Additions and multiplications of doubles: frame and motion 190, strength 25, force of the affine
 * field and its work 90, forces on the grains 55, their sums 12. */
static const double OPERATIONS = 372;
/* What the law adds for a point: its line read and written; operations of a point that opens and
 * does not slide. */
static const double POINT_BYTES = 128, POINT_OPERATIONS = 95;

/* Pa, strength of the specimen under slow loading: a fixed rate of 2e-7 a step, local damping 0.7
 * (BENCH_REFERENCE=1 measures it). */
static const double REFERENCE = 119.48e6;

struct state {
    size_t points, damaged, broken, contacts, contacts_by_points, by_law; /* the last: points */
};

static struct state count_state(const struct brc_sim *sim)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct vgcm_points *p = vgcm_point_columns(c);
    struct state s = {0};
    for (size_t i = 0; i < c->n; i++) {
        uint8_t phase = vgcm_columns(c)->phase[i];
        s.contacts += phase != VGCM_SPHERE;
        s.points += phase != VGCM_SPHERE ? (size_t)c->np[i] : 0;
        s.contacts_by_points += phase == VGCM_POINTS;
        s.by_law += phase == VGCM_POINTS ? (size_t)c->np[i] : 0;
        if (phase != VGCM_POINTS && phase != VGCM_LOOSE)
            continue;
        for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
            double damage = p->law[j][VGCM_DN] + p->law[j][VGCM_DS];
            s.damaged += damage > 0;
            s.broken += damage >= 1;
        }
    }
    return s;
}

/* Settings of run and test, "key", "value", ..., NULL. */
static void make(struct brc_context *ctx, const struct brc_specimen *specimen, struct brc_sim *sim,
                 const char *const *run, const char *const *test)
{
    struct vgcm_params p;
    struct brc_test_params t;
    struct brc_run_params r;
    must(ctx, brc_params_defaults(ctx, brc_model_vgcm.params, &p));
    must(ctx, brc_params_defaults(ctx, brc_test_param_list, &t));
    must(ctx, brc_params_defaults(ctx, brc_run_param_list, &r));
    set(ctx, brc_test_param_list, &t, "strain_max", "0.02");
    set(ctx, brc_test_param_list, &t, "stop_drop", "0.5");
    if (getenv("BENCH_SIMD"))
        set(ctx, brc_run_param_list, &r, "simd", getenv("BENCH_SIMD"));
    for (; *run; run += 2)
        set(ctx, brc_run_param_list, &r, run[0], run[1]);
    for (; *test; test += 2)
        set(ctx, brc_test_param_list, &t, test[0], test[1]);
    const struct brc_test rig = brc_rigs_test(&t, NULL);
    must(ctx, brc_sim_create(ctx, sim, &brc_model_vgcm, &p, specimen, &rig, &r));
}

/* ns a point and step, over STEPS steps. */
static double time_steps(struct brc_sim *sim, size_t points, double *total)
{
    double begin = cpu_seconds();
    for (int i = 0; i < STEPS; i++)
        must(sim->ctx, brc_sim_step(sim));
    double spent = cpu_seconds() - begin;
    *total += spent;
    return 1e9 * spent / STEPS / (double)points;
}

/* A build that this program runs to compare with (report_order) must not write the results. */
static void publish(const struct bench_value *v)
{
    if (getenv("BENCH_MEAN"))
        printf("%s %g\n", v->name, v->value);
    else
        bench_report(v);
}

static void report(const char *name, struct bench_times *t, double bar, double limit)
{
    struct bench_value v = {name, bench_quantile(t, 0.5), "ns/point", bar, limit, 0};
    v.spread = bench_quantile(t, 0.75) - bench_quantile(t, 0.25);
    if (t->n > 0)
        publish(&v);
}

/* GB/s at the size of the contacts' rows, Gflop/s. */
struct machine {
    double bandwidth, arithmetic;
};

static struct machine machine_of(const struct state *s)
{
    size_t size = (size_t)(BYTES * (double)s->contacts);
    struct machine m = {bench_triad(size / 8), bench_arithmetic()};
    double far = bench_triad((size_t)1 << 25);
    publish(&(struct bench_value){"machine_triad_same_size", m.bandwidth, "GB/s", 0, 0, 0});
    publish(&(struct bench_value){"machine_triad_memory", far, "GB/s", 0, 0, 0});
    publish(&(struct bench_value){"machine_arithmetic", m.arithmetic, "Gflop/s", 0, 0, 0});
    return m;
}

/* Least time of a step a point, by bandwidth and by arithmetic [ns]. */
static double machine_limit(const struct machine *m, const struct state *s)
{
    double contacts = (double)s->contacts, points = (double)s->points;
    double by_law = (double)s->by_law;
    double bytes = (BYTES * contacts + POINT_BYTES * by_law) / points;
    double operations = (OPERATIONS * contacts + POINT_OPERATIONS * by_law) / points;
    printf("vgcm: %zu contacts, %zu points, %zu of them by their law: %.3g bytes a point take %.3g "
           "ns, "
           "%.3g operations %.3g ns\n",
           s->contacts, s->points, s->by_law, bytes, bytes / m->bandwidth, operations,
           operations / m->arithmetic);
    return fmax(bytes / m->bandwidth, operations / m->arithmetic);
}

/* ns a point over the whole compression, by another build of this program; least of two runs. */
static double mean_of(const char *program)
{
    char command[600], line[256];
    double least = HUGE_VAL, value;
    snprintf(command, sizeof command, "BENCH_MEAN=1 %s", program);
    for (int i = 0; i < 2; i++) {
        FILE *pipe = popen(command, "r");
        while (pipe && fgets(line, sizeof line, pipe))
            if (sscanf(line, "vgcm_ucs_mean_ns_point %lf", &value) == 1)
                least = fmin(least, value);
        if (!pipe || pclose(pipe) != 0)
            return NAN;
    }
    return least;
}

/* What it costs to add forces and energies in the order of the list: over a build that adds them as
 * they come (make CFG=free). */
static void report_order(const char *program)
{
    char other[512];
    snprintf(other, sizeof other, "build/free/%s", program + strlen("build/"));
    double ratio = mean_of(program) / mean_of(other) - 1;
    bench_report(&(struct bench_value){"vgcm_sums_cost_ratio", ratio, "1", 0.05, 0, 0});
}

static void time_points(struct brc_context *ctx, const struct brc_specimen *specimen)
{
    static struct bench_times elastic, damaged;
    const char *const none[] = {NULL};
    struct brc_sim sim;
    double total = 0;
    make(ctx, specimen, &sim, none, none);
    struct state s = count_state(&sim), half = {0};
    struct machine machine = machine_of(&s);
    double limit = machine_limit(&machine, &s);
    while (elastic.n < ELASTIC_REPEATS)
        bench_note(&elastic, time_steps(&sim, s.points, &total));
    report("vgcm_elastic_ns_point", &elastic, 5, limit);
    while (!brc_rigs_done(&sim) && !getenv("BENCH_SHORT")) {
        double time = time_steps(&sim, s.points, &total);
        if (sim.step % 100 == 0)
            s = count_state(&sim);
        double part = (double)s.damaged / (double)s.points;
        if (part > 0.45 && part < 0.55) {
            bench_note(&damaged, time);
            half = s;
        }
    }
    if (damaged.n > 0) {
        report("vgcm_damaged_ns_point", &damaged, 7, machine_limit(&machine, &half));
        printf("vgcm: then %.3g of the points were damaged, %.3g broken, %.3g of the contacts by "
               "points\n",
               (double)half.damaged / (double)s.points, (double)half.broken / (double)s.points,
               (double)half.contacts_by_points / (double)s.contacts);
        double mean = 1e9 * total / (double)sim.step / (double)s.points;
        publish(&(struct bench_value){"vgcm_ucs_mean_ns_point", mean, "ns/point", 8, limit, 0});
        printf("vgcm: default settings: %.1f s, %.0f steps, %.3g of the points damaged, %.3g "
               "broken at the end, %.2f MPa\n",
               total, (double)sim.step, (double)s.damaged / (double)s.points,
               (double)s.broken / (double)s.points, 1e-6 * sim.rig.force_peak / sim.rig.section);
    }
    brc_sim_free(&sim);
}

/* Strength in compression [Pa], with steps and seconds. */
static double strength(struct brc_context *ctx, const struct brc_specimen *specimen,
                       const char *const *run, const char *const *test, double *seconds,
                       double *steps)
{
    struct brc_sim sim;
    make(ctx, specimen, &sim, run, test);
    double begin = cpu_seconds();
    while (!brc_rigs_done(&sim))
        must(ctx, brc_sim_step(&sim));
    *seconds = cpu_seconds() - begin;
    *steps = (double)sim.step;
    double value = sim.rig.force_peak / sim.rig.section;
    brc_sim_free(&sim);
    return value;
}

/* Cheap settings within 3 % of slow loading: less damping, masses near the stable limit, a
 * larger loading target. BENCH_REFERENCE=1 runs slow loading too (minutes). */
static void time_compression(struct brc_context *ctx, const struct brc_specimen *specimen)
{
    const char *const run[] = {"fluctuation_damping", "0.2", "mass_margin", "0.5", NULL};
    const char *const test[] = {"target", "0.0045", NULL};
    const char *const slow_run[] = {NULL};
    const char *const slow[] = {"loading", "fixed", "rate", "2e-7 1/s", "stop_drop", "0.8", NULL};
    double seconds, steps, reference = REFERENCE;
    if (getenv("BENCH_REFERENCE")) {
        reference = strength(ctx, specimen, slow_run, slow, &seconds, &steps);
        printf("ucs_8000_vgcm: slow loading: %.6g MPa, %.0f steps, %.0f s\n", 1e-6 * reference,
               steps, seconds);
    }
    double value = strength(ctx, specimen, run, test, &seconds, &steps);
    bench_report(&(struct bench_value){"ucs_8000_vgcm_cpu_s", seconds, "s", 20, 0, 0});
    bench_report(&(struct bench_value){"ucs_8000_vgcm_steps", steps, "1", 0, 0, 0});
    bench_report(
        &(struct bench_value){"ucs_8000_vgcm_error", fabs(value / reference - 1), "1", 0.03, 0, 0});
    printf("ucs_8000_vgcm: %.6g MPa against %.6g MPa by slow loading\n", 1e-6 * value,
           1e-6 * reference);
}

int main(int argc, char **argv)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_specimen_params s;
    struct brc_specimen specimen;
    ctx.quiet = 1;
    must(&ctx, brc_params_defaults(&ctx, brc_specimen_param_list, &s));
    must(&ctx, brc_specimen_create(&ctx, &s, &specimen));
    time_points(&ctx, &specimen);
    if (!getenv("BENCH_SHORT") && !getenv("BENCH_MEAN"))
        time_compression(&ctx, &specimen);
    brc_specimen_free(&specimen);
    if (argc > 0 && !getenv("BENCH_SHORT") && !getenv("BENCH_MEAN"))
        report_order(argv[0]);
    return 0;
}
