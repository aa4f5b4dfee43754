/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calibration: target files, the uniform-strain moduli and their inverse, the first guesses, and
 * the objective with formulas in place of simulations. */
#include "common/rigs/rigs.h"
#include "calib/guess.h"
#include "calib/objective.h"
#include "common/engine/model.h"
#include "tests/near.h"
#include "tests/param_lists.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;

/* ---- target files -------------------------------------------------------------------------- */

static double target_value(const struct calib_targets *t, enum calib_quantity_code quantity)
{
    const struct calib_target *found = calib_targets_find(t, quantity);
    assert_non_null(found);
    assert_true(found->source[0] != '\0');
    return found->value;
}

static void target_files_are_read(void **state)
{
    struct calib_targets t;
    (void)state;
    CHECK_OK(&ctx, calib_targets_read(&ctx, "calib/targets/augig.yaml", &t));
    assert_string_equal(t.title, "Augig granite");
    assert_int_equal(t.n, 6);
    assert_true(target_value(&t, CALIB_YOUNGS_MODULUS) == 25.8e9);
    assert_true(target_value(&t, CALIB_POISSON_RATIO) == 0.23);
    assert_true(target_value(&t, CALIB_STRENGTH) == 122.1e6);
    assert_true(target_value(&t, CALIB_BRAZILIAN_STRENGTH) == 8.8e6);
    assert_true(target_value(&t, CALIB_COHESION) == 21e6);
    CHECK_NEAR(target_value(&t, CALIB_FRICTION_ANGLE), 53 * BRC_PI / 180, 0, 1e-15);
    assert_null(calib_targets_find(&t, CALIB_TENSILE_STRENGTH));
    assert_true(calib_targets_find(&t, CALIB_STRENGTH)->deviation == 0);
    CHECK_OK(&ctx, calib_targets_read(&ctx, "calib/targets/lac_du_bonnet.yaml", &t));
    assert_true(target_value(&t, CALIB_TENSILE_STRENGTH) == 6.9e6);
    assert_true(target_value(&t, CALIB_DENSITY) == 2638);
    assert_true(target_value(&t, CALIB_POISSON_RATIO) == 0.31);
    assert_true(calib_targets_find(&t, CALIB_STRENGTH)->deviation == 22e6);
}

static void check_bad_targets(const char *text, const char *message)
{
    char path[] = "/tmp/breccia_test_target_XXXXXX";
    struct calib_targets t;
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), strlen(text));
    close(file);
    int code = calib_targets_read(&ctx, path, &t);
    unlink(path);
    CHECK_FAILS(&ctx, code, BRC_ERR_INPUT, message);
}

static void bad_targets_are_named(void **state)
{
    (void)state;
    check_bad_targets("breccia: 1\n", ": no target; write at least one section such as");
    check_bad_targets("breccia: 1\nyoung_modulus: {value: 1 GPa}\n",
                      ":2: young_modulus: unknown section; allowed youngs_modulus, poisson_ratio");
    check_bad_targets("breccia: 1\nyoung_modulus: {}\n", "; did you mean 'youngs_modulus'?");
    check_bad_targets("breccia: 1\nstrength: {deviation: 1 GPa}\n",
                      ":2: strength.value: required key is missing (unconfined compressive "
                      "strength); allowed (0, inf), unit Pa");
    check_bad_targets("breccia: 1\nstrength: {value: 122.1}\n",
                      ":2: strength.value: '122.1' has no "
                      "unit");
    check_bad_targets("breccia: 1\npoisson_ratio: {value: 0.5}\n",
                      ":2: poisson_ratio.value: 0.5 is out of range; allowed (-1, 0.5)");
    check_bad_targets("breccia: 1\nstrength: {value: 1 GPa, deviation: 3 mm}\n",
                      ":2: strength.deviation: the unit 'mm' has the wrong dimension");
}

/* ---- moduli -------------------------------------------------------------------------------- */

/* Linear contacts: the two closed forms. */
static void linear_moduli_are_the_closed_forms(void **state)
{
    (void)state;
    for (int i = 0; i <= 20; i++) {
        double eta = 0.1 * i, e, nu;
        struct calib_stiffness s = {2e9, 2e9, 2e9 * eta, 2e9 * eta};
        CHECK_OK(&ctx, calib_moduli(&ctx, &s, &e, &nu));
        CHECK_NEAR(e, 2e9 * (2 + 3 * eta) / (4 + eta), 0, 1e-13);
        CHECK_NEAR(nu, (1 - eta) / (4 + eta), 1e-14, 0);
    }
}

