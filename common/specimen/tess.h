/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tessellations by CGAL, with exact predicates: plain Voronoi and Laguerre cells clipped by a
 * convex domain, and the extruded triangle mesh of a disc. Called by specimen.c; knows neither case
 * files nor models. */
#ifndef BRC_TESS_H
#define BRC_TESS_H

#include "common/specimen/facets.h"

/* Cells of the seeds in a convex domain. radius NULL: plain Voronoi; else Laguerre with weights
 * r^2. Seeds must lie in the domain. A seed without a cell (hidden, or coincident seeds) is an
 * error that names it. Inner facets below min_area_ratio times the mean area stay in the list, so
 * that cells are closed, but is_contact is 0 for them and area_dropped has their total area. */
int brc_tess_laguerre(struct brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
                      const struct brc_convex *domain, double min_area_ratio,
                      struct brc_facets *out);

/* gt12's Brazilian disc: regular polygon of n_sides and circumradius radius in the x-y plane, with
 * a side's normal along +y, meshed by Delaunay triangles of at most max_area, extruded from z = 0
 * to thickness. Boundary face ids: 0 bottom, 1 top, 2 + k side k (normal at 90 deg + k 360/n). */
int brc_tess_disc(struct brc_context *ctx, double radius, double thickness, int n_sides,
                  double max_area, struct brc_facets *out);

#endif
