/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A specimen: domain, seeds and tessellation, before any contact model. One specimen serves both
 * models. The axis of cylinders and of compression and tension is z; the Brazilian load is along y.
 */
#ifndef BRC_SPECIMEN_H
#define BRC_SPECIMEN_H

#include "common/specimen/facets.h"
#include "common/input/params.h"

enum brc_shape { BRC_SHAPE_BOX, BRC_SHAPE_CYLINDER, BRC_SHAPE_POLYHEDRON };
enum brc_grains {
    BRC_GRAINS_PACKING,
    BRC_GRAINS_GRID,
    BRC_GRAINS_MESH,
    BRC_GRAINS_POINTS,
    BRC_GRAINS_TESS
};

/* What is asked for is bounded before work begins. */
enum { BRC_MAX_GRAINS = 10000000 };

#define BRC_SPECIMEN_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                            \
    CHOICE(shape, "box|cylinder|polyhedron", "cylinder", "outer shape")                            \
    REAL3(size, "m", "10 cm, 10 cm, 10 cm", "[1e-9, 1e9]", "box: edge lengths along x, y, z",      \
          "shape=box")                                                                             \
    REAL(diameter, "m", "80 mm", "[1e-9, 1e9]", "cylinder: diameter of the circle",                \
         "shape=cylinder")                                                                         \
    REAL(height, "m", "160 mm", "[1e-9, 1e9]", "cylinder: height (thickness of a disc), along z",  \
         "shape=cylinder")                                                                         \
    INT(sides, "0", "[0, 1024]",                                                                   \
        "cylinder: sides of the prism, equal area to the circle; even; 0: 256 in a Brazilian "     \
        "test, 64 in others, and 30 for a mesh, as in gt12",                                       \
        "shape=cylinder")                                                                          \
    TEXT(planes, "", "polyhedron: file of planes, one 'nx ny nz d' a line, n . x <= d, in metres", \
         "shape=polyhedron, grains=packing|grid|mesh|points")                                      \
    CHOICE(grains, "packing|grid|mesh|points|tess", "packing",                                     \
           "packing: spheres grown to contact, Laguerre cells; grid: one random seed per cubic "   \
           "cell, Voronoi cells; mesh: extruded triangles of a disc; points: seeds of a file; "    \
           "tess: cells and shape of a Neper file")                                                \
    TEXT(points, "", "points: file of seeds, 'x y z' or 'x y z radius' a line, in metres",         \
         "grains=points")                                                                          \
    TEXT(tess, "", "tess: tessellation file of Neper (.tess), three-dimensional, flat faces",      \
         "grains=tess")                                                                            \
    REAL(tess_unit, "m", "1 m", "[1e-12, 1e12]", "tess: what the length 1 is in the file",         \
         "grains=tess")                                                                            \
    FLAG(tess_spheres, "off", "tess: weights of the seeds are radii of spheres", "grains=tess")    \
    REAL(diameter_min, "m", "4 mm", "[1e-9, 1e9]", "packing: smallest sphere diameter",            \
         "grains=packing")                                                                         \
    REAL(diameter_max, "m", "6 mm", "[1e-9, 1e9]", "packing: largest sphere diameter",             \
         "grains=packing")                                                                         \
    REAL(solid_fraction, "1", "0.676", "(0.1, 0.75)", "packing: sphere volume / domain volume",    \
         "grains=packing, count=0")                                                                \
    INT(count, "0", "[0, 10000000]", "packing: number of spheres; 0: from the solid fraction",     \
        "grains=packing")                                                                          \
    INT3(cells, "10, 10, 10", "[1, 1000]", "grid: cubic cells along x, y, z", "grains=grid")       \
    REAL(jitter, "1", "1", "[0, 1]", "grid: width of the seeds' random box, in cells; 0: exact",   \
         "grains=grid")                                                                            \
    REAL(triangle_area, "m2", "5 cm2", "[1e-18, 1e18]", "mesh: largest triangle area",             \
         "grains=mesh")                                                                            \
    INT(seed, "1", "[0, 2147483647]", "random seed", "grains=packing|grid")                        \
    REAL(min_area_ratio, "1", "1e-4", "[0, 0.1]",                                                  \
         "facets below this part of the mean area are no contacts",                                \
         "grains=packing|grid|points|tess")                                                        \
    FLAG(cache, "on", "keep finished packings on disk (BRECCIA_CACHE, else ~/.cache/breccia)",     \
         "grains=packing")

struct brc_specimen_params {
    BRC_PARAM_MEMBERS(BRC_SPECIMEN_PARAMS)
};
extern const struct brc_param_list brc_specimen_param_list;

struct brc_specimen {
    struct brc_specimen_params params;
    struct brc_convex domain; /* face ids: box -x +x -y +y -z +z = 0..5; cylinder 0 bottom, 1 top,
                                 2 + k side k with its normal at 90 deg + k 360/(number of sides) */
    double domain_volume;     /* m3 */
    struct brc_facets facets;
    double solid_fraction;        /* spheres / domain; 0 for plain Voronoi */
    double mean_contact_distance; /* m, mean centre distance over the inner facets */
};

/* Makes (or loads from the cache) the specimen. Equal parameters give equal bits. */
int brc_specimen_create(struct brc_context *ctx, const struct brc_specimen_params *params,
                        struct brc_specimen *out);
void brc_specimen_free(struct brc_specimen *s);
/* Logs a warning where the specimen is only a few grains wide in some direction. */
void brc_specimen_warn(struct brc_context *ctx, const struct brc_specimen *s);
/* Extent of the domain: lowest and highest corner. */
void brc_specimen_extent(const struct brc_specimen *s, double low[3], double high[3]);

#endif
