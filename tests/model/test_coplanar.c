/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells with several facets in one plane: a unit cube, turned, one half of it nine lamellae along
 * z, the other seven along y (tests/data/lamellae.tess, 12 digits). What erosion leaves of them and
 * how they are bonded is known by hand. */
#include "tests/fixture.h"
#include "tests/rotate.h"

#include <stdio.h>

static const double Z[] = {0, 0.057, 0.085, 0.308, 0.67, 0.736, 0.835, 0.948, 0.956, 1};
static const double Y[] = {0, 0.158, 0.394, 0.431, 0.581, 0.606, 0.607, 1};
enum { N_Z = 9, N_Y = 7 };
static const double R = 2e-4; /* the thinnest lamella is five times as thick */
static const double B_N = 20e9, DENSITY = 2500;
static const char SPECIMEN[] =
    "shape: polyhedron; grains: tess; tess: tests/data/lamellae.tess; min_area_ratio: 0";

/* A vector of the file's frame in that of the cube, or back. */
static void turn(double x[3], const double from[3], bool to_cube)
{
    double length = sqrt(1 + 0.3 * 0.3 + 0.2 * 0.2 + 0.5 * 0.5), s = (to_cube ? -1 : 1) / length;
    const double q[4] = {1 / length, 0.3 * s, 0.2 * s, 0.5 * s};
    brc_quat_rotate(x, q, from);
}

/* Whether a body is of the first half, and which of its lamellae. */
static bool lamella_of(const struct fixture *f, int32_t body, int *number)
{
    double x[3];
    turn(x, f->specimen.facets.centre[body], true);
    bool is_first = x[0] < 0.5;
    *number = 0;
    while (x[is_first ? 2 : 1] > (is_first ? Z : Y)[*number + 1])
        ++*number;
    return is_first;
}

/* What is left of the interval from a to b that lies on the side of a whole one from 0 to 1. */
static double kept(double a, double b)
{
    return fmin(b, 1 - R) - fmax(a, R);
}

static void erosion_and_bonds(void **state)
{
    struct fixture *f = *state;
    const double zero[3] = {0, 0, 0}, u = 1e-6;
    int n_across = 0;
    fixture_specimen(f, SPECIMEN);
    fixture_free_sim(f, brc_registry_find("polyhedra"),
                     "radius: 0.2 mm; area: eroded; strain_length: gap; bn: 20 GPa; bt: 0 GPa; "
                     "bm: 0 GPa; mu: 0; density: 2500 kg/m3; torsion: off; eps_th: 1",
                     "");
    assert_int_equal(f->sim.bodies.n_grains, N_Z + N_Y);
    for (int32_t i = 0; i < N_Z + N_Y; i++) {
        int k;
        bool is_first = lamella_of(f, i, &k);
        const double thickness = is_first ? Z[k + 1] - Z[k] : Y[k + 1] - Y[k];
        CHECK_NEAR(f->sim.bodies.true_mass[i], DENSITY * 0.5 * thickness, 0, 1e-9);
        const double along[3] = {is_first ? 0 : u, 0, 0};
        double v[3];
        turn(v, along, false);
        fixture_velocity(f, (size_t)i, v, zero);
    }
    fixture_carry(f, 1);
    for (size_t row = 0; row < f->sim.pairs.n; row++) {
        int a, b;
        bool is_a = lamella_of(f, f->sim.pairs.a[row], &a);
        bool is_b = lamella_of(f, f->sim.pairs.b[row], &b);
        if (is_a == is_b || f->sim.pairs.facet[row] < 0)
            continue;
        int i = is_a ? a : b, k = is_a ? b : a;
        double first = (Z[i + 1] - Z[i] - 2 * R) * kept(Y[k], Y[k + 1]);
        double second = (Y[k + 1] - Y[k] - 2 * R) * kept(Z[i], Z[i + 1]);
        double force = B_N * 0.5 * (first + second) * u / (2 * R);
        assert_int_equal(f->sim.pairs.status[row], BRC_INTACT);
        CHECK_NEAR(brc_norm(f->sim.pairs.f[row]), force, 0, 1e-6);
        n_across++;
    }
    assert_int_equal(n_across, N_Z * N_Y);
}

/* The cube as it was before it was turned: with ends across z. */
static void put_upright(struct fixture *f)
{
    double m[3][3];
    for (int k = 0; k < 3; k++) {
        const double axis[3] = {k == 0, k == 1, k == 2};
        double column[3];
        turn(column, axis, true);
        for (int i = 0; i < 3; i++)
            m[i][k] = column[i];
    }
    fixture_turn(f, m);
}

/* Both models carry a load through such a pack: each step balances, nothing breaks. */
static void models_run(void **state)
{
    struct fixture *f = *state;
    fixture_specimen(f, SPECIMEN);
    put_upright(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        double balance[2];
        if (fixture_is(model, "null"))
            continue;
        fixture_sim(f, model,
                    fixture_is(model, "polyhedra")
                        ? "radius: 0.2 mm"
                        : "softening: none; interaction: all; oblique: keep",
                    "", "");
        size_t n_bonds = 0;
        for (size_t row = 0; row < f->sim.pairs.n; row++)
            n_bonds += f->sim.pairs.status[row] == BRC_INTACT;
        assert_int_equal(n_bonds, N_Z * N_Y + N_Z - 1 + N_Y - 1);
        fixture_steps(f, 20);
        fixture_balance(f, balance);
        CHECK_BETWEEN(fixture_largest_force(f), 1e-6, 1e12);
        CHECK_NEAR(balance[0], 0, 1e-9, 0);
        assert_int_equal(f->sim.events.table.n, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(erosion_and_bonds), FIXTURE_TEST(models_run)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