/* Stress of a uniform strain by summing over directions: no integral of the code is used. */
static void sum_over_directions(const struct calib_stiffness *s, double nu, double stress[2])
{
    const int n = 200000;
    stress[0] = stress[1] = 0;
    for (int i = 0; i < n; i++) {
        double u = (i + 0.5) / n, opening = nu * (1 - u * u) - u * u;
        double slip = -(1 + nu) * u * sqrt(1 - u * u); /* axial minus lateral motion */
        double kn = opening > 0 ? s->n_open : s->n_closed;
        double kt = opening > 0 ? s->t_open : s->t_closed;
        double across = sqrt(1 - u * u);
        stress[0] += 3.0 / n * (kn * opening * u * u + kt * slip * u * across);
        stress[1] += 1.5 / n * (kn * opening * (1 - u * u) - kt * slip * u * across);
    }
}

static void bimodular_moduli_balance(void **state)
{
    static const struct calib_stiffness cases[] = {
        {1e9, 3e9, 1e8, 6e8}, {3e9, 1e9, 6e8, 1e8}, {1e9, 1e9, 0, 5e7}, {1e7, 1e9, 0, 0}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        double e, nu, stress[2];
        CHECK_OK(&ctx, calib_moduli(&ctx, &cases[i], &e, &nu));
        sum_over_directions(&cases[i], nu, stress);
        CHECK_NEAR(-stress[0], e, 0, 2e-6);
        CHECK_NEAR(stress[1], 0, 2e-6 * e, 0);
    }
}

static void inversion_is_exact(void **state)
{
    static const double ratio[][2] = {{1, 1}, {1, 0.5}, {0.2, 0.3}, {5, 0.9}, {1, 0.01}};
    (void)state;
    for (int r = 0; r < 5; r++)
        for (int i = 1; i < 24; i++) {
            double nu = 0.01 * i;
            struct calib_inverse how = {ratio[r][0], ratio[r][1], 1e-3, false};
            struct calib_stiffness s;
            double e, back;
            int code = calib_moduli_invert(&ctx, 25.8e9, nu, &how, &s);
            if (code != 0) { /* out of reach of this ratio */
                assert_int_not_equal(r, 0);
                brc_error_clear(&ctx);
                continue;
            }
            CHECK_OK(&ctx, calib_moduli(&ctx, &s, &e, &back));
            CHECK_NEAR(e, 25.8e9, 0, 1e-13);
            CHECK_NEAR(back, nu, 1e-14, 0);
            CHECK_NEAR(s.n_open, s.n_closed * ratio[r][0], 0, 1e-14);
            CHECK_NEAR(s.t_open, s.t_closed * ratio[r][1], 0, 1e-14);
        }
    struct calib_inverse linear = {1, 1, 1e-3, false};
    struct calib_stiffness s;
    CHECK_OK(&ctx, calib_moduli_invert(&ctx, 1, 0.23, &linear, &s));
    CHECK_NEAR(s.t_closed / s.n_closed, (1 - 4 * 0.23) / 1.23, 0, 1e-13);
}

static void out_of_reach_is_said(void **state)
{
    struct calib_inverse how = {1, 1, 0.02, false};
    struct calib_stiffness s, bad = {0, 1, 1, 1};
    double e, nu;
    (void)state;
    CHECK_FAILS(
        &ctx, calib_moduli_invert(&ctx, 1e9, 0.31, &how, &s), BRC_ERR_INPUT,
        "Poisson's ratio 0.31 is out of reach of a uniform strain; allowed [0.0000, 0.2438] "
        "for shear over normal stiffness from 1 to 0.02; `nearest`");
    CHECK_FAILS(&ctx, calib_moduli_invert(&ctx, 1e9, -0.1, &how, &s), BRC_ERR_INPUT,
                "out of reach");
    how.is_nearest = true;
    CHECK_OK(&ctx, calib_moduli_invert(&ctx, 1e9, 0.31, &how, &s));
    CHECK_NEAR(s.t_closed / s.n_closed, 0.02, 0, 1e-14);
    CHECK_OK(&ctx, calib_moduli(&ctx, &s, &e, &nu));
    CHECK_NEAR(e, 1e9, 0, 1e-13);
    CHECK_NEAR(nu, 0.98 / 4.02, 1e-14, 0);
    CHECK_OK(&ctx, calib_moduli_invert(&ctx, 1e9, -0.1, &how, &s));
    CHECK_NEAR(s.t_closed / s.n_closed, 1, 0, 1e-14);
    CHECK_FAILS(&ctx, calib_moduli(&ctx, &bad, &e, &nu), BRC_ERR_INPUT, "give no uniaxial test");
}

