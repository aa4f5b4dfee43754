/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One bond between two cubes of 1 cm, driven by hand to breaking: gt12 eqs 11-15, vgcm eqs 28-33
 * and the bilinear softening, against numbers worked out from the papers. */
#include "tests/fixture.h"
#include "tests/rotate.h"

#include <stdio.h>

static const double H = 1e-2, R = 1e-3;
static const double B_N = 20e9, B_T = 10e9, B_M = 3.3e9, EPS = 2e-3, THETA = 0.05;
static const char POLY[] = "radius: 1 mm; kn: 1e8 N/m; kt: 1e8 N/m; mu: 0; bn: 20 GPa; "
                           "bt: 10 GPa; bm: 3.3 GPa; eps_th: 2e-3; theta_th: 0.05 rad; ";

static void build_cubes(struct fixture *f, const char *settings)
{
    char all[512];
    snprintf(all, sizeof all, "%s%s", POLY, settings);
    fixture_grid(f, 2, 1, 1, H, 0);
    fixture_free_sim(f, brc_registry_find("polyhedra"), all, "dt: 1e-9 s");
}

/* Body 1 displaced by u and turned by phi about the material point of the bond, in one step from
 * wherever it is; then at rest, without viscous forces. */
static void displace(struct fixture *f, const double u[3], const double phi[3])
{
    struct brc_bodies *b = &f->sim.bodies;
    const double zero[3] = {0, 0, 0}, back[4] = {b->q[1][0], -b->q[1][1], -b->q[1][2], -b->q[1][3]};
    double turn[4], to[4], step[4], v[3], w[3], arm[3] = {H / 2, 0, 0};
    brc_quat_from_rotation(turn, phi);
    brc_quat_rotate(arm, turn, arm);
    brc_set(v, H, H / 2, H / 2);
    brc_add(v, v, arm);
    brc_add(v, v, u);
    brc_sub(v, v, b->x[1]);
    brc_quat_mul(to, turn, b->q0[1]);
    brc_quat_mul(step, to, back);
    brc_scale(w, step + 1, 2); /* small, or along one axis and corrected below */
    fixture_velocity(f, 1, v, w);
    fixture_carry(f, 1);
    memcpy(b->q[1], to, sizeof to);
    fixture_velocity(f, 1, zero, zero);
    fixture_forces(f);
}

/* Strain length and area by the two readings that the paper leaves open. */
struct reading {
    const char *settings;
    double length, area;
};
static const struct reading READINGS[2] = {
    {"strain_length: centres; area: facet", 1e-2, 1e-4},
    {"strain_length: gap; area: eroded", 2e-3, 64e-6},
};

static const double ZERO[3] = {0, 0, 0};

/* The displacements of 1e-6 m are resolved to 1e-18 m in places of 1e-2 m: 1e-11 relative. */
static const double TIGHT = 1e-10;

static void tension(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < 2; i++) {
        const struct reading *r = &READINGS[i];
        build_cubes(f, r->settings);
        displace(f, (double[3]){1e-6, 0, 0}, ZERO);
        double expected = B_N * r->area * 1e-6 / r->length; /* 200 N and 640 N */
        size_t row = fixture_row(f, 0, 1);
        CHECK_NEAR(f->sim.pairs.f[row][0], -expected, 0, TIGHT);
        CHECK_NEAR(f->sim.pairs.f[row][1], 0, 1e-9 * expected, 0);
        CHECK_NEAR(f->sim.bodies.f[0][0], expected, 0, TIGHT);
        CHECK_NEAR(brc_norm(f->sim.bodies.t[1]), 0, 1e-9 * expected * H, 0);
        CHECK_NEAR(fixture_stored(f), 0.5 * expected * 1e-6, 0, 2 * TIGHT);
    }
}

static void shear(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < 2; i++) {
        const struct reading *r = &READINGS[i];
        build_cubes(f, r->settings);
        displace(f, (double[3]){1e-7, 3e-7, -4e-7}, ZERO); /* a little apart: no collision */
        double per_m = B_T * r->area / r->length;
        size_t row = fixture_row(f, 0, 1);
        CHECK_NEAR(f->sim.pairs.f[row][1], -per_m * 3e-7, 0, TIGHT);
        CHECK_NEAR(f->sim.pairs.f[row][2], per_m * 4e-7, 0, TIGHT);
        /* at the middle of the material points, 5 mm and half the displacement from the centre */
        double arm[3] = {-H / 2 - 0.5e-7, -1.5e-7, 2e-7}, t[3];
        brc_cross(t, arm, f->sim.pairs.f[row]);
        CHECK_NEAR_ARRAY(f->sim.bodies.t[1], t, 3, 1e-9 * per_m * 5e-7 * H, 0);
        CHECK_NEAR(fixture_third_law(f), 0, 1e-12, 0);
    }
}

