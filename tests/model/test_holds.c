/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grains that platens hold: what acts on a grain is what its stored energy says, wherever it has
 * slid to. Of one grain between two platens of the tension test. */
#include "tests/fixture.h"

static const double H = 1e-2;

/* Moves the grain by v and turns it by w. */
static void move(struct fixture *f, const double v[3], const double w[3])
{
    const double zero[3] = {0, 0, 0};
    fixture_velocity(f, 0, v, w);
    fixture_carry(f, 1);
    fixture_velocity(f, 0, zero, zero);
    fixture_forces(f);
}

/* Work of the forces over a small motion there, and what the stored energy loses by it. */
static void compare(struct fixture *f, int axis, double largest)
{
    const double step = axis < 3 ? 1e-8 : 1e-6;
    double forth[2][3] = {{0}}, back[2][3] = {{0}}, twice[2][3] = {{0}};
    const double *acts = axis < 3 ? f->sim.bodies.f[0] : f->sim.bodies.t[0];
    double work = 2 * step * acts[axis % 3];
    forth[axis / 3][axis % 3] = step;
    twice[axis / 3][axis % 3] = -2 * step;
    back[axis / 3][axis % 3] = step;
    move(f, forth[0], forth[1]);
    double stored = fixture_stored(f);
    move(f, twice[0], twice[1]);
    stored -= fixture_stored(f);
    move(f, back[0], back[1]);
    CHECK_NEAR(work, -stored, 2e-4 * 2 * step * (axis < 3 ? largest : largest * H), 0);
}

static void slide(struct fixture *f, const struct brc_model *model, const char *test)
{
    const double lift[3] = {0, 0, 5e-5}, zero[3] = {0, 0, 0};
    fixture_test(f, model, "mu: 0", test, "", "damped: motion; local_damping: 0");
    fixture_rest(f);
    fixture_velocity(f, f->sim.bodies.n_grains + 1, lift, zero);
    fixture_carry(f, 1);
    fixture_rest(f);
    /* in small turns, as those of steps are */
    for (int i = 0; i < 100; i++)
        move(f, (double[]){3e-5, 1e-5, 0}, (double[]){0, 0, 2e-3});
    move(f, zero, (double[]){1e-3, -2e-3, 0});
    double largest = fabs(f->sim.bodies.f[0][2]);
    assert_true(largest > 1);
    for (int axis = 0; axis < 6; axis++)
        compare(f, axis, largest);
}

static void holds_have_an_energy(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 1, 1, 1, H, 0);
    for (int i = 0; i < fixture_n_models(); i++)
        if (!fixture_is(fixture_model(i), "null")) {
            slide(f, fixture_model(i), "kind: tension; grip: axial");
            slide(f, fixture_model(i), "kind: tension; grip: full");
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(holds_have_an_energy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