/* ---- guesses ------------------------------------------------------------------------------- */

static const struct calib_fabric unit_fabric = {.n_contacts = 10,
                                                .mean_distance = 5.1017e-3,
                                                .coverage = 1,
                                                .bond = 1,
                                                .corners = 50,
                                                .stretch = 1};

static struct calib_guess_params default_params(void)
{
    struct calib_guess_params params;
    CHECK_OK(&ctx, brc_params_defaults(&ctx, calib_guess_param_list, &params));
    return params;
}

static const struct calib_value *find_value(const struct calib_guess *g, const char *key)
{
    for (size_t i = 0; i < g->n; i++)
        if (strcmp(g->value[i].key, key) == 0)
            return &g->value[i];
    return NULL;
}

static double guessed(const struct calib_guess *g, const char *key)
{
    const struct calib_value *v = find_value(g, key);
    assert_non_null(v);
    return v ? v->value : NAN;
}

static void rock_needs_its_values(void **state)
{
    struct calib_targets t = {.title = "X", .n = 1};
    struct calib_rock rock;
    (void)state;
    t.target[0] = (struct calib_target){CALIB_YOUNGS_MODULUS, 1e9, 0, ""};
    CHECK_FAILS(&ctx, calib_rock_from_targets(&ctx, &t, &rock), BRC_ERR_INPUT,
                "X has no poisson_ratio");
    t.target[1] = (struct calib_target){CALIB_POISSON_RATIO, 0.2, 0, ""};
    t.n = 2;
    CHECK_FAILS(&ctx, calib_rock_from_targets(&ctx, &t, &rock), BRC_ERR_INPUT,
                "X has neither tensile_strength nor brazilian_strength");
    t.target[2] = (struct calib_target){CALIB_BRAZILIAN_STRENGTH, 10e6, 0, ""};
    t.n = 3;
    CHECK_OK(&ctx, calib_rock_from_targets(&ctx, &t, &rock));
    assert_true(rock.is_tension_estimated && rock.cohesion == 0 && rock.strength == 0);
    CHECK_NEAR(rock.tension, 7.7e6, 0, 1e-15);
    t.target[3] = (struct calib_target){CALIB_TENSILE_STRENGTH, 9e6, 0, ""};
    t.n = 4;
    CHECK_OK(&ctx, calib_rock_from_targets(&ctx, &t, &rock));
    assert_true(!rock.is_tension_estimated && rock.tension == 9e6);
}

/* The forward formulas with the guess give back what was asked. */
static void vgcm_guess_inverts(void **state)
{
    struct calib_guess_params params = default_params();
    struct calib_fabric fabric = unit_fabric;
    struct calib_rock rock = {25.8e9, 0.2, 7e6, 122e6, 0, 0, false};
    struct calib_guess g;
    (void)state;
    fabric.coverage = 0.9;
    CHECK_OK(&ctx, calib_guess_vgcm(&ctx, &rock, &fabric, &params, &g));
    double e_bar = guessed(&g, "e_bar"), eta = guessed(&g, "eta");
    CHECK_NEAR(0.9 * e_bar * (2 + 3 * eta) / (4 + eta), rock.e, 0, 1e-13);
    CHECK_NEAR((1 - eta) / (4 + eta), rock.nu, 1e-14, 0);
    assert_true(g.nu_misfit < 1e-14 && g.nu_misfit > -1e-14);
    CHECK_NEAR(guessed(&g, "sigma_t") * rock.e / e_bar, rock.tension, 0, 1e-13);
    CHECK_NEAR(guessed(&g, "tau"), 122e6 / 1.29, 0, 1e-13);
    /* sigma^2 d / (2 E-bar) is the elastic energy of a point, per area */
    double d = fabric.mean_distance, sigma = guessed(&g, "sigma_t"), tau = guessed(&g, "tau");
    CHECK_NEAR(guessed(&g, "g_fn"), 9.5 * sigma * sigma * d / (2 * e_bar), 0, 1e-13);
    CHECK_NEAR(guessed(&g, "g_fs"), 9.5 * tau * tau * d / (2 * e_bar * eta), 0, 1e-13);
    assert_null(find_value(&g, "mu"));
    assert_non_null(strstr(g.note, "Friction of contacts not guessed"));
}

