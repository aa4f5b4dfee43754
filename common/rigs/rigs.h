/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests that there are, by name and number (the choice of test.kind), and what is the same for
 * all of them. */
#ifndef BRC_RIGS_H
#define BRC_RIGS_H

#include "common/engine/rig.h"

/* test.kind where a case says nothing */
#define BRC_RIG_DEFAULT "compression"

enum { BRC_MAX_RIGS = 32 };
/* Versions of what tests share: the loading, and what is measured by curve, gauge and readings. */
extern const struct brc_physics brc_rigs_physics[];
int brc_rigs_count(void);
const struct brc_rig_type *brc_rigs_at(int i);
/* Number of the test of that name, -1: there is none. */
int brc_rigs_find(const char *name);
/* The test that the parameters ask for. own: parameters of its own section, NULL where it has none.
 */
struct brc_test brc_rigs_test(const struct brc_test_params *params, const void *own);
/* Whether a test uses a shared key. */
bool brc_rigs_uses(const struct brc_rig_type *rig, const char *key);

/* The key that has ended the test; NULL while it goes on. */
const char *brc_rigs_end(const struct brc_sim *sim);
static inline bool brc_rigs_done(const struct brc_sim *sim)
{
    return brc_rigs_end(sim) != NULL;
}
/* The values measured so far; returns how many: those that the test declares, and those of
 * readings.h. What was not measured has a note: strength and all that hangs on the
 * peak before the load has fallen from it, moduli without a gauge or without two rows. A value that
 * is not finite and has no note is the result of a computation that failed. */
int brc_rigs_results(const struct brc_sim *sim, struct brc_result out[BRC_MAX_RESULTS]);

#endif
