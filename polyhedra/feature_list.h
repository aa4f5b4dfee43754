/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Feature pairs of two cores, and lists of them. For who makes lists (listing_kernels.inc.h,
 * platens.c), evaluates pairs (features.c) or keeps them as points (points.c); knows no simulation.
 */
#ifndef POLY_FEATURE_LIST_H
#define POLY_FEATURE_LIST_H

#include "polyhedra/shape.h"

enum poly_kind { POLY_VERTEX_A, POLY_VERTEX_B, POLY_EDGES };

/* Four are enough for cores whose vertices are not nearer to each other than about R; more would
 * lengthen every point. Where more are near, all vertices of the core are looked at. */
enum { POLY_NEAR = 4, POLY_NONE_NEAR = -1, POLY_MANY_NEAR = -2 };

/* A feature pair. POLY_VERTEX_A: vertex i of a and face j of b (merged: its closest feature on b);
 * POLY_VERTEX_B: face (feature) i of a and vertex j of b; POLY_EDGES: edges i and j. */
struct poly_feature {
    double free; /* m, relative path of the bodies before the pair can touch */
    int32_t i, j;
    int32_t near[POLY_NEAR]; /* vertices of the other core that may lower a merged vertex's weight,
                                then POLY_NONE_NEAR; the first is POLY_MANY_NEAR: more than fit */
    uint8_t kind;
};

/* The closest feature that a feature pair remembers. */
static inline int32_t *poly_remembered(struct poly_feature *f)
{
    return f->kind == POLY_VERTEX_B ? &f->i : &f->j;
}

/* Kept for the whole run and filled for one contact after the other, so that making a list asks for
 * no memory once the largest has been met. */
struct poly_list {
    struct poly_feature *feature;
    size_t n, cap;
    double *work; /* work space of listing_kernels.inc.h */
    int32_t *edge;
    size_t cap_work, cap_edge;
};

/* Two bodies in space. */
struct poly_pair {
    struct poly_core a, b;
    const double *xa, *xb;           /* centres */
    const double (*ra)[3], (*rb)[3]; /* rotation matrices, body to space */
    const double (*va)[3], (*vb)[3]; /* core vertices in space */
    double contact_distance;         /* m, R1 + R2: of the cores, without overlap */
    double fade;                     /* m, over which weights of `merged` change */
    double reach;                    /* m, smaller one of the cores' radii about their centres */
};

void poly_list_free(struct poly_list *l);
int poly_list_add(struct brc_context *ctx, struct poly_list *l, const struct poly_feature *f);

#endif
