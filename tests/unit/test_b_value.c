/* SPDX-License-Identifier: GPL-3.0-or-later */
/* b-values of magnitudes that are drawn from a known law. */
#include "common/rigs/b_value.h"
#include "tests/near.h"

#include <gsl/gsl_randist.h>

enum { N = 600, SETS = 300 };
static const double B = 1.3, FROM = -7;

/* n_below of the n magnitudes lie below the law's beginning, too few for it. */
static void draw(gsl_rng *random, double *magnitude, int n, int n_below)
{
    for (int i = 0; i < n; i++)
        magnitude[i] = i < n_below ? FROM - gsl_ran_flat(random, 0, 1)
                                   : FROM + gsl_ran_exponential(random, 1 / (B * log(10)));
}

/* Mean of the value over the true one, and the scatter of the value over its error. */
static void fit_sets(int n_below, double *mean, double *ratio)
{
    double magnitude[N], square = 0, error = 0;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    *mean = 0;
    for (int i = 0; i < SETS; i++) {
        struct brc_b_value b;
        draw(random, magnitude, N, n_below);
        assert_null(brc_b_value_fit(magnitude, N, &b));
        assert_true(b.n >= BRC_B_VALUE_LEAST && b.n <= N);
        *mean += b.b / B / SETS;
        square += (b.b - B) * (b.b - B) / SETS;
        error += b.error * b.error / SETS;
    }
    *ratio = sqrt(square / error);
    gsl_rng_free(random);
    print_message("%d below: mean over the true one %.4f, scatter over error %.3f\n", n_below,
                  *mean, *ratio);
}

static void test_law_is_found_again(void **state)
{
    (void)state;
    double mean, ratio;
    fit_sets(0, &mean, &ratio);
    CHECK_NEAR(mean, 1, 0.03, 0);
    CHECK_BETWEEN(ratio, 0.7, 1.5);
    fit_sets(200, &mean, &ratio); /* as many per unit as the law has at its beginning: a kink */
    CHECK_NEAR(mean, 1, 0.05, 0);
    CHECK_BETWEEN(ratio, 0.7, 1.6);
}

/* By hand: without a search for the beginning, as there are no more than it takes. */
static void test_formula(void **state)
{
    (void)state;
    double magnitude[BRC_B_VALUE_LEAST], sum = 0;
    struct brc_b_value b;
    for (int i = 0; i < BRC_B_VALUE_LEAST; i++) {
        magnitude[i] = 0.1 * (BRC_B_VALUE_LEAST - i) * (BRC_B_VALUE_LEAST - i);
        sum += magnitude[i] - 0.1;
    }
    assert_null(brc_b_value_fit(magnitude, BRC_B_VALUE_LEAST, &b));
    CHECK_NEAR(b.b, (BRC_B_VALUE_LEAST - 1) / (log(10) * sum), 0, 1e-12);
    CHECK_NEAR(b.error, b.b / sqrt(BRC_B_VALUE_LEAST - 1), 0, 1e-12);
    CHECK_NEAR(b.completeness, 0.1, 0, 1e-12);
    assert_non_null(strstr(brc_b_value_fit(magnitude, BRC_B_VALUE_LEAST - 1, &b), "fewer than 25"));
    for (int i = 0; i < BRC_B_VALUE_LEAST; i++)
        magnitude[i] = -5;
    assert_non_null(strstr(brc_b_value_fit(magnitude, BRC_B_VALUE_LEAST, &b), "of one magnitude"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_law_is_found_again),
                                       cmocka_unit_test(test_formula)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
