/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The section `specimen` of a case: its keys and their choices. Apart from specimen.h, so that each
 * part of the making (seeds, packing, cache) sees what is asked for and not what comes out. */
#ifndef BRC_SPECIMEN_PARAMS_H
#define BRC_SPECIMEN_PARAMS_H

#include "common/input/params.h"

enum brc_shape { BRC_SHAPE_BOX, BRC_SHAPE_CYLINDER, BRC_SHAPE_POLYHEDRON };
enum brc_grains {
    BRC_GRAINS_PACKING,
    BRC_GRAINS_GRID,
    BRC_GRAINS_MESH,
    BRC_GRAINS_POINTS,
    BRC_GRAINS_TESS
};

/* What is asked for is bounded before work begins: a slip in a unit would ask for 1e12 grains, and
 * end for want of memory after minutes. Ten million fill the memory of a large machine. */
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
         "shape=polyhedron, grains=packing|grid|mesh|points", .flags = BRC_PARAM_FILE)             \
    CHOICE(grains, "packing|grid|mesh|points|tess", "packing",                                     \
           "packing: spheres grown to contact, Laguerre cells; grid: one random seed per cubic "   \
           "cell, Voronoi cells; mesh: extruded triangles of a disc; points: seeds of a file; "    \
           "tess: cells and shape of a Neper file")                                                \
    TEXT(points, "", "points: file of seeds, 'x y z' or 'x y z radius' a line, in metres",         \
         "grains=points", .flags = BRC_PARAM_FILE)                                                 \
    TEXT(tess, "", "tess: tessellation file of Neper (.tess), three-dimensional, flat faces",      \
         "grains=tess", .flags = BRC_PARAM_FILE)                                                   \
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
         "facets below this part of the mean area are not contacts",                               \
         "grains=packing|grid|points|tess")                                                        \
    FLAG(cache, "on", "keep finished packings on disk (BRECCIA_CACHE, else ~/.cache/breccia)",     \
         "grains=packing", .flags = BRC_PARAM_MAY_CHANGE | BRC_PARAM_COST)

struct brc_specimen_params {
    BRC_PARAM_MEMBERS(BRC_SPECIMEN_PARAMS)
};
extern const struct brc_param_list brc_specimen_param_list;
/* Versions of what this folder computes: cells and facets, and the ways to seeds. */
extern const struct brc_physics brc_specimen_physics[];

#endif
