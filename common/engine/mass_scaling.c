/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masses of the quasi-static regime, after eqs 26 and 27 of vgcm: as large as a step of 1 needs.
 * They follow the contacts' sums of k, which models keep at hand, so no eigenvalue is computed;
 * what the bound is worth is in docs/numerics.md. Called by sim.c alone. */
#include "common/engine/mass_scaling.h"

#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"

/* The start of a test, and its first step, in which the load closes contacts. */
static bool is_beginning(const struct brc_sim *sim)
{
    return sim->step <= 1 && sim->rig.n_platens > 0;
}

/* Body i gets mass m and moment of inertia: momentum is kept, so that velocities only fall. As a
 * test begins, the masses are chosen for the field of velocities that it begins with. */
static void set_mass(struct brc_sim *sim, size_t i, double mass, double inertia)
{
    struct brc_bodies *b = &sim->bodies;
    double part[2] = {b->mass[i] < mass ? b->mass[i] / mass : 1,
                      b->inertia[i][0] < inertia ? b->inertia[i][0] / inertia : 1};
    double dv[3], dw[3], v[3], field[3] = {0, 0, 0};
    if (is_beginning(sim) && sim->rig.type->field)
        sim->rig.type->field(sim, i, field);
    brc_sub(dv, b->v[i], field);
    brc_scale(dv, dv, 1 - part[0]);
    brc_scale(dw, b->w[i], 1 - part[1]);
    brc_sub(v, b->v[i], dv);
    /* what leaves the kinetic energy of the leapfrog form, see ledger.h */
    double leaves = 0.5 * (b->mass[i] * brc_norm2(b->v[i]) - mass * brc_norm2(v)) +
                    0.5 * (1 - part[1]) * b->inertia[i][0] * brc_norm2(b->w[i]) +
                    0.5 * sim->dt * (brc_dot(dv, b->f[i]) + brc_dot(dw, b->t[i]));
    b->terms[i] = leaves;
    brc_copy(b->v[i], v);
    brc_sub(b->w[i], b->w[i], dw);
    b->mass[i] = mass;
    brc_set(b->inertia[i], inertia, inertia, inertia);
}

/* The kinetic energies that set_mass has taken. */
static void account(struct brc_sim *sim)
{
    double leaves = brc_sum_exact(sim->bodies.terms, sim->bodies.n_grains);
    if (is_beginning(sim))
        sim->ledger.start -= leaves;
    else
        sim->ledger.mass_scaling += leaves;
}

static void add_stiffness(const struct brc_contacts *c, size_t body, double k[2])
{
    for (size_t r = c->adjacent_first[body]; r < c->adjacent_first[body + 1]; r++) {
        uint32_t row = c->adjacent[r] / 2, side = c->adjacent[r] % 2;
        k[0] += c->k[row][0];
        k[1] += c->k[row][1 + side];
    }
}

void brc_mass_scaling_stiffness(const struct brc_sim *sim, size_t body, double k[2])
{
    k[0] = k[1] = 0;
    add_stiffness(&sim->pairs, body, k);
    add_stiffness(&sim->platens, body, k);
}

/* All three moments are made equal: a scaled moment has no geometry behind it, and equal ones turn
 * exactly. terms are filled for every body, since exact sums count all of them. */
void brc_mass_scaling_update(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        double k[2];
        brc_mass_scaling_stiffness(sim, i, k);
        /* K_t = 4 sum k, K_theta = 4 sum k r^2: omega dt <= 2 with dt = 1 is proved for margin 1 */
        double mass = fmax(b->mass[i], sim->run.mass_margin * 0.25 * 4 * k[0]); /* eq:vgcm:26 */
        double inertia =
            fmax(b->inertia[i][0], sim->run.mass_margin * 0.25 * 4 * k[1]); /* eq:vgcm:27 */
        b->terms[i] = 0;
        if (mass > b->mass[i] || inertia > b->inertia[i][0])
            set_mass(sim, i, mass, inertia);
    }
    account(sim);
}

/* Mean stiffness of the springs that act, or may soon; 0: there are none. Of all, not of the
 * nearest: a loose grain may fall on any of them. */
static int mean_stiffness(struct brc_sim *sim, double *k)
{
    struct brc_springs springs = {0};
    int code = sim->model.springs(sim, sim->state, &springs);
    *k = 0;
    for (size_t i = 0; i < springs.n; i++)
        *k += fmax(springs.spring[i].kn, springs.spring[i].ks) / (double)springs.n;
    brc_springs_free(&springs);
    return code;
}

int brc_mass_scaling_loose(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    double k = -1;
    for (size_t i = 0; i < b->n_grains; i++) {
        b->terms[i] = 0;
        if (b->mass[i] > 0 && b->inertia[i][0] > 0)
            continue;
        if (k < 0)
            BRC_TRY(mean_stiffness(sim, &k));
        if (k == 0 && brc_norm2(sim->run.gravity) > 0)
            BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                     "nothing is in contact yet, so there is no stiffness to scale the masses by, "
                     "which gravity moves: choose run.regime: dynamic with run.dt");
        double mass = k > 0 ? sim->run.mass_margin * k : 1;
        double radius = cbrt(3 * b->volume[i] / (4 * BRC_PI));
        set_mass(sim, i, fmax(b->mass[i], mass), fmax(b->inertia[i][0], mass * radius * radius));
    }
    account(sim);
    return 0;
}
