/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stages of a true triaxial test: what is read, what each rule keeps, and the invariants. */
#include "common/geometry/vec.h"
#include "common/rigs/stress_path.h"
#include "tests/near.h"

#include <math.h>
#include <string.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;

static void stages_are_read(void **state)
{
    (void)state;
    struct brc_stage s[BRC_MAX_STAGES];
    int n;
    CHECK_OK(&ctx,
             brc_stages_read(&ctx,
                             "isotropic to 110 MPa,  p constant to strain 0.2, lode 30 degree "
                             "to strain -0.01, ratio 0.5 0.7 to 100 kPa , stress 20 MPa 30 "
                             "MPa 60 MPa, plane strain to strain 1e-3, lateral constant to 0 "
                             "Pa, uniaxial strain to strain 0.01",
                             s, &n));
    assert_int_equal(n, 8);
    assert_int_equal(s[0].kind, BRC_PATH_ISOTROPIC);
    CHECK_NEAR(s[0].to, 110e6, 1e-6, 0);
    assert_false(s[0].is_to_strain);
    assert_int_equal(s[1].kind, BRC_PATH_P_CONSTANT);
    assert_true(s[1].is_to_strain);
    CHECK_NEAR(s[1].to, 0.2, 0, 0);
    CHECK_NEAR(s[2].value[0], BRC_PI / 6, 1e-12, 0);
    CHECK_NEAR(s[2].to, -0.01, 0, 0);
    CHECK_NEAR(s[3].value[1], 0.7, 0, 0);
    CHECK_NEAR(s[3].to, 1e5, 1e-9, 0);
    CHECK_NEAR(s[4].value[1], 30e6, 1e-6, 0);
    CHECK_NEAR(s[4].to, 60e6, 1e-6, 0);
    CHECK_NEAR(s[6].to, 0, 0, 0);
    CHECK_NEAR(s[7].to, 0.01, 0, 0);
}

static void what_is_no_stage_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",
                                        "isotropic",
                                        "isotrop to 1 MPa",
                                        "isotropic to 1 MPa again",
                                        "isotropic to strain 2",
                                        "p constant to strain 0",
                                        "lode 70 degree to strain 0.1",
                                        "lode to strain 0.1",
                                        "ratio 0.5 to 1 MPa",
                                        "isotropic to 1 kg",
                                        "stress 1 MPa 2 MPa"};
    struct brc_stage s[BRC_MAX_STAGES];
    int n;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        CHECK_FAILS(&ctx, brc_stages_read(&ctx, wrong[i], s, &n), BRC_ERR_INPUT,
                    "true_triaxial.stages");
    }
}

static void by_laws(const struct brc_axis_law law[2], double z, double sigma[3])
{
    for (int k = 0; k < 2; k++)
        sigma[k] = law[k].constant + law[k].part * z;
    sigma[2] = z;
}

static void rules_keep_what_they_say(void **state)
{
    (void)state;
    const double start[3] = {90e6, 110e6, 100e6};
    struct brc_axis_law law[2];
    double sigma[3];
    for (double z = 101e6; z < 160e6; z += 7e6) {
        struct brc_stage s = {.kind = BRC_PATH_P_CONSTANT};
        brc_stage_laws(&s, start, law);
        by_laws(law, z, sigma);
        CHECK_NEAR(brc_mean_stress(sigma), 100e6, 1e-6, 0);
        CHECK_NEAR(sigma[0], sigma[1], 1e-6, 0);
        for (double angle = 0; angle < 1.05; angle += BRC_PI / 12) {
            s = (struct brc_stage){.kind = BRC_PATH_LODE, .value = {angle}};
            brc_stage_laws(&s, start, law);
            by_laws(law, z, sigma);
            CHECK_NEAR(brc_mean_stress(sigma), 100e6, 1e-6, 0);
            CHECK_NEAR(brc_lode_angle(sigma), angle, 1e-6, 0);
        }
        s = (struct brc_stage){.kind = BRC_PATH_LATERAL};
        brc_stage_laws(&s, start, law);
        by_laws(law, z, sigma);
        CHECK_NEAR(sigma[0], start[0], 0, 0);
        CHECK_NEAR(sigma[1], start[1], 0, 0);
    }
    struct brc_stage s = {.kind = BRC_PATH_STRESS, .value = {20e6, 30e6, 60e6}};
    brc_stage_laws(&s, start, law);
    by_laws(law, 60e6, sigma);
    CHECK_NEAR(sigma[0], 20e6, 1e-6, 0);
    CHECK_NEAR(sigma[1], 30e6, 1e-6, 0);
    by_laws(law, 100e6, sigma);
    CHECK_NEAR(sigma[0], start[0], 1e-6, 0);
    s = (struct brc_stage){.kind = BRC_PATH_PLANE};
    brc_stage_laws(&s, start, law);
    assert_true(law[1].is_held && !law[0].is_held);
}

/* sigma : d eps = p d eps_v + q d eps_d for strains with the deviator of the stress. */
static void invariants_are_conjugate(void **state)
{
    (void)state;
    const double sigma[3] = {3, 5, 11};
    double eps[3], p = brc_mean_stress(sigma), work = 0;
    for (int k = 0; k < 3; k++) {
        eps[k] = 1e-3 + 2e-4 * (sigma[k] - p);
        work += sigma[k] * eps[k];
    }
    CHECK_NEAR(p * brc_volume_strain(eps) +
                   brc_deviatoric_stress(sigma) * brc_deviatoric_strain(eps),
               work, 1e-15, 0);
    const double compression[3] = {1, 1, 4}, extension[3] = {4, 4, 1};
    CHECK_NEAR(brc_deviatoric_stress(compression), 3, 1e-15, 0);
    CHECK_NEAR(brc_lode_angle(compression), 0, 1e-7, 0);
    CHECK_NEAR(brc_lode_angle(extension), BRC_PI / 3, 1e-7, 0);
}

static void ends_are_told(void **state)
{
    (void)state;
    const double low[3] = {10, 10, 10}, high[3] = {90, 90, 90};
    struct brc_stage s = {.kind = BRC_PATH_ISOTROPIC, .to = 50};
    CHECK_NEAR(brc_stage_sense(&s, low), 1, 0, 0);
    CHECK_NEAR(brc_stage_sense(&s, high), -1, 0, 0);
    assert_false(brc_stage_is_over(&s, 1, 9, low));
    assert_true(brc_stage_is_over(&s, 1, 9, high));
    assert_true(brc_stage_is_over(&s, -1, 9, low));
    s = (struct brc_stage){.kind = BRC_PATH_PLANE, .is_to_strain = true, .to = -0.1};
    CHECK_NEAR(brc_stage_sense(&s, low), -1, 0, 0);
    assert_false(brc_stage_is_over(&s, -1, 0.09, low));
    assert_true(brc_stage_is_over(&s, -1, 0.1, low));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stages_are_read), cmocka_unit_test(what_is_no_stage_is_refused),
        cmocka_unit_test(rules_keep_what_they_say), cmocka_unit_test(invariants_are_conjugate),
        cmocka_unit_test(ends_are_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
