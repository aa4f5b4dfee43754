/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vgcm against closed forms: affine fields, rigid rotations, fracture energies. */
#include "tests/fixture.h"
#include "tests/rotate.h"

#include "vgcm/vgcm.h"

#include <stdio.h>

extern const struct brc_model brc_model_vgcm;

static const double E_BAR = 48.8e9, EDGE = 0.01;

/* A box of Voronoi cells, every facet a contact. */
static void make_pack(struct fixture *f, int n, double jitter)
{
    char text[256];
    snprintf(text, sizeof text,
             "shape: box; grains: grid; size: %.17g m, %.17g m, %.17g m; cells: %d, %d, %d; "
             "jitter: %.17g; min_area_ratio: 0",
             n * EDGE, n * EDGE, n * EDGE, n, n, n, jitter);
    fixture_specimen(f, text);
}

/* A box of Laguerre cells about spheres of 4 to 6 mm: facets off the middle of the centres. */
static void make_packing(struct fixture *f)
{
    fixture_specimen(f,
                     "shape: box; grains: packing; size: 25 mm, 25 mm, 25 mm; min_area_ratio: 0");
}

/* Velocities of a homogeneous strain over a time of 1, without rotation. */
static void strain_bodies(struct fixture *f, double strain[3][3])
{
    const double zero[3] = {0, 0, 0};
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        double v[3];
        brc_mat_mul(v, strain, f->sim.bodies.x[i]);
        fixture_velocity(f, i, v, zero);
    }
}

static bool is_inside(const struct brc_facets *facets, size_t cell)
{
    for (size_t k = facets->cell_first[cell]; k < facets->cell_first[cell + 1]; k++)
        if (facets->cell[facets->cell_facet[k]][1] < 0)
            return false;
    return true;
}

static void check_affine_strain(struct fixture *f)
{
    double strain[3][3] = {{3e-12, 1e-12, -2e-12}, {1e-12, -1e-12, 5e-13}, {-2e-12, 5e-13, 2e-12}};
    static const char *const rule[] = {"paper", "exact", "one"};
    for (int r = 0; r < 3; r++) {
        char text[128];
        snprintf(text, sizeof text, "interaction: all; eta: 1; points: %s", rule[r]);
        fixture_free_sim(f, &brc_model_vgcm, text, "ledger: on");
        strain_bodies(f, strain);
        fixture_carry(f, 1);
        const struct brc_contacts *c = &f->sim.pairs;
        const struct brc_facets *facets = &f->specimen.facets;
        for (size_t i = 0; i < c->n; i++) {
            double force[3], area = facets->area[c->facet[i]];
            brc_mat_mul(force, strain, facets->normal[c->facet[i]]);
            brc_scale(force, force, -E_BAR * area);
            CHECK_NEAR_ARRAY(c->f[i], force, 3, 1e-21 * E_BAR * area + 1e-30, 1e-9);
        }
        size_t n_inside = 0;
        double unit = E_BAR * 1e-12 * EDGE * EDGE;
        for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
            if (!is_inside(facets, i))
                continue;
            n_inside++;
            CHECK_NEAR(brc_norm(f->sim.bodies.f[i]) / unit, 0, 1e-8, 0);
            CHECK_NEAR(brc_norm(f->sim.bodies.t[i]) / (unit * EDGE), 0, 1e-8, 0);
        }
        assert_true(n_inside >= 4);
    }
}

static void affine_strain_is_in_equilibrium(void **state)
{
    struct fixture *f = *state;
    make_pack(f, 4, 0.8);
    check_affine_strain(f);
    make_packing(f);
    check_affine_strain(f);
}

/* With platens the whole specimen is in equilibrium, and E = E-bar, nu = 0. */
static void platens_carry_e_bar(void **state)
{
    struct fixture *f = *state;
    static const char *const test[] = {"kind: compression; rate: 1e-7 1/s; friction: 0",
                                       "kind: tension; rate: 1e-7 1/s; grip: axial",
                                       "kind: tension; rate: 1e-7 1/s; grip: full"};
    make_pack(f, 4, 0.6);
    for (int k = 0; k < 3; k++) {
        fixture_sim(f, &brc_model_vgcm, "interaction: all; eta: 1", test[k], "");
        struct brc_bodies *b = &f->sim.bodies;
        double sense = k == 0 ? -1 : 1, strain[3][3] = {{0}};
        strain[2][2] = sense * 1e-7;
        strain_bodies(f, strain);
        fixture_carry(f, 1);
        double area = 16 * EDGE * EDGE, unit = E_BAR * 1e-7 * EDGE * EDGE;
        for (int p = 0; p < 2; p++) {
            const struct brc_platen *platen = &f->sim.rig.platen[p];
            double force = brc_dot(b->f[platen->body], platen->n);
            CHECK_NEAR(force, sense * E_BAR * 1e-7 * area, 0, 1e-6);
        }
        for (size_t i = 0; i < b->n_grains; i++) {
            CHECK_NEAR(brc_norm(b->f[i]) / unit, 0, 1e-6, 0);
            CHECK_NEAR(brc_norm(b->t[i]) / (unit * EDGE), 0, 1e-6, 0);
        }
    }
}