/* Augig granite against the paper's own set: what the estimate is worth. */
static void augig_guess_is_near_the_paper(void **state)
{
    struct calib_guess_params params = default_params();
    struct calib_targets t;
    struct calib_rock rock;
    struct calib_guess g;
    (void)state;
    CHECK_OK(&ctx, calib_targets_read(&ctx, "calib/targets/augig.yaml", &t));
    CHECK_OK(&ctx, calib_rock_from_targets(&ctx, &t, &rock));
    CHECK_OK(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g));
    CHECK_BETWEEN(guessed(&g, "e_bar") / 48.8e9, 0.9, 1.1);
    CHECK_BETWEEN(guessed(&g, "eta"), 0.05, 0.13);
    CHECK_BETWEEN(guessed(&g, "sigma_t") / 11.4e6, 0.9, 1.2);
    CHECK_BETWEEN(guessed(&g, "tau") / 88.5e6, 0.8, 1.2);
    CHECK_BETWEEN(guessed(&g, "mu"), 0.05, 0.3);
    assert_non_null(strstr(g.note, "of the Brazilian strength"));
    assert_non_null(strstr(g.note, "tau = cohesion"));
}

static void nearest_guess_states_its_misfit(void **state)
{
    struct calib_guess_params params = default_params();
    struct calib_targets t;
    struct calib_rock rock;
    struct calib_guess g;
    (void)state;
    CHECK_OK(&ctx, calib_targets_read(&ctx, "calib/targets/lac_du_bonnet.yaml", &t));
    CHECK_OK(&ctx, calib_rock_from_targets(&ctx, &t, &rock));
    CHECK_FAILS(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g), BRC_ERR_INPUT,
                "Poisson's ratio 0.31 is out of reach");
    params.nearest = 1;
    CHECK_OK(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g));
    CHECK_NEAR(g.nu_misfit, 0.98 / 4.02 - 0.31, 1e-12, 0);
    CHECK_NEAR(g.e, 66.5e9, 0, 1e-12);
    assert_non_null(strstr(g.note, "out of reach; the nearest is 0.2438, off by -0.0662"));
    rock.friction_angle = 0.5;
    CHECK_OK(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g));
    assert_true(guessed(&g, "mu") == 0);
    assert_non_null(strstr(g.note, "Friction angle is out of reach"));
    params.nearest = 0;
    rock.nu = 0.2;
    CHECK_FAILS(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g), BRC_ERR_INPUT,
                "below the 42 deg that interlocked facets give without friction");
}

static void polyhedra_guess_inverts(void **state)
{
    struct calib_guess_params params = default_params();
    struct calib_fabric f = unit_fabric;
    struct calib_rock rock = {25.8e9, 0.2, 7e6, 0, 0, 0, false};
    struct calib_guess g;
    double e, nu;
    (void)state;
    f.bond = 3;
    f.stretch = 4;
    params.features = 1.5;
    params.bond_ratio = 0.8;
    CHECK_OK(&ctx, calib_guess_polyhedra(&ctx, &rock, &f, &params, &g));
    double corners = 1.5 * f.corners, bt = guessed(&g, "bt") * f.bond;
    struct calib_stiffness s = {guessed(&g, "bn") * f.bond, guessed(&g, "kn") * corners, bt,
                                bt + guessed(&g, "kt") * corners};
    CHECK_OK(&ctx, calib_moduli(&ctx, &s, &e, &nu));
    CHECK_NEAR(e, rock.e, 0, 1e-13);
    CHECK_NEAR(nu, rock.nu, 1e-14, 0);
    CHECK_NEAR(s.n_open / s.n_closed, 0.8, 0, 1e-13);
    CHECK_NEAR(s.t_open / s.t_closed, 0.5, 0, 1e-13);
    /* no bond of any direction is above its threshold at the tensile strength, one is at it */
    struct calib_stiffness swapped = {s.n_closed, s.n_open, s.t_closed, s.t_open};
    CHECK_OK(&ctx, calib_moduli(&ctx, &swapped, &e, &nu));
    double largest = 0;
    for (int i = 0; i <= 100000; i++) {
        double u = i / 100000.0, opening = u * u - nu * (1 - u * u);
        double sum = (opening > 0 ? opening : 0) + (1 + nu) * u * sqrt(1 - u * u);
        largest = sum > largest ? sum : largest;
    }
    CHECK_NEAR(guessed(&g, "eps_th"), f.stretch * largest * rock.tension / e, 0, 1e-9);
}

