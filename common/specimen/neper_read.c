/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From what a tessellation file holds to cells and their domain. Neper's own planes, centres and
 * volumes are not taken over: they have the digits of the file each for itself, and cells must
 * agree about a facet. So everything follows from the vertices, through the same complex as a
 * tessellation of breccia's. Called by specimen.c. */
#include "common/specimen/cell_complex.h"
#include "common/geometry/hilbert.h"
#include "common/base/input_file.h"
#include "common/specimen/neper.h"
#include "common/specimen/neper_file.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

/* Parts of the specimen's extent. A face is flat where its vertices are within this distance of its
 * plane, far above rounding and far below what regularization bends. */
static const double flat_tolerance = 1e-6;
static const double merge_length = 1e-10;
/* planes of the domain that differ by less are one: as files of planes, or by the file's digits */
static const double plane_digits = 4e-9, digits_margin = 8;

struct tess {
    struct brc_neper_file file;
    double (*centre)[3];      /* of the cells */
    double extent, origin[3]; /* places are relative to origin, 0 where the body is near it */
    double precision;         /* of the vertices: the last digit of the largest */
};

/* Moves all places to where no digits are lost; middle is that of the body's box. */
static void come_near(struct tess *t, const double middle[3])
{
    brc_convex_origin(middle, t->extent / 2, t->origin);
    for (size_t i = 0; i < t->file.n_vertices; i++)
        brc_sub(t->file.vertex[i], t->file.vertex[i], t->origin);
    for (size_t i = 0; i < t->file.n_cells; i++)
        brc_sub(t->file.seed[i], t->file.seed[i], t->origin);
}

/* To metres. The last digit of the largest coordinate is what any vertex may be off by; whoever
 * judges whether faces are flat and cells are closed allows for that. */
static void scale(struct tess *t, double metres)
{
    double low[3], high[3], largest = 0;
    for (size_t i = 0; i < t->file.n_cells; i++)
        for (int k = 0; k < 4; k++)
            t->file.seed[i][k] *= metres;
    for (size_t i = 0; i < t->file.n_vertices; i++)
        brc_scale(t->file.vertex[i], t->file.vertex[i], metres);
    brc_box_of(low, high, t->file.vertex, t->file.n_vertices);
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(low[k]), fabs(high[k])) / metres);
    brc_sub(high, high, low);
    t->extent = brc_norm(high);
    brc_axpy(low, 0.5, high);
    come_near(t, low);
    if (largest > 0)
        t->precision = metres * pow(10, floor(log10(largest)) + 1 - t->file.digits);
}

/* Area times normal of a face, by its loop, and the mean of its vertices. */
static void measure_face(const struct tess *t, const struct brc_neper_face *f, double area[3],
                         double middle[3])
{
    const int32_t *loop = t->file.loop + f->first;
    brc_set(area, 0, 0, 0);
    brc_set(middle, 0, 0, 0);
    for (int32_t i = 0; i < f->n; i++)
        brc_axpy(middle, 1.0 / f->n, t->file.vertex[loop[i]]);
    for (int32_t i = 0; i < f->n; i++) {
        double a[3], b[3], cross[3];
        brc_sub(a, t->file.vertex[loop[i]], middle);
        brc_sub(b, t->file.vertex[loop[i + 1 < f->n ? i + 1 : 0]], middle);
        brc_cross(cross, a, b);
        brc_axpy(area, 0.5, cross);
    }
}

/* Means of the faces' middles, which lie inside of convex cells: they tell inside from outside;
 * true centroids are measured when the cells are known to be closed. Cells without faces are left
 * out: such a cell has been hidden by others. It is told and not refused, as the others fill the
 * domain. n_faces and kept are work of a length a cell; kept lists those that stay, whose number it
 * returns.
 */
