/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole state of a simulation as a list of parts, each a set of rows with declared fields: the
 * tables of the field lists, and the scalars of the clock, the rig and the ledger, which are
 * declared here. Saving and loading walk over this list and know nothing else. */
#ifndef BRC_STATE_H
#define BRC_STATE_H

#include "sim.h"

#define BRC_CLOCK_FIELDS(SCALAR, VECTOR)                                              \
    SCALAR(int64_t, step, BRC_STATE, "1", "steps made")                               \
    SCALAR(double, time, BRC_STATE, "s", "time (steps in the quasi-static regime)")   \
    SCALAR(double, dt, BRC_STATE, "s", "time step")                                   \
    SCALAR(double, dt_limit, BRC_STATE, "s", "last estimate of the stable time step") \
    SCALAR(double, skin, BRC_STATE, "m", "skin of the candidate list")                \
    SCALAR(double, damping_alpha, BRC_STATE, "1", "local damping in use")             \
    SCALAR(int64_t, n_listings, BRC_STATE, "1", "times that candidates were listed")  \
    VECTOR(int64_t, k_seen, 2, BRC_STATE, "1", "stiffness versions at the last mass scaling")

#define BRC_RIG_FIELDS(SCALAR, VECTOR)                                                      \
    SCALAR(double, rate, BRC_STATE, "s-1", "strain rate")                                   \
    SCALAR(double, strain, BRC_STATE, "1", "platen strain")                                 \
    SCALAR(double, force, BRC_STATE, "N", "mean platen force in the sense of the test")     \
    SCALAR(double, force_peak, BRC_STATE, "N", "largest force so far")                      \
    SCALAR(double, strain_peak, BRC_STATE, "1", "platen strain at the largest force")       \
    SCALAR(int64_t, peak_step, BRC_STATE, "1", "step of the largest force")                 \
    SCALAR(double, unbalanced, BRC_STATE, "1", "unbalanced-force ratio")                    \
    SCALAR(double, unbalanced_max, BRC_STATE, "1", "largest unbalanced-force ratio so far") \
    SCALAR(double, kinetic_ratio, BRC_STATE, "1", "kinetic / stored energy")

#define BRC_PLATEN_FIELDS(SCALAR, VECTOR)                                      \
    SCALAR(double, boundary_work, BRC_STATE, "J", "work done on the specimen") \
    VECTOR(double, force_old, 3, BRC_STATE, "N", "force of the step before")

#define BRC_VERSION_FIELDS(SCALAR, VECTOR)                                 \
    SCALAR(int64_t, version, BRC_STATE, "1", "changes of the set of rows") \
    SCALAR(int64_t, k_version, BRC_STATE, "1", "changes of any stiffness")

/* Rows of one part: value j of field i in row r lies at brc_state_value(part, i, r) + j. */
struct brc_state_part {
    const char *path; /* group in the file, "pairs/points" */
    struct brc_fieldset set;
    struct brc_table *table; /* columns; NULL: rows are structs at base, owner_size apart */
    char *base;
    size_t n;
};

enum { BRC_STATE_MAX_PARTS = 24 };

/* Lists the parts as they are now; valid until an array of the simulation changes its size. */
int brc_state_parts(struct brc_sim *sim, struct brc_state_part part[BRC_STATE_MAX_PARTS]);
void *brc_state_value(const struct brc_state_part *part, int field, size_t row);

/* Makes the row sets of a simulation fit for loading: contacts become the given sorted pairs with
 * np points each, events and curve get their counts. */
struct brc_state_shape {
    size_t n_contacts[2]; /* pairs, platens */
    int32_t (*pair[2])[2];
    int32_t *np[2];
    size_t n_events, n_curve;
};
int brc_state_reshape(struct brc_sim *sim, const struct brc_state_shape *shape);

#endif
