/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest eigenfrequency of small spring systems against dense eigenvalues by GSL, and against
 * the closed form of a chain. */
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "tests/near.h"

#include <gsl/gsl_eigen.h>
#include <stdlib.h>

enum { MAX_SPRINGS = 400 };

/* Scene of a test: springs that the fake model hands over. */
static struct brc_spring scene[MAX_SPRINGS];
static size_t n_scene;

static int scene_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out)
{
    (void)state;
    for (size_t i = 0; i < n_scene; i++)
        BRC_TRY(brc_springs_add(sim->ctx, out, &scene[i]));
    return 0;
}

struct trial {
    struct brc_context ctx;
    struct brc_sim sim;
    uint64_t random;
};

static int set_up(void **state)
{
    static struct trial t;
    t = (struct trial){.ctx = BRC_CONTEXT_INIT, .random = 99};
    t.sim.ctx = &t.ctx;
    t.sim.model.springs = scene_springs;
    t.sim.model.flags = BRC_MODEL_ROTATES | BRC_MODEL_ORIENTED;
    n_scene = 0;
    *state = &t;
    return 0;
}

static int tear_down(void **state)
{
    struct trial *t = *state;
    brc_bodies_free(&t->sim.bodies);
    return 0;
}

static double draw(struct trial *t)
{
    t->random = t->random * UINT64_C(6364136223846793005) + 1442695040888963407;
    return (double)(t->random >> 11) / 9007199254740992.0 * 2 - 1;
}

static void make_bodies(struct trial *t, size_t n_grains, size_t n_platens, double mass,
                        double inertia)
{
    struct brc_bodies *b = &t->sim.bodies;
    CHECK_OK(&t->ctx, brc_bodies_create(&t->ctx, b, n_grains, n_platens, (struct brc_fieldset){0}));
    for (size_t i = 0; i < n_grains; i++) {
        b->mass[i] = mass;
        b->q[i][0] = 1;
        brc_set(b->inertia[i], inertia, inertia, inertia);
    }
}

static struct brc_spring *add_spring(int32_t a, int32_t b, double kn, double ks)
{
    scene[n_scene] = (struct brc_spring){.a = a, .b = b, .n = {1, 0, 0}, .kn = kn, .ks = ks};
    return &scene[n_scene++];
}

/* Row of the relative displacement (or rotation) of a spring along e, over 6 numbers a body. */
static void gradient(double *row, size_t n, const struct brc_spring *s, const double e[3],
                     bool twist)
{
    double ma[3], mb[3];
    memset(row, 0, 6 * n * sizeof *row);
    brc_cross(ma, s->ra, e);
    brc_cross(mb, s->rb, e);
    for (int k = 0; k < 3; k++) {
        row[6 * s->a + k] = twist ? 0 : -e[k];
        row[6 * s->b + k] = twist ? 0 : e[k];
        row[6 * s->a + 3 + k] = twist ? -e[k] : -ma[k];
        row[6 * s->b + 3 + k] = twist ? e[k] : mb[k];
    }
}

/* Largest eigenvalue of M^-1/2 K M^-1/2, K assembled from the energies of the springs. */
static double dense_eigenvalue(const struct brc_bodies *b)
{
    size_t n = b->n_grains, size = 6 * n;
    gsl_matrix *k = gsl_matrix_calloc(size, size);
    double *row = calloc(6 * b->n, sizeof *row);
    for (size_t i = 0; i < n_scene; i++) {
        const struct brc_spring *s = &scene[i];
        double e[3][3];
        brc_copy(e[0], s->n);
        brc_frame(e[1], e[2], s->n);
        for (int part = 0; part < 4; part++) {
            double stiffness = part == 0 ? s->kn : part < 3 ? s->ks : s->kt;
            gradient(row, b->n, s, e[part % 3], part == 3);
            for (size_t p = 0; p < size; p++)
                for (size_t q = 0; q < size; q++) {
                    double mp = p % 6 < 3 ? b->mass[p / 6] : b->inertia[p / 6][0];
                    double mq = q % 6 < 3 ? b->mass[q / 6] : b->inertia[q / 6][0];
                    *gsl_matrix_ptr(k, p, q) += stiffness * row[p] * row[q] / sqrt(mp * mq);
                }
        }
    }
    gsl_vector *values = gsl_vector_alloc(size);
    gsl_eigen_symm_workspace *w = gsl_eigen_symm_alloc(size);
    gsl_eigen_symm(k, values, w);
    double largest = gsl_vector_max(values);
    gsl_eigen_symm_free(w);
    gsl_vector_free(values);
    gsl_matrix_free(k);
    free(row);
    return largest;
}

/* The estimate must be at most 1 % above the true limit (an unsafe side that the margins of run
 * cover many times over) and at most 3 % below it. */
static void check_limit(struct trial *t, double eigenvalue)
{
    double limit = 0;
    CHECK_OK(&t->ctx, brc_stability_limit(&t->sim, &limit));
    CHECK_BETWEEN(limit / (2 / sqrt(eigenvalue)), 0.97, 1.01);
}

