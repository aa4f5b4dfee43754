/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two bodies, closed forms: impact, sliding, rolling, friction on an incline. All numbers follow
 * from mechanics alone, none from the code. */
#include "tests/fixture.h"

#include <stdio.h>

/* An octahedron whose core has its tip on the x axis flies at a box: one vertex on one face. */
static const double R = 1e-3, TIP = 0.01, BOX = 0.02, GAP = 1e-6;
static const double K = 1e6;

static const struct brc_model *poly(void)
{
    return brc_registry_find("polyhedra");
}

static const struct brc_model *vgcm(void)
{
    return brc_registry_find("vgcm");
}

/* Distance of the octahedron's centre to its rounded tip: erosion moves the core's tip in by
 * sqrt(3) R, rounding gives R back. */
static double rounded_tip(void)
{
    return TIP - sqrt(3) * R + R;
}

static void build_polyhedra(struct fixture *f, const char *settings, double dt)
{
    struct brc_convex cell[2];
    char run[64], all[256];
    for (int i = 0; i < 2; i++)
        cell[i] = (struct brc_convex){0};
    fixture_box(f, &cell[0], (double[3]){-BOX / 2, 0, 0}, (double[3]){BOX, BOX, BOX});
    fixture_octahedron(f, &cell[1], (double[3]){rounded_tip() + GAP, 0, 0}, TIP);
    fixture_loose(f, cell, NULL, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    snprintf(run, sizeof run, "dt: %.17g s", dt);
    snprintf(all, sizeof all, "radius: 1 mm; kn: 1e6 N/m; kt: 1e6 N/m; %s", settings);
    fixture_free_sim(f, poly(), all, run);
}

/* Two spheres of radius 5 mm on the x axis, their surfaces GAP apart. */
static void build_spheres(struct fixture *f, const char *settings, double dt)
{
    const double radius[2] = {5e-3, 5e-3}, edges[3] = {8e-3, 8e-3, 8e-3};
    struct brc_convex cell[2];
    char run[64];
    for (int i = 0; i < 2; i++) {
        cell[i] = (struct brc_convex){0};
        fixture_box(f, &cell[i], (double[3]){i == 0 ? 0 : 1e-2 + GAP, 0, 0}, edges);
    }
    fixture_loose(f, cell, radius, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    snprintf(run, sizeof run, "dt: %.17g s", dt);
    fixture_free_sim(f, vgcm(), settings, run);
}

static double effective_mass(const struct fixture *f)
{
    const double *m = f->sim.bodies.mass;
    return m[0] * m[1] / (m[0] + m[1]);
}

/* Relative velocity v of body 1 at the touch, which happens GAP / -v[0] from now with the centres
 * (or the tip) on the x axis. Returns when contact began; the centre of mass stays. */
static double throw_at(struct fixture *f, const double v[3])
{
    const double zero[3] = {0, 0, 0}, *m = f->sim.bodies.mass;
    double v0[3], v1[3], until = GAP / -v[0];
    brc_scale(v0, v, -m[1] / (m[0] + m[1]));
    brc_scale(v1, v, m[0] / (m[0] + m[1]));
    fixture_velocity(f, 0, v0, zero);
    fixture_velocity(f, 1, v1, zero);
    for (int k = 1; k < 3; k++) {
        f->sim.bodies.x[0][k] -= v0[k] * until;
        f->sim.bodies.x[1][k] -= v1[k] * until;
    }
    fixture_ledger(f);
    return until;
}

struct impact {
    double duration;
    double e, e_t;    /* restitution along x, and of the velocity across */
    double residual;  /* of the ledger */
    double largest_f; /* N */
};

/* Flies through the contact; the moment of separation comes from the straight flight after it. */
static struct impact impact(struct fixture *f, const double v[3], double duration)
{
    const struct brc_bodies *b = &f->sim.bodies;
    double start = throw_at(f, v), distance = b->x[1][0] - b->x[0][0] - GAP;
    struct impact r = {0};
    int n = (int)ceil((start + 3 * duration) / f->sim.dt);
    for (int i = 0; i < n; i++) {
        fixture_steps(f, 1);
        r.largest_f = fmax(r.largest_f, fixture_largest_force(f));
        CHECK_NEAR(fixture_third_law(f), 0, 1e-12, 0);
    }
    double out = b->v[1][0] - b->v[0][0];
    r.duration = n * f->sim.dt - (b->x[1][0] - b->x[0][0] - distance) / out - start;
    r.e = out / -v[0];
    r.e_t = v[1] != 0 ? (b->v[1][1] - b->v[0][1]) / v[1] : 0;
    r.residual = brc_ledger_residual(&f->sim.ledger);
    return r;
}

/* 2000 steps a half period: leapfrog's frequency is off by (pi/2000)^2/24, the step in which the
 * contact begins and ends makes (pi/2000)^2 at most: together below 5e-6. */
enum { STEPS = 2000 };

static void head_on(struct fixture *f, double k, double v)
{
    double m = effective_mass(f), half = BRC_PI * sqrt(m / k);
    struct impact r = impact(f, (double[3]){-v, 0, 0}, half);
    CHECK_NEAR(r.duration, half, 0, 2e-5);
    CHECK_NEAR(r.e, 1, 0, 2e-5);
    CHECK_NEAR(r.largest_f, v * sqrt(k * m), 0, 2e-5);
    /* one step of the trapezoid rule is cut by the onset of contact: (pi/2000)^2 */
    CHECK_NEAR(r.residual, 0, 1e-5, 0);
}

/* Stiffness of two spheres by PHYSICS: E-bar pi r^2 / d with d their distance at touch. */
static double sphere_stiffness(void)
{
    return 48.8e9 * BRC_PI * 25e-6 / 1e-2;
}

static void head_on_polyhedra(void **state)
{
    struct fixture *f = *state;
    const char *rules[3] = {"mu: 0; gn: 0 1/s; features: strict",
                            "mu: 0; gn: 0 1/s; features: closed",
                            "mu: 0; gn: 0 1/s; features: merged"};
    double m1 = 3000 * BOX * BOX * BOX, m2 = 3000 * 4.0 / 3 * TIP * TIP * TIP;
    for (int i = 0; i < 3; i++) {
        build_polyhedra(f, rules[i], BRC_PI * sqrt(m1 * m2 / (m1 + m2) / K) / STEPS);
        CHECK_NEAR(f->sim.bodies.mass[0], m1, 0, 1e-12);
        CHECK_NEAR(f->sim.bodies.mass[1], m2, 0, 1e-12);
        head_on(f, K, 0.05);
    }
}

static void head_on_spheres(void **state)
{
    struct fixture *f = *state;
    double m = 2650 * 4.0 / 3 * BRC_PI * 125e-9;
    build_spheres(f, "mu: 0", BRC_PI * sqrt(m / 2 / sphere_stiffness()) / STEPS);
    /* the sphere's own mass, or that of the cell: the law does not care */
    head_on(f, sphere_stiffness(), 0.05);
}

/* m x'' + g m x' + K x = 0 until the force, which is never tensile, vanishes: x'' = 0 at
 * omega t = pi - atan2(2 beta omega, omega^2 - beta^2), and e is the velocity there. */
static double restitution(double beta, double omega0)
{
    double omega = sqrt(omega0 * omega0 - beta * beta);
    double phase = BRC_PI - atan2(2 * beta * omega, omega * omega - beta * beta);
    return exp(-beta / omega * phase) * -(cos(phase) - beta / omega * sin(phase));
}

static void damped(struct fixture *f, double k, double g)
{
    double omega0 = sqrt(k / effective_mass(f)), half = BRC_PI / omega0;
    struct impact r = impact(f, (double[3]){-0.05, 0, 0}, half);
    /* the damping force uses the velocity of the half step before: first order, g dt / 2 = 3e-4 of
     * the viscous part; measured 3e-4 of e */
    CHECK_NEAR(r.e, restitution(g / 2, omega0), 0, 1e-3);
    /* the viscous work is summed by the same trapezoid: first order at the jump of the force when
     * contact begins, g v m on v dt: g dt of the energy */
    CHECK_NEAR(r.residual, 0, g * half / STEPS, 0);
}

static void viscous_restitution_polyhedra(void **state)
{
    struct fixture *f = *state;
    double m1 = 3000 * BOX * BOX * BOX, m2 = 3000 * 4.0 / 3 * TIP * TIP * TIP;
    double omega0 = sqrt(K * (m1 + m2) / (m1 * m2));
    for (int i = 1; i <= 3; i++) {
        char settings[64];
        double g = 0.2 * i * i * omega0; /* the last beyond what a linear dashpot could bear */
        snprintf(settings, sizeof settings, "mu: 0; gn: %.17g 1/s", g);
        build_polyhedra(f, settings, BRC_PI / omega0 / STEPS);
        damped(f, K, g);
    }
}

static void viscous_restitution_spheres(void **state)
{
    struct fixture *f = *state;
    char settings[64];
    build_spheres(f, "", 1e-9);
    double omega0 = sqrt(sphere_stiffness() / effective_mass(f)), g = 0.4 * omega0;
    snprintf(settings, sizeof settings, "mu: 0; viscous: %.17g 1/s", g);
    build_spheres(f, settings, BRC_PI / omega0 / STEPS);
    damped(f, sphere_stiffness(), g);
}

/* Sliding all through the contact: the impulse across is mu times that along, so the velocity of
 * the centres across falls by mu (1 + e) v_n: e_t = 1 - mu (1 + e) / tan(theta). */
static void oblique(struct fixture *f, double k, double mu)
{
    double v[3] = {-0.05, 0.4, 0}, half = BRC_PI * sqrt(effective_mass(f) / k);
    struct impact r = impact(f, v, half);
    /* the spring across must load first and unload last; K_t v_t is 8 times mu K_n v_n or more, so
     * that it slips from the first step on; the normal turns by 1e-4 meanwhile */
    CHECK_NEAR(r.e, 1, 0, 2e-3);
    CHECK_NEAR(r.e_t, 1 - mu * (1 + r.e) * 0.05 / 0.4, 0, 1e-3);
    CHECK_BETWEEN(r.e_t, 0.5, 0.97);
    CHECK_NEAR(r.residual, 0, 1e-3, 0);
}

static void oblique_sliding_polyhedra(void **state)
{
    struct fixture *f = *state;
    double m1 = 3000 * BOX * BOX * BOX, m2 = 3000 * 4.0 / 3 * TIP * TIP * TIP;
    build_polyhedra(f, "mu: 0.2; gn: 0 1/s", BRC_PI * sqrt(m1 * m2 / (m1 + m2) / K) / STEPS);
    oblique(f, K, 0.2);
}

static void oblique_sliding_spheres(void **state)
{
    struct fixture *f = *state;
    double m = 2650 * 4.0 / 3 * BRC_PI * 125e-9;
    build_spheres(f, "mu: 0.2; eta: 1", BRC_PI * sqrt(m / 2 / sphere_stiffness()) / STEPS);
    oblique(f, sphere_stiffness(), 0.2);
}

/* A sphere thrown without spin along a much larger fixed one under gravity slides until it rolls
 * at 5/7 of its speed: angular momentum about the place of contact, I = 2/5 m r^2. */
static void slip_to_roll(void **state)
{
    struct fixture *f = *state;
    const double r = 5e-3, big = 50, v0 = 0.1, g = 10, zero[3] = {0, 0, 0};
    const double radius[2] = {r, big};
    struct brc_convex cell[2];
    for (int i = 0; i < 2; i++)
        cell[i] = (struct brc_convex){0};
    fixture_box(f, &cell[0], (double[3]){0, 0, 0}, (double[3]){8e-3, 8e-3, 8e-3});
    fixture_box(f, &cell[1], (double[3]){0, 0, -big - r}, (double[3]){80, 80, 80});
    fixture_loose(f, cell, radius, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    double k = 48.8e9 * BRC_PI * r * r / (r + big);
    fixture_free_sim(f, vgcm(), "mu: 0.3; eta: 1", "dt: 1e-5 s; gravity: 0 m/s2, 0 m/s2, -10 m/s2");
    struct brc_bodies *b = &f->sim.bodies;
    double inertia = 0.4 * b->mass[0] * r * r, sum = 0;
    brc_set(b->inertia[0], inertia, inertia, inertia);
    double omega = sqrt(k / b->mass[0]);
    assert_true(1e-5 * omega < 0.3);
    b->x[0][2] -= b->mass[0] * g / k; /* where the contact carries the weight */
    fixture_velocity(f, 0, (double[3]){v0, 0, 0}, zero);
    /* rolls after 2 v0 / (7 mu g) = 9.5 ms; then the mean over 20 ms, long against the oscillation
     * on the spring across, whose amplitude is mu g / omega = 2e-3 of v0 */
    int n_slide = 1200, n_mean = 2000;
    for (int i = 0; i < n_slide + n_mean; i++) {
        fixture_steps(f, 1);
        brc_set(b->x[1], 0, 0, -big - r);
        fixture_velocity(f, 1, zero, zero);
        if (i == 475) /* half way: still v = v0 - mu g t */
            CHECK_NEAR(b->v[0][0], v0 - 0.3 * g * 476 * 1e-5, 0, 5e-3);
        if (i >= n_slide)
            sum += b->v[0][0] / n_mean;
    }
    CHECK_NEAR(sum, 5.0 / 7 * v0, 0, 2e-3);
    CHECK_NEAR(b->w[0][1] * r, 5.0 / 7 * v0, 0, 1e-2);
}

/* A cube of 1 cm on a plane under gravity tilted by tan(theta) = slope, which comes on slowly, so
 * that the cube is set down without a bounce. Returns the acceleration along the plane after it. */
static double incline(struct fixture *f, double slope, bool on_platen, size_t cube)
{
    const double zero[3] = {0, 0, 0}, g = 10;
    enum { RAMP = 2000, START = 3000, END = 6000 };
    struct brc_bodies *b = &f->sim.bodies;
    double theta = atan(slope), held[3], v_start = 0;
    brc_copy(held, b->x[0]);
    for (int i = 1; i <= END; i++) {
        double part = i < RAMP ? 0.5 - 0.5 * cos(BRC_PI * i / RAMP) : 1;
        brc_set(f->sim.run.gravity, part * g * sin(theta), 0, -part * g * cos(theta));
        fixture_steps(f, 1);
        if (!on_platen) {
            brc_copy(b->x[0], held);
            fixture_velocity(f, 0, zero, zero);
        }
        if (i == START)
            v_start = b->v[cube][0];
    }
    CHECK_NEAR(b->v[cube][2], 0, 1e-4, 0); /* it lies */
    return (b->v[cube][0] - v_start) / ((END - START) * f->sim.dt);
}

/* mu = 0.3: rest at tan(theta) = 0.29; g cos(theta) (tan(theta) - mu) above. */
static void check_incline(struct fixture *f, bool on_platen, size_t cube,
                          void (*build)(struct fixture *))
{
    const double slopes[3] = {0.29, 0.31, 0.5};
    for (int i = 0; i < 3; i++) {
        build(f);
        double x0 = f->sim.bodies.x[cube][0];
        double a = incline(f, slopes[i], on_platen, cube);
        double expected = slopes[i] > 0.3 ? 10 * cos(atan(slopes[i])) * (slopes[i] - 0.3) : 0;
        /* 0.3 % of mu g: the undamped remains of rocking on the springs */
        CHECK_NEAR(a, expected, 0.01, 0);
        if (i == 0) /* held by springs that stretch by micrometres */
            CHECK_NEAR(f->sim.bodies.x[cube][0], x0, 1e-5, 0);
    }
}

static void build_block_on_slab(struct fixture *f)
{
    struct brc_convex cell[2];
    for (int i = 0; i < 2; i++)
        cell[i] = (struct brc_convex){0};
    fixture_box(f, &cell[0], (double[3]){0, 0, -5e-3}, (double[3]){0.06, 0.06, 1e-2});
    fixture_box(f, &cell[1], (double[3]){0, 0, 5e-3}, (double[3]){1e-2, 1e-2, 1e-2});
    fixture_loose(f, cell, NULL, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    /* critical damping is about 2 omega = 2 sqrt(4e5 / 3e-3) = 23000 1/s */
    fixture_free_sim(f, poly(), "radius: 1 mm; kn: 1e5 N/m; kt: 1e5 N/m; mu: 0.3; gn: 1e4 1/s",
                     "dt: 1e-5 s");
}

static void block_on_a_slab(void **state)
{
    check_incline(*state, false, 1, build_block_on_slab);
}

static void drop_upper_platen(struct fixture *f)
{
    f->sim.bodies.x[2][2] += 1;
    fixture_list(f);
    fixture_forces(f);
    fixture_rest(f);
}

static void build_block_on_platen(struct fixture *f)
{
    fixture_grid(f, 1, 1, 1, 1e-2, 0);
    fixture_sim(f, poly(), "radius: 1 mm; kn: 1e5 N/m; kt: 1e5 N/m; mu: 0; gn: 1e4 1/s",
                "friction: 0.3; loading: fixed; rate: 1e-15 1/s", "regime: dynamic; dt: 1e-5 s");
    drop_upper_platen(f);
}

static void block_on_a_platen(void **state)
{
    check_incline(*state, true, 0, build_block_on_platen);
}

static void build_cell_on_platen(struct fixture *f)
{
    fixture_grid(f, 1, 1, 1, 1e-2, 0);
    fixture_sim(f, vgcm(), "e_bar: 1e7 Pa; eta: 1; mu: 0; interaction: all",
                "friction: 0.3; loading: fixed; rate: 1e-15 1/s", "regime: dynamic; dt: 1e-5 s");
    drop_upper_platen(f);
}

static void vgcm_cell_on_a_platen(void **state)
{
    check_incline(*state, true, 0, build_cell_on_platen);
}

/* A cell that leaves its platen is not held back, by the springs nor by what damps them. */
static void an_open_platen_does_not_pull(void **state)
{
    struct fixture *f = *state;
    const double v[3] = {0.1, 0, 0.2}, zero[3] = {0, 0, 0};
    fixture_grid(f, 1, 1, 1, 1e-2, 0);
    fixture_sim(f, vgcm(), "e_bar: 1e7 Pa; eta: 1; mu: 0; interaction: all; viscous: 1e3 1/s",
                "friction: 0.3; loading: fixed; rate: 1e-15 1/s",
                "regime: dynamic; dt: 1e-5 s; local_damping: 0");
    drop_upper_platen(f);
    fixture_velocity(f, 0, v, zero);
    fixture_steps(f, 20);
    assert_true(f->sim.platens.gap[0] > 0);
    for (int k = 0; k < 3; k++)
        CHECK_NEAR(f->sim.bodies.v[0][k], v[k], 1e-15, 1e-12);
    /* the same motion towards it is damped */
    fixture_velocity(f, 0, (double[3]){0.1, 0, -0.2}, zero);
    fixture_steps(f, 25);
    assert_true(f->sim.bodies.v[0][0] < 0.0999 && f->sim.bodies.v[0][2] > -0.1999);
}

/* The automatic step is below the limit of a contact before the two touch, so that the impact is as
 * elastic as the step makes it. */
static void the_step_meets_an_impact(void **state)
{
    struct fixture *f = *state;
    const double v[3] = {-1e-3, 0, 0};
    build_polyhedra(f, "mu: 0; gn: 0 1/s", 0);
    double limit = 2 * sqrt(effective_mass(f) / K);
    CHECK_BETWEEN(f->sim.dt, 0.2 * limit, 0.5 * limit);
    struct impact r = impact(f, v, BRC_PI * sqrt(effective_mass(f) / K));
    assert_true(r.largest_f > 0);
    CHECK_NEAR(r.e, 1, 0.1, 0);
    /* and a step that was too long falls when they touch */
    build_polyhedra(f, "mu: 0; gn: 0 1/s", 0);
    f->sim.dt = 0.9 * limit;
    throw_at(f, v);
    for (int i = 0; i < 1000 && fixture_largest_force(f) == 0; i++)
        fixture_steps(f, 1);
    CHECK_BETWEEN(f->sim.dt, 0.2 * limit, 0.51 * limit);
}

/* Two cubes GAP apart meet with whole faces. */
static void build_cubes(struct fixture *f, const char *settings, const char *run)
{
    struct brc_convex cell[2];
    char all[256];
    for (int i = 0; i < 2; i++) {
        cell[i] = (struct brc_convex){0};
        fixture_box(f, &cell[i], (double[3]){i * (1e-2 + GAP), 0, 0},
                    (double[3]){1e-2, 1e-2, 1e-2});
    }
    fixture_loose(f, cell, NULL, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    snprintf(all, sizeof all, "radius: 1 mm; kn: 1e6 N/m; kt: 1e6 N/m; gn: 0 1/s; %s", settings);
    fixture_free_sim(f, poly(), all, run);
}

/* Kinetic energy after they have met, over that before. */
static double energy_of_cubes(struct fixture *f, const char *settings, const char *run)
{
    build_cubes(f, settings, run);
    throw_at(f, (double[3]){-0.5, 0, 0});
    double before = fixture_kinetic(f);
    double duration = BRC_PI * sqrt(effective_mass(f) / K);
    int n = (int)ceil((GAP / 0.5 + 3 * duration) / f->sim.dt);
    for (int i = 0; i < 3 * n; i++)
        fixture_steps(f, 1);
    assert_true(fixture_largest_force(f) == 0);
    return fixture_kinetic(f) / before;
}

/* All springs of two faces close at once. The step bears them before they do. */
static void the_step_meets_whole_faces(void **state)
{
    static const char *const rules[] = {"merged", "closed"};
    struct fixture *f = *state;
    for (int friction = 0; friction < 2; friction++)
        for (int k = 0; k < 2; k++) {
            char settings[80];
            snprintf(settings, sizeof settings, "mu: %d; features: %s", friction, rules[k]);
            double energy = energy_of_cubes(f, settings, "");
            double fine = energy_of_cubes(f, settings, "dt_margin: 0.05");
            print_message("%s: kinetic energy %.4f of that before, %.4f at a tenth of the step\n",
                          settings, energy, fine);
            CHECK_NEAR(energy, 1, 0.1, 0);
            CHECK_NEAR(fine, 1, 0.005, 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(head_on_polyhedra),
        FIXTURE_TEST(head_on_spheres),
        FIXTURE_TEST(viscous_restitution_polyhedra),
        FIXTURE_TEST(viscous_restitution_spheres),
        FIXTURE_TEST(oblique_sliding_polyhedra),
        FIXTURE_TEST(oblique_sliding_spheres),
        FIXTURE_TEST(slip_to_roll),
        FIXTURE_TEST(block_on_a_slab),
        FIXTURE_TEST(block_on_a_platen),
        FIXTURE_TEST(vgcm_cell_on_a_platen),
        FIXTURE_TEST(an_open_platen_does_not_pull),
        FIXTURE_TEST(the_step_meets_an_impact),
        FIXTURE_TEST(the_step_meets_whole_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
