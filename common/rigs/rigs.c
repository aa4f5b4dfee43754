/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests that were linked in: the Makefile writes their list from the files of this folder, so
 * that a new test is one file. Names become the choices of test.kind by the same list. */
#include "common/rigs/rigs.h"

#include "common/engine/sim.h"
#include "common/rigs/loading.h"

#include "rig_list.h"
#include <string.h>

#define BRC_OWNER struct brc_test_params
static const struct brc_param test_params[] = {BRC_PARAM_LIST(BRC_TEST_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_test_param_list = BRC_PARAMS(test_params, struct brc_test_params);

#define BRC_RIG(symbol) extern const struct brc_rig_type symbol;
BRC_RIGS
#undef BRC_RIG

static const struct brc_rig_type *const registered[] = {
#define BRC_RIG(symbol) &symbol,
    BRC_RIGS
#undef BRC_RIG
};

_Static_assert(sizeof registered / sizeof registered[0] <= BRC_MAX_RIGS,
               "BRC_MAX_RIGS is too small");

int brc_rigs_count(void)
{
    return (int)(sizeof registered / sizeof registered[0]);
}

const struct brc_rig_type *brc_rigs_at(int i)
{
    return registered[i];
}

int brc_rigs_find(const char *name)
{
    for (int i = 0; i < brc_rigs_count(); i++)
        if (strcmp(registered[i]->name, name) == 0)
            return i;
    return -1;
}

struct brc_test brc_rigs_test(const struct brc_test_params *params, const void *own)
{
    return (struct brc_test){registered[params->kind], params, own};
}

/* By whole words, as one key may be a part of another (rate, rate_max). */
bool brc_rigs_uses(const struct brc_rig_type *rig, const char *key)
{
    size_t n = strlen(key);
    for (const char *at = rig->keys; (at = strstr(at, key)) != NULL; at += n)
        if ((at == rig->keys || at[-1] == ' ') && (at[n] == ' ' || at[n] == '\0'))
            return true;
    return false;
}

bool brc_rigs_done(const struct brc_sim *sim)
{
    const struct brc_rig_type *type = sim->rig.type;
    return type->is_done ? type->is_done(sim) : brc_loading_is_done(sim);
}

/* Broken contacts are counted for every test, whatever it measures. */
int brc_rigs_results(const struct brc_sim *sim, struct brc_result out[BRC_MAX_RESULTS])
{
    static const char *const broken[BRC_N_MODES] = {"broken_tension", "broken_shear",
                                                    "broken_torsion"};
    const struct brc_rig_type *type = sim->rig.type;
    struct brc_measured measured[BRC_MAX_RESULTS];
    int n = 0;
    type->results(sim, measured);
    for (; n < type->n_quantities; n++)
        out[n] = (struct brc_result){type->quantities[n].name, measured[n].value,
                                     type->quantities[n].unit, measured[n].note};
    for (int m = 0; m < BRC_N_MODES; m++)
        out[n++] = (struct brc_result){broken[m], (double)sim->events.count[m], "1", NULL};
    return n;
}