/* Area of the face of a cell on a facet after erosion by R, by clipping. */
static double eroded_face(struct fixture *f, size_t cell, int32_t facet)
{
    const struct brc_facets *s = &f->specimen.facets;
    struct brc_plane planes[64];
    struct brc_convex core = {0};
    size_t n = s->cell_first[cell + 1] - s->cell_first[cell];
    double area = 0, unused[3];
    assert_true(n <= 64);
    brc_facets_cell_planes(s, cell, planes);
    for (size_t i = 0; i < n; i++)
        planes[i].d -= R;
    CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, &core, planes, n, s->centre[cell], 10 * H));
    for (size_t i = 0; i < core.n_faces; i++)
        if (core.plane[i].id == facet)
            area = brc_polygon_area(core.vertex, core.loop + core.first[i],
                                    core.first[i + 1] - core.first[i], core.plane[i].n, unused);
    brc_convex_free(&core);
    return area;
}

static void area_is_the_mean_of_two_eroded_faces(void **state)
{
    /* a Voronoi pack: the faces of the two sides differ */
    struct fixture *f = *state;
    char all[512];
    const double u = 1e-6;
    snprintf(all, sizeof all, "%sbt: 0 GPa; torsion: off; strain_length: gap; area: eroded", POLY);
    fixture_grid(f, 3, 3, 3, H, 0.8);
    fixture_free_sim(f, brc_registry_find("polyhedra"), all, "");
    const struct brc_facets *s = &f->specimen.facets;
    const double zero[3] = {0, 0, 0}, about[3] = {H, H, H};
    for (size_t i = 0; i < f->sim.bodies.n; i++) { /* a uniform stretch: every bond opens */
        double v[3];
        brc_sub(v, f->sim.bodies.x[i], about);
        brc_scale(v, v, u / H);
        fixture_velocity(f, i, v, zero);
    }
    fixture_carry(f, 1);
    int n_differ = 0;
    for (size_t row = 0; row < f->sim.pairs.n; row++) {
        int32_t facet = f->sim.pairs.facet[row], a = f->sim.pairs.a[row], b = f->sim.pairs.b[row];
        if (facet < 0)
            continue;
        double ea = eroded_face(f, (size_t)a, facet), eb = eroded_face(f, (size_t)b, facet), d[3];
        brc_sub(d, f->sim.bodies.x0[b], f->sim.bodies.x0[a]);
        double opening = brc_dot(d, s->normal[facet]) * u / H;
        double area = ea == 0 || eb == 0 ? 0 : 0.5 * (ea + eb);
        /* displacements of 1e-7 m or more in places of 3 cm */
        CHECK_NEAR(-brc_dot(f->sim.pairs.f[row], s->normal[facet]), B_N * area * opening / (2 * R),
                   1e-6, 1e-6);
        n_differ += area > 0 && fabs(ea / eb - 1) > 0.05;
    }
    assert_true(n_differ > 10);
}

static void torsion(void **state)
{
    struct fixture *f = *state;
    const double theta = 1e-3;
    for (int i = 0; i < 3; i++) {
        const struct reading *r = &READINGS[i % 2];
        char settings[128];
        snprintf(settings, sizeof settings, "%s; torsion_length: %s", r->settings,
                 i < 2 ? "0 m" : "5 cm");
        double length = i < 2 ? r->length : 0.05;
        build_cubes(f, settings);
        displace(f, (double[3]){1e-9, 0, 0}, (double[3]){theta, 0, 0});
        double expected = B_M * r->area * theta * length;
        CHECK_NEAR(f->sim.bodies.t[1][0], -expected, 0, 1e-9);
        CHECK_NEAR(f->sim.bodies.t[0][0], expected, 0, 1e-9);
        double stretch = 0.5 * B_N * r->area * 1e-18 / r->length;
        CHECK_NEAR(fixture_stored(f), 0.5 * expected * theta + stretch, 0, 1e-6);
    }
    build_cubes(f, "torsion: off");
    displace(f, (double[3]){1e-9, 0, 0}, (double[3]){theta, 0, 0});
    /* the stretch alone: 0.2 N over an arm of 5 mm, and no couple about the normal */
    CHECK_NEAR(f->sim.bodies.t[1][0], 0, 1e-9, 0);
}