/* Invariants C_iikk and C_ikik of the stiffness under uniform strain. */
static void stiffness_invariants(struct fixture *f, const char *settings, double c[2])
{
    c[0] = c[1] = 0;
    for (int i = 0; i < 3; i++)
        for (int k = i; k < 3; k++) {
            double strain[3][3] = {{0}}, stress[3][3];
            strain[i][k] = strain[k][i] = 1e-9;
            fixture_free_sim(f, &brc_model_vgcm, settings, "ledger: on");
            strain_bodies(f, strain);
            fixture_carry(f, 1);
            fixture_stress(f, stress);
            c[1] += (stress[i][k] + stress[k][i]) / 2;
            if (i == k)
                c[0] += stress[0][0] + stress[1][1] + stress[2][2];
        }
}

/* Moduli of the isotropic part over those of eta = 1 (E-bar and 0) are those of the uniform-strain
 * estimate, for any pack: both invariants are sums over contacts in which directions drop out. */
static void uniform_strain_moduli(void **state)
{
    struct fixture *f = *state;
    static const double eta[] = {0, 0.125, 0.5, 0.75};
    double whole[2], c[2];
    make_pack(f, 4, 1);
    stiffness_invariants(f, "interaction: all; eta: 1", whole);
    double unit = whole[0] / 3; /* E-bar times the share of the volume between centres */
    CHECK_NEAR(whole[1] / unit, 6, 0, 1e-6);
    for (int k = 0; k < 4; k++) {
        char text[64];
        snprintf(text, sizeof text, "interaction: all; eta: %g", eta[k]);
        stiffness_invariants(f, text, c);
        double lame = (2 * c[0] - c[1]) / 15 / unit, shear = (3 * c[1] - c[0]) / 30 / unit;
        double e = shear * (3 * lame + 2 * shear) / (lame + shear);
        CHECK_NEAR(e, (2 + 3 * eta[k]) / (4 + eta[k]), 0, 1e-6);
        CHECK_NEAR(lame / (2 * (lame + shear)), (1 - eta[k]) / (4 + eta[k]), 1e-6, 0);
    }
}

/* Turns the whole pack rigidly by 90 degrees in n steps. */
static void turn_pack(struct fixture *f, const double axis[3], int n)
{
    struct brc_bodies *b = &f->sim.bodies;
    double phi[3], q[4], x[3], v[3];
    brc_scale(phi, axis, 0.5 * BRC_PI / n);
    brc_quat_from_rotation(q, phi);
    for (int step = 0; step < n; step++) {
        for (size_t i = 0; i < b->n; i++) {
            brc_quat_rotate(x, q, b->x[i]);
            brc_sub(v, x, b->x[i]);
            fixture_velocity(f, i, v, phi);
        }
        fixture_carry(f, 1);
    }
}

/* Largest error of a contact force after 90 degrees in n steps, over the mean force. */
static double rotation_error(struct fixture *f, int n)
{
    double strain[3][3] = {{3e-5, 1e-5, -2e-5}, {1e-5, -1e-5, 0.5e-5}, {-2e-5, 0.5e-5, 2e-5}};
    double axis[3] = {0.6, -0.48, 0.64}, whole[4], phi[3], error = 0, sum = 0, old[1024][3];
    fixture_free_sim(f, &brc_model_vgcm, "interaction: all", "ledger: on");
    strain_bodies(f, strain);
    fixture_carry(f, 1);
    const struct brc_contacts *c = &f->sim.pairs;
    assert_true(c->n <= 1024);
    memcpy(old, c->f, c->n * sizeof old[0]);
    turn_pack(f, axis, n);
    brc_scale(phi, axis, 0.5 * BRC_PI);
    brc_quat_from_rotation(whole, phi);
    for (size_t i = 0; i < c->n; i++) {
        double e[3];
        brc_quat_rotate(e, whole, old[i]);
        brc_sub(e, c->f[i], e);
        error = fmax(error, brc_norm(e));
        sum += brc_norm(c->f[i]);
    }
    return error / (sum / (double)c->n);
}

