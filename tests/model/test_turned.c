/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimen and rig turned together are the same test: space has no directions but those that the
 * rig brings. Tests are tied to x, y and z, so their `place` is called on the specimen as it was
 * made; then platens and velocities are turned to where the specimen has been turned. Engine and
 * models see the turned world alone, and so does `drive` of those tests that move along the normals
 * of their platens. A cantilever has keys for its axes, and a path of stresses says which is x and
 * which y: these are turned by their keys, without a line of help. */
#include "tests/fixture.h"

#include <stdlib.h>

extern const struct brc_model brc_model_polyhedra, brc_model_vgcm;
static const struct brc_model *const models[] = {&brc_model_polyhedra, &brc_model_vgcm};
enum { N_MODELS = 2 };

#define RUN "damping: along_velocity"

/* --- turning -----------------------------------------------------------------------------------
 */

/* The one turned world at a time. */
static struct {
    const struct brc_rig_type *type; /* the test itself */
    struct brc_rig_type seen;        /* and what the engine is given for it */
    const struct brc_specimen *made; /* before it was turned */
    double forth[3][3], back[3][3], back_turn[4];
    double n[BRC_MAX_PLATENS][3]; /* of the platens, in the axes of the test */
} world;

static void turn_platens(struct brc_sim *sim, double m[3][3])
{
    struct brc_bodies *b = &sim->bodies;
    size_t n = b->n_grains;
    fixture_turn_vectors(b->x + n, b->n - n, m);
    fixture_turn_vectors(b->v + n, b->n - n, m);
    fixture_turn_vectors(b->v_mean + n, b->n - n, m);
    for (int i = 0; i < sim->rig.n_platens; i++) {
        fixture_turn_vectors(&sim->rig.platen[i].n, 1, m);
        fixture_turn_vectors(&sim->rig.platen[i].across, 1, m);
    }
}

/* Where bodies began is told in the axes of the test throughout: tests alone read it. */
static int place(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    const struct brc_specimen *specimen = sim->specimen;
    size_t n = b->n_grains;
    double(*x)[3] = malloc(n * sizeof *x), (*q)[4] = malloc(n * sizeof *q);
    memcpy(x, b->x, n * sizeof *x);
    memcpy(q, b->q, n * sizeof *q);
    fixture_turn_vectors(b->x, n, world.back);
    memcpy(b->x0, b->x, n * sizeof *x);
    for (size_t i = 0; i < n; i++) {
        brc_quat_mul(b->q[i], world.back_turn, q[i]);
        memcpy(b->q0[i], b->q[i], sizeof b->q[i]);
    }
    sim->rig.type = world.type; /* its field, in its own axes */
    sim->specimen = world.made;
    int code = world.type->place(sim);
    sim->specimen = specimen;
    sim->rig.type = &world.seen;
    for (int i = 0; i < sim->rig.n_platens; i++)
        brc_copy(world.n[i], sim->rig.platen[i].n);
    memcpy(b->x, x, n * sizeof *x);
    memcpy(b->q, q, n * sizeof *q);
    fixture_turn_vectors(b->v, n, world.forth);
    fixture_turn_vectors(b->v_mean, n, world.forth);
    turn_platens(sim, world.forth);
    free(x);
    free(q);
    return code;
}

static int drive_along_axes(struct brc_sim *sim)
{
    turn_platens(sim, world.back);
    int code = world.type->drive(sim);
    turn_platens(sim, world.forth);
    return code;
}

/* Gauges are along the axes of the test; bodies get their bits back. */
static int measure(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    double(*x)[3] = malloc(b->n * sizeof *x), now[BRC_MAX_PLATENS][3] = {{0}};
    memcpy(x, b->x, b->n * sizeof *x);
    fixture_turn_vectors(b->x, b->n, world.back);
    for (int i = 0; i < sim->rig.n_platens; i++) {
        brc_copy(now[i], sim->rig.platen[i].n);
        brc_copy(sim->rig.platen[i].n, world.n[i]);
    }
    int code = world.type->measure(sim);
    memcpy(b->x, x, b->n * sizeof *x);
    for (int i = 0; i < sim->rig.n_platens; i++)
        brc_copy(sim->rig.platen[i].n, now[i]);
    free(x);
    return code;
}

