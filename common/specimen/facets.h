/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tessellation result: closed cells and the polygons between them. Immutable once made; both
 * models read the same facets. A facet is stored once and seen from both cells, so that they agree
 * about its area and vertices to the last bit, and a bond is a facet's number: contacts of a
 * specimen follow from this list, never from a search for what is near. Made by tess.h, tess_disc.c
 * and neper.h; knows no model and no material. */
#ifndef BRC_FACETS_H
#define BRC_FACETS_H

#include "common/base/pool.h"
#include "common/geometry/convex.h"

struct brc_facets {
    /* cells, numbered along a space-filling order */
    size_t n_cells;
    double *volume;      /* [n_cells] m3 */
    double (*centre)[3]; /* [n_cells] m, centroid of the cell */
    double (*seed)[3];   /* [n_cells] m, Voronoi seed or centre of the sphere */
    double *radius;      /* [n_cells] m, sphere radius (Laguerre weight r^2); 0 for plain Voronoi */
    size_t *cell_first;  /* [n_cells + 1] */
    int32_t *cell_facet; /* facets of a cell, ascending */
    /* facets, sorted by (low cell, high cell), boundary facets of a cell after its inner ones */
    size_t n_facets;
    int32_t (*cell)[2];    /* [n_facets] low and high cell; [1] = -1 on the boundary */
    int32_t *face;         /* [n_facets] domain plane id on the boundary, -1 inside */
    uint8_t *is_contact;   /* [n_facets] 0: inner facet below the area limit, which closes its cells
                              but carries no contact; 1: every other facet */
    double *area;          /* [n_facets] m2 */
    double (*centroid)[3]; /* [n_facets] m */
    double (*normal)[3];   /* [n_facets] unit, out of cell[0] */
    size_t *first;         /* [n_facets + 1] range in loop */
    int32_t *loop;         /* vertex ids, counter-clockwise seen against the normal's tip */
    /* vertices, shared by all facets and cells that meet there */
    size_t n_vertices;
    double (*vertex)[3]; /* [n_vertices] m */
    double area_dropped; /* m2, total area of the facets that are not contacts */
    double precision; /* m, last digit of the vertices in the file that they stem from; 0: none */
    struct brc_pool pool; /* owns the arrays */
};

void brc_facets_free(struct brc_facets *f);
/* Room for the seeds of n cells; radii are 0. */
int brc_facets_seeds(struct brc_context *ctx, struct brc_facets *f, size_t n);
/* The check that nothing leaves unseen, whatever it was made by, and in every build: every cell is
 * a closed convex body (each edge once in each direction, Euler's formula, volume above zero,
 * closure), and the volumes sum to the domain. An error names the cell, and its place with `origin`
 * added. */
int brc_facets_verify(struct brc_context *ctx, const struct brc_facets *f, double domain_volume,
                      const double origin[3]);
/* Moves all places [m]; areas and volumes stay as they were measured near the origin. */
void brc_facets_shift(struct brc_facets *f, const double by[3]);
/* Sets is_contact and area_dropped for a limit of min_area_ratio times the mean inner area. Tiny
 * facets are kept and only marked: a cell without them would be open, while a contact over one
 * would have next to no stiffness and a normal that is rounding. */
void brc_facets_mark_contacts(struct brc_facets *f, double min_area_ratio);
/* Sum of the areas between two cells [m2], and their number *n. */
double brc_facets_inner_area(const struct brc_facets *f, size_t *n);
/* m, of a cell's sphere, or where the specimen has none that of a sphere of the cell's volume. */
double brc_facets_radius(const struct brc_facets *f, size_t cell);
/* m, twice the area over the perimeter: what a facet is wide where it is narrow. */
double brc_facets_width(const struct brc_facets *f, size_t facet);
/* Planes of a cell's facets, outward, id = facet; n = cell_first[c+1] - cell_first[c]. */
void brc_facets_cell_planes(const struct brc_facets *f, size_t cell, struct brc_plane *planes);
/* The cell as a convex polyhedron with the shared vertices; face ids are facet numbers. */
int brc_facets_cell(struct brc_context *ctx, const struct brc_facets *f, size_t cell,
                    struct brc_convex *c);

/* Hash of seeds, cells, facets and vertices: equal specimens have equal ones. A run that resumes
 * compares it with that of its state, since the specimen is made anew and not saved. */
uint64_t brc_facets_hash(const struct brc_facets *f);

#endif
