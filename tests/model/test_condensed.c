/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of polyhedra with condensed springs against the literal ones. */
#include "common/output/io_h5.h"
#include "polyhedra/poly.h"
#include "tests/fixture.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern const struct brc_model brc_model_polyhedra;

static const struct brc_h5_extra nothing = {NULL, 0, NULL, 0};

enum { STEPS = 800 };

static void load(struct fixture *f, const char *kind, const char *settings, const char *run)
{
    char all[320], test[100];
    snprintf(all, sizeof all, FIXTURE_TABLE_1 "; %s", settings);
    snprintf(test, sizeof test, "kind: %s; loading: fixed; rate: 4e-6 1/s; strain_max: 0.99", kind);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                        "jitter: 0.6; seed: 3");
    fixture_sim(f, &brc_model_polyhedra, all, test, run);
}

/* A pack that is pressed until many springs slip; part of it breaks when bonds are weak. */
static void press(struct fixture *f, const char *settings, const char *run)
{
    load(f, "compression", settings, run);
}

static double force_after(struct fixture *f, const char *kind, const char *settings)
{
    load(f, kind, settings, "");
    fixture_steps(f, STEPS);
    return f->sim.rig.force;
}

static size_t count_held(const struct fixture *f)
{
    const struct poly_contacts *columns = f->sim.pairs.model_columns;
    size_t n = 0;
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        n += columns->is_linearised[i];
    return n;
}

/* The error of the load falls with the path between two literal evaluations. (Where springs slip,
 * it is not smooth in the path: the two are far apart.) */
static void check_load(struct fixture *f, const char *rule)
{
    static const char *const paths[2] = {"0.01", "0.0002"};
    char settings[160];
    double error[2];
    snprintf(settings, sizeof settings, "eps_th: 0.05; %s; evaluation: literal", rule);
    double literal = force_after(f, "compression", settings);
    for (int i = 0; i < 2; i++) {
        snprintf(settings, sizeof settings,
                 "eps_th: 0.05; %s; evaluation: condensed; condensed_path: %s", rule, paths[i]);
        error[i] = fabs(force_after(f, "compression", settings) / literal - 1);
        print_message("%s, path %s R: load off by %.2e, %zu rows condensed, residual %.1e\n", rule,
                      paths[i], error[i], count_held(f), brc_ledger_residual(&f->sim.ledger));
        assert_true(count_held(f) > 20);
        assert_true(brc_ledger_residual(&f->sim.ledger) < 1e-12);
        assert_true(f->sim.events.table.n == 0);
    }
    assert_true(error[0] > 0 && error[0] < 2e-3);
    assert_true(error[1] < error[0] / 4);
}

static void load_is_that_of_literal_springs(void **state)
{
    check_load(*state, "features: merged");
    check_load(*state, "features: closed");
}

/* Bonds begin to pull, or cease to, within paths of this size: a tangent that went on through that
 * would be off by 4e-4. */
static void bonds_begin_to_pull(void **state)
{
    struct fixture *f = *state;
    double literal = force_after(f, "tension", "eps_th: 0.05; evaluation: literal");
    double condensed = force_after(f, "tension", "eps_th: 0.05; condensed_path: 0.05");
    print_message("load off by %.2e, %zu rows condensed\n", condensed / literal - 1, count_held(f));
    assert_true(count_held(f) > 20);
    CHECK_NEAR(condensed, literal, 0, 1.5e-4);
}

/* --- acting springs --------------------------------------------------------------------------- */

struct changes {
    double *weight; /* of each point that acts in the present pose */
    size_t n_points, n;
    double largest; /* weight of a point that acts now or then, but not both */
};

static void note_weight(void *user, const struct poly_active *active)
{
    ((struct changes *)user)->weight[active->point] = active->geometry.weight;
}

static void look_at_row(struct changes *changes, const struct brc_contacts *c, size_t row)
{
    const struct poly_points *points = c->point_columns;
    for (size_t p = (size_t)c->p0[row], end = p + (size_t)c->np[row]; p < end; p++) {
        double then = points->spring[p][POLY_WEIGHT], now = changes->weight[p];
        changes->n_points += then > 0;
        if ((then > 0) == (now > 0))
            continue;
        assert_int_equal(points->kind[p], POLY_EDGES);
        changes->largest = fmax(changes->largest, fmax(then, now));
        changes->n++;
    }
}

static void look_at_springs(struct changes *changes, const struct fixture *f)
{
    const struct brc_contacts *c = &f->sim.pairs;
    const struct poly_contacts *columns = c->model_columns;
    changes->weight = test_calloc(c->points.n, sizeof *changes->weight);
    poly_each_active(&f->sim, f->sim.state, note_weight, changes);
    for (size_t i = 0; i < c->n; i++)
        if (columns->is_linearised[i])
            look_at_row(changes, c, i);
    test_free(changes->weight);
}

