/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pressure on a specimen's sides, by a surface of the test's own, and the triaxial test. */
#include "common/engine/accounts.h"
#include "common/engine/rotation.h"
#include "common/rigs/pressure.h"
#include "tests/fixture.h"

#include <stdlib.h>
#include <string.h>

extern const struct brc_model brc_model_polyhedra, brc_model_vgcm;

static void build(struct fixture *f, const char *pressure)
{
    char own[64];
    snprintf(own, sizeof own, "pressure: %s", pressure);
    fixture_test(f, &brc_model_polyhedra, "", "kind: triaxial; target: 0.02", own, "");
}

static void cylinder(struct fixture *f)
{
    fixture_specimen(f, "shape: cylinder; diameter: 2 cm; height: 2 cm; grains: packing; "
                        "diameter_min: 5 mm; diameter_max: 7 mm; seed: 2; cache: off");
}

/* --- the closed surface, as the header says it moves -------------------------------------------
 */

static bool is_end(const struct fixture *f, size_t facet)
{
    return fabs(f->specimen.facets.normal[facet][2]) > 0.9;
}

/* Vertices of the sides: the mean of where their grains carry them. Others stay. */
static double (*places(struct fixture *f))[3]
{
    const struct brc_facets *s = &f->specimen.facets;
    double(*x)[3] = calloc(s->n_vertices, sizeof *x);
    int *n = calloc(s->n_vertices, sizeof *n);
    int32_t *last = malloc(s->n_vertices * sizeof *last); /* facets are sorted by cell */
    memset(last, -1, s->n_vertices * sizeof *last);
    for (size_t i = 0; i < s->n_facets; i++) {
        if (s->cell[i][1] >= 0 || is_end(f, i))
            continue;
        for (size_t k = s->first[i]; k < s->first[i + 1]; k++) {
            int32_t v = s->loop[k], cell = s->cell[i][0];
            double now[3];
            if (last[v] == cell)
                continue;
            last[v] = cell;
            brc_bodies_carry(&f->sim.bodies, (size_t)cell, s->vertex[v], now);
            brc_add(x[v], x[v], now);
            n[v]++;
        }
    }
    for (size_t v = 0; v < s->n_vertices; v++)
        if (n[v] > 0)
            brc_scale(x[v], x[v], 1.0 / n[v]);
        else
            brc_copy(x[v], s->vertex[v]);
    free(n);
    free(last);
    return x;
}

/* Of the triangles from a facet's mean corner: area vector, its moment about the origin, and three
 * times the volume under them. */
struct sums {
    double area[3], moment[3], volume;
};

static void add_facet(const struct fixture *f, double (*x)[3], size_t facet, struct sums *sums)
{
    const struct brc_facets *s = &f->specimen.facets;
    size_t first = s->first[facet], n = s->first[facet + 1] - first;
    double m[3] = {0, 0, 0};
    for (size_t k = 0; k < n; k++)
        brc_axpy(m, 1.0 / (double)n, x[s->loop[first + k]]);
    for (size_t k = 0; k < n; k++) {
        const double *u = x[s->loop[first + k]], *v = x[s->loop[first + (k + 1) % n]];
        double a[3], b[3], area[3], middle[3], moment[3];
        brc_sub(a, u, m);
        brc_sub(b, v, m);
        brc_cross(area, a, b);
        brc_scale(area, area, 0.5);
        brc_add(middle, u, v);
        brc_add(middle, middle, m);
        brc_scale(middle, middle, 1.0 / 3);
        brc_cross(moment, middle, area);
        brc_add(sums->area, sums->area, area);
        brc_add(sums->moment, sums->moment, moment);
        sums->volume += brc_dot(middle, area) / 3;
    }
}

static struct sums sum_over(struct fixture *f, bool ends, bool sides)
{
    const struct brc_facets *s = &f->specimen.facets;
    struct sums sums = {0};
    double(*x)[3] = places(f);
    for (size_t i = 0; i < s->n_facets; i++)
        if (s->cell[i][1] < 0 && (is_end(f, i) ? ends : sides))
            add_facet(f, x, i, &sums);
    free(x);
    return sums;
}