/* The keys are those of the registered models, and the values lie in their ranges. */
static void guesses_fit_the_models(void **state)
{
    struct calib_guess_params params = default_params();
    struct calib_rock rock = {25.8e9, 0.2, 7e6, 122e6, 21e6, 0.9, false};
    struct calib_guess g;
    (void)state;
    CHECK_OK(&ctx, param_list_check(&ctx, "guess", calib_guess_param_list));
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        if (strcmp(model->name, "vgcm") == 0)
            CHECK_OK(&ctx, calib_guess_vgcm(&ctx, &rock, &unit_fabric, &params, &g));
        else if (strcmp(model->name, "polyhedra") == 0)
            CHECK_OK(&ctx, calib_guess_polyhedra(&ctx, &rock, &unit_fabric, &params, &g));
        else
            continue;
        void *values = calloc(1, model->params.owner_size);
        for (size_t k = 0; k < g.n; k++) {
            char text[64];
            bool is_pure = strcmp(g.value[k].unit, "1") == 0;
            snprintf(text, sizeof text, "%.17g %s", g.value[k].value,
                     is_pure ? "" : g.value[k].unit);
            CHECK_OK(&ctx, brc_params_set(&ctx, model->params, values, model->name, g.value[k].key,
                                          text, "guess"));
        }
        free(values);
    }
}

/* ---- objective ----------------------------------------------------------------------------- */

/* A rock with formulas: E = a, nu = b, strengths in fixed ratios to a. */
struct fake {
    int n_runs[16];
    const char *lost; /* a result that is not reported */
    double bad;       /* value of nu when not 0 */
};

static void fake_result(struct brc_summary *out, const struct fake *f, const char *name,
                        double value, const char *unit)
{
    if (f->lost && strcmp(f->lost, name) == 0)
        return;
    out->results[out->n_results++] =
        (struct brc_result){.name = name, .value = value, .unit = unit};
}

static int fake_run(struct brc_context *c, void *user, const struct calib_trial *trial,
                    struct brc_summary *out)
{
    struct fake *f = user;
    assert_string_equal(trial->model, "fake");
    assert_int_equal(trial->n, 2);
    assert_string_equal(trial->variables[0].key, "a");
    f->n_runs[trial->test]++;
    out->cpu_s = 2;
    if (trial->x[0] > 1e12)
        BRC_FAIL(c, BRC_ERR_BLOWUP, "blown up");
    if (trial->test == brc_rigs_find("compression")) {
        fake_result(out, f, "E", trial->x[0], "Pa");
        fake_result(out, f, "nu", f->bad != 0 ? f->bad : trial->x[1], "1");
    }
    fake_result(out, f, "strength",
                trial->x[0] / (trial->test == brc_rigs_find("compression") ? 200 : 4000), "Pa");
    return 0;
}

static struct calib_targets fake_targets(void)
{
    struct calib_targets t = {.title = "fake rock", .n = 5};
    t.target[0] = (struct calib_target){CALIB_YOUNGS_MODULUS, 20e9, 1e9, ""};
    t.target[1] = (struct calib_target){CALIB_POISSON_RATIO, 0.2, 0, ""};
    t.target[2] = (struct calib_target){CALIB_STRENGTH, 100e6, 0, ""};
    t.target[3] = (struct calib_target){CALIB_TENSILE_STRENGTH, 5e6, 0.5e6, ""};
    t.target[4] = (struct calib_target){CALIB_DENSITY, 2600, 0, ""};
    return t;
}

static const struct calib_variable fake_variables[] = {{"a", 1e9, 1e13}, {"b", 0, 0.5}};

static void objective_weighs_residuals(void **state)
{
    struct calib_targets t = fake_targets();
    struct fake fake = {{0}, NULL, 0};
    struct calib_objective o = {"fake", &t, 2, fake_variables, 0.05, {fake_run, &fake}};
    struct calib_evaluation v;
    (void)state;
    assert_int_equal(calib_objective_size(&o), 4);
    CHECK_OK(&ctx, calib_objective_evaluate(&ctx, &o, (const double[]){20e9, 0.2}, &v));
    assert_true(v.cost == 0 && v.n == 4);
    CHECK_OK(&ctx, calib_objective_evaluate(&ctx, &o, (const double[]){22e9, 0.21}, &v));
    assert_int_equal(v.n, 4);
    CHECK_NEAR(v.residual[0].residual, 2, 0, 1e-14);
    CHECK_NEAR(v.residual[1].residual, 1, 0, 1e-12);
    CHECK_NEAR(v.residual[2].residual, 2, 0, 1e-12);
    CHECK_NEAR(v.residual[3].residual, 1, 0, 1e-12);
    CHECK_NEAR(v.cost, 0.5 * (4 + 1 + 4 + 1), 0, 1e-12);
    CHECK_NEAR(v.residual[3].deviation, 0.5e6, 0, 0);
    CHECK_NEAR(v.residual[2].deviation, 5e6, 0, 1e-15);
    assert_int_equal(v.residual[3].quantity, CALIB_TENSILE_STRENGTH);
    /* each test once an evaluation, the Brazilian one not at all */
    assert_int_equal(fake.n_runs[brc_rigs_find("compression")], 2);
    assert_int_equal(fake.n_runs[brc_rigs_find("tension")], 2);
    assert_int_equal(fake.n_runs[brc_rigs_find("brazilian")], 0);
    assert_int_equal(v.n_runs, 2);
    CHECK_NEAR(v.cpu_s, 4, 0, 0);
}

