/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a test begins: the field of velocities, and the scaled masses that carry it. */
#include "common/engine/mass_scaling.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <string.h>

static void load(struct fixture *f, const struct brc_model *model, const char *kind,
                 const char *settings)
{
    char test[120];
    snprintf(test, sizeof test, "kind: %s; loading: fixed; rate: 1e-7 1/s; sample_steps: 5", kind);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 5 cm; cells: 3, 3, 5; "
                        "jitter: 0.5; seed: 7");
    fixture_sim(f, model, settings, test, "");
}

/* Largest difference of a grain's velocity from the field, over the field's largest. */
static double off_field(const struct fixture *f)
{
    double off = 0, largest = 0, v[3], dv[3];
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        f->sim.rig.type->field(&f->sim, i, v);
        largest = fmax(largest, brc_norm(v));
        brc_sub(dv, f->sim.bodies.v[i], v);
        off = fmax(off, brc_norm(dv));
    }
    return off / largest;
}

/* The grains have the velocities of a uniform strain, so that the load rises with the strain from
 * the first rows on. (Platens that hit grains at rest would load them four times as much.) */
static void the_load_begins_without_a_shock(void **state)
{
    static const char *const kinds[] = {"compression", "tension"};
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++)
        for (int k = 0; k < 2; k++) {
            load(f, brc_registry_at(m), kinds[k], "");
            double off = off_field(f);
            fixture_steps(f, 600);
            const struct brc_curve *c = &f->sim.rig.curve;
            double steady = c->stress[119] / c->strain[119], worst = 0;
            for (int i = 1; i < 4; i++)
                worst = fmax(worst, c->stress[i] / c->strain[i] / steady);
            print_message("%s, %s: velocities off by %.1e; load over the steady one %.2f, residual "
                          "%.1e\n",
                          brc_registry_at(m)->name, kinds[k], off, worst, c->residual[119]);
            assert_true(off < 1e-6);
            CHECK_BETWEEN(worst, 0.5, 1.6);
            assert_true(c->residual[119] < 1e-6);
        }
}

/* Masses that grow later keep momentum, and what is lost goes to the ledger. */
static void later_masses_inject_nothing(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++) {
        load(f, brc_registry_at(m), "tension", "");
        fixture_steps(f, 20);
        struct brc_bodies *b = &f->sim.bodies;
        double mass = b->mass[11], momentum[3], after[3];
        brc_scale(momentum, b->v[11], mass);
        f->sim.run.mass_margin *= 10;
        brc_mass_scaling_update(&f->sim);
        brc_scale(after, b->v[11], b->mass[11]);
        assert_true(b->mass[11] > 3 * mass);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(after[k], momentum[k], 0, 1e-12);
        assert_true(f->sim.ledger.mass_scaling > 0);
    }
}

/* The state but for what says the density. */
static uint64_t hash_without_density(struct fixture *f)
{
    struct brc_bodies *b = &f->sim.bodies;
    memset(b->true_mass, 0, b->n * sizeof *b->true_mass);
    memset(b->true_inertia, 0, b->n * sizeof *b->true_inertia);
    return brc_sim_hash(&f->sim);
}

/* Without gravity the density does not change a bit of a quasi-static run, not even one that would
 * make the true masses larger than the scaled ones. */
static void the_density_is_without_effect(void **state)
{
    static const char *const density[] = {"density: 3000 kg/m3", "density: 1234.5 kg/m3",
                                          "density: 1e14 kg/m3"};
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++) {
        uint64_t hash[3];
        for (int k = 0; k < 3; k++) {
            load(f, brc_registry_at(m), "compression", density[k]);
            assert_true(f->sim.bodies.true_mass[0] > 0);
            fixture_steps(f, 300);
            hash[k] = hash_without_density(f);
        }
        assert_true(hash[0] == hash[1]);
        assert_true(hash[0] == hash[2]);
    }
}

/* A column of three cubes or spheres that touch, without bonds, between platens that hardly move.
 */
