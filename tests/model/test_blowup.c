/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A blow-up of either model names step, body, contact and what to change; nothing stable is one. */
#include "common/engine/blowup.h"
#include "tests/fixture.h"

#include <stdio.h>

/* A scalar of the contact that each model's message must show, a column that spoils its force, and
 * what leaves nothing but bonds that never break: no place for energy to go. */
static const struct spoilt {
    const char *model, *shown, *spoils, *unbreakable;
} spoilt[] = {{"vgcm", ", phase ", "kn", "softening: none; sigma_t: 1e9 GPa; tau: 1e9 GPa"},
              {"polyhedra", ", room ", "bond",
               FIXTURE_TABLE_1 "; breakable: off; gn: 0 1/s; mu: 0; kn: 1 N/m; kt: 0 N/m"}};
enum { N_MODELS = sizeof spoilt / sizeof spoilt[0] };

static const struct brc_model *model_of(int i)
{
    const struct brc_model *model = brc_registry_find(spoilt[i].model);
    assert_non_null(model);
    return model;
}

static void expect_text(const struct brc_context *ctx, const char *text)
{
    if (!strstr(ctx->message, text)) {
        print_error("no '%s' in: %s\n", text, ctx->message);
        fail();
    }
}

/* Steps until the simulation fails, at most n, all of the length of the first; returns the step it
 * failed at, 0 when it did not. */
static long steps_to_failure(struct fixture *f, int n)
{
    double dt = f->sim.dt;
    for (int i = 0; i < n; i++) {
        f->sim.dt = dt;
        int code = brc_sim_step(&f->sim);
        if (code == 0)
            code = brc_blowup_energy(&f->sim);
        if (code == 0)
            continue;
        assert_int_equal(code, BRC_ERR_BLOWUP);
        char step[40];
        snprintf(step, sizeof step, "unstable at step %lld,", (long long)f->sim.step);
        expect_text(&f->ctx, step);
        expect_text(&f->ctx, "its contact with ");
        return (long)f->sim.step;
    }
    return 0;
}

/* Small velocities that the ledger knows of. */
static void stir(struct fixture *f)
{
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        double v[3], w[3];
        fixture_draw_unit(f, v);
        fixture_draw_unit(f, w);
        brc_scale(v, v, 1e-4);
        brc_scale(w, w, 1e-3);
        fixture_velocity(f, i, v, w);
    }
    fixture_ledger(f);
}

static void start(struct fixture *f, int i)
{
    fixture_grid(f, 3, 3, 3, 0.01, 0.4);
    fixture_free_sim(f, model_of(i), spoilt[i].unbreakable, "");
    stir(f);
}

static void test_velocity_that_is_no_number(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        start(f, i);
        fixture_steps(f, 5);
        f->sim.bodies.v[13][1] = NAN;
        assert_int_equal(steps_to_failure(f, 1), 6);
        expect_text(&f->ctx, "grain 13 at ");
        expect_text(&f->ctx, "(bonded): force ");
        expect_text(&f->ctx, spoilt[i].shown);
        expect_text(&f->ctx, "lower run.dt_margin (now 0.5;");
        expect_text(&f->ctx, "lower the stiffness of ");
        brc_error_clear(&f->ctx);
    }
}

static void spoil(struct fixture *f, const char *name, size_t row)
{
    struct brc_table *t = &f->sim.pairs.model;
    for (int k = 0; k < t->set.n; k++)
        if (strcmp(t->set.fields[k].name, name) == 0)
            ((double *)brc_table_column(t, k))[row * (size_t)t->set.fields[k].width] = NAN;
}

/* A contact whose force is no number is named in the step that computes it, by both bodies. */
static void test_force_that_is_no_number(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        char body[40], other[40];
        start(f, i);
        fixture_steps(f, 2);
        size_t row = f->sim.pairs.n / 2;
        snprintf(body, sizeof body, ": grain %d at ", f->sim.pairs.a[row]);
        snprintf(other, sizeof other, "contact with grain %d (", f->sim.pairs.b[row]);
        spoil(f, spoilt[i].spoils, row);
        assert_int_equal(steps_to_failure(f, 1), 3);
        expect_text(&f->ctx, body);
        expect_text(&f->ctx, other);
        expect_text(&f->ctx, "has a velocity that is no number");
        expect_text(&f->ctx, "nan N, stiffness ");
        brc_error_clear(&f->ctx);
    }
}

/* Just below the limit nothing is reported; above it the growth is, long before grains fly. */
static void test_growth_of_energy(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        start(f, i);
        f->sim.dt = 0.98 * f->sim.dt_limit;
        assert_int_equal(steps_to_failure(f, 400), 0);
        start(f, i);
        f->sim.dt = 1.5 * f->sim.dt_limit;
        assert_true(steps_to_failure(f, 400) > 0);
        expect_text(&f->ctx, " of the kinetic energy of ");
        expect_text(&f->ctx, "was given only ");
        for (size_t k = 0; k < f->sim.bodies.n_grains; k++)
            CHECK_BETWEEN(f->sim.bodies.path_length[k], 0, 0.1 * f->sim.skin);
        brc_error_clear(&f->ctx);
    }
}

/* Without the ledger nothing is known of energy; motion is still seen. */
static void test_motion(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        fixture_grid(f, 3, 3, 3, 0.01, 0.4);
        fixture_free_sim(f, model_of(i), spoilt[i].unbreakable, "ledger: off; dt: 1e-9 s");
        stir(f);
        f->sim.dt = 2 * f->sim.dt_limit;
        assert_true(steps_to_failure(f, 2000) > 0);
        expect_text(&f->ctx, " at once (4 skins of ");
        expect_text(&f->ctx, "lower run.dt (now 1e-09 s, the stable limit was ");
        brc_error_clear(&f->ctx);
    }
}

static void test_platen_that_is_too_fast(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        fixture_grid(f, 3, 3, 3, 0.01, 0.4);
        fixture_sim(f, model_of(i), "", "loading: fixed; rate: 0.5 1/s; strain_max: 0.9", "");
        assert_int_equal(steps_to_failure(f, 1), 1);
        expect_text(&f->ctx, "platen 27 at ");
        expect_text(&f->ctx, "its contact with grain ");
        expect_text(&f->ctx, "raise run.mass_margin (now 1.2), load more slowly (test.rate");
        brc_error_clear(&f->ctx);
    }
}

/* Bodies at rest have round-off, not energy. */
static void test_rest_is_no_growth(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_MODELS; i++) {
        fixture_grid(f, 3, 3, 3, 0.01, 0.4);
        fixture_free_sim(f, model_of(i), "", "");
        for (size_t k = 0; k < 27; k++)
            f->sim.bodies.v[k][0] = 1e-12 * (double)k;
        assert_int_equal(steps_to_failure(f, 100), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(test_velocity_that_is_no_number), FIXTURE_TEST(test_force_that_is_no_number),
        FIXTURE_TEST(test_growth_of_energy),           FIXTURE_TEST(test_motion),
        FIXTURE_TEST(test_platen_that_is_too_fast),    FIXTURE_TEST(test_rest_is_no_growth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
