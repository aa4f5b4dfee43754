/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rock of the defaults: what a case without a section for its model gives, at any grain size.
 */
#include "common/runs/case.h"
#include "polyhedra/poly.h"
#include "tests/fixture.h"
#include "vgcm/vgcm.h"

#include <stdio.h>

static const char *const models[] = {"polyhedra", "vgcm"};
enum { N_MODELS = 2 };

struct rock {
    double e, nu, strength;
};

static double result(const struct fixture *f, const char *name)
{
    struct brc_result r[BRC_MAX_RESULTS];
    int n = brc_rigs_results(&f->sim, r);
    for (int i = 0; i < n; i++)
        if (strcmp(r[i].name, name) == 0)
            return r[i].value;
    return NAN;
}

/* Unconfined compression (or another test) with nothing but defaults, to its end. */
static struct rock break_sample(struct fixture *f, const char *model, const char *specimen,
                                const char *test)
{
    if (f->has_specimen)
        brc_specimen_free(&f->specimen);
    fixture_specimen(f, specimen);
    fixture_sim(f, brc_registry_find(model), "", test, "");
    while (!brc_rigs_done(&f->sim))
        CHECK_OK(&f->ctx, brc_sim_step(&f->sim));
    return (struct rock){result(f, "E"), result(f, "nu"), result(f, "strength")};
}

/* Augig granite: E 25.8 GPa, nu 0.23, 122.1 MPa. Other seeds: 3 % and 7 % up or down. */
static void nothing_given_is_a_granite(void **state)
{
    for (int i = 0; i < N_MODELS; i++) {
        struct rock rock =
            break_sample(*state, models[i], "diameter: 32 mm; height: 64 mm; sides: 64", "");
        CHECK_NEAR(rock.e, 25.8e9, 0, 0.1);
        CHECK_NEAR(rock.nu, 0.23, 0.04, 0);
        CHECK_NEAR(rock.strength, 122.1e6, 0, 0.2);
    }
}

/* Moduli and strengths do not know the grain size, which is 10 mm, 10 um or 10 m. The factors are
 * powers of two, so that nothing is rounded in another way: breaking would make much of it. */
static void defaults_scale_with_the_grains(void **state)
{
    static const double factor[] = {1, 1.0 / 1024, 1024};
    char specimen[240];
    for (int i = 0; i < N_MODELS; i++) {
        struct rock rock[3];
        for (int k = 0; k < 3; k++) {
            double side = 0.03 * factor[k], height = 0.05 * factor[k];
            snprintf(specimen, sizeof specimen,
                     "shape: box; size: %.17g m, %.17g m, %.17g m; grains: grid; cells: 3, 3, 5; "
                     "jitter: 0.5",
                     side, side, height);
            rock[k] = break_sample(*state, models[i], specimen, "kind: tension; strain_max: 0.005");
            assert_true(isfinite(rock[k].e) && isfinite(rock[k].strength));
            assert_true(rock[k].e == rock[0].e && rock[k].nu == rock[0].nu);
            assert_true(rock[k].strength == rock[0].strength);
        }
    }
}

/* What is given by hand stays as it is, and what is not follows from the grains: cubes of 1 cm have
 * facets of 1 cm2 between centres 1 cm apart. */
static void given_values_win(void **state)
{
    struct fixture *f = *state;
    const struct poly_params *p;
    fixture_grid(f, 2, 2, 2, 0.01, 0);
    fixture_sim(f, brc_registry_find("polyhedra"), "kn_modulus: 5 GPa; kt_ratio: 0.25", "", "");
    p = f->sim.params;
    CHECK_NEAR(p->kn, 5e7, 0, 1e-9);
    CHECK_NEAR(p->kt, 1.25e7, 0, 1e-9);
    CHECK_NEAR(p->radius, 5e-4, 0, 1e-9);
    fixture_sim(f, brc_registry_find("polyhedra"), "kn: 3e6 N/m; kt: 0 N/m; radius: 0.3 mm", "",
                "");
    p = f->sim.params;
    assert_true(p->kn == 3e6 && p->kt == 0 && p->radius == 0.3e-3);
}

/* Energies of the published set, which has contacts of 5.1017 mm; half of them at half the size. */
static void energies_follow_the_distance(void **state)
{
    struct fixture *f = *state;
    const struct vgcm_params *p;
    fixture_grid(f, 2, 2, 2, 5.1017e-3 / 2, 0);
    fixture_sim(f, brc_registry_find("vgcm"), "", "", "");
    p = f->sim.params;
    CHECK_NEAR(p->g_fn, 64.6 / 2, 0, 2e-3);
    CHECK_NEAR(p->g_fs, 31114.4 / 2, 0, 2e-3);
    fixture_sim(f, brc_registry_find("vgcm"), "g_fn: 70 J/m2", "", "");
    p = f->sim.params;
    assert_true(p->g_fn == 70);
}

/* The run header says what came out. */
static void header_names_the_stiffness(void **state)
{
    struct fixture *f = *state;
    char text[2048];
    fixture_grid(f, 2, 2, 2, 0.01, 0);
    fixture_sim(f, brc_registry_find("polyhedra"), "kn_modulus: 5 GPa", "", "");
    f->sim.model.describe(&f->sim, f->sim.state, text, sizeof text);
    assert_non_null(strstr(text, "K_n = 5e+07 N/m"));
    assert_non_null(strstr(text, "by kn_modulus"));
    assert_non_null(strstr(text, "R = 0.0005 m"));
}

/* Sides of a cylinder go by the test: corners of the outer facets are springs of polyhedra. */
static void sides_go_by_the_test(void **state)
{
    static const struct {
        const char *specimen, *test;
        int sides;
    } cases[] = {{"", "compression", 64},
                 {"", "tension", 64},
                 {"", "brazilian", 0}, /* as brc_specimen_create chooses */
                 {"sides: 100", "compression", 100},
                 {"grains: mesh", "compression", 0}};
    struct fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct brc_case run_case;
        char text[160];
        snprintf(text, sizeof text, "breccia: 1\nspecimen: {%s}\ntest: {kind: %s}\n",
                 cases[i].specimen, cases[i].test);
        CHECK_OK(&f->ctx, brc_case_parse(&f->ctx, &run_case, "case", text));
        assert_int_equal(run_case.specimen.sides, cases[i].sides);
        brc_case_free(&run_case);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(nothing_given_is_a_granite),
                                       FIXTURE_TEST(defaults_scale_with_the_grains),
                                       FIXTURE_TEST(given_values_win),
                                       FIXTURE_TEST(sides_go_by_the_test),
                                       FIXTURE_TEST(energies_follow_the_distance),
                                       FIXTURE_TEST(header_names_the_stiffness)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
