/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "state.h"

#define BRC_OWNER struct brc_sim
static const struct brc_field clock_fields[] = {BRC_CLOCK_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_rig
static const struct brc_field rig_fields[] = {BRC_RIG_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_platen
static const struct brc_field platen_fields[] = {BRC_PLATEN_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_contacts
static const struct brc_field version_fields[] = {BRC_VERSION_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_ledger
static const struct brc_field ledger_fields[] = {
#define LEDGER_ROW(name, sign, meaning) BRC_FIELD(double, name, BRC_STATE, "J", meaning)
    BRC_LEDGER_TERMS(LEDGER_ROW)
        BRC_FIELD(double, start, BRC_STATE, "J", "kinetic and stored energy at the start")
#undef LEDGER_ROW
};
#undef BRC_OWNER
/* sim->travel_listed, seen as rows of one value */
struct travel_row {
    double travel_listed;
};
#define BRC_OWNER struct travel_row
static const struct brc_field travel_fields[] = {BRC_FIELD(
    double, travel_listed, BRC_STATE, "m", "travel of each body when candidates were last listed")};
#undef BRC_OWNER
#define BRC_OWNER struct brc_events
static const struct brc_field count_fields[] = {
    BRC_FIELD3(int64_t, count, BRC_N_MODES, BRC_STATE, "1", "events by mode")};
#undef BRC_OWNER

static struct brc_state_part table_part(const char *path, struct brc_table *table)
{
    return (struct brc_state_part){.path = path, .set = table->set, .table = table, .n = table->n};
}

#define RECORDS(path_, fields, object, count)                                   \
    (struct brc_state_part)                                                     \
    {                                                                           \
        .path = (path_), .set = BRC_FIELDSET(fields, *(object)), .table = NULL, \
        .base = (char *)(object), .n = (size_t)(count)                          \
    }

static int contact_parts(struct brc_contacts *c, const char *const path[4],
                         struct brc_state_part *part)
{
    part[0] = table_part(path[0], &c->table);
    part[1] = table_part(path[1], &c->model);
    part[2] = table_part(path[2], &c->points);
    part[3] = RECORDS(path[3], version_fields, c, 1);
    return 4;
}

int brc_state_parts(struct brc_sim *sim, struct brc_state_part part[BRC_STATE_MAX_PARTS])
{
    static const char *const pairs[] = {"pairs", "pairs/model", "pairs/points", "pairs/versions"};
    static const char *const platens[] = {"platens", "platens/model", "platens/points",
                                          "platens/versions"};
    int n = 0;
    part[n++] = RECORDS("clock", clock_fields, sim, 1);
    part[n++] = RECORDS("ledger", ledger_fields, &sim->ledger, 1);
    part[n++] = RECORDS("rig", rig_fields, &sim->rig, 1);
    part[n++] = RECORDS("rig/platens", platen_fields, sim->rig.platen, sim->rig.n_platens);
    part[n++] = table_part("bodies", &sim->bodies.table);
    part[n++] = table_part("bodies/model", &sim->bodies.model);
    n += contact_parts(&sim->pairs, pairs, part + n);
    n += contact_parts(&sim->platens, platens, part + n);
    part[n++] = table_part("events", &sim->events.table);
    part[n++] = RECORDS("events/counts", count_fields, &sim->events, 1);
    part[n++] = table_part("curve", &sim->rig.curve.table);
    struct travel_row *travel = (struct travel_row *)sim->travel_listed;
    part[n++] = RECORDS("bodies/listed", travel_fields, travel, sim->bodies.n);
    return n;
}

void *brc_state_value(const struct brc_state_part *part, int field, size_t row)
{
    const struct brc_field *f = &part->set.fields[field];
    if (part->table)
        return (char *)brc_table_column(part->table, field) + row * brc_field_size(f);
    return part->base + row * part->set.owner_size + f->offset;
}

static int reshape_contacts(struct brc_context *ctx, struct brc_contacts *c,
                            const struct brc_state_shape *shape, int set)
{
    const int32_t(*pair)[2] = (const int32_t(*)[2])shape->pair[set];
    BRC_TRY(brc_contacts_set(ctx, c, NULL, 0));
    BRC_TRY(brc_contacts_set(ctx, c, pair, shape->n_contacts[set]));
    for (size_t i = 0; i < c->n; i++)
        BRC_TRY(brc_contacts_points(ctx, c, i, shape->np[set][i]));
    return 0;
}

int brc_state_reshape(struct brc_sim *sim, const struct brc_state_shape *shape)
{
    BRC_TRY(reshape_contacts(sim->ctx, &sim->pairs, shape, 0));
    BRC_TRY(reshape_contacts(sim->ctx, &sim->platens, shape, 1));
    BRC_TRY(brc_table_resize(sim->ctx, &sim->events.table, shape->n_events));
    return brc_table_resize(sim->ctx, &sim->rig.curve.table, shape->n_curve);
}
