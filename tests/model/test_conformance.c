/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every contact model owes to the framework, whatever its law: forces that balance and turn
 * with the pack. Runs over every registered model and the null model. */
#include "tests/rotate.h"
#include "tests/subjects.h"

#include <stdlib.h>

/* Random motion of every grain: displacements of about strain x SUBJECT_GRAIN a step. */
static void shake(struct fixture *f, double strain, int n)
{
    for (int step = 0; step < n; step++) {
        for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
            double v[3], w[3];
            for (int k = 0; k < 3; k++) {
                v[k] = strain * SUBJECT_GRAIN * fixture_draw(f);
                w[k] = strain * fixture_draw(f);
            }
            fixture_velocity(f, i, v, w);
        }
        fixture_carry(f, 1);
    }
    fixture_rest(f);
}

static void forces_balance(void **state)
{
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        struct subject s = subject_of(model);
        const char *tests[3] = {"kind: none", "kind: compression; friction: 0.5",
                                "kind: tension; grip: full"};
        for (int t = 0; t < 3; t++) {
            double balance[2];
            fixture_sim(f, model, s.elastic, tests[t], "");
            shake(f, 1e-5, 3);
            fixture_balance(f, balance);
            /* sums of some hundred forces and of arms of 5 cm: 1e-14 each */
            CHECK_NEAR(balance[0], 0, 1e-13, 0);
            CHECK_NEAR(balance[1], 0, 1e-12, 0);
            CHECK_NEAR(fixture_third_law(f), 0, 1e-12, 0);
            if (!fixture_is(model, "null"))
                assert_true(fixture_largest_force(f) > subject_force(&s, 1e-6));
        }
    }
}

static void gather_is_the_sum_of_rows(void **state)
{
    /* the framework's sums against a plain accumulation, which adds in another order */
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject_of(fixture_model(i));
        fixture_sim(f, fixture_model(i), s.elastic, "rate: 1e-6 1/s; loading: fixed", "");
        fixture_steps(f, 20);
        struct brc_bodies *b = &f->sim.bodies;
        double(*sums)[6] = test_calloc(b->n, sizeof *sums);
        for (size_t k = 0; k < b->n; k++) {
            brc_copy(sums[k], b->f[k]);
            brc_copy(sums[k] + 3, b->t[k]);
        }
        const struct brc_contacts *sets[2] = {&f->sim.pairs, &f->sim.platens};
        double size = 1e-300;
        /* the moments of pairs are not kept where the model adds them itself */
        bool has_moments = !(f->sim.model.flags & BRC_MODEL_ADDS);
        for (int c = 0; c < 2; c++)
            for (size_t r = 0; r < sets[c]->n; r++) {
                const int32_t end[2] = {sets[c]->a[r], sets[c]->b[r]};
                brc_axpy(sums[end[0]], 1, sets[c]->f[r]);
                brc_axpy(sums[end[1]], -1, sets[c]->f[r]);
                brc_axpy(sums[end[0]] + 3, -1, sets[c]->ta[r]);
                brc_axpy(sums[end[1]] + 3, -1, sets[c]->tb[r]);
                size += brc_norm(sets[c]->f[r]);
            }
        for (size_t k = 0; k < b->n; k++) {
            CHECK_NEAR(brc_norm(sums[k]), 0, 1e-13 * size, 0);
            if (has_moments)
                CHECK_NEAR(brc_norm(sums[k] + 3), 0, 1e-13 * size * SUBJECT_GRAIN, 0);
        }
        test_free(sums);
    }
}

static void translation_gives_no_force(void **state)
{
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        struct subject s = subject_of(model);
        const double v[3] = {0.7 * SUBJECT_GRAIN, -0.4 * SUBJECT_GRAIN, 0.3 * SUBJECT_GRAIN},
                     zero[3] = {0, 0, 0};
        fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
        for (size_t k = 0; k < f->sim.bodies.n; k++)
            fixture_velocity(f, k, v, zero);
        fixture_carry(f, 1);
        /* places of 4 cm are known to 7e-18 m, that is a strain of 1e-15 */
        CHECK_NEAR(fixture_largest_force(f), 0, subject_force(&s, 2e-14), 0);
        assert_int_equal(f->sim.events.table.n, 0);
    }
}

/* Turns everything about the origin by phi in n exact steps; velocities are those of the chords. */
static void turn(struct fixture *f, const double phi[3], int n)
{
    double step[3], q[4];
    brc_scale(step, phi, 1.0 / n);
    brc_quat_from_rotation(q, step);
    for (int i = 0; i < n; i++) {
        for (size_t k = 0; k < f->sim.bodies.n; k++) {
            double x[3];
            brc_quat_rotate(x, q, f->sim.bodies.x[k]);
            brc_sub(x, x, f->sim.bodies.x[k]);
            fixture_velocity(f, k, x, step);
        }
        fixture_carry(f, 1);
    }
}