static void rigid_rotation_drifts_with_second_order(void **state)
{
    struct fixture *f = *state;
    make_packing(f);
    double coarse = rotation_error(f, 400), fine = rotation_error(f, 1600);
    CHECK_BETWEEN(log(coarse / fine) / log(4), 1.9, 2.1);
    CHECK_BETWEEN(fine, 0, 5e-3);
}

/* Two grains; the second moves by n steps of du. Returns the work over the area of the facet. */
static double drive_pair(struct fixture *f, const double du[3], int n)
{
    const double zero[3] = {0, 0, 0};
    double work = 0, old[3];
    const struct brc_contacts *c = &f->sim.pairs;
    for (int i = 0; i < n; i++) {
        brc_copy(old, c->f[0]);
        fixture_velocity(f, 1, du, zero);
        fixture_carry(f, 1);
        work -= 0.5 * (brc_dot(old, du) + brc_dot(c->f[0], du));
    }
    return work / f->specimen.facets.area[c->facet[0]];
}

static void fracture_energy(struct fixture *f, const char *settings, int axis, double energy)
{
    double du[3] = {0, 0, 0}, area = 0, lost = 0;
    int n = 20000;
    fixture_free_sim(f, &brc_model_vgcm, settings, "ledger: on");
    const struct brc_sim *sim = &f->sim;
    assert_int_equal(sim->pairs.n, 1);
    du[axis] = 6e-5 / n;
    CHECK_NEAR(drive_pair(f, du, n), energy, 0, 0.01);
    assert_int_equal(sim->pairs.status[0], BRC_BROKEN);
    assert_int_equal(sim->events.table.n, (size_t)sim->pairs.np[0]);
    for (size_t i = 0; i < sim->events.table.n; i++) {
        assert_int_equal(sim->events.mode[i], axis == 0 ? BRC_MODE_TENSION : BRC_MODE_SHEAR);
        area += sim->events.area[i];
        lost += sim->events.energy[i];
    }
    CHECK_NEAR(area, EDGE * EDGE, 0, 1e-12);
    CHECK_NEAR(lost, energy * area, 0, 0.01);
    CHECK_NEAR(brc_accounts_settle(&f->sim)->damage, lost, 0, 1e-9);
    CHECK_NEAR(fixture_stored(f), 0, 1e-4 * lost, 0);
}

static void fracture_takes_the_energy_given(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 2, 1, 1, EDGE, 0);
    static const char *const form[] = {
        "softening: bilinear", "softening: bilinear; softening_beta: 0.3333; softening_w1: 0.8",
        "softening: linear"};
    for (int k = 0; k < 3; k++) {
        char text[256];
        snprintf(text, sizeof text, "%s; eta: 1; mu: 0; tau: 10 MPa; g_fn: 60 N/m; g_fs: 80 N/m",
                 form[k]);
        fracture_energy(f, text, 0, 60);
        fracture_energy(f, text, 1, 80);
    }
    /* brittle: the elastic energy sigma^2 d / (2 E-bar) */
    fracture_energy(f, "softening: none; eta: 1; mu: 0; tau: 10 MPa", 0,
                    11.4e6 * 11.4e6 * EDGE / (2 * E_BAR));
    fracture_energy(f, "softening: none; eta: 1; mu: 0; tau: 10 MPa", 1, 1e14 * EDGE / (2 * E_BAR));
}

static void snap_back_is_refused(void **state)
{
    struct fixture *f = *state;
    struct vgcm_params p;
    make_pack(f, 3, 0.5);
    struct brc_context *ctx = &f->ctx;
    CHECK_OK(ctx, brc_params_defaults(ctx, brc_model_vgcm.params, &p));
    CHECK_OK(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen));
    p.g_fn = 6.8;
    CHECK_FAILS(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen), BRC_ERR_INPUT, "vgcm.g_fn = 6.8");
    p.energies = VGCM_ENERGIES_POST_PEAK;
    CHECK_OK(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen));
    p.energies = VGCM_ENERGIES_TOTAL;
    p.softening = VGCM_SOFTENING_NONE;
    CHECK_OK(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen));
    p.softening = VGCM_SOFTENING_BILINEAR;
    p.g_fn = 64.6;
    p.g_fs = 3114.4; /* as printed: below the elastic energy */
    CHECK_FAILS(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen), BRC_ERR_INPUT, "3114.4");
    p.g_fs = 31114.4;
    p.interaction = VGCM_INTERACTION_AREA;
    p.interaction_area = 10;
    CHECK_FAILS(ctx, brc_model_vgcm.check(ctx, &p, &f->specimen), BRC_ERR_INPUT, "interaction");
}