static size_t place_cells(struct tess *t, int32_t *n_faces, size_t *kept)
{
    size_t n = 0, first = 0; /* empty one, from 1 */
    for (size_t i = 0; i < t->file.n_faces; i++) {
        double area[3], middle[3];
        const int32_t *cell = t->file.face[i].cell;
        measure_face(t, &t->file.face[i], area, middle);
        for (int k = 0; k < 2 && cell[k] >= 0; k++) {
            brc_axpy(t->centre[cell[k]], 1, middle);
            n_faces[cell[k]]++;
        }
    }
    for (size_t i = 0; i < t->file.n_cells; i++) {
        if (n_faces[i] == 0) {
            first = n == i ? i + 1 : first;
            continue;
        }
        brc_scale(t->centre[n], t->centre[i], 1.0 / n_faces[i]);
        kept[n++] = i;
    }
    if (first > 0)
        brc_log(t->file.ctx, "%s: %zu of the cells have no faces and are left out, first cell %zu",
                t->file.path, t->file.n_cells - n, first);
    return n;
}

/* Numbers the cells along a space-filling curve, as those of any specimen are, at once and for all
 * that follows: seeds, centres and the cells of faces, whose low one comes first from here on. */
static int number_cells(struct tess *t)
{
    struct brc_neper_file *f = &t->file;
    size_t n = f->n_cells, *kept = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *kept),
           *order = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *order);
    int32_t *number_of = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *number_of);
    double(*centre)[3] = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *centre);
    double(*seed)[4] = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *seed);
    t->centre = brc_pool_alloc(f->ctx, &f->pool, n, sizeof *t->centre);
    if (f->pool.is_failed)
        return BRC_ERR_MEMORY;
    f->n_cells = place_cells(t, number_of, kept);
    BRC_TRY(brc_hilbert_order(f->ctx, t->centre, f->n_cells, order));
    for (size_t i = 0; i < f->n_cells; i++) {
        number_of[kept[order[i]]] = (int32_t)i;
        brc_copy(centre[i], t->centre[order[i]]);
        memcpy(seed[i], f->seed[kept[order[i]]], sizeof *seed);
        if (!f->has_seeds)
            brc_copy(seed[i], centre[i]);
    }
    t->centre = centre;
    f->seed = seed;
    for (size_t i = 0; i < f->n_faces; i++) {
        int32_t *cell = f->face[i].cell, own = number_of[cell[0]];
        int32_t other = cell[1] < 0 ? INT32_MAX : number_of[cell[1]];
        cell[0] = own < other ? own : other;
        cell[1] = cell[1] < 0 ? -1 : own < other ? other : own;
    }
    return 0;
}

/* A face of the domain that lies in the plane of another one is that one: Neper's may have several
 * to a plane, and the convex body has dropped all but one. Which one is found by the direction, as
 * no two planes of a convex body have the same. */
static int join_domain_faces(struct tess *t, const struct brc_plane *plane,
                             const struct brc_convex *domain)
{
    int32_t *to = brc_pool_alloc(t->file.ctx, &t->file.pool, t->file.n_domain, sizeof *to);
    if (!to)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->file.n_domain; i++) {
        double best = -2;
        for (size_t k = 0; k < domain->n_faces; k++) {
            double cosine = brc_dot(domain->plane[k].n, plane[i].n);
            bool is_own = domain->plane[k].id == (int32_t)i;
            if (is_own || cosine > best)
                to[i] = domain->plane[k].id;
            best = is_own ? 2 : fmax(best, cosine);
        }
    }
    for (size_t i = 0; i < t->file.n_faces; i++)
        if (t->file.face[i].domain >= 0)
            t->file.face[i].domain = to[t->file.face[i].domain];
    return 0;
}

/* The planes of the domain by the outward areas of the faces that lie on them. Not by the equations
 * of the file, which are passed over everywhere: the planes must be those of the vertices. */
