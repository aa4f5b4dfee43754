/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cores of cells: the part of a cell that is farther than a radius from all its facets; rounded by
 * spheres of that radius, it is the spheropolyhedron of gt12. Facets of a cell in one plane
 * (lamellae, tessellations of two scales) are one face of the core. Used by the polyhedra model and
 * by the first guess of its stiffnesses; knows no contact. */
#ifndef BRC_EROSION_H
#define BRC_EROSION_H

#include "common/specimen/facets.h"

/* Work space, kept from cell to cell; zero before the first use. */
struct brc_erosion {
    const struct brc_facets *facets;
    size_t index, n;        /* the cell, and the number of its facets */
    struct brc_convex cell; /* the whole cell */
    struct brc_convex core; /* what is left of it; no faces when nothing is */
    struct brc_plane
        *plane; /* [n] of the cell, outward; behind them work: one a face of the core */
    struct {
        int32_t leader;   /* the first and largest of the facets in this one's plane */
        int32_t share;    /* number of facets in the plane that this one leads */
    } * facet;            /* [n] */
    double (*polygon)[3]; /* work */
    size_t cap_plane, cap_facet, cap_polygon;
};

void brc_erosion_free(struct brc_erosion *e);
/* Takes a cell up: its body, and which of its facets lie in one plane. */
int brc_erosion_begin(struct brc_context *ctx, struct brc_erosion *e, const struct brc_facets *f,
                      size_t cell);
/* The core for a radius; a face's id is the number of the facet that leads its plane. centre is a
 * point inside the cell. */
int brc_erosion_core(struct brc_context *ctx, struct brc_erosion *e, double radius,
                     const double centre[3]);
/* area [n_facets][2] [m2]: sets those of the cell's facets, on its side of them (first: the low
 * cell): the part of the core's face that lies over the facet; 0 where erosion has removed the
 * face. The facets of one plane share its face without gaps. */
int brc_erosion_areas(struct brc_context *ctx, struct brc_erosion *e, double (*area)[2]);
/* Radius of the largest sphere inside the cell, known to be below high [m]. */
double brc_erosion_inscribed(struct brc_erosion *e, double high);

#endif