/* Quasi-static tension and compression into failure: ledger against state, and balance. */
static void ledger_holds_through_failure(void **state)
{
    struct fixture *f = *state;
    static const char *const kind[] = {"tension", "compression"};
    static const char *const law[] = {
        "interaction: all; tau: 20 MPa; g_fs: 600 N/m; mu: 0.3",
        "interaction: all; tau: 20 MPa; g_fs: 600 N/m; mu: 0.3; damage: strength",
        "interaction: all; softening: none; tau: 20 MPa; mu: 0.3; eta: 0.5"};
    double damage[6];
    make_packing(f);
    for (int k = 0; k < 6; k++) {
        char text[256];
        double stored[3];
        snprintf(text, sizeof text,
                 "kind: %s; loading: fixed; rate: 2e-6 1/s; strain_max: 0.005; stop_drop: 0; "
                 "friction: 0.2",
                 kind[k / 3]);
        fixture_sim(f, &brc_model_vgcm, law[k % 3], text, "");
        fixture_steps(f, 2000);
        const struct brc_ledger *l = &f->sim.ledger;
        assert_true(f->sim.events.table.n > 50);
        brc_accounts_stored(&f->sim, stored);
        double sum = stored[0] + stored[1] + stored[2];
        double scale = l->boundary + l->start;
        CHECK_NEAR(l->bond + l->contact_normal + l->contact_shear, sum, 1e-4 * scale, 0);
        CHECK_NEAR(l->bond, stored[0], 1e-4 * scale, 0);
        CHECK_NEAR(brc_ledger_residual(l), 0, 1e-5, 0);
        assert_true(l->damage > 0 && (l->friction > 0 || k < 3));
        damage[k] = l->damage;
    }
    /* opening and slip go together: the two ways to add them part */
    assert_true(damage[0] != damage[1] && damage[3] != damage[4]);
}

