/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Crack log: one event a broken bond (polyhedra) or fully damaged local point (vgcm). Force and
 * branch stand here, as neither can be told later: the force is gone with the bond, and the grains
 * fly apart. */
#ifndef BRC_EVENTS_H
#define BRC_EVENTS_H

#include "common/base/table.h"

enum brc_mode { BRC_MODE_TENSION, BRC_MODE_SHEAR, BRC_MODE_TORSION, BRC_N_MODES };

#define BRC_EVENT_FIELDS(SCALAR, VECTOR)                                               \
    SCALAR(int64_t, step, BRC_STATE, "1", "step of the break")                         \
    SCALAR(int32_t, a, BRC_STATE, "1", "body with the lower number")                   \
    SCALAR(int32_t, b, BRC_STATE, "1", "body with the higher number")                  \
    SCALAR(int32_t, facet, BRC_STATE, "1", "facet of the specimen")                    \
    SCALAR(int32_t, point, BRC_STATE, "1", "point of the contact, 0 for a whole bond") \
    SCALAR(uint8_t, mode, BRC_STATE, "1", "0 tension, 1 shear, 2 torsion")             \
    VECTOR(double, x, 3, BRC_STATE, "m", "place")                                      \
    VECTOR(double, n, 3, BRC_STATE, "1", "normal, from a to b")                        \
    SCALAR(double, area, BRC_STATE, "m2", "area that broke")                           \
    SCALAR(double, energy, BRC_STATE, "J", "energy dissipated by the break")           \
    VECTOR(double, force, 3, BRC_STATE, "N", "force on b that the break set free")     \
    VECTOR(double, branch, 3, BRC_STATE, "m", "from the centre of a to that of b")

struct brc_event {
    int32_t a, b, facet, point;
    enum brc_mode mode;
    double x[3], n[3], area, energy, force[3], branch[3];
};

struct brc_events {
    BRC_EVENT_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
    int64_t count[BRC_N_MODES];
};

void brc_events_init(struct brc_events *e);
void brc_events_free(struct brc_events *e);
/* Appends; a failure to grow is recorded in ctx and checked by the step loop. */
void brc_events_add(struct brc_context *ctx, struct brc_events *e, int64_t step,
                    const struct brc_event *event);
const char *brc_mode_name(enum brc_mode mode);

#endif