static void field(const struct brc_sim *sim, size_t grain, double v[3])
{
    struct brc_sim as_placed = *sim;
    for (int i = 0; i < sim->rig.n_platens; i++)
        brc_copy(as_placed.rig.platen[i].n, world.n[i]);
    world.type->field(&as_placed, grain, v);
    fixture_turn_vectors((double(*)[3])v, 1, world.forth);
}

/* What stands in f is made again in g, turned by phi. */
static void make_turned(struct fixture *f, struct fixture *g, const char *settings,
                        const char *test, const char *own, const double phi[3])
{
    const struct brc_model *model = brc_registry_find(f->sim.model.name);
    double q[4], back[3];
    world.type = f->sim.rig.type;
    world.made = &f->specimen;
    world.seen = *world.type;
    world.seen.place = place;
    world.seen.measure = measure;
    if (world.type->n_platens > 2)
        world.seen.drive = drive_along_axes;
    if (world.type->field)
        world.seen.field = field;
    brc_quat_from_rotation(q, phi);
    brc_quat_matrix(world.forth, q);
    brc_scale(back, phi, -1);
    brc_quat_from_rotation(world.back_turn, back);
    brc_quat_matrix(world.back, world.back_turn);
    fixture_turn(g, world.forth);
    g->instead = &world.seen;
    fixture_test(g, model, settings, test, own, RUN);
}

/* --- before the first break --------------------------------------------------------------------
 */

/* Points of vgcm soften before they break. */
static bool is_damaged(const struct fixture *f)
{
    return f->sim.events.table.n > 0 || f->sim.ledger.damage != 0;
}

static void run_both(struct fixture *f, struct fixture *g, int most)
{
    while (!is_damaged(f) && !is_damaged(g) && f->sim.step < most && !brc_rigs_done(&f->sim)) {
        fixture_steps(f, 1);
        fixture_steps(g, 1);
    }
}

/* Largest difference of two columns over the largest value of one. */
static double differ(const double *a, const double *b, const double *scale, size_t n)
{
    double most = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        assert_true(isfinite(a[i]) && isfinite(b[i]));
        most = fmax(most, fabs(a[i] - b[i]));
        largest = fmax(largest, fabs(scale[i]));
    }
    return most / largest;
}

/* Of rows that both have, all before damage. */
static void check_rows(const struct fixture *f, const struct fixture *g, const char *name,
                       double allowed)
{
    const struct brc_curve *c = &f->sim.rig.curve, *d = &g->sim.rig.curve;
    size_t n = c->table.n;
    assert_true(n >= 10 && d->table.n == n);
    double stress = differ(c->stress, d->stress, c->stress, n);
    double strain = differ(c->strain, d->strain, c->strain, n);
    bool has_gauge = f->sim.rig.n_platens > 1; /* a clamp alone has none */
    double along = has_gauge ? differ(c->strain_axial, d->strain_axial, c->strain, n) : 0;
    double across = has_gauge ? differ(c->strain_lateral, d->strain_lateral, c->strain, n) : 0;
    print_message("%s, %s: %zu rows, stress to %.1e, platens to %.1e, gauges to %.1e, %.1e\n",
                  f->sim.model.name, name, n, stress, strain, along, across);
    CHECK_NEAR(stress, 0, allowed, 0);
    CHECK_NEAR(strain, 0, allowed, 0);
    CHECK_NEAR(along, 0, allowed, 0);
    CHECK_NEAR(across, 0, allowed, 0);
}

static const char CORE[] = "shape: cylinder; diameter: 2 cm; height: 2 cm; grains: packing; "
                           "diameter_min: 5 mm; diameter_max: 7 mm; seed: 2",
                  BOX[] = "shape: box; size: 2 cm, 2 cm, 2 cm; grains: packing; diameter_min: "
                          "5 mm; diameter_max: 7 mm; seed: 2";

static const double PHI[3] = {0.7, -1.1, 0.4};

/* Faces of polyhedra touch at a depth of zero as they are made, and what touches counts in the
 * scaled masses; where faces part, it is round-off that says which do. So their touches are next to
 * nothing where they are not pressed together. */
#define NO_TOUCH "kn: 1 N/m; kt: 1 N/m"

