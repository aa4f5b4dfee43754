/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closest feature of a core to a point: walks and searches in the body frame of the core, which
 * decide where; the laws take the distance from there (geometry.h). No length or angle is compared
 * with an absolute number: results scale with the sample. Scalars throughout: of the steps of a
 * walk each depends on the one before, so that lanes would have nothing to do side by side. */
#ifndef POLY_CLOSEST_H
#define POLY_CLOSEST_H

#include "polyhedra/shape.h"

#include "common/geometry/vec.h"

static inline void poly_to_body(double r[3], const double m[3][3], const double x[3],
                                const double v[3])
{
    double d[3];
    brc_sub(d, v, x);
    for (int k = 0; k < 3; k++)
        r[k] = m[0][k] * d[0] + m[1][k] * d[1] + m[2][k] * d[2];
}

/* fmin and fmax are calls; these are instructions. */
static inline double poly_least(double a, double b)
{
    return a < b ? a : b;
}

static inline double poly_most(double a, double b)
{
    return a > b ? a : b;
}

/* Features are named by a code: 4 x index + kind. One number, so that a point remembers its closest
 * feature in the place where an index of a face would be (struct poly_feature). */
enum poly_closest_kind { POLY_ON_FACE, POLY_ON_EDGE, POLY_ON_VERTEX };

struct poly_closest {
    double s;    /* m, distance, negative inside the core */
    double n[3]; /* unit, from the core to the point: gradient of s */
    int32_t feature;
};

static inline int32_t poly_feature_code(int32_t index, enum poly_closest_kind kind)
{
    return 4 * index + (int32_t)kind;
}

static inline double poly_height(const struct poly_face *f, const double p[3])
{
    return brc_dot(f->n, p) - f->d;
}

/* Side of the face that p is farthest outside of; -1 when it is strictly above or below the face.
 */
static inline int32_t poly_outside(const struct poly_core *c, const struct poly_face *f,
                                   const double p[3])
{
    int32_t worst = -1;
    double most = 0;
    for (int32_t k = f->first; k < f->first + f->n_sides; k++) {
        double out = brc_dot(c->side[k].m, p) - c->side[k].off;
        if (out >= most) {
            most = out;
            worst = k;
        }
    }
    return worst;
}

/* Face whose plane p is highest above; inside the core this is the nearest face. Outside the core
 * it is a face that p is above, a good one to begin a walk at; the height bounds the distance from
 * below. */
static inline int32_t poly_highest(const struct poly_core *c, const double p[3], double *height)
{
    int32_t best = 0;
    double most = poly_height(&c->face[0], p);
    for (int32_t f = 1; f < c->n_faces; f++) {
        double h = poly_height(&c->face[f], p);
        if (h > most) {
            most = h;
            best = f;
        }
    }
    *height = most;
    return best;
}

/* Closest point of the line of an edge, in parts of it from its first end; along is the whole edge.
 * Outside 0 to 1 where that is beyond an end: walks want to know beyond which. */
static inline double poly_along_edge(const struct poly_core *c, int32_t edge, const double p[3],
                                     double along[3])
{
    const double *v0 = c->vertex[c->end[edge][0]];
    double r[3];
    brc_sub(along, c->vertex[c->end[edge][1]], v0);
    brc_sub(r, p, v0);
    return brc_dot(r, along) / brc_norm2(along);
}

/* p over face f, with that height above its plane. */
void poly_on_face(struct poly_closest *r, const struct poly_core *c, int32_t f, double height);
/* Signed distance of p to the core: a walk over neighbouring features from a remembered one. The
 * surface is convex, so where the walk settles is the closest feature, wherever it began. */
void poly_closest_walk(struct poly_closest *r, const struct poly_core *c, const double p[3],
                       int32_t feature);
/* The same of a point outside by trying every edge: where the walk does not settle. */
void poly_closest_search(struct poly_closest *r, const struct poly_core *c, const double p[3]);
/* Unsigned distance of p to a closed face, from outside or inside; the feature may be one of its
 * edges or vertices. */
void poly_closest_on_face(struct poly_closest *r, const struct poly_core *c, int32_t index,
                          const double p[3]);
/* Vertex p against a face by the rules `strict` (only above or below it) and `closed`. A vertex
 * inside the core counts once, at its nearest face, with a negative distance. False where this is
 * another one's, or where p is beyond the contact distance for sure. */
bool poly_closest_of_rule(struct poly_closest *r, const struct poly_core *c, int32_t face,
                          const double p[3], bool is_strict, double contact_distance);
/* How far p may move before its closest feature is another one, 0 or less inside the core. */
double poly_closest_margin(const struct poly_core *c, const struct poly_closest *at,
                           const double p[3]);
/* The same of its closest feature on a closed face, 0 or less also where p is below the face. */
double poly_closest_margin_of_face(const struct poly_core *c, int32_t face,
                                   const struct poly_closest *at, const double p[3]);
/* Path of q before it can touch a face of the core. */
double poly_path_to_face(const struct poly_core *c, int32_t face, const double q[3], bool is_strict,
                         double contact_distance);

#endif
