/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The literal evaluation: one feature pair at a time, from the poses alone. It decides closest
 * features that are not sure, does all of `closed`, and gives energy and springs. The laws are
 * those of geometry.h, with the one pair in all lanes. */
#ifndef POLY_FEATURES_H
#define POLY_FEATURES_H

#include "polyhedra/closest.h"
#include "polyhedra/feature_list.h"
#include "polyhedra/geometry.h"

/* Lists every feature pair whose closed distance is below the contact distance + skin. *allowance
 * is how far the bodies may come nearer before another pair could touch. */
int poly_list_features(struct brc_context *ctx, struct poly_list *l, const struct poly_pair *p,
                       enum poly_rule rule, double skin, double *allowance);
/* Path of q before it can touch a face of the core c. */
double poly_path_to_face(const struct poly_core *c, int32_t face, const double q[3],
                         enum poly_rule rule, double contact_distance);

static inline void poly_to_body(double r[3], const double m[3][3], const double x[3],
                                const double v[3])
{
    double d[3];
    brc_sub(d, v, x);
    for (int k = 0; k < 3; k++)
        r[k] = m[0][k] * d[0] + m[1][k] * d[1] + m[2][k] * d[2];
}

static inline void poly_to_space(double r[3], const double m[3][3], const double v[3])
{
    for (int k = 0; k < 3; k++)
        r[k] = brc_dot(m[k], v);
}

/* How a listed feature pair touches now; *active is its side (0 when apart), and the closest
 * feature that it remembers may be updated. When apart, -delta is a relative path that it is free
 * for. *margin: how far a vertex may move before its closest feature changes, 0 or less where that
 * is not known. */
bool poly_find_contact(struct poly_geometry *t, const struct poly_pair *p, struct poly_feature *f,
                       uint8_t *active, double *margin, enum poly_rule rule);

#endif