/* Two spheres of 6 mm, never bonded, with their centres at the distance given. */
static void make_strangers(struct fixture *f, double distance)
{
    const double edges[3] = {EDGE, EDGE, EDGE}, radius[2] = {0.006, 0.006};
    double at[3] = {0, 0, 0};
    struct brc_convex cell[2];
    for (int i = 0; i < 2; i++) {
        cell[i] = (struct brc_convex){0};
        at[0] = i * distance;
        fixture_box(f, &cell[i], at, edges);
    }
    fixture_loose(f, cell, radius, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    fixture_free_sim(f, &brc_model_vgcm, "mu: 0.4", "skin: 0.5; dt: 1e-6 s");
}

/* Moves the second grain by (x, y, 0); returns the force on it along x. */
static double move_stranger(struct fixture *f, double x, double y)
{
    const double v[3] = {x, y, 0}, zero[3] = {0, 0, 0};
    fixture_velocity(f, 1, v, zero);
    fixture_carry(f, 1);
    return f->sim.bodies.f[1][0];
}

static void new_neighbours_push_and_rub(void **state)
{
    struct fixture *f = *state;
    double k = E_BAR * BRC_PI * 36e-6 / 0.012;
    make_strangers(f, 0.0125); /* apart by 0.5 mm */
    assert_int_equal(f->sim.pairs.n, 1);
    CHECK_NEAR(f->sim.pairs.k[0][0], 0, 0, 0);
    CHECK_NEAR(move_stranger(f, -4e-4, 0), 0, 0, 0);
    CHECK_NEAR(move_stranger(f, -2e-4, 0), k * 1e-4, 0, 1e-6);
    CHECK_NEAR(f->sim.pairs.k[0][0], k, 0, 1e-9);
    CHECK_NEAR(fixture_stored(f), k * 1e-8 / 2, 0, 1e-6);
    for (int i = 0; i < 100; i++)
        move_stranger(f, 0, 1e-6); /* eta is 1/8: slips at 0.4 * 1e-4 * 8 = 3.2e-4 m */
    /* shear spring, and the push along the tilted line of centres */
    double tilted = f->sim.bodies.f[1][0] * 1e-4 / 0.0119;
    CHECK_NEAR(f->sim.bodies.f[1][1], tilted - 0.125 * k * 1e-4, 0, 2e-3);
    for (int i = 0; i < 400; i++)
        move_stranger(f, 0, 1e-6);
    CHECK_NEAR(-f->sim.bodies.f[1][1] / f->sim.bodies.f[1][0], 0.4, 0.05, 0);
    assert_true(brc_accounts_settle(&f->sim)->friction > 0);
    CHECK_NEAR(move_stranger(f, 2e-4, 0), 0, 0, 0);
    CHECK_NEAR(f->sim.bodies.f[1][1], 0, 0, 0);
    CHECK_NEAR(fixture_stored(f), 0, 0, 0);
}

static void overlapping_strangers_start_without_force(void **state)
{
    struct fixture *f = *state;
    double k = E_BAR * BRC_PI * 36e-6 / 0.012;
    make_strangers(f, 0.011); /* overlap of 1 mm */
    CHECK_NEAR(move_stranger(f, 0, 0), 0, 0, 0);
    CHECK_NEAR(move_stranger(f, 1e-4, 0), 0, 0, 0);
    CHECK_NEAR(move_stranger(f, -2e-4, 0), k * 1e-4, 0, 1e-6);
}

/* Places after a damped motion of the pack, turned by q before and back after it. */
static void damped_places(struct fixture *f, const char *damping, const double q[4], double (*x)[3])
{
    const double zero[3] = {0, 0, 0}, back[4] = {q[0], -q[1], -q[2], -q[3]};
    char text[128];
    snprintf(text, sizeof text, "regime: quasi_static; damping: %s", damping);
    fixture_free_sim(f, &brc_model_vgcm, "interaction: all", text);
    fixture_place(f, q, zero);
    const struct vgcm_contacts *c = vgcm_columns(&f->sim.pairs);
    for (size_t i = 0; i < f->sim.pairs.n; i++) { /* the contacts' frames as well */
        brc_quat_rotate(c->n[i], q, c->n[i]);
        brc_quat_rotate(c->s[i], q, c->s[i]);
    }
    f->random = 88172645463325252;
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        double v[3], w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = 1e-8 * fixture_draw(f);
            w[k] = 1e-6 * fixture_draw(f);
        }
        brc_quat_rotate(v, q, v);
        brc_quat_rotate(w, q, w);
        fixture_velocity(f, i, v, w);
    }
    fixture_steps(f, 100);
    fixture_place(f, back, zero);
    memcpy(x, f->sim.bodies.x, f->sim.bodies.n * sizeof *x);
}

/* Largest difference of the places of a pack and a turned pack, over the largest displacement. */
static double turned_difference(struct fixture *f, const char *damping)
{
    const double none[4] = {1, 0, 0, 0}, turn[4] = {0.8, 0.36, -0.48, 0};
    double x[2][64][3], difference = 0, moved = 0;
    damped_places(f, damping, none, x[0]);
    assert_true(f->sim.bodies.n <= 64);
    damped_places(f, damping, turn, x[1]);
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        double e[3], u[3];
        brc_sub(e, x[1][i], x[0][i]);
        brc_sub(u, x[0][i], f->sim.bodies.x0[i]);
        difference = fmax(difference, brc_norm(e));
        moved = fmax(moved, brc_norm(u));
    }
    return difference / moved;
}

/* Damping as printed depends on the axes; along the velocity it does not. */
static void printed_damping_depends_on_the_axes(void **state)
{
    struct fixture *f = *state;
    make_pack(f, 3, 0.8);
    CHECK_BETWEEN(turned_difference(f, "along_velocity"), 0, 1e-6);
    CHECK_BETWEEN(turned_difference(f, "cartesian"), 0.02, 1);
}

/* Rows that were loose, and that closed again, summed over steps. */
struct loose {
    size_t rows, closed;
};

enum { WAY_STEPS = 1200, WAY_ROWS = 200 };
typedef double way[WAY_STEPS][WAY_ROWS][6];

/* Leads all grains to and fro along prescribed ways, through breaking; forces of all rows and
 * moments on all grains go to w. literal: by their points, no row may be affine or loose. */
