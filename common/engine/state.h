/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole state of a simulation as a list of parts, each a set of rows with declared fields: the
 * tables of the field lists, and the scalars of clock, rig and ledger as one row. Saving and
 * loading walk over this list and know nothing else. */
#ifndef BRC_STATE_H
#define BRC_STATE_H

#include "common/engine/sim.h"

struct brc_state_part {
    const char *path; /* group in the file, "pairs/points" */
    struct brc_fieldset set;
    struct brc_table *table; /* columns; NULL: rows are structs at base, set.owner_size apart */
    void *base;
    size_t n;
    bool is_fixed; /* the case decides the number of rows; else it is loaded */
};

enum { BRC_STATE_MAX_PARTS = 16 };

struct brc_state {
    int n;
    struct brc_state_part part[BRC_STATE_MAX_PARTS];
};

/* Lists the parts as they are now; n of a part is valid until its table changes. */
void brc_state_list(struct brc_sim *sim, struct brc_state *state);
/* Address of the values of a field in a row. */
void *brc_state_value(const struct brc_state_part *part, int field, size_t row);

#endif
