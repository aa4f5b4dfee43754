/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accounts of the grains: what their contacts store and dissipate. A model books the energies of a
 * contact on its grain a, in the order of (a, b), and the ledger is their sum over the grains, made
 * only when somebody reads it: so neither the order of the contacts nor how the grains are shared
 * out is felt in it, and a step pays for one addition a contact. Rejected: to
 * add to the ledger in each step, which either rounds by the order of the list, or costs an exact
 * sum over all grains for each of six terms. */
#ifndef BRC_ACCOUNTS_H
#define BRC_ACCOUNTS_H

#include "common/engine/ledger.h"

/* Columns of `energy` of the bodies [J]: the terms of the ledger that models book. What is stored
 * now (struct brc_model, energy) has the same columns. The first four go side by side as lanes. */
enum brc_account {
    BRC_ACCOUNT_NORMAL,
    BRC_ACCOUNT_SHEAR,
    BRC_ACCOUNT_DAMAGE,
    BRC_ACCOUNT_FRICTION,
    BRC_ACCOUNT_BOND,
    BRC_ACCOUNT_VISCOUS,
    BRC_N_ACCOUNTS = 8 /* two are left over: one line of the cache a grain */
};

struct brc_sim;

/* Opens the accounts with what is stored now, and the ledger with that and its kinetic energy. */
void brc_accounts_open(struct brc_sim *sim);
/* Brings sim->ledger up to date; before it is read, saved or hashed. Returns it. */
const struct brc_ledger *brc_accounts_settle(struct brc_sim *sim);
/* Energy stored now, from the state alone [J]: bonds, contact normal, contact shear. */
void brc_accounts_stored(const struct brc_sim *sim, double stored[3]);

#endif