/* The two sides of eq 15 = 1 for a displacement u and a twist. */
static void breaks_at(struct fixture *f, const char *settings, const double u[3], double theta,
                      enum brc_mode mode)
{
    build_cubes(f, settings);
    size_t row = fixture_row(f, 0, 1);
    double stored = 0;
    for (int i = 0; i < 2; i++) {
        double v[3], side = i == 0 ? 1 - 1e-6 : 1 + 1e-6;
        brc_scale(v, u, side);
        displace(f, v, (double[3]){side * theta, 0, 0});
        assert_int_equal(f->sim.pairs.status[row], i == 0 ? BRC_INTACT : BRC_BROKEN);
        assert_int_equal(f->sim.events.table.n, i);
        if (i == 0)
            stored = fixture_stored(f);
    }
    assert_int_equal(f->sim.events.mode[0], mode);
    assert_int_equal(f->sim.events.a[0], 0);
    assert_int_equal(f->sim.events.b[0], 1);
    CHECK_NEAR(f->sim.events.n[0][0], 1, 1e-3, 0);
    CHECK_NEAR(f->sim.events.x[0][0], H + u[0] / 2, 1e-6, 0);
    /* what was stored, but for the work of the last step of 2e-6 */
    CHECK_NEAR(f->sim.events.energy[0], stored, 0, 1e-5);
    /* final: no force when it comes back, nothing stored */
    displace(f, (double[3]){1e-7, 0, 0}, ZERO);
    CHECK_NEAR(fixture_largest_force(f), 0, 0, 0);
    CHECK_NEAR(fixture_stored(f), 0, 0, 0);
    assert_int_equal(f->sim.events.table.n, 1);
}

static void breaking(void **state)
{
    struct fixture *f = *state;
    /* strain 2e-3 over the centres' distance of 1 cm: 20 um */
    breaks_at(f, "", (double[3]){EPS * H, 0, 0}, 0, BRC_MODE_TENSION);
    breaks_at(f, "", (double[3]){1e-10, 0.6 * (EPS * H - 1e-10), 0.8 * (EPS * H - 1e-10)}, 0,
              BRC_MODE_SHEAR);
    breaks_at(f, "", (double[3]){1e-10, 0, 0}, THETA * (1 - 1e-10 / (EPS * H)), BRC_MODE_TORSION);
    /* all three: 0.5 + 0.3 + 0.2 */
    breaks_at(f, "", (double[3]){0.5 * EPS * H, 0.3 * EPS * H, 0}, 0.2 * THETA, BRC_MODE_TENSION);
    /* 2e-3 over the gap of 2 mm: 4 um */
    breaks_at(f, "strain_length: gap; area: eroded", (double[3]){EPS * 2 * R, 0, 0}, 0,
              BRC_MODE_TENSION);
}

static void options_of_breaking(void **state)
{
    struct fixture *f = *state;
    build_cubes(f, "theta_limit: off");
    displace(f, (double[3]){1e-9, 0, 0}, (double[3]){3 * THETA, 0, 0});
    assert_int_equal(f->sim.pairs.status[fixture_row(f, 0, 1)], BRC_INTACT);
    build_cubes(f, "breakable: off");
    displace(f, (double[3]){0.1 * H, 0, 0}, ZERO);
    assert_int_equal(f->sim.pairs.status[fixture_row(f, 0, 1)], BRC_INTACT);
    CHECK_NEAR(f->sim.bodies.f[1][0], -B_N * 1e-4 * 0.1, 0, 1e-9);
    build_cubes(f, "bonds: off");
    displace(f, (double[3]){1e-7, 0, 0}, ZERO);
    CHECK_NEAR(fixture_largest_force(f), 0, 0, 0);
}

static void compression_is_the_collision_s(void **state)
{
    /* the bond has no normal force under compression (eq 12): breaking it changes nothing */
    struct fixture *f = *state;
    const char *rules[3] = {"features: strict", "features: closed", "features: merged"};
    for (int i = 0; i < 3; i++) {
        double force[2];
        for (int bonds = 0; bonds < 2; bonds++) {
            char settings[64];
            snprintf(settings, sizeof settings, "%s; bonds: %s", rules[i], bonds ? "on" : "off");
            build_cubes(f, settings);
            displace(f, (double[3]){-1e-7, 0, 0}, ZERO);
            force[bonds] = f->sim.bodies.f[1][0];
        }
        if (i > 0) /* no foot is strictly inside coincident faces */
            assert_true(force[1] > 0);
        CHECK_NEAR(force[1], force[0], 0, 1e-9);
    }
}

