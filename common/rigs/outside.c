/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forces on grains from outside, with their work. It knows bodies, and neither surface nor test. */
#include "common/rigs/outside.h"

#include "common/engine/rotation.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

#include <string.h>

void brc_outside_turn(const struct brc_sim *sim, int32_t grain)
{
    if (!(sim->model.flags & BRC_MODEL_ORIENTED))
        brc_rotation_turn(sim->bodies.q[grain], sim->bodies.w[grain], sim->dt);
}

double brc_outside_push(const struct brc_sim *sim, int32_t grain, const double now[6],
                        double last[6])
{
    const struct brc_bodies *b = &sim->bodies;
    double force[3], moment[3];
    brc_add(b->f[grain], b->f[grain], now);
    brc_add(b->t[grain], b->t[grain], now + 3);
    brc_add(force, last, now);
    brc_add(moment, last + 3, now + 3);
    memcpy(last, now, 6 * sizeof *last);
    return 0.5 * sim->dt * (brc_dot(force, b->v[grain]) + brc_dot(moment, b->w[grain]));
}