static void stack(struct fixture *f, const struct brc_model *model, double gap, const char *run)
{
    struct brc_convex cell[3];
    const double radius[3] = {0.005, 0.005, 0.005}, edges[3] = {0.01, 0.01, 0.01};
    for (int i = 0; i < 3; i++) {
        const double centre[3] = {0, 0, (0.01 + gap) * i};
        cell[i] = (struct brc_convex){0};
        fixture_box(f, &cell[i], centre, edges);
    }
    fixture_loose(f, cell, radius, 3);
    for (int i = 0; i < 3; i++)
        brc_convex_free(&cell[i]);
    fixture_sim(f, model, "", "kind: compression; loading: fixed; rate: 1e-30 1/s", run);
}

/* Weight of the grains from first on. */
static double weight_from(const struct fixture *f, size_t first)
{
    double weight = 0;
    for (size_t i = first; i < f->sim.bodies.n_grains; i++)
        weight += 9.81 * f->sim.bodies.true_mass[i];
    return weight;
}

/* What is at rest under gravity presses on the platen with its weight, although no contact has a
 * stiffness when it begins. */
static void gravity_settles_what_only_touches(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++)
        for (int k = 0; k < 2; k++) {
            stack(f, brc_registry_at(m), k == 0 ? 0 : 1e-8, "gravity: 0 m/s2, 0 m/s2, -9.81 m/s2");
            double weight = weight_from(f, 0);
            fixture_steps(f, 6000);
            print_message("%s: %.6f of the weight, residual %.1e\n", brc_registry_at(m)->name,
                          f->sim.rig.platen[0].force / weight, brc_ledger_residual(&f->sim.ledger));
            CHECK_NEAR(f->sim.rig.platen[0].force, weight, 0, 1e-3);
            assert_true(brc_ledger_residual(&f->sim.ledger) < 1e-3);
        }
}

/* A grain that has lost its contacts keeps its scaled mass, so that it falls by what contacts
 * would be pressed by, until it meets the platen. */
static void a_lost_grain_falls_slowly(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++) {
        stack(f, brc_registry_at(m), 0, "gravity: 0 m/s2, 0 m/s2, -9.81 m/s2");
        fixture_steps(f, 1000);
        struct brc_bodies *b = &f->sim.bodies;
        double mass = b->mass[2], z = b->x[2][2];
        b->x[2][0] += 0.02;
        fixture_list(f);
        fixture_steps(f, 200);
        double fallen = z - b->x[2][2];
        assert_true(b->mass[2] == mass);
        CHECK_BETWEEN(fallen / (0.5 * 200 * 200 * weight_from(f, 2) / mass), 0.2, 1.01);
        fixture_steps(f, 20000);
    }
}

/* Nothing that is near gives a stiffness: gravity has no time scale then. */
static void gravity_needs_a_stiffness(void **state)
{
    struct fixture *f = *state;
    struct brc_convex cell[2];
    const double radius[2] = {0.005, 0.005}, edges[3] = {0.01, 0.01, 0.01};
    for (int i = 0; i < 2; i++) {
        cell[i] = (struct brc_convex){0};
        fixture_box(f, &cell[i], (const double[]){0, 0, 1.0 * i}, edges);
    }
    fixture_loose(f, cell, radius, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    for (int m = 0; m < brc_registry_count(); m++) {
        fixture_sim(f, brc_registry_at(m), "", "kind: none", "");
        fixture_steps(f, 10);
        struct brc_run_params run = f->sim.run;
        struct brc_sim sim;
        run.gravity[2] = -9.81;
        const struct brc_test test = brc_rigs_test(&f->sim.rig.params, NULL);
        CHECK_FAILS(&f->ctx,
                    brc_sim_create(&f->ctx, &sim, brc_registry_at(m), f->sim.params, &f->specimen,
                                   &test, &run),
                    BRC_ERR_INPUT, "nothing is in contact yet");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(the_load_begins_without_a_shock),
        FIXTURE_TEST(later_masses_inject_nothing),
        FIXTURE_TEST(the_density_is_without_effect),
        FIXTURE_TEST(gravity_settles_what_only_touches),
        FIXTURE_TEST(a_lost_grain_falls_slowly),
        FIXTURE_TEST(gravity_needs_a_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