static void objective_errors_are_named(void **state)
{
    struct calib_targets t = fake_targets();
    struct fake fake = {{0}, "nu", 0};
    struct calib_objective o = {"fake", &t, 2, fake_variables, 0.05, {fake_run, &fake}};
    struct calib_evaluation v;
    const double x[] = {20e9, 0.2};
    (void)state;
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT,
                "the compression test of fake gave no nu");
    fake = (struct fake){{0}, NULL, NAN};
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT, "gave no nu");
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, (const double[]){20e9, 0.51}, &v),
                BRC_ERR_INPUT, "fake.b = 0.51 is outside its bounds [0, 0.5]");
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, (const double[]){NAN, 0.2}, &v),
                BRC_ERR_INPUT, "fake.a = nan is outside its bounds");
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, (const double[]){2e12, 0.2}, &v),
                BRC_ERR_BLOWUP, "blown up");
    fake = (struct fake){{0}, NULL, 0};
    t.target[1].value = 0;
    CHECK_FAILS(&ctx, calib_objective_evaluate(&ctx, &o, x, &v), BRC_ERR_INPUT,
                "the target poisson_ratio is 0 and has no deviation");
}

static void objective_is_checked(void **state)
{
    static const struct brc_param params[] = {
        {"a", BRC_REAL, 0, "Pa", "1 Pa", NULL, NULL, 0, .meaning = "a"},
        {"b", BRC_REAL, 0, "1", "1", NULL, NULL, 8, .meaning = "b"},
        {"count", BRC_INT, 0, "1", "1", NULL, NULL, 16, .meaning = "n"},
    };
    struct brc_param_list list = {params, 3, 24};
    struct calib_targets t = fake_targets();
    struct calib_variable bad[] = {{"a", 1, 2}, {"b", 1, 2}, {"b", 1, 2}};
    struct calib_objective o = {"fake", &t, 2, fake_variables, 0.05, {NULL, NULL}};
    (void)state;
    CHECK_OK(&ctx, calib_objective_check(&ctx, &o, list));
    o.variables = bad;
    o.n = 3;
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "fake.b is a variable twice");
    bad[2] = (struct calib_variable){"count", 1, 2};
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "fake.count is not a quantity of the model");
    bad[2] = (struct calib_variable){"cuont", 1, 2};
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "; did you mean 'count'?");
    bad[1].high = 1;
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "fake.b has the bounds 1 and 1 1; allowed finite bounds");
    o.n = 5;
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "5 variables for 4 targets");
    o.n = 1;
    o.relative_deviation = 0;
    CHECK_FAILS(&ctx, calib_objective_check(&ctx, &o, list), BRC_ERR_INPUT,
                "the relative deviation 0 of targets");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(target_files_are_read),
        cmocka_unit_test(bad_targets_are_named),
        cmocka_unit_test(linear_moduli_are_the_closed_forms),
        cmocka_unit_test(bimodular_moduli_balance),
        cmocka_unit_test(inversion_is_exact),
        cmocka_unit_test(out_of_reach_is_said),
        cmocka_unit_test(rock_needs_its_values),
        cmocka_unit_test(vgcm_guess_inverts),
        cmocka_unit_test(augig_guess_is_near_the_paper),
        cmocka_unit_test(nearest_guess_states_its_misfit),
        cmocka_unit_test(polyhedra_guess_inverts),
        cmocka_unit_test(guesses_fit_the_models),
        cmocka_unit_test(objective_weighs_residuals),
        cmocka_unit_test(objective_errors_are_named),
        cmocka_unit_test(objective_is_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
