/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the benchmarks share: specimens and runs, medians over repeats, the machine's own limits,
 * and results/bench/bench.json. Times are user CPU time of one core. */
#ifndef BRC_TESTS_BENCH_H
#define BRC_TESTS_BENCH_H

#include "common/engine/sim.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static inline void must(struct brc_context *ctx, int code)
{
    if (code == 0)
        return;
    fprintf(stderr, "%s\n", ctx->message);
    exit(1);
}

static inline double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void set(struct brc_context *ctx, struct brc_param_list list, void *values,
                       const char *key, const char *text)
{
    must(ctx, brc_params_set(ctx, list, values, "bench", key, text, "bench"));
}

/* Table 1 of gt12, with which the times in the documentation have been measured. */
static inline void set_table_1(struct brc_context *ctx, struct brc_param_list polyhedra,
                               void *values)
{
    static const char *const table[][2] = {{"radius", "1 mm"}, {"kn", "1e8 N/m"}, {"kt", "1e8 N/m"},
                                           {"mu", "0.3"},      {"bn", "20 GPa"},  {"bt", "20 GPa"},
                                           {"bm", "3.3 GPa"},  {"eps_th", "0.02"}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        set(ctx, polyhedra, values, table[i][0], table[i][1]);
}

/* ---- repeats ------------------------------------------------------------------------------- */

enum { BENCH_MAX_TIMES = 4096 };

struct bench_times {
    double time[BENCH_MAX_TIMES];
    int n;
};

static inline void bench_note(struct bench_times *t, double time)
{
    if (t->n < BENCH_MAX_TIMES)
        t->time[t->n++] = time;
}

static inline int bench_compare(const void *p, const void *q)
{
    double a = *(const double *)p, b = *(const double *)q;
    return (a > b) - (a < b);
}

/* Value below which the part q of the repeats lie. */
static inline double bench_quantile(struct bench_times *t, double q)
{
    qsort(t->time, (size_t)t->n, sizeof t->time[0], bench_compare);
    return t->n > 0 ? t->time[(int)(q * (t->n - 1) + 0.5)] : 0;
}

/* ---- results ------------------------------------------------------------------------------- */

/* bar: largest value that is wanted, 0 for none. limit: what the machine's bandwidth or arithmetic
 * rate allows, measured in the same run, 0 for none. spread: distance of the quartiles. */
struct bench_value {
    const char *name;
    double value;
    const char *unit;
    double bar, limit, spread;
};

#define BENCH_FILE "results/bench/bench.json"

/* Lines of the file that name other values: one value takes one line. */
static inline char *bench_others(const char *name)
{
    char wanted[256], line[1024], *text = calloc(1, 1);
    size_t size = 0;
    snprintf(wanted, sizeof wanted, "\"name\": \"%s\"", name);
    FILE *file = fopen(BENCH_FILE, "r");
    while (file && text && fgets(line, sizeof line, file)) {
        size_t length = strcspn(line, "\n");
        if (!strstr(line, "\"name\"") || strstr(line, wanted))
            continue;
        if (line[length - 1] == ',')
            length--;
        text = realloc(text, size + length + 3);
        if (text)
            size += (size_t)snprintf(text + size, length + 3, "%.*s,\n", (int)length, line);
    }
    if (file)
        fclose(file);
    return text;
}

/* Prints the value, and puts it into the file in place of the one that is there. */
static inline void bench_report(const struct bench_value *v)
{
    const char *state = v->bar == 0 ? "none" : v->value <= v->bar ? "met" : "missed";
    printf("%s %.4g %s", v->name, v->value, v->unit);
    if (v->bar > 0)
        printf("  (bar %g: %s)", v->bar, state);
    if (v->limit > 0)
        printf("  (machine's limit %.3g: fraction reached %.2f)", v->limit, v->limit / v->value);
    printf("\n");
    fflush(stdout);
    char *others = bench_others(v->name);
    mkdir("results", 0777);
    mkdir("results/bench", 0777);
    FILE *file = fopen(BENCH_FILE, "w");
    if (!file || !others) {
        perror(BENCH_FILE);
        exit(1);
    }
    fprintf(file,
            "[\n%s  {\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\", \"bar\": %g, \"limit\": "
            "%.6g, \"spread\": %.3g, \"state\": \"%s\"}\n]\n",
            others, v->name, v->value, v->unit, v->bar, v->limit, v->spread, state);
    fclose(file);
    free(others);
}

/* ---- the machine --------------------------------------------------------------------------- */

typedef double bench_half __attribute__((vector_size(16)));
typedef double bench_lanes __attribute__((vector_size(32), may_alias));
typedef double bench_wide __attribute__((vector_size(64)));

/* a = b + s c over three arrays of n doubles in all, GB/s of the best of a few passes. */
__attribute__((target_clones("avx2", "default"))) static inline double bench_triad(size_t n)
{
    double *a = aligned_alloc(64, n / 24 * 24 * sizeof *a), best = 0;
    if (!a)
        return 0;
    size_t third = n / 24 * 2;
    bench_lanes *x = (bench_lanes *)(void *)a, *y = x + third, *z = y + third;
    memset(a, 0, n / 24 * 24 * sizeof *a);
    size_t passes = 1 + ((size_t)1 << 24) / n;
    for (int repeat = 0; repeat < 8; repeat++) {
        double begin = cpu_seconds();
        for (size_t k = 0; k < passes; k++)
            for (size_t i = 0; i < third; i++)
                x[i] = y[i] + 3.0 * z[i];
        double rate = 1e-9 * 96 * (double)(third * passes) / (cpu_seconds() - begin);
        best = rate > best ? rate : best;
    }
    free(a);
    return best;
}

/* Vectors that fit into the registers of each instruction set together with two constants, and are
 * enough to hide the latencies of a multiplication and an addition; times one vector operation. */
enum { BENCH_CHAINS = 12, BENCH_TURNS = 1000000 };
#define BENCH_ARITHMETIC(name, type, set)                                                     \
    __attribute__((noinline, target(set))) static double name(void)                           \
    {                                                                                         \
        type x[BENCH_CHAINS], one = (type){0} + 0.999, two = (type){0} + 0.001;               \
        for (int k = 0; k < BENCH_CHAINS; k++)                                                \
            x[k] = (type){0} + k;                                                             \
        __asm__ volatile("" : "+x"(one), "+x"(two));                                          \
        double begin = cpu_seconds();                                                         \
        for (int i = 0; i < BENCH_TURNS; i++)                                                 \
            _Pragma("GCC unroll 12") for (int k = 0; k < BENCH_CHAINS; k++) x[k] =            \
                x[k] * one + two;                                                             \
        double spent = cpu_seconds() - begin;                                                 \
        volatile double sink = 0;                                                             \
        for (int k = 0; k < BENCH_CHAINS; k++)                                                \
            sink = sink + x[k][0];                                                            \
        return 1e-9 * 2 * BENCH_CHAINS * sizeof(type) / sizeof(double) * BENCH_TURNS / spent; \
    }
BENCH_ARITHMETIC(bench_arithmetic_base, bench_half, "sse2")
BENCH_ARITHMETIC(bench_arithmetic_avx2, bench_lanes, "avx2")
BENCH_ARITHMETIC(bench_arithmetic_avx512, bench_wide, "avx512f")

/* Multiplications and additions of doubles, independent of each other, Gflop/s at best. */
static inline double bench_arithmetic(void)
{
    double best = 0;
    for (int repeat = 0; repeat < 8; repeat++) {
        double rate = __builtin_cpu_supports("avx512f") ? bench_arithmetic_avx512()
                      : __builtin_cpu_supports("avx2")  ? bench_arithmetic_avx2()
                                                        : bench_arithmetic_base();
        best = rate > best ? rate : best;
    }
    return best;
}

#endif