static void coincident_faces(void **state)
{
    /* a motion of 1e-9 m across changes how many springs `closed` counts, and leaves `merged` as it
     * was */
    struct fixture *f = *state;
    double jump[2];
    for (int i = 0; i < 2; i++) {
        double low = HUGE_VAL, high = 0;
        for (int j = -1; j <= 1; j++) {
            build_cubes(f,
                        i == 0 ? "features: closed; bonds: off" : "features: merged; bonds: off");
            displace(f, (double[3]){-1e-6, j * 1e-9, j * 0.3e-9}, (double[3]){j * 1e-9, 0, 0});
            low = fmin(low, f->sim.bodies.f[1][0]);
            high = fmax(high, f->sim.bodies.f[1][0]);
        }
        jump[i] = high / low;
        print_message("coincident faces, %s: force %g to %g N\n", i == 0 ? "closed" : "merged", low,
                      high);
    }
    /* weights of merged have a slope of about 1/R: 1e-9 / 1e-3 */
    CHECK_NEAR(jump[1], 1, 1e-4, 0);
    CHECK_BETWEEN(jump[0], 1, 10);
}

/* --- vgcm --------------------------------------------------------------------------------------
 */

static const double E_BAR = 48.8e9;

static void build_cells(struct fixture *f, const char *settings)
{
    char all[512];
    snprintf(all, sizeof all, "interaction: all; mu: 0; %s", settings);
    fixture_grid(f, 2, 1, 1, H, 0);
    fixture_free_sim(f, brc_registry_find("vgcm"), all, "");
}

/* Moves the second sphere to x in one step, without turning it. */
static void step_to(struct fixture *f, const double x[3])
{
    struct brc_bodies *b = &f->sim.bodies;
    double v[3];
    brc_sub(v, x, b->x[1]);
    fixture_velocity(f, 1, v, ZERO);
    fixture_carry(f, 1);
}

struct pull {
    double work, peak, u_peak; /* J, N, m */
    double at_kink;            /* force at the displacement of the kink */
    double last;               /* force at the end */
    double damage;             /* J, of the ledger */
};

/* Pulls to u_end in n steps along (direction 0) or across (direction 1, on an arc about the first
 * centre, so that the distance of the centres stays). */
static struct pull pull(struct fixture *f, int direction, double u_end, double u_kink, int n)
{
    struct pull r = {0};
    double old = 0;
    const double *x0 = f->sim.bodies.x[0];
    for (int i = 1; i <= n; i++) {
        double u = u_end * i / n, c = cos(u / H), s = sin(u / H);
        double x[3] = {x0[0] + (direction == 0 ? H + u : H * c),
                       x0[1] + (direction == 0 ? 0 : H * s), x0[2]};
        step_to(f, x);
        const double *fb = f->sim.bodies.f[1];
        double force = direction == 0 ? -fb[0] : fb[0] * s - fb[1] * c;
        r.work += 0.5 * (old + force) * u_end / n;
        if (force > r.peak) {
            r.peak = force;
            r.u_peak = u;
        }
        if (fabs(u - u_kink) < 0.5 * u_end / n)
            r.at_kink = force;
        old = force;
    }
    r.last = old;
    r.damage = brc_accounts_settle(&f->sim)->damage;
    return r;
}

static void elastic_tension_of_a_facet(void **state)
{
    /* sum of the points' stiffness E-bar A / d (eq 28), times eta across (eq 29) */
    struct fixture *f = *state;
    const char *points[3] = {"points: paper", "points: exact", "points: one"};
    for (int i = 0; i < 3; i++) {
        build_cells(f, points[i]);
        double k = E_BAR * H * H / H, x[3];
        brc_copy(x, f->sim.bodies.x[1]);
        x[0] += 1e-7;
        step_to(f, x);
        CHECK_NEAR(f->sim.bodies.f[1][0], -k * 1e-7, 0, 1e-8);
        x[1] += 1e-8; /* the normal turns by 1e-6 */
        step_to(f, x);
        CHECK_NEAR(f->sim.bodies.f[1][1], -0.125 * k * 1e-8 - 1e-6 * k * 1e-7, 0, 2e-5);
        CHECK_NEAR(fixture_third_law(f), 0, 1e-12, 0);
    }
}