/* Grains of a pack that is pressed and sheared, by 4e-6 and 1e-6 a step. */
static void shear(struct fixture *f)
{
    const double none[3] = {0, 0, 0};
    const struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        double z = b->x[i][2] / f->sim.dt, v[3] = {1e-6 * z, 0, -4e-6 * z};
        fixture_velocity(f, i, v, none);
    }
}

/* While a row is condensed the springs that act are those that did when it was computed, but for
 * edges of `merged` that come or go by their ends: their weight is 3 (s / (R sin))^2 after a path
 * s, below 3 (0.005 / 0.1)^2 where it counts at all. */
static void the_same_springs_act(void **state)
{
    struct fixture *f = *state;
    static const char *const settings[] = {
        "eps_th: 0.05", "bonds: off", "features: strict; condensed_path: 0.05",
        "eps_th: 0.05; features: closed; strain_length: gap; area: eroded",
        "eps_th: 0.05; features: closed; condensed_path: 0.05"};
    for (int i = 0; i < 5; i++) {
        struct changes changes = {.n = 0};
        load(f, i == 1 ? "none" : "compression", settings[i], "");
        for (int k = 0; k < STEPS; k += 10) {
            if (i == 1)
                shear(f);
            fixture_steps(f, 10);
            look_at_springs(&changes, f);
        }
        print_message("%s: %zu of %zu springs of condensed rows have come or gone, weights up to "
                      "%.1e\n",
                      settings[i], changes.n, changes.n_points, changes.largest);
        assert_true(changes.n_points > 1000);
        assert_true(i < 2 ? changes.largest < 7.5e-3 : changes.n == 0);
    }
}

/* Two bonded cubes that spin about their common centre by 1e-4 a step; x becomes where the first
 * one is after one radian. */
static void spin(struct fixture *f, const char *evaluation, double x[3])
{
    char settings[100];
    snprintf(settings, sizeof settings,
             "radius: 1 mm; mu: 0; gn: 0 1/s; breakable: off; evaluation: %s", evaluation);
    fixture_grid(f, 2, 1, 1, 0.01, 0);
    fixture_free_sim(f, &brc_model_polyhedra, settings, "dt: 1e-8 s");
    for (size_t i = 0; i < 2; i++) {
        const double w[3] = {0, 0, 1e4}, v[3] = {0, w[2] * (i == 0 ? -0.005 : 0.005), 0};
        fixture_velocity(f, i, v, w);
    }
    fixture_steps(f, 10000);
    brc_copy(x, f->sim.bodies.x[0]);
}

/* The path of a pair that turns as a whole is none, but its force turns to the first order alone.
 */
static void pairs_turn(void **state)
{
    struct fixture *f = *state;
    double x[3], y[3];
    spin(f, "literal", x);
    spin(f, "condensed", y);
    /* m: the bond is stretched by 6.6e-6; off by 6e-10, and without a limit of the turn by 9e-9 */
    CHECK_NEAR_ARRAY(y, x, 3, 2e-9, 0);
}

/* Two cubes that are 0.003 R apart when their features are listed for the first time, and come
 * nearer by 1e-4 R a step: their force after 40 steps. */
static double force_of_neighbours(struct fixture *f, const char *evaluation)
{
    const double toward[3] = {-10, 0, 0}, none[3] = {0, 0, 0};
    char settings[100];
    snprintf(settings, sizeof settings, "radius: 1 mm; bonds: off; gn: 0 1/s; evaluation: %s",
             evaluation);
    fixture_grid(f, 2, 1, 1, 0.01, 0);
    fixture_free_sim(f, &brc_model_polyhedra, settings, "dt: 1e-8 s");
    f->sim.bodies.x[1][0] += 3e-6;
    fixture_velocity(f, 1, toward, none);
    fixture_steps(f, 40);
    assert_int_equal(f->sim.pairs.n, 1);
    return f->sim.pairs.f[0][0];
}

/* A contact whose list has just been made is linearised for the path of the nearest feature pair,
 * not for that of an empty list. */
static void new_lists_count(void **state)
{
    double literal = force_of_neighbours(*state, "literal");
    assert_true(literal > 0);
    CHECK_NEAR(force_of_neighbours(*state, "condensed"), literal, 0, 0.01);
}

/* Force on b and moment on a of a contact. */
static void wrench_of(double w[6], const struct brc_contacts *c, size_t i)
{
    brc_copy(w, c->f[i]);
    brc_copy(w + 3, c->ta[i]);
}

