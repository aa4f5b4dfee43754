/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/near.h"

static void equal_numbers_pass(void **state)
{
    double a[2] = {1, 2}, b[2] = {1, 2 + 1e-12};
    (void)state;
    CHECK_NEAR(1.0, 1.0 + 1e-12, 0, 1e-11);
    CHECK_NEAR(0.0, 1e-12, 1e-11, 0);
    CHECK_NEAR_ARRAY(a, b, 2, 0, 1e-11);
    CHECK_BETWEEN(1.5, 1, 2);
}

static void compiler_does_not_fuse(void **state)
{
    volatile double a = 1 + 1.0 / (1 << 30), b = -(1 + 2.0 / (1 << 30));
    (void)state;
    /* a a rounds to 1 + 2/2^30 unless the product is fused with the sum */
    assert_true(a * a + b == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_numbers_pass),
        cmocka_unit_test(compiler_does_not_fuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
