/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stable time step: largest eigenfrequency of the present springs by power iteration. */
#ifndef BRC_STABILITY_H
#define BRC_STABILITY_H

#include "common/base/error.h"

/* A linear spring between a point at arm ra of body a and one at arm rb of body b: kn along n, ks
 * across, kt [N m] against relative rotation about n. */
struct brc_spring {
    int32_t a, b;
    double ra[3], rb[3], n[3];
    double kn, ks, kt;
    bool is_near; /* may act in the next step: those of a pair follow each other */
};

struct brc_springs {
    struct brc_spring *spring;
    size_t n, cap;
};

/* Appends; used by the models' `springs`. */
int brc_springs_add(struct brc_context *ctx, struct brc_springs *s,
                    const struct brc_spring *spring);
void brc_springs_free(struct brc_springs *s);

/* Largest stable step 2/omega_max [s] for the masses in use: of all springs that act together, and
 * of those that are near between two bodies, which may close at once, with the two alone; local
 * damping alpha lowers it by sqrt(1 + alpha). HUGE_VAL when nothing is stiff. */
int brc_stability_limit(struct brc_sim *sim, double *dt_limit);
/* Dynamic regime, for models that look closer at a pair between two estimates: lowers
 * sim->dt_limit to what the given springs, all between the same two bodies, need alone. Their
 * numbers of bodies are lost. */
int brc_stability_foresee(struct brc_sim *sim, struct brc_springs *springs);

#endif