static void rotation_at_once_gives_no_force(void **state)
{
    /* models whose displacements are total (no memory of the path) bear any angle in one go */
    struct fixture *f = *state;
    subject_pack(f);
    const struct brc_model *model = brc_registry_find("polyhedra");
    struct subject s = subject_of(model);
    for (int i = 0; i < 8; i++) {
        double phi[3], q[4], u[3] = {0.3, -0.2, 0.1};
        fixture_free_sim(f, model, s.elastic, "");
        fixture_draw_unit(f, phi);
        brc_scale(phi, phi, BRC_PI * (i + 1) / 8);
        brc_quat_from_rotation(q, phi);
        fixture_place(f, q, u);
        fixture_list(f);
        fixture_forces(f);
        /* places of 40 cm: 1e-16 m, a strain of 1e-14, times the springs of a facet */
        CHECK_NEAR(fixture_largest_force(f), 0, subject_force(&s, 1e-12), 0);
        CHECK_NEAR(fixture_stored(f), 0, subject_force(&s, 1e-12) * 1e-12 * SUBJECT_GRAIN, 0);
        assert_int_equal(f->sim.events.table.n, 0);
    }
}

static double drift_of_turn(struct fixture *f, const struct brc_model *model, int n)
{
    struct subject s = subject_of(model);
    fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
    turn(f, (double[3]){0.9, -0.5, 1.2}, n); /* 91 degrees about a skew axis */
    return fixture_largest_force(f) / subject_force(&s, 1);
}

static void rotation_in_steps_drifts_little(void **state)
{
    /* strain that a turn of 90 degrees leaves behind: nothing where displacements are total; of the
     * second order or better in the step where they are summed up (91 degrees in 200 steps: 8 mrad
     * each, third order each) */
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        double drift = drift_of_turn(f, fixture_model(i), 200);
        double finer = drift_of_turn(f, fixture_model(i), 400);
        print_message("%s: turned by 91 degrees, strain left: %.2e in 200 steps, %.2e in 400\n",
                      fixture_model(i)->name, drift, finer);
        CHECK_NEAR(drift, 0, 2e-5, 0);
        if (drift > 1e-11)
            CHECK_BETWEEN(log2(drift / finer), 1.8, 4.5);
    }
}

/* Largest error of the turned forces as a strain; energy relative to what it was. */
static double error_of_turn(struct fixture *f, const struct brc_model *model, int n,
                            double *energy_error)
{
    struct subject s = subject_of(model);
    f->random = 5;
    fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
    shake(f, 1e-5, 3);
    fixture_forces(f);
    size_t n_rows = f->sim.pairs.n;
    double(*old)[3] = test_calloc(n_rows + 1, sizeof *old);
    double stored = fixture_stored(f), phi[3] = {-0.4, 0.8, 0.5}, q[4], error = 0;
    for (size_t r = 0; r < n_rows; r++)
        brc_copy(old[r], f->sim.pairs.f[r]);
    turn(f, phi, n);
    brc_quat_from_rotation(q, phi);
    assert_int_equal(f->sim.pairs.n, n_rows);
    for (size_t r = 0; r < n_rows; r++) {
        double d[3];
        brc_quat_rotate(d, q, old[r]);
        brc_sub(d, d, f->sim.pairs.f[r]);
        error = fmax(error, brc_norm(d) / subject_force(&s, 1));
    }
    *energy_error = stored > 0 ? fabs(fixture_stored(f) / stored - 1) : 0;
    test_free(old);
    return error;
}

static void forces_turn_with_the_pack(void **state)
{
    /* a strained pack is turned: forces and energy turn with it. The memory of shear must be
     * carried along by tilt and twirl: without, the error is of the order of the strain itself. */
    struct fixture *f = *state;
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        double energy[2], error[2];
        for (int k = 0; k < 2; k++)
            error[k] = error_of_turn(f, fixture_model(i), 400 << k, &energy[k]);
        print_message("%s: strained by 3e-5 and turned by 59 degrees: error of the forces as a "
                      "strain %.2e in 400 steps, %.2e in 800; of the energy %.2e, %.2e\n",
                      fixture_model(i)->name, error[0], error[1], energy[0], energy[1]);
        /* steps of 2.6 mrad: the chord is off by a third of 1e-9 of 1 cm each, 400 times */
        CHECK_NEAR(error[0], 0, 5e-6, 0);
        CHECK_NEAR(energy[1], 0, 0.02, 0);
        if (error[0] > 1e-10)
            CHECK_BETWEEN(log2(error[0] / error[1]), 1.8, 4.5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(forces_balance),
        FIXTURE_TEST(gather_is_the_sum_of_rows),
        FIXTURE_TEST(translation_gives_no_force),
        FIXTURE_TEST(rotation_at_once_gives_no_force),
        FIXTURE_TEST(rotation_in_steps_drifts_little),
        FIXTURE_TEST(forces_turn_with_the_pack),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
