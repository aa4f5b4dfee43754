/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Platens that are held at a stress, without a gain that would have to be tuned. A pair of platens
 * is one more body of the network: its mass is what its contacts' stiffness asks for, as for a
 * grain (eq 26 of vgcm), so that the step is stable by the same proof for soft and for stiff
 * specimens; local damping takes what swings. In slow loading it does not accelerate, so the force
 * is what was asked for. Rejected: a velocity in proportion to the force that is missing, whose
 * gain must be found anew for each specimen and each state of damage.
 *
 * The two platens approach each other by the same way: their middle would drift otherwise, as
 * nothing holds it. */
#include "common/rigs/servo.h"

#include "common/engine/mass_scaling.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

/* Local damping of the platens where grains have none: in the dynamic regime. */
static const double DAMPING = 0.7;

/* Mass that a step of dt needs, of both platens. It stays when contacts are lost, so that a platen
 * that has come off is not thrown at the specimen. */
static void follow_stiffness(const struct brc_sim *sim, int first, double *mass)
{
    double k[2], sum = 0;
    for (int i = first; i < first + 2; i++) {
        brc_mass_scaling_stiffness(sim, (size_t)sim->rig.platen[i].body, k);
        sum += k[0];
    }
    double needed = sim->run.mass_margin * sum * sim->dt * sim->dt; /* eq:vgcm:26 */
    *mass = fmax(*mass, needed);
}

void brc_servo_push(struct brc_sim *sim, int first, double force, double *mass)
{
    struct brc_bodies *b = &sim->bodies;
    const struct brc_platen *p = &sim->rig.platen[first], *other = p + 1;
    double *v = b->v[p->body], *mean = b->v_mean[p->body];
    double missing = 2 * force - p->force - other->force;
    double speed = brc_dot(v, p->n);
    bool is_spared = sim->damp_fluctuation && sim->rig.is_steady;
    double damped = is_spared ? speed - brc_dot(mean, p->n) : speed;
    double alpha = sim->damping_alpha > 0 ? sim->damping_alpha : DAMPING;
    follow_stiffness(sim, first, mass);
    if (*mass > 0)
        speed +=
            sim->dt * (missing - (damped == 0 ? 0 : copysign(alpha * missing, damped))) / *mass;
    brc_scale(v, p->n, speed);
    brc_scale(b->v[other->body], other->n, speed);
    for (int k = 0; k < 3 && sim->tracks_mean; k++) {
        mean[k] += (v[k] - mean[k]) / sim->run.damping_memory;
        b->v_mean[other->body][k] = -mean[k];
    }
}
