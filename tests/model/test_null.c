/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The null model is the gauge of how wide the model interface is. */
#include "tests/fixture.h"

#include <stdio.h>

static void it_stays_under_sixty_lines(void **state)
{
    FILE *file = fopen("tests/null/model.c", "r");
    int n = 0;
    (void)state;
    assert_non_null(file);
    for (int c; (c = fgetc(file)) != EOF;)
        n += c == '\n';
    fclose(file);
    assert_in_range(n, 10, 59);
}

static void a_missing_operation_is_named(void **state)
{
    struct fixture *f = *state;
    struct brc_model model = brc_model_null;
    CHECK_OK(&f->ctx, brc_model_check(&f->ctx, &model));
    model.energy = NULL;
    CHECK_FAILS(&f->ctx, brc_model_check(&f->ctx, &model), BRC_ERR_INTERNAL, "energy");
}

static void every_model_has_a_name_of_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < fixture_n_models(); i++) {
        assert_true(strlen(fixture_model(i)->name) > 0);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(fixture_model(i)->name, fixture_model(j)->name);
    }
    for (int i = 0; i < brc_registry_count(); i++)
        assert_ptr_equal(brc_registry_find(brc_registry_at(i)->name), brc_registry_at(i));
    assert_null(brc_registry_find("null")); /* linked into tests only */
}

static void grains_fall_freely(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 2, 2, 2, 0.01, 0);
    fixture_free_sim(f, &brc_model_null, "", "dt: 1e-3 s; gravity: 0 m/s2, 0 m/s2, -10 m/s2");
    double z0 = f->sim.bodies.x[3][2], v0 = f->sim.bodies.v[3][2];
    fixture_steps(f, 100);
    /* leapfrog is exact for a constant force: only round-off of 100 sums */
    CHECK_NEAR(f->sim.bodies.v[3][2] - v0, -10 * 0.1, 0, 1e-12);
    CHECK_NEAR(f->sim.bodies.x[3][2] - z0, v0 * 0.1 - 10 * 1e-6 * 99 * 100 / 2, 0, 1e-12);
    CHECK_NEAR(brc_ledger_residual(&f->sim.ledger), 0, 1e-12, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(it_stays_under_sixty_lines),
        FIXTURE_TEST(a_missing_operation_is_named),
        FIXTURE_TEST(every_model_has_a_name_of_its_own),
        FIXTURE_TEST(grains_fall_freely),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