/* By how much all contacts are off that are well on their way from one evaluation to the next, and
 * how far they have changed since the last: squared forces and, over the size of a grain, moments.
 */
struct slope {
    double off[2], change[2];
    size_t n;
};

static void look_at_slope(struct fixture *f, struct slope *s)
{
    struct brc_contacts *c = &f->sim.pairs;
    struct poly_contacts *columns = c->model_columns;
    double(*then)[6] = test_malloc(c->n * sizeof *then);
    double(*held)[6] = test_malloc(c->n * sizeof *held);
    bool *was_held = test_malloc(c->n * sizeof *was_held);
    for (size_t i = 0; i < c->n; i++) {
        const double *shift = columns->motion[i], end = shift[POLY_MOTION_END];
        was_held[i] = columns->is_linearised[i] && shift[POLY_MOTION_PATH] > 0.3 * end &&
                      shift[POLY_MOTION_PATH] < 0.9 * end;
        wrench_of(then[i], c, i);
        memcpy(held[i], columns->linearised_force[i], sizeof held[i]);
        columns->is_linearised[i] = 0;
    }
    fixture_carry(f, 0);
    for (size_t i = 0; i < c->n; i++) {
        double now[6];
        wrench_of(now, c, i);
        for (int k = 0; k < 6 && was_held[i]; k++) {
            double change = now[k] - (k < 3 ? held[i][k] : -held[i][k]);
            s->off[k / 3] += (now[k] - then[i][k]) * (now[k] - then[i][k]);
            s->change[k / 3] += change * change;
        }
        s->n += was_held[i];
    }
    test_free(then);
    test_free(held);
    test_free(was_held);
}

/* The sum that is moved along is what bond and springs give literally, for the present pose. */
static void tangent_is_the_slope(void **state)
{
    struct fixture *f = *state;
    static const char *const rules[] = {"merged", "closed"};
    for (int i = 0; i < 2; i++) {
        char settings[120];
        struct slope s = {.n = 0};
        snprintf(settings, sizeof settings,
                 "eps_th: 0.05; evaluation: condensed; condensed_path: 0.005; mu: 0; features: %s",
                 rules[i]);
        press(f, settings, "");
        for (int k = 0; k < 4; k++) {
            fixture_steps(f, STEPS / 4);
            look_at_slope(f, &s);
        }
        print_message("%s, %zu rows: change of force %.2e, off by %.2e; of moment %.2e, %.2e\n",
                      rules[i], s.n, sqrt(s.change[0]), sqrt(s.off[0]), sqrt(s.change[1]),
                      sqrt(s.off[1]));
        assert_true(s.n > 10);
        for (int k = 0; k < 2; k++)
            assert_true(s.off[k] < 0.05 * 0.05 * s.change[k]);
    }
}

/* The same bits with every instruction set, through breaks, and from the middle of a path on. */
static void check_bits(struct fixture *f, const char *settings, size_t n_held)
{
    static const char *const sets[] = {"simd: base", "simd: avx2", "simd: avx512"};
    char path[64];
    uint64_t hash[BRC_N_SIMD] = {0};
    for (int set = 0; set < BRC_N_SIMD; set++) {
        if (brc_simd_check(&f->ctx, 1 + set) != 0) {
            brc_error_clear(&f->ctx);
            hash[set] = hash[0];
            continue;
        }
        press(f, settings, sets[set]);
        fixture_steps(f, STEPS);
        hash[set] = brc_sim_hash(&f->sim);
        assert_true(f->sim.events.table.n > 0 && count_held(f) >= n_held);
    }
    assert_true(hash[0] == hash[1] && hash[0] == hash[2]);
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-condensed.h5", (long)getpid());
    press(f, settings, "");
    fixture_steps(f, STEPS / 2 + 3);
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &nothing));
    press(f, settings, "");
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &nothing));
    fixture_steps(f, STEPS - STEPS / 2 - 3);
    unlink(path);
    assert_true(brc_sim_hash(&f->sim) == hash[0]);
}

static void bits_are_the_same(void **state)
{
    check_bits(*state, "eps_th: 1e-3; evaluation: condensed; condensed_path: 0.01", 6);
    check_bits(*state, "eps_th: 1e-3; features: closed", 6);
    check_bits(*state, "eps_th: 1e-3; features: closed; evaluation: literal", 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(load_is_that_of_literal_springs),
                                       FIXTURE_TEST(bonds_begin_to_pull),
                                       FIXTURE_TEST(pairs_turn),
                                       FIXTURE_TEST(new_lists_count),
                                       FIXTURE_TEST(the_same_springs_act),
                                       FIXTURE_TEST(tangent_is_the_slope),
                                       FIXTURE_TEST(bits_are_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
