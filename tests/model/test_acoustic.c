/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moment tensors of acoustic events, by hand: one bond of two cubes that is broken by a given path.
 */
#include "common/rigs/acoustic.h"
#include "tests/fixture.h"
#include "tests/rotate.h"

#define H 0.01
static const double AREA = H * H, PATH = 3.5; /* steps up to the limit: the fourth one breaks */

/* A brittle bond of each model, its stiffnesses per area, and where it breaks [m]. Shear limits are
 * small, as cubes that slip by a part of their size turn the line of their centres by it. */
static const struct bond {
    const char *model, *pulled, *sheared;
    double kn, ks, open, slip;
} bonds[] = {
    {"polyhedra",
     "radius: 1 mm; mu: 0; bn: 20 GPa; bt: 5 GPa; torsion: off; strain_length: centres; "
     "area: facet; eps_th: 1e-4",
     "radius: 1 mm; mu: 0; bn: 20 GPa; bt: 5 GPa; torsion: off; strain_length: centres; "
     "area: facet; eps_th: 1e-6",
     20e9 / H, 5e9 / H, 1e-4 * H, 1e-6 * H},
    {"vgcm", "interaction: all; points: one; softening: none; sigma_t: 1 MPa; tau: 50 MPa",
     "interaction: all; points: one; softening: none; sigma_t: 1 kPa; tau: 1 kPa; mu: 0",
     48.8e9 / H, 0.125 * 48.8e9 / H, 1e6 / (48.8e9 / H), 1e3 / (0.125 * 48.8e9 / H)},
};
enum { N_BONDS = sizeof bonds / sizeof bonds[0] };

static void build(struct fixture *f, const char *model, const char *settings, int axis)
{
    fixture_grid(f, 1 + (axis == 0), 1 + (axis == 1), 1 + (axis == 2), H, 0);
    fixture_free_sim(f, brc_registry_find(model), settings, "");
}

/* Moves grain 1 by u in each step, until the bond breaks; the number of steps. */
static int until_it_breaks(struct fixture *f, const double u[3])
{
    const double zero[3] = {0, 0, 0};
    int n = 0;
    fixture_velocity(f, 1, u, zero);
    for (; f->sim.events.table.n == 0 && n < 4000; n++)
        fixture_carry(f, 1);
    assert_int_equal(f->sim.events.table.n, 1);
    return n;
}

static void check_moment(struct fixture *f, const double moment[6], double r, double near_r)
{
    struct brc_acoustic a;
    double scale = 0;
    for (int k = 0; k < 6; k++)
        scale = fmax(scale, fabs(moment[k]));
    CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
    assert_int_equal(a.table.n, 1);
    CHECK_NEAR_ARRAY(a.moment[0], moment, 6, 1e-5 * scale, 1e-5);
    CHECK_NEAR(a.r[0], r, near_r, 0);
    brc_acoustic_free(&a);
}

static void pulled(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_BONDS; i++) {
        const struct bond *b = &bonds[i];
        double step = b->open / PATH;
        build(f, b->model, b->pulled, 2);
        assert_int_equal(until_it_breaks(f, (double[3]){0, 0, step}), 4);
        double force = b->kn * AREA * 4 * step;
        const double *on_b = f->sim.events.force[0], *branch = f->sim.events.branch[0];
        CHECK_NEAR_ARRAY(on_b, ((double[3]){0, 0, -force}), 3, 1e-9 * force, 1e-9);
        CHECK_NEAR_ARRAY(branch, ((double[3]){0, 0, H + 4 * step}), 3, 1e-15, 1e-12);
        check_moment(f, (double[6]){0, 0, force * (H + 4 * step), 0, 0, 0}, 300.0 / 7, 1e-6);
    }
}

static void sheared(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_BONDS; i++) {
        const struct bond *b = &bonds[i];
        double step = b->slip / PATH;
        build(f, b->model, b->sheared, 2);
        assert_int_equal(until_it_breaks(f, (double[3]){step, 0, 0}), 4);
        double force = b->ks * AREA * 4 * step;
        check_moment(f, (double[6]){0, 0, 0, 0, 0.5 * force * H, 0}, 0, 1e-2);
        CHECK_NEAR(f->sim.events.force[0][0], -force, 0, 1e-5);
    }
}

