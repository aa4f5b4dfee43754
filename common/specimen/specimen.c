/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the section `specimen` to cells: domain, seeds, tessellation, and the areas below which
 * facets carry no contact. What is asked for is bounded before work begins. Knows no model. */
#include "common/specimen/specimen.h"

#include "common/geometry/hilbert.h"
#include "common/specimen/neper.h"
#include "common/input/numbers.h"
#include "common/specimen/packing_cache.h"
#include "common/specimen/seeds.h"
#include "common/specimen/tess.h"
#include "common/geometry/vec.h"

#include <string.h>

#define BRC_OWNER struct brc_specimen_params
static const struct brc_param specimen_params[] = {BRC_PARAM_LIST(BRC_SPECIMEN_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_specimen_param_list =
    BRC_PARAMS(specimen_params, struct brc_specimen_params);
const struct brc_physics brc_specimen_physics[] = {{"cells", 1, NULL},
                                                   {"packing", 1, "specimen.grains=packing"},
                                                   {"grid", 1, "specimen.grains=grid"},
                                                   {"mesh", 1, "specimen.grains=mesh"},
                                                   {NULL, 0, NULL}};

enum { MAX_FILE_PLANES = 1000 };
/* Files of planes have nine digits or more: what differs by less is one plane. Three components and
 * a distance, each half a digit off in either of two planes. */
static const double plane_digits = 4e-9;
/* m: lengths of a specimen, however it is given. Far beyond any use; within them no square or cube
 * of a length leaves the range of a double. */
static const double least_length = 1e-9, largest_length = 1e9;
/* Fewer grains across do not stand for a rock: each of them shows in the result. */
static const double few_grains = 5;

/* Sides of the polygon that stands for a circle where the case gives none. A flat side under a
 * platen is loaded over its whole width at once, a circle over a patch that grows with the load:
 * the strength of a Brazilian test is right when the patch at the peak spans four sides or more,
 * whatever the size of the grains (docs/numerics.md). 256 sides do that down to a strain of 0.1 %
 * and cost next to nothing, as only boundary facets are cut. A mesh has a triangle or more a side.
 */
enum { SIDES = 256, MESH_SIDES = 30 };

/* One place for the default, since the disc's mesh and the cylinder's planes must have the same
 * sides. */
static int number_of_sides(const struct brc_specimen_params *p)
{
    if (p->sides > 0)
        return p->sides;
    return p->grains == BRC_GRAINS_MESH ? MESH_SIDES : SIDES;
}

/* Prism of n sides with the area of the circle, so that a nominal stress is right whatever n is, or
 * for gt12's mesh inscribed in it; the normal of side k is at 90 deg + k 360/n. Even, so that a
 * flat side faces either platen of a Brazilian test. */
static int make_cylinder(struct brc_context *ctx, const struct brc_specimen_params *p,
                         struct brc_pool *pool, struct brc_convex *domain)
{
    int n = number_of_sides(p);
    if (n % 2 != 0 || n < 4)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.sides = %d must be 4 or more and even, so that two sides face the "
                 "platens; 0 chooses the number",
                 n);
    struct brc_plane *plane = brc_pool_alloc(ctx, pool, (size_t)n + 2, sizeof *plane);
    if (!plane)
        return BRC_ERR_MEMORY;
    bool is_inscribed = p->grains == BRC_GRAINS_MESH;
    double apothem =
        p->diameter / 2 * (is_inscribed ? cos(BRC_PI / n) : sqrt(BRC_PI / (n * tan(BRC_PI / n))));
    plane[0] = (struct brc_plane){{0, 0, -1}, 0, 0};
    plane[1] = (struct brc_plane){{0, 0, 1}, p->height, 1};
    for (int k = 0; k < n; k++) {
        double angle = 0.5 * BRC_PI + 2 * BRC_PI * k / n;
        plane[2 + k] = (struct brc_plane){{cos(angle), sin(angle), 0}, apothem, 2 + k};
    }
    /* the two loaded sides face y to the last bit */
    brc_set(plane[2].n, 0, 1, 0);
    brc_set(plane[2 + n / 2].n, 0, -1, 0);
    const double centre[3] = {0, 0, p->height / 2};
    return brc_convex_from_planes(ctx, domain, plane, (size_t)n + 2, centre,
                                  p->diameter + p->height);
}

/* One plane a row: nx ny nz d. Normals need not have the length 1 in the file. */
static int enclose(struct brc_context *ctx, const char *path, const struct brc_numbers *rows,
                   struct brc_pool *pool, struct brc_convex *domain)
{
    struct brc_plane *plane = brc_pool_alloc(ctx, pool, rows->n, sizeof *plane);
    if (!plane)
        return BRC_ERR_MEMORY;
    if (rows->n > MAX_FILE_PLANES)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.planes: '%s' has %zu planes, at most %d are allowed",
                 path, rows->n, MAX_FILE_PLANES);
    for (size_t i = 0; i < rows->n; i++) {
        const double *row = rows->value + 4 * i;
        plane[i] = (struct brc_plane){{row[0], row[1], row[2]}, 0, (int32_t)i};
        plane[i].d = row[3] / brc_normalise(plane[i].n, plane[i].n);
        if (!isfinite(plane[i].d))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "specimen.planes: %s:%d: the normal nx ny nz must not be zero", path,
                     rows->line[i]);
    }
    BRC_TRY(brc_convex_enclosed(ctx, domain, plane, rows->n, plane_digits));
    if (domain->n_faces == 0)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "specimen.planes: the planes of '%s' enclose nothing",
                 path);
    return 0;
}

