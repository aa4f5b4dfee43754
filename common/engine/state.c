/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of what is saved. Paths are the groups of state files, so they stay as they are whatever
 * the structs are called. A test without columns or scalars of its own has no group for them: an
 * empty one would change the files of all tests that came before. */
#include "common/engine/state.h"

static void add_table(struct brc_state *s, const char *path, struct brc_table *table, bool is_fixed)
{
    s->part[s->n++] = (struct brc_state_part){
        .path = path, .set = table->set, .table = table, .n = table->n, .is_fixed = is_fixed};
}

void brc_state_list(struct brc_sim *sim, struct brc_state *state)
{
    state->n = 0;
    brc_accounts_settle(sim);
    state->part[state->n++] = (struct brc_state_part){
        .path = "scalars", .set = brc_sim_scalars, .base = sim, .n = 1, .is_fixed = true};
    add_table(state, "bodies", &sim->bodies.table, true);
    add_table(state, "bodies/model", &sim->bodies.model, true);
    add_table(state, "pairs", &sim->pairs.table, false);
    add_table(state, "pairs/model", &sim->pairs.model, false);
    add_table(state, "pairs/points", &sim->pairs.points, false);
    add_table(state, "platens", &sim->platens.table, false);
    add_table(state, "platens/model", &sim->platens.model, false);
    add_table(state, "platens/points", &sim->platens.points, false);
    add_table(state, "events", &sim->events.table, false);
    add_table(state, "curve", &sim->rig.curve.table, false);
    if (sim->rig.curve.own.set.n > 0)
        add_table(state, "curve/test", &sim->rig.curve.own, false);
    if (sim->rig.own_state.set.n > 0)
        add_table(state, "test", &sim->rig.own_state, true);
}

void *brc_state_value(const struct brc_state_part *part, int field, size_t row)
{
    const struct brc_field *f = &part->set.fields[field];
    if (part->table)
        return (char *)brc_table_column(part->table, field) + row * brc_field_size(f);
    return (char *)part->base + row * part->set.owner_size + f->offset;
}
