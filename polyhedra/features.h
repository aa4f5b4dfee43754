/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The literal evaluation: one feature pair at a time, from the poses alone. It decides closest
 * features that are not sure, and gives energy and springs. The laws are those of geometry.h, with
 * the one pair in all lanes. */
#ifndef POLY_FEATURES_H
#define POLY_FEATURES_H

#include "polyhedra/closest.h"
#include "polyhedra/feature_list.h"
#include "polyhedra/geometry.h"

/* Lists every feature pair whose closed distance is below the contact distance + skin. *allowance
 * is how far the bodies may come nearer before another pair could touch. */
int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance);
/* How a listed feature pair touches now; *active is its side (0 when apart), and the closest
 * feature that it remembers may be updated. When apart, -delta is a relative path that it is free
 * for. *margin: how far a vertex may move before its closest feature changes, 0 or less where that
 * is not known. What it returns follows from poses and the side alone: the remembered feature is
 * where the walk begins, not what it finds. */
bool poly_find_contact(struct poly_geometry *t, const struct poly_pair *p, struct poly_feature *f,
                       uint8_t *active, double *margin, enum poly_rule rule);
/* `closed`: relative path before the pair can touch, less than 0 where it touches. */
double poly_closed_gap(const struct poly_pair *p, struct poly_feature *f);
/* `closed`: what of the face (itself, an edge, a vertex) is closest to the vertex, as a code. */
int32_t poly_feature_of_face(const struct poly_pair *p, struct poly_feature *f);

#endif