/* Every grain is moved and turned by its own. */
static void shake(struct fixture *f, double size)
{
    struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        double w[3];
        for (int k = 0; k < 3; k++) {
            b->x[i][k] += size * fixture_draw(f);
            w[k] = 100 * size * fixture_draw(f);
        }
        brc_rotation_turn(b->q[i], w, 1);
    }
}

static void the_surface_is_closed(void **state)
{
    struct fixture *f = *state;
    cylinder(f);
    build(f, "5 MPa");
    for (int round = 0; round < 3; round++) {
        struct brc_bodies *b = &f->sim.bodies;
        brc_pressure_find(&f->sim, f->sim.rig.memory);
        struct sums ends = sum_over(f, true, false), sides = sum_over(f, false, true);
        double area[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, size = 0;
        for (size_t i = 0; i < b->n_grains; i++) {
            double arm[3];
            brc_cross(arm, b->x[i], b->side_area[i]);
            brc_add(area, area, b->side_area[i]);
            brc_add(moment, moment, arm);
            brc_add(moment, moment, b->side_moment[i]);
            size += brc_norm(b->side_area[i]);
        }
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(area[k], -sides.area[k], 1e-14 * size, 0);
            CHECK_NEAR(area[k] - ends.area[k], 0, 1e-14 * size, 0);
            CHECK_NEAR(moment[k] - ends.moment[k], 0, 1e-15 * size, 0);
        }
        shake(f, 1e-4);
    }
}

static void move(struct fixture *f, double (*u)[3], double part)
{
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++)
        brc_axpy(f->sim.bodies.x[i], part, u[i]);
}

/* d/dt of the volume by the motion of the ends alone, where their vertices move from x to y. */
static double rate_of_ends(struct fixture *f, double (*x)[3], double (*y)[3])
{
    const struct brc_facets *s = &f->specimen.facets;
    double(*now)[3] = places(f), rate = 0;
    for (size_t i = 0; i < s->n_facets; i++) {
        size_t first = s->first[i], n = s->first[i + 1] - first;
        double m[3] = {0, 0, 0}, vm[3] = {0, 0, 0};
        if (s->cell[i][1] >= 0 || !is_end(f, i))
            continue;
        for (size_t k = 0; k < n; k++) {
            int32_t v = s->loop[first + k];
            brc_axpy(m, 1.0 / (double)n, now[v]);
            brc_axpy(vm, 1.0 / (double)n, y[v]);
            brc_axpy(vm, -1.0 / (double)n, x[v]);
        }
        for (size_t k = 0; k < n; k++) {
            int32_t v = s->loop[first + k], w = s->loop[first + (k + 1) % n];
            double a[3], b[3], area[3], speed[3];
            brc_sub(a, now[v], m);
            brc_sub(b, now[w], m);
            brc_cross(area, a, b);
            for (int c = 0; c < 3; c++)
                speed[c] = (vm[c] + y[v][c] - x[v][c] + y[w][c] - x[w][c]) / 3;
            rate += 0.5 * brc_dot(area, speed);
        }
    }
    free(now);
    return rate;
}

/* For a straight motion of the grains by u the power of a unit pressure on the closed surface is a
 * polynomial of degree 2 in time, so that Simpson's rule gives its work, which is -dV. */
