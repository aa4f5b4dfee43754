/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The uniform-strain sums of the first guess against the models: a block whose grains all follow
 * one uniform strain stores the energy that the sums say. */
#include "calib/fabric.h"
#include "tests/fixture.h"

#include <stdio.h>

/* Energy stored after one step of uniform isotropic strain. */
static double strained(struct fixture *f, const char *model, const char *settings, double strain)
{
    const double still[3] = {0, 0, 0};
    fixture_free_sim(f, brc_registry_find(model), settings, "ledger: off");
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        double v[3];
        brc_scale(v, f->sim.bodies.x[i], strain);
        fixture_velocity(f, i, v, still);
    }
    fixture_carry(f, 1);
    return fixture_stored(f);
}

static struct calib_fabric measure(struct fixture *f, const struct calib_fabric_rules *rules)
{
    struct calib_fabric fabric;
    CHECK_OK(&f->ctx, calib_fabric_measure(&f->ctx, &f->specimen.facets, rules, &fabric));
    return fabric;
}

/* Normal stiffness N [Pa] that an energy means: W = 3/2 V N strain^2. */
static double stiffness(const struct calib_fabric *fabric, double energy, double strain)
{
    return energy / (1.5 * fabric->volume * strain * strain);
}

static void bonds_store_what_the_sum_says(void **state)
{
    static const char *const settings[] = {
        "bn: 20 GPa; strain_length: centres; area: facet; radius: 1 mm; bt: 0 Pa; breakable: off",
        "bn: 20 GPa; strain_length: gap; area: eroded; radius: 1 mm; bt: 0 Pa; breakable: off",
        "bn: 20 GPa; strain_length: gap; area: facet; radius: 0.5 mm; bt: 0 Pa; breakable: off"};
    static const struct calib_fabric_rules rules[] = {{HUGE_VAL, 1e-3, false, false},
                                                      {HUGE_VAL, 1e-3, true, true},
                                                      {HUGE_VAL, 0.5e-3, false, true}};
    struct fixture *f = *state;
    fixture_grid(f, 5, 5, 5, 0.01, 1);
    for (int i = 0; i < 3; i++) {
        struct calib_fabric fabric = measure(f, &rules[i]);
        double n = stiffness(&fabric, strained(f, "polyhedra", settings[i], 1e-5), 1e-5);
        CHECK_NEAR(n, 20e9 * fabric.bond, 0, 1e-6);
    }
}

/* Feature pairs per corner, the table of docs/calibration.md. */
static void corners_count_by_rule(void **state)
{
    static const struct {
        const char *rule, *radius;
        double low, high; /* over strains from 1e-5 to 1e-3 */
    } rows[] = {{"merged", "0.2 mm", 0.35, 0.75}, {"strict", "0.2 mm", 0.9, 1},
                {"closed", "0.2 mm", 1, 6},       {"merged", "1 mm", 0.25, 0.5},
                {"strict", "1 mm", 0.7, 0.85},    {"closed", "1 mm", 0.8, 3}};
    const struct calib_fabric_rules all = {.gap = HUGE_VAL};
    struct fixture *f = *state;
    fixture_grid(f, 5, 5, 5, 0.01, 1);
    struct calib_fabric fabric = measure(f, &all);
    for (int i = 0; i < 6; i++)
        for (double strain = 1e-5; strain < 2e-3; strain *= 10) {
            char settings[160];
            snprintf(settings, sizeof settings,
                     "features: %s; radius: %s; kn: 1e8 N/m; kt: 0 N/m; bt: 0 Pa; breakable: off",
                     rows[i].rule, rows[i].radius);
            double n = stiffness(&fabric, strained(f, "polyhedra", settings, -strain), strain);
            CHECK_BETWEEN(n / (1e8 * fabric.corners), rows[i].low, rows[i].high);
        }
}

static void coverage_is_the_energy_that_is_left(void **state)
{
    static const char *const settings[] = {
        "interaction: all; e_bar: 10 GPa",
        "interaction: gap; interaction_gap: 1 mm; e_bar: 10 GPa"};
    static const double gaps[] = {HUGE_VAL, 1e-3};
    struct fixture *f = *state;
    double energy[2];
    struct calib_fabric fabric[2];
    fixture_specimen(f, "shape: box; size: 30 mm, 30 mm, 30 mm; grains: packing");
    for (int i = 0; i < 2; i++) {
        struct calib_fabric_rules rules = {.gap = gaps[i]};
        fabric[i] = measure(f, &rules);
        energy[i] = strained(f, "vgcm", settings[i], 1e-6);
    }
    CHECK_NEAR(fabric[0].coverage, 1, 1e-3, 0);
    CHECK_NEAR(stiffness(&fabric[0], energy[0], 1e-6), 10e9 * fabric[0].coverage, 0, 0.02);
    assert_true(fabric[1].coverage < 0.99);
    CHECK_NEAR(energy[1] / energy[0], fabric[1].coverage / fabric[0].coverage, 0, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(bonds_store_what_the_sum_says),
        FIXTURE_TEST(corners_count_by_rule),
        FIXTURE_TEST(coverage_is_the_energy_that_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