static void bending_and_twist_of_a_facet(void **state)
{
    /* b turned by phi about the middle of the facet: moment k phi times the second moment of area,
     * which the paper's points overstate twice for a square and `exact` gives */
    struct fixture *f = *state;
    const struct {
        const char *points;
        double factor;
    } cases[3] = {{"points: paper", 2}, {"points: exact", 1}, {"points: one", 0}};
    const double phi = 1e-7, moment = E_BAR / H * (H * H * H * H / 12) * phi;
    for (int i = 0; i < 3; i++) {
        for (int axis = 0; axis < 2; axis++) {
            double w[3] = {axis == 0 ? phi : 0, axis == 1 ? phi : 0, 0}, v[3], m[3], arm[3];
            build_cells(f, cases[i].points);
            brc_cross(v, w, (double[3]){H / 2, 0, 0});
            fixture_velocity(f, 1, v, w);
            fixture_carry(f, 1);
            /* about the middle of the facet */
            brc_set(arm, H / 2, 0, 0);
            brc_cross(m, arm, f->sim.bodies.f[1]);
            brc_add(m, m, f->sim.bodies.t[1]);
            double expected = axis == 0 ? 2 * 0.125 : 1; /* twist: polar moment, shear stiffness */
            CHECK_NEAR(m[axis], -cases[i].factor * expected * moment, 1e-5 * moment, 1e-5);
        }
    }
}

/* Peak stress, kink and end by PHYSICS: w = u - u0, kink at w1 = 0.75 G_s / sigma with a quarter of
 * the peak, nothing left from 5 G_s / sigma on, G_s = G_f - sigma u0 / 2. */
static void check_softening(struct fixture *f, int direction, double sigma, double g_f, double k)
{
    double area = H * H, u0 = sigma / k, g_s = g_f - 0.5 * sigma * u0;
    double u_kink = u0 + 0.75 * g_s / sigma, u_end = u0 + 5 * g_s / sigma;
    int n = 8000;
    struct pull r = pull(f, direction, 1.05 * u_end, u_kink, n);
    /* one step is 1.05 u_end / n; the force falls by its slope within it */
    double step = 1.05 * u_end / n;
    CHECK_NEAR(r.peak, sigma * area, 0, 2 * step / u0);
    CHECK_NEAR(r.u_peak, u0, 2 * step, 0);
    CHECK_NEAR(r.at_kink, 0.25 * sigma * area, 0, 2 * step / (u_kink - u0) * 4);
    CHECK_NEAR(r.work, g_f * area, 0, 2e-3);
    CHECK_NEAR(r.last, 0, 1e-6 * sigma * area, 0);
    CHECK_NEAR(r.damage, g_f * area, 0, 2e-3);
    CHECK_NEAR(fixture_stored(f), 0, 1e-6 * g_f * area, 0);
    double event_energy = 0, event_area = 0;
    for (size_t i = 0; i < f->sim.events.table.n; i++) {
        assert_int_equal(f->sim.events.mode[i], direction == 0 ? BRC_MODE_TENSION : BRC_MODE_SHEAR);
        event_energy += f->sim.events.energy[i];
        event_area += f->sim.events.area[i];
    }
    CHECK_NEAR(event_area, area, 0, 1e-12);
    CHECK_NEAR(event_energy, g_f * area, 0, 2e-3);
}

static void softening_in_tension(void **state)
{
    struct fixture *f = *state;
    /* u0 = 2.34 um, elastic energy 13.3 J/m2 */
    build_cells(f, "sigma_t: 11.4 MPa; g_fn: 64.6 J/m2");
    check_softening(f, 0, 11.4e6, 64.6, E_BAR / H);
}

static void softening_in_shear(void **state)
{
    struct fixture *f = *state;
    /* a low cohesion keeps the arc short: u0 = 1.64 um of 1 cm, elastic energy 0.82 J/m2 */
    build_cells(f, "tau: 1 MPa; g_fs: 4 J/m2");
    check_softening(f, 1, 1e6, 4, 0.125 * E_BAR / H);
}

