/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums that do not depend on the order of their terms. */
#include "common/parallel/sums.h"
#include "tests/fixture.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>

enum { N = 5003, ORDERS = 200 };

/* Terms over many decades and of both signs, so that a plain sum loses much. */
static void fill(gsl_rng *rng, double *x, size_t n, double decades)
{
    for (size_t i = 0; i < n; i++)
        x[i] = (gsl_rng_uniform(rng) - 0.5) * pow(10, -decades * gsl_rng_uniform(rng));
}

static double plain_sum(const double *x, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i];
    return sum;
}

static void any_order_gives_the_same_bits(void **state)
{
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static double x[N];
    size_t n_plain = 0;
    for (int decades = 0; decades <= 30; decades += 10) {
        fill(rng, x, N, decades);
        double sum = brc_sum_exact(x, N), plain = plain_sum(x, N);
        for (int k = 0; k < ORDERS; k++) {
            gsl_ran_shuffle(rng, x, N, sizeof *x);
            double again = brc_sum_exact(x, N);
            assert_memory_equal(&sum, &again, sizeof sum);
            n_plain += plain_sum(x, N) != plain;
        }
    }
    assert_true(n_plain > ORDERS); /* what the exact sum is for */
    gsl_rng_free(rng);
}

/* Zeros in between, as contacts without a force are, change nothing. */
static void zeros_change_nothing(void **state)
{
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static double x[N], spread[2 * N];
    fill(rng, x, 1000, 8);
    for (size_t n = 1; n < 1000; n += 37) {
        for (size_t i = 0; i < n; i++) {
            spread[2 * i] = 0;
            spread[2 * i + 1] = x[i];
        }
        /* the number of terms decides the quanta, so it must be the same: of grains, say */
        for (size_t i = n; i < 2 * n; i++)
            x[i] = i < 1000 ? x[i] : 0;
        double padded[2 * N] = {0};
        for (size_t i = 0; i < n; i++)
            padded[i] = x[i];
        double a = brc_sum_exact(padded, 2 * n), b = brc_sum_exact(spread, 2 * n);
        double left_out = brc_sum_exact_of(padded, n, 2 * n);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(&a, &left_out, sizeof a);
    }
    gsl_rng_free(rng);
    /* what is cut off hangs on the number of terms of the whole, given or not */
    static const double whole[N] = {1, -1, 0x1p-85};
    double all = brc_sum_exact(whole, N), part = brc_sum_exact_of(whole, 3, N);
    assert_memory_equal(&all, &part, sizeof all);
    assert_true(brc_sum_exact(whole, 3) == 0x1p-85);
}

/* Against sums in long double: as good as rounding the true sum. */
static void nothing_is_lost(void **state)
{
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static double x[N];
    for (int decades = 0; decades <= 12; decades += 3) {
        fill(rng, x, N, decades);
        long double sum = 0, size = 0;
        for (size_t i = 0; i < N; i++) {
            sum += x[i];
            size = fmaxl(size, fabsl(x[i]));
        }
        assert_true(fabsl((long double)brc_sum_exact(x, N) - sum) <=
                    1.2e-16L * fabsl(sum) + 1e-18L * size);
    }
    gsl_rng_free(rng);
}

static void ends_of_the_range(void **state)
{
    (void)state;
    const double tiny[5] = {5e-324, 5e-324, -5e-324, 2e-308, 5e-324}, none[3] = {0, -0.0, 0};
    const double wrong[5] = {1, 2, NAN, 3, 4}, endless[2] = {1, HUGE_VAL}, huge[2] = {1e290, 1e290};
    const double whole[6] = {1e200, 1, -1e200, 1, 1e100, -1e100};
    assert_true(brc_sum_exact(tiny, 5) == 2e-308 + 2 * 5e-324);
    assert_true(brc_sum_exact(none, 3) == 0);
    assert_true(brc_sum_exact(NULL, 0) == 0);
    assert_true(isnan(brc_sum_exact(wrong, 5)));
    assert_true(isnan(brc_sum_exact(endless, 2)));
    assert_true(isnan(brc_sum_exact(huge, 2)));
    assert_true(brc_sum_exact(whole, 6) == 0); /* 1 lies 2^-664 below the largest term */
    assert_true(brc_sum_exact(whole, 1) == 1e200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_order_gives_the_same_bits), cmocka_unit_test(zeros_change_nothing),
        cmocka_unit_test(nothing_is_lost), cmocka_unit_test(ends_of_the_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