static void curves_turn_with_specimen_and_rig(void **state)
{
    static const struct {
        const char *specimen, *test, *own;
        const char *settings[N_MODELS]; /* NULL: without this model */
    } tests[] = {{CORE, "kind: compression; friction: 0.3", "", {"", ""}},
                 {CORE, "kind: tension", "", {NO_TOUCH, ""}},
                 {CORE, "kind: tension; grip: full", "", {NO_TOUCH, ""}},
                 {CORE, "kind: brazilian; plate_width: 4 mm", "edge_radius: 1 mm", {NULL, ""}},
                 {CORE, "kind: brazilian", "platens: jaws", {NULL, ""}},
                 {CORE, "kind: triaxial; friction: 0.3", "pressure: 10 MPa", {"", ""}},
                 {BOX,
                  "kind: true_triaxial",
                  "stages: isotropic to 20 MPa, stress 20 MPa 30 MPa 80 MPa",
                  {"", ""}}};
    struct fixture *f = *state, *g;
    assert_int_equal(fixture_open((void **)&g), 0);
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        for (int m = 0; m < N_MODELS; m++) {
            char test[128];
            if (!tests[i].settings[m])
                continue;
            snprintf(test, sizeof test, "%s; target: 0.01", tests[i].test);
            fixture_specimen(f, tests[i].specimen);
            fixture_specimen(g, tests[i].specimen);
            fixture_test(f, models[m], tests[i].settings[m], test, tests[i].own, RUN);
            make_turned(f, g, tests[i].settings[m], test, tests[i].own, PHI);
            run_both(f, g, 3000);
            check_rows(f, g, tests[i].test, 1e-6);
        }
    fixture_close((void **)&g);
}

/* --- by the keys of the tests ------------------------------------------------------------------
 */

/* The turn of a cube that takes x to one axis, and -z to a direction across it. */
static void whole_turn(double m[3][3], int axis, int across, double sense)
{
    double x[3] = {0}, y[3], z[3] = {0};
    x[axis] = 1;
    z[across] = -sense;
    brc_cross(y, z, x);
    for (int k = 0; k < 3; k++)
        brc_set(m[k], x[k], y[k], z[k]);
}

static void bend(struct fixture *f, const struct brc_model *model, const char *settings,
                 const char *way)
{
    char own[128];
    snprintf(own, sizeof own, "load: 1 N; tolerance: 1e-8; ramp: 100; %s", way);
    fixture_test(f, model, settings, "kind: cantilever", own, RUN);
    while (!brc_rigs_done(&f->sim))
        fixture_steps(f, 1);
    assert_string_equal(brc_rigs_end(&f->sim), "cantilever.tolerance");
}

/* Each of the twelve beams that begin at the lower end of an axis, when at rest: so masses do not
 * count, nor, without friction, the way there. */
static void a_beam_bends_alike_along_any_axis(void **state)
{
    static const char beam[] = "shape: box; size: 3 cm, 1 cm, 1 cm; grains: packing; diameter_min: "
                               "5 mm; diameter_max: 7 mm; seed: 1";
    struct fixture *f = *state;
    for (int m = 0; m < N_MODELS; m++) {
        const char *settings = m == 0 ? "mu: 0" : "";
        double strain, force, worst = 0;
        fixture_specimen(f, beam);
        bend(f, models[m], settings, "axis: x; direction: -z");
        strain = f->sim.rig.strain;
        force = f->sim.rig.force;
        for (int i = 0; i < 12; i++) {
            int axis = i / 4, across = (axis + 1 + i / 2 % 2) % 3;
            double turn[3][3], sense = i % 2 ? 1 : -1;
            char way[64];
            snprintf(way, sizeof way, "axis: %c; direction: %s%c", "xyz"[axis],
                     sense < 0 ? "-" : "", "xyz"[across]);
            whole_turn(turn, axis, across, sense);
            fixture_specimen(f, beam);
            fixture_turn(f, turn);
            bend(f, models[m], settings, way);
            worst = fmax(worst, fabs(f->sim.rig.strain / strain - 1));
            CHECK_NEAR(f->sim.rig.strain, strain, 0, 1e-6);
            CHECK_NEAR(f->sim.rig.force, force, 0, 1e-6);
        }
        print_message("%s: the tip of a turned beam to %.1e\n", models[m]->name, worst);
    }
}