static void lead(struct fixture *f, bool is_literal, const char *settings, way w, struct loose *r)
{
    fixture_free_sim(f, &brc_model_vgcm, settings, "ledger: on");
    struct brc_contacts *c = &f->sim.pairs;
    struct vgcm_contacts *columns = vgcm_columns(c);
    bool was[WAY_ROWS] = {false};
    *r = (struct loose){0};
    assert_true(c->n <= WAY_ROWS);
    for (size_t i = 0; is_literal && i < c->n; i++)
        columns->phase[i] = VGCM_POINTS;
    for (int step = 0; step < WAY_STEPS; step++) {
        for (size_t i = 0; i < f->sim.bodies.n; i++) {
            double v[3], spin[3];
            for (int k = 0; k < 3; k++) {
                double phase = 17.0 * (double)i + 5 * k;
                v[k] = 4e-7 * sin(0.015 * step + phase) + 2e-7 * sin(0.05 * step + 2 * phase);
                spin[k] = 2e-5 * sin(0.02 * step + 3 * phase);
            }
            fixture_velocity(f, i, v, spin);
        }
        fixture_carry(f, 1);
        for (size_t i = 0; i < c->n; i++) {
            bool is_loose = columns->phase[i] == VGCM_LOOSE;
            r->rows += is_loose;
            r->closed += was[i] && !is_loose;
            was[i] = is_loose;
            if (is_literal && is_loose)
                columns->phase[i] = VGCM_POINTS;
            brc_copy(w[step][i], c->f[i]);
        }
        for (size_t i = 0; i < f->sim.bodies.n; i++)
            brc_copy(w[step][i] + 3, f->sim.bodies.sum[i] + 4);
    }
}

/* Loose rows, and affine ones up to the step in which they cease to be, give what the law of their
 * points gives. */
static void loose_rows_have_no_forces(void **state)
{
    struct fixture *f = *state;
    static const char *const settings[] = {
        "interaction: all", "interaction: all; softening: none",
        "interaction: all; eta: 0.5; tau: 30 MPa; g_fs: 500 J/m2; damage: strength",
        "interaction: all; mu: 0.6; eta: 0.5; tau: 30 MPa; g_fs: 500 J/m2"};
    static way loose, literal;
    make_pack(f, 3, 0.8);
    for (int k = 0; k < 4; k++) {
        struct loose r;
        lead(f, false, settings[k], loose, &r);
        struct brc_ledger ledger = *brc_accounts_settle(&f->sim);
        print_message("%s: %zu rows loose, %zu closed\n", settings[k], r.rows, r.closed);
        assert_true(r.rows > 1000 && r.closed > 10);
        lead(f, true, settings[k], literal, &r);
        double scale = fixture_largest_force(f), work = brc_accounts_settle(&f->sim)->damage;
        for (int step = 0; step < WAY_STEPS; step++)
            for (size_t i = 0; i < f->sim.pairs.n; i++) {
                CHECK_NEAR_ARRAY(loose[step][i], literal[step][i], 3, 1e-10 * scale, 0);
                CHECK_NEAR_ARRAY(loose[step][i] + 3, literal[step][i] + 3, 3, 1e-10 * scale * EDGE,
                                 0);
            }
        CHECK_NEAR(ledger.damage, work, 0, 1e-10);
        CHECK_NEAR(ledger.bond, f->sim.ledger.bond, 1e-10 * work, 0);
        CHECK_NEAR(ledger.friction, f->sim.ledger.friction, 1e-10 * work, 0);
        CHECK_NEAR(ledger.contact_normal, f->sim.ledger.contact_normal, 1e-10 * work, 0);
        CHECK_NEAR(ledger.contact_shear, f->sim.ledger.contact_shear, 1e-10 * work, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(affine_strain_is_in_equilibrium),
        FIXTURE_TEST(platens_carry_e_bar),
        FIXTURE_TEST(uniform_strain_moduli),
        FIXTURE_TEST(rigid_rotation_drifts_with_second_order),
        FIXTURE_TEST(fracture_takes_the_energy_given),
        FIXTURE_TEST(snap_back_is_refused),
        FIXTURE_TEST(ledger_holds_through_failure),
        FIXTURE_TEST(loose_rows_have_no_forces),
        FIXTURE_TEST(new_neighbours_push_and_rub),
        FIXTURE_TEST(overlapping_strangers_start_without_force),
        FIXTURE_TEST(printed_damping_depends_on_the_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