static void the_work_is_that_of_the_volume(void **state)
{
    struct fixture *f = *state;
    cylinder(f);
    build(f, "5 MPa");
    struct brc_bodies *b = &f->sim.bodies;
    shake(f, 1e-4);
    double(*u)[3] = calloc(b->n_grains, sizeof *u), work = 0, size = 0;
    for (size_t i = 0; i < b->n_grains; i++)
        for (int k = 0; k < 3; k++)
            u[i][k] = 1e-3 * fixture_draw(f);
    double before = sum_over(f, true, true).volume;
    double(*x)[3] = places(f);
    move(f, u, 1);
    double(*y)[3] = places(f), after = sum_over(f, true, true).volume;
    move(f, u, -1);
    for (int third = 0; third < 3; third++) {
        const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
        brc_pressure_find(&f->sim, f->sim.rig.memory);
        for (size_t i = 0; i < b->n_grains; i++) {
            work += weight[third] * brc_dot(b->side_area[i], u[i]);
            size += weight[third] * fabs(brc_dot(b->side_area[i], u[i]));
        }
        work -= weight[third] * rate_of_ends(f, x, y);
        move(f, u, 0.5);
    }
    CHECK_NEAR(work, before - after, 1e-13 * size, 0);
    free(u);
    free(x);
    free(y);
}

/* A grain that has gone takes its facets with it, and drags no vertex of the others. */
static void a_grain_that_has_left_is_not_pressed(void **state)
{
    struct fixture *f = *state;
    cylinder(f);
    build(f, "5 MPa");
    struct brc_bodies *b = &f->sim.bodies;
    struct brc_pressure *sides = f->sim.rig.memory;
    size_t gone = 0;
    brc_pressure_find(&f->sim, sides);
    while (brc_norm(b->side_area[gone]) == 0)
        gone++;
    double largest = 0;
    for (size_t i = 0; i < b->n_grains; i++)
        largest = fmax(largest, brc_norm(b->side_area[i]));
    CHECK_NEAR(brc_pressure_lost(&f->sim, sides), 0, 0, 0);
    brc_axpy(b->x[gone], -1e4, b->side_area[gone]);
    b->x[gone][0] *= 50;
    b->x[gone][1] *= 50;
    brc_pressure_find(&f->sim, sides);
    assert_int_equal(b->has_left[gone], 1);
    CHECK_NEAR(brc_norm(b->side_area[gone]), 0, 0, 0);
    assert_true(brc_pressure_lost(&f->sim, sides) > 0.001);
    for (size_t i = 0; i < b->n_grains; i++) {
        assert_true(i == gone || b->has_left[i] == 0);
        assert_true(brc_norm(b->side_area[i]) < 2 * largest);
    }
}

/* --- the test ----------------------------------------------------------------------------------
 */

static const struct brc_model *const models[] = {&brc_model_polyhedra, &brc_model_vgcm};
enum { N_MODELS = 2 };

static void no_pressure_is_compression(void **state)
{
    struct fixture *f = *state;
    double force[2][40];
    cylinder(f);
    for (int m = 0; m < N_MODELS; m++) {
        for (int i = 0; i < 2; i++) {
            if (i == 0)
                fixture_sim(f, models[m], "", "kind: compression; target: 0.02", "");
            else
                fixture_test(f, models[m], "", "kind: triaxial; target: 0.02", "pressure: 0 Pa",
                             "");
            fixture_steps(f, 400);
            for (int k = 0; k < 40; k++)
                force[i][k] = f->sim.rig.curve.force[k];
        }
        assert_memory_equal(force[0], force[1], sizeof force[0]);
    }
}

/* The pressure follows the platens up to what was asked, and stays; energies balance. */
static void the_ramp_is_isotropic(void **state)
{
    struct fixture *f = *state;
    cylinder(f);
    for (int m = 0; m < N_MODELS; m++) {
        fixture_test(f, models[m], "", "kind: triaxial; target: 0.01; strain_max: 2e-3",
                     "pressure: 10 MPa", "");
        double rate = 0;
        while (f->sim.rig.stage == 0 && f->sim.step < 3000) {
            rate = f->sim.rig.rate;
            fixture_steps(f, 1);
        }
        assert_int_equal(f->sim.rig.stage, 1);
        assert_true(f->sim.rig.rate < 0.2 * rate); /* a stage begins as a test does */
        fixture_steps(f, 400);
        const struct brc_curve *c = &f->sim.rig.curve;
        const double *sigma_1 = fixture_column(f, "sigma_1"),
                     *sigma_3 = fixture_column(f, "sigma_3");
        size_t ramp = (size_t)f->sim.rig.stage_row;
        for (size_t i = 0; i < c->table.n; i++) {
            assert_true(sigma_3[i] <= 10e6);
            CHECK_NEAR(sigma_1[i] - sigma_3[i], c->stress[i], 1e-9 * sigma_1[i], 0);
            if (i < ramp)
                CHECK_NEAR(sigma_1[i] / sigma_3[i], 1, 0.02, 0);
            if (i > ramp)
                CHECK_NEAR(sigma_3[i], 10e6, 1e-6, 0);
        }
        assert_true(c->stress[c->table.n - 1] > 2e6);
        const struct brc_ledger *l = brc_accounts_settle(&f->sim);
        CHECK_NEAR(brc_ledger_residual(l), 0, 1e-4, 0);
        assert_true(l->boundary > 0);
    }
}

