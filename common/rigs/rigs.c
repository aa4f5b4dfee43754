/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests that were linked in: the Makefile writes their list from the files of this folder, so
 * that a new test is one file. Names become the choices of test.kind by the same list. */
#include "common/rigs/rigs.h"

#include "common/engine/sim.h"
#include "common/rigs/loading.h"
#include "common/rigs/readings.h"

#include "rig_list.h"
#include <string.h>

#define BRC_OWNER struct brc_test_params
static const struct brc_param test_params[] = {BRC_PARAM_LIST(BRC_TEST_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_test_param_list = BRC_PARAMS(test_params, struct brc_test_params);

const struct brc_physics brc_rigs_physics[] = {
    {"loading", 2, NULL}, {"measures", 2, NULL}, {NULL, 0, NULL}};

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
_Static_assert(BRC_MAX_QUANTITIES + BRC_N_READINGS <= BRC_MAX_RESULTS,
               "BRC_MAX_RESULTS is too small");

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

const char *brc_rigs_end(const struct brc_sim *sim)
{
    const struct brc_rig_type *type = sim->rig.type;
    return type->end ? type->end(sim) : brc_loading_end(sim);
}

static struct brc_result result(const struct brc_quantity *q, const struct brc_measured *m)
{
    return (struct brc_result){
        .name = q->name, .value = m->value, .unit = q->unit, .note = m->note};
}

/* What a test declares, then what is read off every test. Of the latter the screen shows the
 * numbers of breaks alone. */
int brc_rigs_results(const struct brc_sim *sim, struct brc_result out[BRC_MAX_RESULTS])
{
    const struct brc_rig_type *type = sim->rig.type;
    struct brc_measured measured[BRC_MAX_QUANTITIES], readings[BRC_N_READINGS];
    int n = 0;
    type->results(sim, measured);
    for (; n < type->n_quantities; n++)
        out[n] = result(&type->quantities[n], &measured[n]);
    brc_readings(sim, readings);
    for (int i = 0; i < BRC_N_READINGS; i++, n++) {
        out[n] = result(&brc_readings_quantities[i], &readings[i]);
        out[n].is_detail = i >= BRC_N_MODES;
    }
    return n;
}
