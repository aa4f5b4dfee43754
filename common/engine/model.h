/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact model is one const struct of this type, filled in <folder>/model.c and named
 * brc_model_<folder>. The framework owns the memory of everything declared in the field lists;
 * saving, hashing and comparing come from them. docs/add-a-model.md walks through it. */
#ifndef BRC_MODEL_H
#define BRC_MODEL_H

#include "common/base/table.h"
#include "common/input/params.h"
#include "common/engine/accounts.h"
#include "common/engine/stability.h"
#include "common/geometry/grid.h"

enum brc_model_flags {
    BRC_MODEL_ROTATES = 1,  /* grains turn: moments are used */
    BRC_MODEL_ORIENTED = 2, /* the model reads q: orientation is integrated */
    BRC_MODEL_ADDS = 4 /* forces adds those of pairs to the sum of bodies, in the order of (a, b) */
};

struct brc_model {
    const char *name;
    const char *citation;
    struct brc_param_list params;
    const struct brc_physics *physics; /* versions of the model and its laws; NULL: none are told */
    struct brc_fieldset body_fields, contact_fields, point_fields;
    unsigned flags;
    int point_lanes; /* ranges of points begin at its multiples, padded with zeros; 0 counts as 1 */

    /* --- required --- */

    /* Geometry, mass and inertia of the grains: fills sim->bodies x, q, true_mass, true_inertia,
     * volume, bounding_radius and the model's body fields for the grains. Called once. */
    int (*shape)(struct brc_sim *sim, void *state);
    /* Opens the initial contacts and points of sim->pairs from the facets, and of sim->platens from
     * the boundary facets. Called once, after shape. */
    int (*bond)(struct brc_sim *sim, void *state);
    /* Candidates have changed: open rows that may interact, close those that are apart, keep the
     * state of the rest (brc_contacts_merge). Bonded rows stay whatever the candidates say. */
    int (*pairs)(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                 const struct brc_neighbours *platens);
    /* Hot. All rows of sim->pairs for one step: writes f, ta, tb, k (and k_version), updates point
     * state, books energies on the grains' accounts (accounts.h) when sim->run.ledger is on,
     * appends crack events. No allocation outside brc_contacts_points and brc_events_add, no I/O;
     * reads bodies, never writes them, but for their accounts, and for their sum where the model
     * ADDS: then ta and tb need not be written, nor read again. */
    void (*forces)(struct brc_sim *sim, void *state);
    /* The same for the rows of sim->platens. */
    void (*platens)(struct brc_sim *sim, void *state);
    /* Energy stored now, from state alone [J]: adds that of each contact to the row of its grain a,
     * in the accounts of bonds, normal and shear springs. */
    void (*energy)(const struct brc_sim *sim, const void *state,
                   double (*of_grain)[BRC_N_ACCOUNTS]);
    /* Springs that act now, linearised, for the stable time step. */
    int (*springs)(const struct brc_sim *sim, const void *state, struct brc_springs *out);

    /* --- optional: NULL where the model has none --- */

    /* Judges parameters and specimen together; allocates nothing; names the parameter that is
     * wrong. */
    int (*check)(struct brc_context *ctx, const void *params, const struct brc_specimen *specimen);
    /* Private memory in *state. free accepts a half-built state and NULL. */
    int (*create)(struct brc_sim *sim, void **state);
    void (*free)(void *state);
    /* Parameters or options changed: choose the specialised loop. */
    void (*select)(struct brc_sim *sim, void *state);
    /* A loaded state has replaced all fields: derive private memory again. */
    int (*restore)(struct brc_sim *sim, void *state);
    /* Fields that hold nothing in this model, in the tables of bodies, pairs and platens and those
     * of their points: names with spaces between. They are not saved. */
    const char *no_bodies, *no_pairs, *no_platens;
    /* Part of the tensile strength of an intact bond (row of sim->pairs) that is left, in [0, 1]:
     * tells what holds together. None: all of it. */
    double (*strength_left)(const struct brc_sim *sim, const void *state, size_t row);
    /* One paragraph for the run header: readings chosen, derived stiffness. */
    void (*describe)(const struct brc_sim *sim, const void *state, char *text, size_t size);
};

/* Registered models: the folders that held a model.c at build time. */
int brc_registry_count(void);
const struct brc_model *brc_registry_at(int i);
const struct brc_model *brc_registry_find(const char *name);
/* An internal error that names the first required operation which a model lacks. */
int brc_model_check(struct brc_context *ctx, const struct brc_model *model);

#endif