static void brittle_drops_at_once(void **state)
{
    struct fixture *f = *state;
    build_cells(f, "softening: none; sigma_t: 35.5 MPa; tau: 106.5 MPa");
    double u0 = 35.5e6 * H / E_BAR;
    struct pull r = pull(f, 0, 1.2 * u0, -1, 1200);
    CHECK_NEAR(r.peak, 35.5e6 * H * H, 0, 2e-3);
    CHECK_NEAR(r.last, 0, 0, 0);
    CHECK_NEAR(r.work, 0.5 * 35.5e6 * u0 * H * H, 0, 4e-3);
    CHECK_NEAR(r.damage, r.work, 0, 2e-3);
    assert_true(f->sim.events.table.n == 5); /* four corners and the centroid */
}

static void damage_unloads_by_the_secant(void **state)
{
    struct fixture *f = *state;
    build_cells(f, FIXTURE_ENERGIES);
    double sigma = 11.4e6, u0 = sigma * H / E_BAR, g_s = 64.6 - 0.5 * sigma * u0;
    double u = u0 + 0.4 * g_s / sigma, x[3];
    struct pull r = pull(f, 0, u, -1, 2000);
    double force = r.last;
    /* on the first branch: from sigma down to a quarter at 0.75 */
    CHECK_NEAR(force, sigma * H * H * (1 - 0.75 * 0.4 / 0.75), 0, 1e-3);
    brc_copy(x, f->sim.bodies.x[0]);
    x[0] += H + u / 2;
    step_to(f, x);
    CHECK_NEAR(-f->sim.bodies.f[1][0], force / 2, 0, 1e-6);
    x[0] += u / 2;
    step_to(f, x);
    CHECK_NEAR(-f->sim.bodies.f[1][0], force, 0, 1e-6);
    /* and closed it carries compression with the full stiffness */
    x[0] -= u + 1e-7;
    step_to(f, x);
    CHECK_NEAR(f->sim.bodies.f[1][0], E_BAR * H * 1e-7, 0, 1e-5);
}

static void friction_after_damage(void **state)
{
    /* broken, pressed together by 1 um, slid: Coulomb friction of the compression alone */
    struct fixture *f = *state;
    build_cells(f, "mu: 0.3; eta: 1; softening: none; sigma_t: 1 MPa");
    pull(f, 0, 1e-6, -1, 100);
    double x[3];
    brc_copy(x, f->sim.bodies.x[0]);
    x[0] += H - 1e-7;
    step_to(f, x);
    double normal = f->sim.bodies.f[1][0];
    CHECK_NEAR(normal, E_BAR * H * 1e-7, 0, 1e-5);
    x[1] += 1e-7;
    step_to(f, x);
    /* 1e-7 across would give the spring 48.8 N of a limit of 14.6 N; the normal has turned by 1e-5
     */
    CHECK_NEAR(f->sim.bodies.f[1][1], -0.3 * normal, 0, 1e-4);
    assert_true(brc_accounts_settle(&f->sim)->friction > 0);
}

static void snap_back_is_refused(void **state)
{
    /* fracture energy below the elastic one: 13.3 J/m2 for d = 1 cm */
    struct fixture *f = *state;
    const struct brc_model *vgcm = brc_registry_find("vgcm");
    struct brc_test_params t;
    struct brc_run_params r;
    void *params = test_calloc(1, vgcm->params.owner_size);
    fixture_grid(f, 2, 1, 1, H, 0);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, vgcm->params, params));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_test_param_list, &t));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_run_param_list, &r));
    fixture_set(f, vgcm->params, params, "interaction: all; g_fn: 10 J/m2");
    const struct brc_test test = brc_rigs_test(&t, NULL);
    CHECK_FAILS(&f->ctx, brc_sim_create(&f->ctx, &f->sim, vgcm, params, &f->specimen, &test, &r),
                BRC_ERR_INPUT, "g_fn");
    test_free(params);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(tension),
        FIXTURE_TEST(shear),
        FIXTURE_TEST(area_is_the_mean_of_two_eroded_faces),
        FIXTURE_TEST(torsion),
        FIXTURE_TEST(breaking),
        FIXTURE_TEST(options_of_breaking),
        FIXTURE_TEST(compression_is_the_collision_s),
        FIXTURE_TEST(coincident_faces),
        FIXTURE_TEST(elastic_tension_of_a_facet),
        FIXTURE_TEST(bending_and_twist_of_a_facet),
        FIXTURE_TEST(softening_in_tension),
        FIXTURE_TEST(softening_in_shear),
        FIXTURE_TEST(brittle_drops_at_once),
        FIXTURE_TEST(damage_unloads_by_the_secant),
        FIXTURE_TEST(friction_after_damage),
        FIXTURE_TEST(snap_back_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
