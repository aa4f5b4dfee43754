/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a uniform strain sees of a specimen: sums over its facets that turn the contact stiffnesses
 * of both models into moduli. Derivation in docs/calibration.md. For the first guess (guess.h);
 * knows facets and the models' rules of which count, but no model. */
#ifndef CALIB_FABRIC_H
#define CALIB_FABRIC_H

#include "common/specimen/facets.h"

/* Which facets and areas count. */
struct calib_fabric_rules {
    double gap;            /* m: facets of spheres nearer than the gap; HUGE_VAL: all facets */
    double rounding;       /* m: sphero-radius of the polyhedra */
    bool is_eroded;        /* bonds have the mean area of the two eroded faces */
    bool is_length_of_gap; /* strain length 2 rounding, else the distance of the centres */
    /* the last three as polyhedra.radius, .area and .strain_length; gap as vgcm.interaction */
};

/* All sums are over inner facets and divided by 3 V, the sum of A d over all of them: the volume
 * that they represent, without the layer at the boundary. */
struct calib_fabric {
    size_t n_contacts;
    double volume;        /* m3, represented by the inner facets: V */
    double mean_distance; /* m, of the contacts' seeds */
    double coverage;      /* 1: part of sum A d that the contacts carry */
    double bond;    /* 1: sum A_bond d^2 / L: a bond modulus times this is a stiffness in Pa */
    double corners; /* 1/m: sum of corners times d^2: a corner's stiffness times this in Pa */
    double stretch; /* 1: mean of d / L, a bond's strain in a unit strain */
};

/* Fails where no facet is a contact, or where the rules need a sphero-radius and have none. */
int calib_fabric_measure(struct brc_context *ctx, const struct brc_facets *facets,
                         const struct calib_fabric_rules *rules, struct calib_fabric *out);

#endif