static int make_domain(struct tess *t, struct brc_convex *domain)
{
    struct brc_plane *plane =
        brc_pool_alloc(t->file.ctx, &t->file.pool, t->file.n_domain, sizeof *plane);
    double(*sum)[3] = brc_pool_alloc(t->file.ctx, &t->file.pool, t->file.n_domain, sizeof *sum);
    if (t->file.pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->file.n_faces; i++) {
        const struct brc_neper_face *f = &t->file.face[i];
        double area[3], middle[3], out[3];
        if (f->domain < 0)
            continue;
        measure_face(t, f, area, middle);
        brc_sub(out, middle, t->centre[f->cell[0]]);
        brc_axpy(plane[f->domain].n, brc_dot(area, out) < 0 ? -1 : 1, area);
        brc_axpy(sum[f->domain], brc_norm(area), middle);
    }
    for (size_t i = 0; i < t->file.n_domain; i++) {
        double area = brc_normalise(plane[i].n, plane[i].n);
        if (area == 0)
            BRC_FAIL(t->file.ctx, BRC_ERR_INPUT, "%s: face %zu of the domain has no faces of cells",
                     t->file.path, i + 1);
        plane[i].d = brc_dot(plane[i].n, sum[i]) / area;
        plane[i].id = (int32_t)i;
    }
    BRC_TRY(brc_convex_enclosed(t->file.ctx, domain, plane, t->file.n_domain,
                                fmax(plane_digits, digits_margin * t->precision / t->extent)));
    return join_domain_faces(t, plane, domain);
}

/* Largest distance of a face's vertex from a plane through a point. */
static double depth_of(const struct tess *t, const struct brc_neper_face *f, const double n[3],
                       const double at[3])
{
    double depth = 0;
    for (int32_t k = 0; k < f->n; k++) {
        double r[3];
        brc_sub(r, t->file.vertex[t->file.loop[f->first + (size_t)k]], at);
        depth = fmax(depth, fabs(brc_dot(n, r)));
    }
    return depth;
}

/* A face that is not flat: by its digits, by the shape of the domain, or by regularization. */
static int fail_flat(const struct tess *t, size_t i, double depth)
{
    struct brc_context *ctx = t->file.ctx;
    const char *path = t->file.path;
    int32_t domain = t->file.face[i].domain;
    if (depth <= digits_margin * t->precision)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: the vertices have %d digits, too few for face %zu to be flat: make the "
                 "tessellation larger, and say what the length 1 is there by specimen.tess_unit",
                 path, t->file.digits, i + 1);
    if (domain >= 0 && t->file.is_curved[domain])
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "%s: face %zu lies on a curved face of the domain (%d), and grains have flat ones: "
            "use a domain of planes, a prism for a cylinder",
            path, i + 1, domain + 1);
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "%s: face %zu is not flat; make the tessellation without regularization", path, i + 1);
}

/* Faces on the domain lie on its planes, too, onto which their vertices are moved. */
static int check_flat(const struct tess *t, size_t i, const double n[3], const double middle[3],
                      const struct brc_convex *domain)
{
    const struct brc_neper_face *f = &t->file.face[i];
    double depth = depth_of(t, f, n, middle);
    for (size_t k = 0; k < domain->n_faces && f->domain >= 0; k++) {
        const struct brc_plane *p = &domain->plane[k];
        double at[3];
        brc_scale(at, p->n, p->d);
        if (p->id == f->domain)
            depth = fmax(depth, depth_of(t, f, p->n, at));
    }
    return depth <= flat_tolerance * t->extent ? 0 : fail_flat(t, i, depth);
}

/* A face as a facet: out of its lower cell, the loop turned to fit. The file's signs are not needed
 * for that, since the cell's middle tells which side is out. */
static int add_facet(struct tess *t, struct brc_cell_complex *c, size_t i,
                     const struct brc_convex *domain)
{
    const struct brc_neper_face *f = &t->file.face[i];
    int32_t *loop = t->file.loop + f->first;
    double n[3], middle[3], out[3];
    measure_face(t, f, n, middle);
    brc_normalise(n, n);
    BRC_TRY(check_flat(t, i, n, middle, domain));
    brc_sub(out, middle, t->centre[f->cell[0]]);
    if (brc_dot(n, out) < 0) {
        brc_scale(n, n, -1);
        for (int32_t k = 0; k < f->n / 2; k++) {
            int32_t v = loop[k];
            loop[k] = loop[f->n - 1 - k];
            loop[f->n - 1 - k] = v;
        }
    }
    struct brc_cell_complex_facet facet = {{f->cell[0], f->cell[1]},
                                           f->cell[1] < 0 ? f->domain : BRC_FACE_INNER,
                                           f->n,
                                           0,
                                           {n[0], n[1], n[2]}};
    return brc_cell_complex_add_facet(t->file.ctx, c, &facet, loop);
}