/* Reading is apart from what is made of the rows, so that they are freed whatever the planes
 * enclose. */
static int make_polyhedron(struct brc_context *ctx, const struct brc_specimen_params *p,
                           struct brc_pool *pool, struct brc_convex *domain)
{
    struct brc_numbers rows;
    BRC_TRY(brc_numbers_read(ctx, "specimen.planes", p->planes, "nx ny nz d", 4, 4, &rows));
    int code = enclose(ctx, p->planes, &rows, pool, domain);
    brc_numbers_free(&rows);
    return code;
}

/* Boxes and cylinders begin at the origin; planes of a file may be anywhere, and what is far away
 * is worked on nearby (geometry/convex.h). */
static int make_domain(struct brc_context *ctx, const struct brc_specimen_params *p,
                       struct brc_pool *pool, struct brc_convex *domain)
{
    const double low[3] = {0, 0, 0};
    switch ((enum brc_shape)p->shape) {
    case BRC_SHAPE_BOX:
        return brc_convex_box(ctx, domain, low, p->size);
    case BRC_SHAPE_CYLINDER:
        return make_cylinder(ctx, p, pool, domain);
    case BRC_SHAPE_POLYHEDRON:
        return make_polyhedron(ctx, p, pool, domain);
    }
    return BRC_ERR_INTERNAL;
}

/* Packings are kept sorted, so that one from the cache has the same bits as one that is made. Seeds
 * are sorted before they are tessellated, as cells have their numbers. */
static int make_seeds(struct brc_context *ctx, const struct brc_specimen *s,
                      struct brc_seeds *seeds)
{
    const struct brc_specimen_params *p = &s->params;
    bool is_packing = p->grains == BRC_GRAINS_PACKING;
    if (p->grains == BRC_GRAINS_GRID && p->shape != BRC_SHAPE_BOX)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.grains: grid needs specimen.shape: box");
    if (is_packing && brc_packing_cache_load(ctx, p, &s->domain, seeds))
        return 0;
    if (is_packing)
        BRC_TRY(brc_seeds_packing(ctx, p, &s->domain, s->domain_volume, seeds));
    else if (p->grains == BRC_GRAINS_GRID)
        BRC_TRY(brc_seeds_grid(ctx, p, seeds));
    else
        BRC_TRY(brc_seeds_points(ctx, p, s->domain_volume, seeds));
    BRC_TRY(brc_seeds_sort(ctx, seeds));
    if (is_packing)
        brc_packing_cache_save(ctx, p, &s->domain, seeds);
    return 0;
}

/* Each sphere's centre must lie in its own cell: contacts of vgcm act between the centres over the
 * facet between them. A sphere that is much larger than its neighbour can have that one's centre in
 * its own cell, although both have one. */
static int check_centres(struct brc_context *ctx, const struct brc_facets *f)
{
    for (size_t i = 0; i < f->n_facets; i++) {
        for (int side = 0; side < 2 && f->cell[i][side] >= 0; side++) {
            int32_t c = f->cell[i][side];
            double d[3];
            brc_sub(d, f->centroid[i], f->seed[c]);
            if ((side == 0 ? 1 : -1) * brc_dot(d, f->normal[i]) <= 0)
                BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                         "the centre of sphere %d lies outside of its Laguerre cell; use another "
                         "specimen.seed, a narrower range of diameters or a smaller "
                         "specimen.solid_fraction",
                         c);
        }
    }
    return 0;
}

/* Meshes have no seeds, and their domain's polygon is inscribed in the circle as gt12's is. Their
 * number of triangles is bounded here, as only the area knows it. */
