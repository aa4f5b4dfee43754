/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Brute-force twin of the contact detection of polyhedra: every feature of one core against every
 * feature of the other, by distance functions of its own. */
#ifndef BRC_TESTS_TWIN_FEATURES_H
#define BRC_TESTS_TWIN_FEATURES_H

#include "common/geometry/convex.h"

/* A core in space: faces as vertex loops, edges as vertex pairs. */
struct twin_core {
    size_t n_vertices, n_edges, n_faces;
    double (*vertex)[3];
    int32_t (*edge)[2];
    size_t *first; /* [n_faces + 1] */
    int32_t *loop;
    double (*normal)[3];
};

/* Feature contacts with a distance below rest: counts, and the sum of rest - distance along the
 * direction from a to b, with its moment about the origin. */
struct twin_sum {
    int vertex_face, edge_edge; /* strict: feet strictly inside */
    int vertex_edge, vertex_vertex;
    double overlap[3], moment[3];
    double closest; /* of any pair counted in overlap */
    /* pairs of closed sets nearer than rest - doubt, and those within doubt of rest: who is right
     * about them is a matter of round-off */
    int closed, doubtful;
    double doubt;
};

void twin_core_from(struct twin_core *core, const struct brc_convex *c);
void twin_core_free(struct twin_core *core);
/* The cores share a point: then distances have signs, and the twin says nothing. */
bool twin_overlap(const struct twin_core *a, const struct twin_core *b);
/* strict: vertex-face and edge-edge pairs with feet strictly inside; otherwise closed sets. */
void twin_compare(const struct twin_core *a, const struct twin_core *b, double rest, bool strict,
                  struct twin_sum *sum);

#endif