/* A quarter turn about z changes x for y in a path of stresses. */
static void a_path_turns_with_its_axes(void **state)
{
    double quarter[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    struct fixture *f = *state, *g;
    assert_int_equal(fixture_open((void **)&g), 0);
    for (int m = 0; m < N_MODELS; m++) {
        fixture_specimen(f, BOX);
        fixture_specimen(g, BOX);
        fixture_turn(g, quarter);
        fixture_test(f, models[m], "", "kind: true_triaxial; target: 0.01",
                     "stages: stress 20 MPa 30 MPa 80 MPa", RUN);
        fixture_test(g, models[m], "", "kind: true_triaxial; target: 0.01",
                     "stages: stress 30 MPa 20 MPa 80 MPa", RUN);
        run_both(f, g, 3000);
        check_rows(f, g, "x for y", 1e-6);
    }
    fixture_close((void **)&g);
}

/* --- peaks -------------------------------------------------------------------------------------
 */

static double peak(struct fixture *f)
{
    while (!brc_rigs_done(&f->sim) && f->sim.step < 20000)
        fixture_steps(f, 1);
    assert_null(brc_curve_why_no_peak(&f->sim.rig));
    return f->sim.rig.force_peak / f->sim.rig.section;
}

enum { N_PEAKS = 8 };

static void mean_of(const double x[N_PEAKS], double *mean, double *error)
{
    double square = 0;
    *mean = 0;
    for (int i = 0; i < N_PEAKS; i++)
        *mean += x[i] / N_PEAKS;
    for (int i = 0; i < N_PEAKS; i++)
        square += (x[i] - *mean) * (x[i] - *mean);
    *error = sqrt(square / (N_PEAKS * (N_PEAKS - 1)));
}

/* Beyond damage round-off grows to other cracks, so peaks agree in the mean alone: of 8 specimens
 * within 2 standard errors, and pair by pair, where the scatter of the specimens drops out, within
 * 3.5 of the differences, which chance exceeds once in a hundred times (Student's t of 7), or 1e-6
 * where there are none. */
static void peaks_agree_in_the_mean(void **state)
{
    static const struct {
        const char *test, *own;
    } tests[] = {
        {"kind: compression; target: 0.03; stop_drop: 0.8; strain_max: 0.1", ""},
        {"kind: triaxial; target: 0.03; stop_drop: 0.8; strain_max: 0.1", "pressure: 5 MPa"}};
    struct fixture *f = *state, *g;
    assert_int_equal(fixture_open((void **)&g), 0);
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        for (int m = 0; m < N_MODELS; m++) {
            double made[N_PEAKS], more[N_PEAKS], mean[2], error[2];
            for (int k = 0; k < N_PEAKS; k++) {
                char core[200];
                snprintf(core, sizeof core,
                         "shape: cylinder; diameter: 2 cm; height: 4 cm; grains: packing; "
                         "diameter_min: 5 mm; diameter_max: 7 mm; seed: %d",
                         k + 1);
                fixture_specimen(f, core);
                fixture_specimen(g, core);
                fixture_test(f, models[m], "", tests[i].test, tests[i].own, RUN);
                make_turned(f, g, "", tests[i].test, tests[i].own, PHI);
                made[k] = peak(f);
                more[k] = peak(g) - made[k];
            }
            mean_of(made, &mean[0], &error[0]);
            mean_of(more, &mean[1], &error[1]);
            print_message("%s, %s: %.2f +- %.2f MPa, turned %+.3f +- %.3f MPa\n", models[m]->name,
                          tests[i].test, 1e-6 * mean[0], 1e-6 * error[0], 1e-6 * mean[1],
                          1e-6 * error[1]);
            CHECK_NEAR(mean[1], 0, 2 * error[0], 0);
            CHECK_NEAR(mean[1], 0, 3.5 * error[1] + 1e-6 * mean[0], 0);
        }
    fixture_close((void **)&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(curves_turn_with_specimen_and_rig),
                                       FIXTURE_TEST(a_beam_bends_alike_along_any_axis),
                                       FIXTURE_TEST(a_path_turns_with_its_axes),
                                       FIXTURE_TEST(peaks_agree_in_the_mean)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