/* A specimen that is turned, by 120 degrees about its diagonal, has its tensor turned. */
static void turned(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_BONDS; i++) {
        double first[6] = {0};
        for (int axis = 0; axis < 3; axis++) {
            struct brc_acoustic a;
            double u[3];
            int x = axis, y = (axis + 1) % 3, z = (axis + 2) % 3;
            build(f, bonds[i].model, bonds[i].pulled, axis);
            u[x] = 0.1 * bonds[i].open;
            u[y] = 0.07 * bonds[i].open;
            u[z] = -0.03 * bonds[i].open;
            until_it_breaks(f, u);
            CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
            const double *m = a.moment[0];
            const double own[6] = {m[x],     m[y],     m[z],
                                   m[3 + x], m[3 + y], m[3 + z]}; /* 3 + k: without k */
            if (axis == 0)
                memcpy(first, own, sizeof own);
            assert_true(first[0] > 0 && first[5] > 0 && first[4] < 0);
            CHECK_NEAR_ARRAY(own, first, 6, 1e-9 * first[0], 1e-9);
            brc_acoustic_free(&a);
        }
    }
}

/* What a bond that softens sets free is what it bore as that began, not the nothing that it bears
 * at the end of it. */
static void softened(void **state)
{
    struct fixture *f = *state;
    const struct bond *b = &bonds[1];
    double step = b->open / PATH, force = b->kn * AREA * 4 * step;
    build(f, b->model,
          "interaction: all; points: one; softening: bilinear; sigma_t: 1 MPa; tau: 50 MPa", 2);
    assert_true(until_it_breaks(f, (double[3]){0, 0, step}) > 20);
    CHECK_NEAR(f->sim.events.force[0][2], -force, 0, 1e-9);
}

/* The friction of a bond that is pressed stays when it breaks, and so does what presses it. */
static void pressed(void **state)
{
    struct fixture *f = *state;
    const struct bond *b = &bonds[1];
    const double zero[3] = {0, 0, 0}, press = 1e-9, mu = 0.5;
    build(f, b->model,
          "interaction: all; points: one; softening: none; sigma_t: 10 kPa; tau: 10 kPa; mu: 0.5",
          2);
    fixture_velocity(f, 1, (double[3]){0, 0, -press}, zero);
    fixture_carry(f, 1);
    double friction = mu * b->kn * press, step = (1e4 + friction) / b->ks / PATH;
    assert_int_equal(until_it_breaks(f, (double[3]){step, 0, 0}), 4);
    double force = AREA * (b->ks * 4 * step - friction);
    CHECK_NEAR(f->sim.events.force[0][0], -force, 0, 1e-4);
    CHECK_NEAR(f->sim.events.force[0][2], 0, 1e-4 * force, 0);
}

/* Whatever the force and the direction: turned with both, the tensor has the same R. */
static void any_force_turned(void **state)
{
    struct fixture *f = *state;
    build(f, "vgcm", "interaction: all", 2);
    for (int trial = 0; trial < 20; trial++) {
        struct brc_event event = {.a = 0, .b = 1, .area = 1, .energy = 1};
        struct brc_acoustic a;
        double q[4], phi[3], m[3][3], turned[3][3], rotation[3][3];
        for (int k = 0; k < 3; k++) {
            event.force[k] = fixture_draw(f);
            event.branch[k] = fixture_draw(f);
            phi[k] = 3 * fixture_draw(f);
        }
        f->sim.events.table.n = 0;
        brc_events_add(&f->ctx, &f->sim.events, 0, &event);
        CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
        const double *s = a.moment[0], r = a.r[0];
        const double all[3][3] = {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
        brc_quat_from_rotation(q, phi);
        brc_quat_matrix(rotation, q);
        for (int i = 0; i < 3; i++) /* the rows of all turned, then its columns */
            brc_mat_mul(m[i], rotation, all[i]);
        for (int i = 0; i < 3; i++) {
            double column[3] = {m[0][i], m[1][i], m[2][i]};
            brc_mat_mul(turned[i], rotation, column);
        }
        brc_acoustic_free(&a);
        brc_quat_rotate(event.force, q, event.force);
        brc_quat_rotate(event.branch, q, event.branch);
        f->sim.events.table.n = 0;
        brc_events_add(&f->ctx, &f->sim.events, 0, &event);
        CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
        const double is[6] = {turned[0][0], turned[1][1], turned[2][2],
                              turned[1][2], turned[0][2], turned[0][1]};
        CHECK_NEAR_ARRAY(a.moment[0], is, 6, 1e-12, 0);
        CHECK_NEAR(a.r[0], r, 1e-9, 0);
        brc_acoustic_free(&a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(pulled),   FIXTURE_TEST(sheared), FIXTURE_TEST(turned),
        FIXTURE_TEST(softened), FIXTURE_TEST(pressed), FIXTURE_TEST(any_force_turned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
