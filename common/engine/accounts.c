/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ledger's terms from what the grains have on their accounts. Called by whoever reads, saves or
 * hashes the ledger, never in each step. */
#include "common/engine/accounts.h"

#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/parallel/sums.h"

#include <string.h>

/* Sum over the grains of one of their accounts. Most of them are empty in most runs. */
static double total(const struct brc_bodies *b, double (*of_grain)[BRC_N_ACCOUNTS], int account)
{
    bool is_empty = true;
    for (size_t i = 0; i < b->n_grains; i++) {
        b->terms[i] = of_grain[i][account];
        is_empty = is_empty && b->terms[i] == 0;
    }
    return is_empty ? 0 : brc_sum_exact(b->terms, b->n_grains);
}

/* Each grain's part of what is stored now, in the bodies' `sum`, which is free between steps. */
static void find_stored(const struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    memset(b->sum, 0, b->n * sizeof *b->sum);
    sim->model.energy(sim, sim->state, b->sum);
}

void brc_accounts_stored(const struct brc_sim *sim, double stored[3])
{
    static const int account[3] = {BRC_ACCOUNT_BOND, BRC_ACCOUNT_NORMAL, BRC_ACCOUNT_SHEAR};
    find_stored(sim);
    for (int k = 0; k < 3; k++)
        stored[k] = total(&sim->bodies, sim->bodies.sum, account[k]);
}

/* A constant force works along the way from the start alone, whatever the steps were. */
static double work_of_gravity(const struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    if (!BRC_OPTION(brc_norm2(sim->run.gravity) > 0))
        return 0;
    for (size_t i = 0; i < b->n_grains; i++) {
        double way[3];
        brc_sub(way, b->x[i], b->x0[i]);
        b->terms[i] = b->true_mass[i] * brc_dot(sim->run.gravity, way);
    }
    return brc_sum_exact(b->terms, b->n_grains);
}

const struct brc_ledger *brc_accounts_settle(struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    struct brc_ledger *l = &sim->ledger;
    if (!BRC_OPTION(sim->run.ledger))
        return l;
    double *const term[] = {
        [BRC_ACCOUNT_BOND] = &l->bond,           [BRC_ACCOUNT_NORMAL] = &l->contact_normal,
        [BRC_ACCOUNT_SHEAR] = &l->contact_shear, [BRC_ACCOUNT_DAMAGE] = &l->damage,
        [BRC_ACCOUNT_FRICTION] = &l->friction,   [BRC_ACCOUNT_VISCOUS] = &l->viscous};
    for (int k = 0; k <= BRC_ACCOUNT_VISCOUS; k++)
        *term[k] = total(b, b->energy, k);
    l->local_damping = brc_sum_exact(b->damping, b->n_grains);
    l->gravity = work_of_gravity(sim);
    return l;
}

void brc_accounts_open(struct brc_sim *sim)
{
    const struct brc_bodies *b = &sim->bodies;
    sim->ledger = (struct brc_ledger){.kinetic = sim->ledger.kinetic};
    find_stored(sim);
    memcpy(b->energy, b->sum, b->n * sizeof *b->energy);
    memset(b->damping, 0, b->n * sizeof *b->damping);
    sim->ledger.start = brc_ledger_imbalance(brc_accounts_settle(sim));
}