/* A specimen turned as a whole has the same forces, turned: a spin gets no moment from them. */
static void sides_turn_with_the_specimen(void **state)
{
    struct fixture *f = *state;
    const double phi[3] = {0.3, -0.2, 0.7}, still[3] = {0, 0, 0};
    double q[4], m[3][3];
    cylinder(f);
    build(f, "5 MPa");
    struct brc_bodies *b = &f->sim.bodies;
    double(*area)[3] = calloc(b->n_grains, sizeof *area);
    brc_pressure_find(&f->sim, f->sim.rig.memory);
    memcpy(area, b->side_area, b->n_grains * sizeof *area);
    brc_quat_from_rotation(q, phi);
    brc_quat_matrix(m, q);
    fixture_place(f, q, still);
    brc_pressure_find(&f->sim, f->sim.rig.memory);
    for (size_t i = 0; i < b->n_grains; i++) {
        double turned[3];
        brc_mat_mul(turned, m, area[i]);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(b->side_area[i][k], turned[k], 1e-15, 0);
    }
    free(area);
}

/* Hard cases: a thousand times the strength, and a specimen that falls to pieces. */
static void hard_pressures_are_borne(void **state)
{
    static const struct {
        const struct brc_model *model;
        const char *settings, *pressure;
    } cases[] = {{&brc_model_vgcm, "sigma_t: 100 kPa; tau: 500 kPa; softening: none", "100 MPa"},
                 {&brc_model_polyhedra, "eps_th: 2e-6", "100 MPa"},
                 {&brc_model_vgcm, "sigma_t: 10 kPa; tau: 10 kPa; softening: none", "20 kPa"},
                 {&brc_model_polyhedra, "eps_th: 1e-7; mu: 0.1", "100 kPa"}};
    struct fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char own[64];
        snprintf(own, sizeof own, "pressure: %s", cases[i].pressure);
        cylinder(f);
        fixture_test(f, cases[i].model, cases[i].settings,
                     "kind: triaxial; target: 0.02; strain_max: 0.05; stop_drop: 0", own, "");
        while (!brc_rigs_end(&f->sim) && f->sim.step < 6000)
            fixture_steps(f, 1);
        const struct brc_ledger *l = brc_accounts_settle(&f->sim);
        print_message("%s, %s: %lld steps, stage %lld, %zu broken, lost %.3g, residual %.2g\n",
                      cases[i].model->name, own, (long long)f->sim.step,
                      (long long)f->sim.rig.stage, f->sim.events.table.n,
                      brc_pressure_lost(&f->sim, f->sim.rig.memory), brc_ledger_residual(l));
        assert_int_equal(f->sim.rig.stage, 1);
        CHECK_BETWEEN(brc_ledger_residual(l), 0, 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(the_surface_is_closed),
                                       FIXTURE_TEST(the_work_is_that_of_the_volume),
                                       FIXTURE_TEST(a_grain_that_has_left_is_not_pressed),
                                       FIXTURE_TEST(sides_turn_with_the_specimen),
                                       FIXTURE_TEST(no_pressure_is_compression),
                                       FIXTURE_TEST(the_ramp_is_isotropic),
                                       FIXTURE_TEST(hard_pressures_are_borne)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
