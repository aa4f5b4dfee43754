/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Envelopes through peaks whose law is known, exact and with noise. */
#include "calib/envelope.h"
#include "tests/near.h"

#include <gsl/gsl_randist.h>

enum { N = 8, SETS = 2000 };
static const double COHESION = 21e6, ANGLE = 0.925, STRENGTH = 120e6, M = 24;

static double line(double sigma_3)
{
    double slope = (1 + sin(ANGLE)) / (1 - sin(ANGLE));
    return 2 * COHESION * sqrt(slope) + slope * sigma_3;
}

static double curve(double sigma_3)
{
    return sigma_3 + sqrt(M * STRENGTH * sigma_3 + STRENGTH * STRENGTH);
}

static void make(struct calib_peak peak[N], double (*law)(double), gsl_rng *random, double noise)
{
    for (int i = 0; i < N; i++) {
        int pressure = i / 2;
        peak[i].sigma_3 = 3e6 * pressure;
        peak[i].sigma_1 = law(peak[i].sigma_3) + gsl_ran_gaussian(random, noise);
    }
}

static void test_exact_peaks(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct calib_peak peak[N];
    struct calib_mohr_coulomb mc;
    struct calib_hoek_brown hb;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    make(peak, line, random, 0);
    CHECK_OK(&ctx, calib_mohr_coulomb_fit(&ctx, peak, N, &mc));
    CHECK_NEAR(mc.cohesion.value, COHESION, 0, 1e-10);
    CHECK_NEAR(mc.angle.value, ANGLE, 0, 1e-10);
    CHECK_NEAR(mc.strength.value, line(0), 0, 1e-10);
    CHECK_NEAR(mc.r2, 1, 1e-12, 0);
    make(peak, curve, random, 0);
    peak[0].sigma_3 = -4e6; /* a direct tension on the branch below */
    peak[0].sigma_1 = curve(-4e6);
    CHECK_OK(&ctx, calib_hoek_brown_fit(&ctx, peak, N, &hb));
    CHECK_NEAR(hb.strength.value, STRENGTH, 0, 1e-8);
    CHECK_NEAR(hb.m.value, M, 0, 1e-8);
    CHECK_NEAR(curve(-hb.tension), 0, 1, 0);
    CHECK_NEAR(hb.r2, 1, 1e-12, 0);
    gsl_rng_free(random);
}

/* In how many sets the interval holds the true value, and the mean of the value over the true one.
 */
struct cover {
    double held, mean;
};

static void count(struct cover *c, const struct calib_estimate *e, double is)
{
    assert_true(e->error > 0 && e->low < e->value && e->value < e->high);
    c->held += (e->low <= is && is <= e->high) / (double)SETS;
    c->mean += e->value / is / SETS;
}

/* 95 % of 2000 sets: a standard error of half a per cent. */
static void test_intervals_hold_what_they_say(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct calib_peak peak[N];
    struct cover c[5] = {0};
    double scatter = 0;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < SETS; i++) {
        struct calib_mohr_coulomb mc;
        struct calib_hoek_brown hb;
        make(peak, line, random, 5e6);
        CHECK_OK(&ctx, calib_mohr_coulomb_fit(&ctx, peak, N, &mc));
        count(&c[0], &mc.cohesion, COHESION);
        count(&c[1], &mc.angle, ANGLE);
        scatter += mc.scatter * mc.scatter / SETS;
        make(peak, curve, random, 5e6);
        CHECK_OK(&ctx, calib_hoek_brown_fit(&ctx, peak, N, &hb));
        count(&c[2], &hb.strength, STRENGTH);
        count(&c[3], &hb.m, M);
        count(&c[4], &hb.a, M * STRENGTH);
    }
    for (int k = 0; k < 5; k++) {
        print_message("held %.3f, mean %.4f\n", c[k].held, c[k].mean);
        CHECK_BETWEEN(c[k].held, 0.935, 0.965);
        CHECK_NEAR(c[k].mean, 1, 0.02, 0);
    }
    CHECK_NEAR(sqrt(scatter), 5e6, 0, 0.02);
    gsl_rng_free(random);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct calib_mohr_coulomb mc;
    struct calib_hoek_brown hb;
    const struct calib_peak two[] = {{0, 100e6}, {5e6, 150e6}},
                            same[] = {{5e6, 100e6}, {5e6, 101e6}, {5e6, 102e6}},
                            falling[] = {{0, 100e6}, {5e6, 90e6}, {10e6, 80e6}},
                            none[] = {{0, 100e6}, {5e6, NAN}, {10e6, 180e6}};
    CHECK_FAILS(&ctx, calib_mohr_coulomb_fit(&ctx, two, 2, &mc), BRC_ERR_INPUT, "2 points");
    CHECK_FAILS(&ctx, calib_hoek_brown_fit(&ctx, same, 3, &hb), BRC_ERR_INPUT,
                "one confining stress (sigma_3 = 5 MPa)");
    CHECK_FAILS(&ctx, calib_mohr_coulomb_fit(&ctx, falling, 3, &mc), BRC_ERR_INPUT, "the slope -2");
    CHECK_FAILS(&ctx, calib_hoek_brown_fit(&ctx, falling, 3, &hb), BRC_ERR_INPUT, "do not rise");
    CHECK_FAILS(&ctx, calib_mohr_coulomb_fit(&ctx, none, 3, &mc), BRC_ERR_INPUT, "peak 2");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_exact_peaks),
                                       cmocka_unit_test(test_intervals_hold_what_they_say),
                                       cmocka_unit_test(test_what_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