/* Merging joins what the file has twice and no more: its length is that of rounding, since the
 * cells of a file are to stay as they were made. */
static int fill_complex(struct tess *t, struct brc_cell_complex *c, const struct brc_convex *domain)
{
    c->n_cells = t->file.n_cells;
    for (size_t v = 0; v < t->file.n_vertices; v++)
        BRC_TRY(brc_cell_complex_add_vertex(t->file.ctx, c, t->file.vertex[v]));
    for (size_t i = 0; i < t->file.n_faces; i++)
        BRC_TRY(add_facet(t, c, i, domain));
    BRC_TRY(brc_cell_complex_merge_vertices(t->file.ctx, c, merge_length * t->extent));
    return brc_cell_complex_snap_to_planes(t->file.ctx, c, domain);
}

/* A seed on the other side of a face gives way to the centre of its cell: cells are measured from
 * their seeds. */
static void keep_seeds_inside(struct tess *t)
{
    for (size_t i = 0; i < t->file.n_faces; i++) {
        const struct brc_neper_face *f = &t->file.face[i];
        double area[3], middle[3], to_seed[3], to_centre[3];
        measure_face(t, f, area, middle);
        for (int k = 0; k < 2 && f->cell[k] >= 0; k++) {
            double *seed = t->file.seed[f->cell[k]];
            brc_sub(to_seed, seed, middle);
            brc_sub(to_centre, t->centre[f->cell[k]], middle);
            if (brc_dot(to_seed, area) * brc_dot(to_centre, area) <= 0)
                brc_copy(seed, t->centre[f->cell[k]]);
        }
    }
}

/* Weights are radii of spheres only where the case says so, as the file does not tell. Without
 * spheres the seeds are no more than points to measure the cells from. */
static int make_facets(struct tess *t, struct brc_cell_complex *c, bool has_spheres, double volume,
                       struct brc_facets *out)
{
    if (!has_spheres)
        keep_seeds_inside(t);
    out->precision = t->precision;
    BRC_TRY(brc_facets_seeds(t->file.ctx, out, t->file.n_cells));
    for (size_t i = 0; i < t->file.n_cells; i++) {
        brc_copy(out->seed[i], t->file.seed[i]);
        out->radius[i] = has_spheres ? t->file.seed[i][3] : 0;
    }
    BRC_TRY(brc_cell_complex_finish(t->file.ctx, c, out));
    return brc_facets_verify(t->file.ctx, out, volume, t->origin);
}

/* The domain comes before the cells, since boundary vertices are moved onto its planes; it is made
 * from the same vertices, so that the two agree but for their last digits. */
static int make_all(struct tess *t, double metres, bool has_spheres, struct brc_convex *domain,
                    struct brc_cell_complex *c, struct brc_facets *out)
{
    const struct brc_input in = {
        .key = "specimen.tess", .path = t->file.path, .largest = BRC_INPUT_LARGEST};
    double volume, centroid[3], inertia[3][3];
    BRC_TRY(brc_input_read(t->file.ctx, &in, &t->file.text, &t->file.size));
    BRC_TRY(brc_neper_parse(&t->file));
    scale(t, metres);
    BRC_TRY(number_cells(t));
    BRC_TRY(make_domain(t, domain));
    brc_convex_mass(domain, &volume, centroid, inertia);
    BRC_TRY(fill_complex(t, c, domain));
    BRC_TRY(make_facets(t, c, has_spheres, volume, out));
    if (brc_norm(t->origin) > 0) {
        brc_convex_shift(domain, t->origin);
        brc_facets_shift(out, t->origin);
    }
    return 0;
}

int brc_neper_read(struct brc_context *ctx, const char *path, double metres, bool has_spheres,
                   struct brc_convex *domain, struct brc_facets *out)
{
    struct tess t = {.file = {.ctx = ctx, .path = path}};
    struct brc_cell_complex c = {0};
    int code = make_all(&t, metres, has_spheres, domain, &c, out);
    brc_cell_complex_free(&c);
    free(t.file.text);
    brc_pool_free(&t.file.pool);
    return code;
}