static int tessellate(struct brc_context *ctx, struct brc_specimen *s)
{
    const struct brc_specimen_params *p = &s->params;
    if (p->grains == BRC_GRAINS_MESH) {
        if (p->shape != BRC_SHAPE_CYLINDER)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.grains: mesh needs specimen.shape: cylinder");
        double count = BRC_PI / 4 * p->diameter * p->diameter / p->triangle_area;
        if (count > BRC_MAX_GRAINS)
            BRC_FAIL(
                ctx, BRC_ERR_INPUT,
                "specimen.triangle_area = %g m2 asks for %.3g triangles, at most %g are allowed",
                p->triangle_area, count, (double)BRC_MAX_GRAINS);
        return brc_tess_disc(ctx, p->diameter / 2, p->height, number_of_sides(p), p->triangle_area,
                             &s->facets);
    }
    struct brc_seeds seeds = {0};
    int code = make_seeds(ctx, s, &seeds);
    if (code == 0)
        code = brc_tess_laguerre(ctx, seeds.x, seeds.radius, seeds.n, &s->domain, p->min_area_ratio,
                                 &s->facets);
    if (code == 0 && seeds.radius)
        code = check_centres(ctx, &s->facets);
    brc_seeds_free(&seeds);
    return code;
}

/* Cells and domain as a file has them: nothing is left to be tessellated, and another shape in the
 * case would be a contradiction that nobody sees. */
static int read_tess(struct brc_context *ctx, struct brc_specimen *s)
{
    const struct brc_specimen_params *p = &s->params;
    if (p->shape != BRC_SHAPE_POLYHEDRON)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.grains: tess has its shape from the file; write specimen.shape: "
                 "polyhedron");
    BRC_TRY(brc_neper_read(ctx, p->tess, p->tess_unit, p->tess_spheres, &s->domain, &s->facets));
    brc_facets_mark_contacts(&s->facets, p->min_area_ratio);
    return p->tess_spheres ? check_centres(ctx, &s->facets) : 0;
}

/* Extents of a domain that comes from a file; the others are within their keys' ranges. The usual
 * cause is a file in millimetres. */
static int check_domain(struct brc_context *ctx, const struct brc_specimen *s)
{
    double low[3], high[3];
    brc_box_of(low, high, s->domain.vertex, s->domain.n_vertices);
    for (int k = 0; k < 3; k++) {
        double length = high[k] - low[k];
        if (!(length >= least_length && length <= largest_length))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "the specimen measures %g m along %c; allowed are %g m to %g m: lengths in "
                     "files are metres, but for specimen.tess_unit",
                     length, "xyz"[k], least_length, largest_length);
    }
    return 0;
}

/* A file of cells has its domain with it. All other grains need the domain first: seeds lie in it,
 * and its planes cut the cells. */
static int make_or_read(struct brc_context *ctx, struct brc_pool *pool, struct brc_specimen *s)
{
    double centroid[3], inertia[3][3];
    bool is_read = s->params.grains == BRC_GRAINS_TESS;
    BRC_TRY(is_read ? read_tess(ctx, s) : make_domain(ctx, &s->params, pool, &s->domain));
    BRC_TRY(check_domain(ctx, s));
    brc_convex_mass(&s->domain, &s->domain_volume, centroid, inertia);
    return is_read ? 0 : tessellate(ctx, s);
}

/* Half of a specimen is freed here, so that callers have one to free or none. */
int brc_specimen_create(struct brc_context *ctx, const struct brc_specimen_params *params,
                        struct brc_specimen *out)
{
    struct brc_pool pool = {0};
    *out = (struct brc_specimen){.params = *params};
    int code = make_or_read(ctx, &pool, out);
    brc_pool_free(&pool);
    if (code != 0)
        brc_specimen_free(out);
    return code;
}

/* Grains across by the volume of a mean grain, along the shortest side. */
void brc_specimen_warn(struct brc_context *ctx, const struct brc_specimen *s)
{
    double low[3], high[3], grain = cbrt(s->domain_volume / (double)s->facets.n_cells), across;
    bool is_flat = s->params.grains == BRC_GRAINS_MESH; /* one grain thick by design */
    brc_specimen_extent(s, low, high);
    if (is_flat)
        grain = sqrt(s->domain_volume / ((high[2] - low[2]) * (double)s->facets.n_cells));
    int least = 0;
    for (int k = 1; k < (is_flat ? 2 : 3); k++)
        if (high[k] - low[k] < high[least] - low[least])
            least = k;
    across = (high[least] - low[least]) / grain;
    if (across < few_grains * (1 - 1e-9))
        brc_log(ctx,
                "warning: the specimen is about %.1f grains across along %c, and below %g single "
                "grains decide on the result: use smaller grains or a larger specimen",
                across, "xyz"[least], few_grains);
}

void brc_specimen_free(struct brc_specimen *s)
{
    brc_facets_free(&s->facets);
    brc_convex_free(&s->domain);
    memset(s, 0, sizeof *s);
}

/* Of the cells and not of the domain: platens begin where grains end, and the two may differ in
 * their last digits. */
void brc_specimen_extent(const struct brc_specimen *s, double low[3], double high[3])
{
    brc_box_of(low, high, s->facets.vertex, s->facets.n_vertices);
}
