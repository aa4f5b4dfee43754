/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vgcm at platens of every surface and bonding: energy balances as it does on a plane, and what is
 * bonded along the normal pulls there and rubs only while it is pushed. */
#include "tests/fixture.h"

#include "vgcm/vgcm.h"

#include <stdio.h>

extern const struct brc_model brc_model_vgcm;

static const double EDGE = 0.01, LIMIT = 5e-6;

struct shape {
    const char *name;
    enum brc_surface surface;
    double half_width, edge_radius, radius;
    double below; /* m, of the platen's place under the specimen's end, so that nothing overlaps */
};

static const struct shape SHAPES[] = {
    {"plane", BRC_SURFACE_PLANE, 0, 0, 0, 0},
    {"sharp strip", BRC_SURFACE_STRIP, 0.012, 0, 0, 0},
    {"round strip", BRC_SURFACE_STRIP, 0.006, 0.02, 0, 0},
    {"pin", BRC_SURFACE_CYLINDER, 0, 0, -0.04, 0},
    {"jaw", BRC_SURFACE_CYLINDER, 0, 0, 0.04, 0.00293},
};
enum { N_SHAPES = sizeof SHAPES / sizeof SHAPES[0] };

/* The simulation's platens get another surface, and its contacts are made anew. */
static void reshape(struct fixture *f, const struct shape *shape, enum brc_bonding bonding)
{
    struct brc_sim *sim = &f->sim;
    for (int k = 0; k < sim->rig.n_platens; k++) {
        struct brc_platen *p = &sim->rig.platen[k];
        p->surface = shape->surface;
        p->half_width = shape->half_width;
        p->edge_radius = shape->edge_radius;
        p->radius = shape->radius;
        p->bonding = bonding;
        if (bonding == BRC_BONDING_NONE)
            brc_axpy(sim->bodies.x[p->body], -shape->below, p->n);
    }
    CHECK_OK(sim->ctx, brc_contacts_set(sim->ctx, &sim->pairs, NULL, 0));
    CHECK_OK(sim->ctx, brc_contacts_set(sim->ctx, &sim->platens, NULL, 0));
    CHECK_OK(sim->ctx, sim->model.bond(sim, sim->state));
}

static void make(struct fixture *f, const struct shape *shape, enum brc_bonding bonding,
                 const char *more)
{
    char settings[200];
    snprintf(settings, sizeof settings,
             "interaction: all; sigma_t: 1000 GPa; tau: 1000 GPa; eta: 0.5%s", more);
    fixture_sim(f, &brc_model_vgcm, settings,
                "kind: compression; loading: fixed; rate: 10 1/s; friction: 0.3",
                "regime: dynamic; dt: 2e-7 s; local_damping: 0; fluctuation_damping: 0");
    reshape(f, shape, bonding);
}

/* Grains fly about between platens that close in: they slide, open and close on the surfaces. */
static double residual_on(struct fixture *f, const struct shape *shape, enum brc_bonding bonding,
                          const char *more)
{
    double stored[3];
    make(f, shape, bonding, more);
    for (size_t c = 0; c < f->sim.bodies.n_grains; c++) {
        const double v[3] = {2 * fixture_draw(f), 2 * fixture_draw(f), fixture_draw(f)};
        const double w[3] = {5 * fixture_draw(f), 5 * fixture_draw(f), 5 * fixture_draw(f)};
        fixture_velocity(f, c, v, w);
    }
    fixture_forces(f);
    fixture_ledger(f);
    fixture_steps(f, 1500);
    brc_accounts_stored(&f->sim, stored);
    double residual = brc_ledger_residual(&f->sim.ledger), slid = f->sim.ledger.friction;
    double drift = brc_ledger_drift(&f->sim.ledger, stored);
    print_message("%s, bonding %d: residual %.1e, drift %.1e, friction %.3g J, normal %.3g J\n",
                  shape->name, (int)bonding, residual, drift, slid, f->sim.ledger.contact_normal);
    assert_true(drift < 1e-4);
    assert_true(stored[1] > 0);
    assert_true((slid > 0) == (bonding == BRC_BONDING_NONE || bonding == BRC_BONDING_NORMAL));
    return residual;
}

static void energy_balances_on_every_surface(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 3, 3, 3, EDGE, 0.4);
    for (int more = 0; more < 2; more++)
        for (int bonding = BRC_BONDING_NONE; bonding <= BRC_BONDING_FULL; bonding++) {
            const char *viscous = more ? "; viscous: 1e4 1/s" : "";

            for (int k = 0; k < N_SHAPES; k++)
                assert_true(residual_on(f, &SHAPES[k], (enum brc_bonding)bonding, viscous) < LIMIT);
        }
}

/* Force of a platen on the specimen along its normal and across it, after it has moved. */
static void force_after(struct fixture *f, const double way[2], double force[2])
{
    const struct brc_platen *p = &f->sim.rig.platen[0];
    const double zero[3] = {0, 0, 0};
    double v[3];
    for (size_t i = 0; i < f->sim.bodies.n; i++)
        fixture_velocity(f, i, zero, zero);
    brc_scale(v, p->n, way[0]);
    brc_axpy(v, way[1], p->across);
    fixture_velocity(f, (size_t)p->body, v, zero);
    fixture_carry(f, 1);
    force[0] = -brc_dot(f->sim.bodies.f[p->body], p->n);
    force[1] = -brc_dot(f->sim.bodies.f[p->body], p->across);
}

static void normal_bonding_pulls_and_rubs(void **state)
{
    struct fixture *f = *state;
    double force[2], pushed[2];
    fixture_grid(f, 3, 3, 3, EDGE, 0);
    make(f, &SHAPES[0], BRC_BONDING_NORMAL, "");
    force_after(f, (const double[]){-1e-7, 0}, force);
    assert_true(force[0] < 0);
    force_after(f, (const double[]){0, 1e-6}, pushed);
    CHECK_NEAR(pushed[0], force[0], 0, 1e-12);
    CHECK_NEAR(pushed[1], 0, 1e-9 * fabs(force[0]), 0);
    force_after(f, (const double[]){2e-7, 0}, pushed);
    CHECK_NEAR(pushed[0], -force[0], 0, 1e-9); /* the same spring both ways */
    force_after(f, (const double[]){0, 1e-6}, pushed);
    CHECK_NEAR(pushed[1], 0.3 * pushed[0], 0, 1e-9); /* slides by Coulomb's law */
}

static void curved_surface_pushes_along_its_own_normal(void **state)
{
    struct fixture *f = *state;
    fixture_grid(f, 3, 3, 3, EDGE, 0);
    make(f, &SHAPES[3], BRC_BONDING_FULL, "");
    double force[2], across = 0, along = 0;
    force_after(f, (const double[]){1e-8, 0}, force);
    const struct brc_contacts *c = &f->sim.platens;
    const struct brc_platen *p = &f->sim.rig.platen[0];
    for (size_t i = 0; i < c->n; i++) {
        if (c->b[i] != p->body)
            continue;
        across = fmax(across, fabs(brc_dot(c->f[i], p->across)));
        along = fmax(along, fabs(brc_dot(c->f[i], p->n)));
    }
    CHECK_NEAR(force[1], 0, 1e-9 * force[0], 0); /* both sides are alike */
    assert_true(across > 0.05 * along && across < along);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(energy_balances_on_every_surface),
        FIXTURE_TEST(normal_bonding_pulls_and_rubs),
        FIXTURE_TEST(curved_surface_pushes_along_its_own_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
