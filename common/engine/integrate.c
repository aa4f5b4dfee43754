/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/engine/integrate.h"

#include "common/engine/sim.h"
#include "common/geometry/vec.h"

/* Turns q and the body-frame angular momentum by the free rotation about one principal axis. */
static void rotate_axis(double q[4], double lb[3], int axis, double inertia, double dt)
{
    int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double half[4], phi[3] = {dt * lb[axis] / inertia, 0, 0}, lj = lb[j];
    brc_quat_from_rotation(half, phi);
    double c = half[0], s = half[1], cos_phi = 1 - 2 * s * s, sin_phi = 2 * s * c;
    lb[j] = cos_phi * lj + sin_phi * lb[k];
    lb[k] = cos_phi * lb[k] - sin_phi * lj;
    double q0 = q[0], qj = q[1 + j];
    q[0] = c * q0 - s * q[1 + axis];
    q[1 + axis] = c * q[1 + axis] + s * q0;
    q[1 + j] = c * qj + s * q[1 + k];
    q[1 + k] = c * q[1 + k] - s * qj;
}

static void quat_normalise(double q[4])
{
    double s = 1 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] *= s;
}

void brc_integrate_spin(double w[3], const double q[4], const double l[3], const double inertia[3])
{
    double m[3][3], lb[3];
    brc_quat_matrix(m, q);
    brc_mat_mul_t(lb, m, l);
    for (int k = 0; k < 3; k++)
        lb[k] /= inertia[k];
    brc_mat_mul(w, m, lb);
}

void brc_integrate_rotate(double q[4], double w[3], const double l[3], const double inertia[3],
                          double dt)
{
    double m[3][3], lb[3];
    brc_quat_matrix(m, q);
    brc_mat_mul_t(lb, m, l);
    rotate_axis(q, lb, 0, inertia[0], dt / 2);
    rotate_axis(q, lb, 1, inertia[1], dt / 2);
    rotate_axis(q, lb, 2, inertia[2], dt);
    rotate_axis(q, lb, 1, inertia[1], dt / 2);
    rotate_axis(q, lb, 0, inertia[0], dt / 2);
    quat_normalise(q);
    brc_integrate_spin(w, q, l, inertia);
}

static bool is_isotropic(const double inertia[3])
{
    return inertia[0] == inertia[1] && inertia[1] == inertia[2];
}

static void turn_isotropic(double q[4], const double w[3], double dt)
{
    double phi[3], turn[4], old[4] = {q[0], q[1], q[2], q[3]};
    brc_scale(phi, w, dt);
    brc_quat_from_rotation(turn, phi);
    brc_quat_mul(q, turn, old);
    quat_normalise(q);
}

/* Orientations, in the order of the bodies; before their spin is read for anything else. */
static void drift_orientations(struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        if (is_isotropic(b->inertia[i]))
            turn_isotropic(b->q[i], b->w[i], sim->dt);
        else
            brc_integrate_rotate(b->q[i], b->w[i], b->l[i], b->inertia[i], sim->dt);
    }
}

static const struct brc_integrate_loops *loops_of(const struct brc_sim *sim)
{
    return brc_simd_of(sim->run.simd) == BRC_SIMD_BASE ? &brc_integrate_base : &brc_integrate_avx2;
}

void brc_integrate_drift(struct brc_sim *sim)
{
    if (sim->model.flags & BRC_MODEL_ORIENTED)
        drift_orientations(sim);
    loops_of(sim)->drift(sim);
}

void brc_integrate_kick(struct brc_sim *sim, double dt)
{
    loops_of(sim)->kick(sim, dt);
}

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
    if (is_beginning(sim))
        sim->ledger.start -= leaves;
    else
        sim->ledger.mass_scaling += leaves;
    brc_copy(b->v[i], v);
    brc_sub(b->w[i], b->w[i], dw);
    b->mass[i] = mass;
    brc_set(b->inertia[i], inertia, inertia, inertia);
}

static void add_stiffness(const struct brc_contacts *c, size_t body, double k[2])
{
    for (size_t r = c->adjacent_first[body]; r < c->adjacent_first[body + 1]; r++) {
        uint32_t row = c->adjacent[r] / 2, side = c->adjacent[r] % 2;
        k[0] += c->k[row][0];
        k[1] += c->k[row][1 + side];
    }
}

void brc_integrate_stiffness(const struct brc_sim *sim, size_t body, double k[2])
{
    k[0] = k[1] = 0;
    add_stiffness(&sim->pairs, body, k);
    add_stiffness(&sim->platens, body, k);
}

void brc_integrate_scale_masses(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++) {
        double k[2];
        brc_integrate_stiffness(sim, i, k);
        /* K_t = 4 sum k, K_theta = 4 sum k r^2: omega dt <= 2 with dt = 1 is proved for margin 1 */
        double mass = fmax(b->mass[i], sim->run.mass_margin * 0.25 * 4 * k[0]); /* eq:vgcm:26 */
        double inertia =
            fmax(b->inertia[i][0], sim->run.mass_margin * 0.25 * 4 * k[1]); /* eq:vgcm:27 */
        if (mass > b->mass[i] || inertia > b->inertia[i][0])
            set_mass(sim, i, mass, inertia);
    }
}

/* Mean stiffness of the springs that act, or may soon; 0: there are none. */
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

int brc_integrate_loose_masses(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    double k = -1;
    for (size_t i = 0; i < b->n_grains; i++) {
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
    return 0;
}
