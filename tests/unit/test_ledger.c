/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/engine/ledger.h"
#include "tests/near.h"

static void balance_by_hand(void **state)
{
    /* the sample took up 10 + 3 + 2 + 1 + 4 + 5 + 6 + 7 + 8 = 46 from 2 at the start, the platens
     * put in 40 and gravity 4: nothing is lost */
    struct brc_ledger l = {.kinetic = 10,
                           .bond = 3,
                           .contact_normal = 2,
                           .contact_shear = 1,
                           .friction = 4,
                           .damage = 5,
                           .viscous = 6,
                           .local_damping = 7,
                           .mass_scaling = 8,
                           .boundary = 40,
                           .gravity = 4,
                           .start = 2};
    (void)state;
    CHECK_NEAR(brc_ledger_imbalance(&l), 0, 0, 0);
    CHECK_NEAR(brc_ledger_residual(&l), 0, 0, 0);
    l.friction -= 2;
    CHECK_NEAR(brc_ledger_imbalance(&l), -2, 0, 0);
    assert_true(brc_ledger_residual(&l) > 0.02);
}

static void every_term_counts_with_its_sign(void **state)
{
    (void)state;
#define CHECK_TERM(name, sign, meaning) \
    CHECK_NEAR(brc_ledger_imbalance(&(struct brc_ledger){.name = 3}), (sign)*3.0, 0, 0);
    BRC_LEDGER_TERMS(CHECK_TERM)
#undef CHECK_TERM
}

static void residual_is_relative_to_boundary_work(void **state)
{
    struct brc_ledger l = {.boundary = -200, .bond = -198}; /* platens may take work out */
    (void)state;
    CHECK_NEAR(brc_ledger_residual(&l), 0.01, 0, 1e-14);
    l = (struct brc_ledger){0};
    CHECK_NEAR(brc_ledger_residual(&l), 0, 0, 0); /* nothing has happened yet: no 0/0 */
    l.damage = 1;                                 /* out of nothing: must not read as 0 */
    assert_true(brc_ledger_residual(&l) > 0.5);
}

static enum brc_energy_check check_of(double work, double lost, double moved, double noise)
{
    const double stored[3] = {0.25 * work, 0.25 * work, 0.5 * work - lost - moved};
    const struct brc_ledger l = {.boundary = work, .bond = work - lost};
    return brc_ledger_check(&l, stored, noise);
}

/* Whichever is larger counts, of either sign; what rounding makes of no work does not. */
static void energy_is_judged(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        assert_int_equal(check_of(50, sign * 1.4, 0, 0), BRC_ENERGY_GOOD);
        assert_int_equal(check_of(50, sign * 1.6, 0, 0), BRC_ENERGY_DOUBTFUL);
        assert_int_equal(check_of(50, 0, sign * 1.6, 0), BRC_ENERGY_DOUBTFUL);
        assert_int_equal(check_of(50, sign * 9.9, 0, 0), BRC_ENERGY_DOUBTFUL);
        assert_int_equal(check_of(50, sign * 10.1, 0, 0), BRC_ENERGY_WRONG);
        assert_int_equal(check_of(50, 0, sign * 10.1, 0), BRC_ENERGY_WRONG);
        assert_int_equal(check_of(0, sign * 1e-20, 0, 1e-19), BRC_ENERGY_GOOD);
        assert_int_equal(check_of(0, sign * 1e-18, 0, 1e-19), BRC_ENERGY_WRONG);
    }
    assert_int_equal(check_of(50, NAN, 0, 0), BRC_ENERGY_WRONG);
    assert_int_equal(check_of(0, 0, 0, 0), BRC_ENERGY_GOOD);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balance_by_hand),
        cmocka_unit_test(every_term_counts_with_its_sign),
        cmocka_unit_test(residual_is_relative_to_boundary_work),
        cmocka_unit_test(energy_is_judged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