static void two_masses(void **state)
{
    /* k between m and m: omega^2 = 2 k / m */
    struct trial *t = *state;
    make_bodies(t, 2, 0, 3, 1);
    add_spring(0, 1, 600, 0);
    check_limit(t, 400);
}

static void mass_and_wall(void **state)
{
    /* a platen never moves: omega^2 = k / m */
    struct trial *t = *state;
    make_bodies(t, 1, 1, 3, 1);
    add_spring(0, 1, 600, 0);
    check_limit(t, 200);
}

static void arm_couples_rotation(void **state)
{
    /* spring across n at arm r of a body held by a wall: K = ks (1, r; r, r^2), so the eigenvalue
     * is ks (1/m + r^2/I) */
    struct trial *t = *state;
    make_bodies(t, 1, 1, 2, 0.1);
    struct brc_spring *s = add_spring(0, 1, 0, 500);
    brc_set(s->ra, 0.3, 0, 0);
    check_limit(t, 500 * (1 / 2.0 + 0.09 / 0.1));
}

static void twist_alone(void **state)
{
    struct trial *t = *state;
    make_bodies(t, 2, 0, 1, 0.5);
    add_spring(0, 1, 0, 0)->kt = 20;
    check_limit(t, 2 * 20 / 0.5);
}

static void chain_of_forty(void **state)
{
    /* free chain: omega^2 = 4 k/m sin^2(pi (n-1) / 2n), next eigenvalue 0.5 % below: slow for a
     * power iteration */
    struct trial *t = *state;
    make_bodies(t, 40, 0, 1, 1);
    for (int32_t i = 0; i < 39; i++)
        add_spring(i, i + 1, 100, 0);
    double s = sin(BRC_PI * 39 / 80);
    check_limit(t, 400 * s * s);
}

static void random_networks(void **state)
{
    struct trial *t = *state;
    for (int round = 0; round < 10; round++) {
        make_bodies(t, 12, 2, 1, 0.05);
        n_scene = 0;
        for (int i = 0; i < 50; i++) {
            int32_t a = (int32_t)(6 + 6 * draw(t)), b = (int32_t)(7 + 7 * draw(t));
            if (a == b)
                continue;
            struct brc_spring *s = add_spring(a, b, 100 * (1.1 + draw(t)), 30 * (1 + draw(t)));
            s->kt = 1 + draw(t);
            for (int k = 0; k < 3; k++) {
                s->n[k] = draw(t);
                s->ra[k] = 0.3 * draw(t);
                s->rb[k] = 0.3 * draw(t);
            }
            brc_normalise(s->n, s->n);
        }
        for (size_t i = 0; i < 12; i++)
            t->sim.bodies.mass[i] = 1 + 0.5 * draw(t);
        check_limit(t, dense_eigenvalue(&t->sim.bodies));
        brc_bodies_free(&t->sim.bodies);
    }
}

static void smallest_moment_is_a_bound(void **state)
{
    /* turned principal axes: the limit may only be on the safe side of the dense one */
    struct trial *t = *state;
    double limit = 0;
    make_bodies(t, 1, 1, 1, 1);
    brc_set(t->sim.bodies.inertia[0], 0.1, 0.2, 0.3);
    brc_quat_from_rotation(t->sim.bodies.q[0], (double[3]){0, 0, BRC_PI / 2});
    struct brc_spring *s = add_spring(0, 1, 0, 500);
    brc_set(s->ra, 0.3, 0, 0); /* turns the body about z and y; y is its first axis */
    CHECK_OK(&t->ctx, brc_stability_limit(&t->sim, &limit));
    double exact = 500 * (1 + 0.09 / 0.1);
    CHECK_BETWEEN(limit / (2 / sqrt(exact)), 0.9, 1.01);
}

static void local_damping_lowers_it(void **state)
{
    struct trial *t = *state;
    make_bodies(t, 2, 0, 3, 1);
    add_spring(0, 1, 600, 0);
    t->sim.damping_alpha = 0.7;
    check_limit(t, 400 * 1.7);
}

static void models_without_rotation(void **state)
{
    struct trial *t = *state;
    t->sim.model.flags = 0;
    make_bodies(t, 1, 1, 2, 0); /* moments are not even set */
    brc_set(add_spring(0, 1, 0, 500)->ra, 0.3, 0, 0);
    check_limit(t, 250);
}

static void nothing_stiff_is_no_limit(void **state)
{
    struct trial *t = *state;
    double limit = 0;
    make_bodies(t, 3, 0, 1, 1);
    CHECK_OK(&t->ctx, brc_stability_limit(&t->sim, &limit));
    assert_true(limit == HUGE_VAL);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(two_masses),
        TEST(mass_and_wall),
        TEST(arm_couples_rotation),
        TEST(twist_alone),
        TEST(chain_of_forty),
        TEST(random_networks),
        TEST(smallest_moment_is_a_bound),
        TEST(local_damping_lowers_it),
        TEST(models_without_rotation),
        TEST(nothing_stiff_is_no_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
