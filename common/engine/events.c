/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The crack log. Models append as their loops find breaks; whoever draws or counts cracks reads it
 * as a table. Within a step events are sorted, so that the log does not tell in which order threads
 * or instruction sets took the contacts. */
#include "common/engine/events.h"

#include "common/base/invariant.h"
#include "common/geometry/vec.h"

#include <string.h>

#define BRC_OWNER struct brc_events
static const struct brc_field event_fields[] = {BRC_EVENT_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

void brc_events_init(struct brc_events *e)
{
    memset(e, 0, sizeof *e);
    struct brc_fieldset set = BRC_FIELDSET(event_fields, struct brc_events);
    brc_table_init(&e->table, "events", set, e);
}

void brc_events_free(struct brc_events *e)
{
    brc_table_free(&e->table);
}

static bool is_before(const struct brc_event *event, const struct brc_events *e, size_t i)
{
    if (event->a != e->a[i])
        return event->a < e->a[i];
    return event->b != e->b[i] ? event->b < e->b[i] : event->point < e->point[i];
}

/* By insertion: a step has few events, and they come nearly in order. There is no code to return in
 * the middle of a force loop, so a failure stays in the context and the step looks there. */
void brc_events_add(struct brc_context *ctx, struct brc_events *e, int64_t step,
                    const struct brc_event *event)
{
    size_t i = e->table.n;
    BRC_ASSERT(event->a < event->b && (i == 0 || e->step[i - 1] <= step));
    if (brc_table_resize(ctx, &e->table, i + 1) != 0)
        return;
    /* within a step by grains and point, whatever order the contacts were taken in */
    for (; i > 0 && e->step[i - 1] == step && is_before(event, e, i - 1); i--)
        brc_table_copy(&e->table, i, i - 1, 1);
    e->step[i] = step;
    e->a[i] = event->a;
    e->b[i] = event->b;
    e->facet[i] = event->facet;
    e->point[i] = event->point;
    e->mode[i] = (uint8_t)event->mode;
    brc_copy(e->x[i], event->x);
    brc_copy(e->n[i], event->n);
    e->area[i] = event->area;
    e->energy[i] = event->energy;
    brc_copy(e->force[i], event->force);
    brc_copy(e->branch[i], event->branch);
    e->count[event->mode]++;
}

const char *brc_mode_name(enum brc_mode mode)
{
    static const char *const name[BRC_N_MODES] = {"tension", "shear", "torsion"};
    return name[mode];
}
