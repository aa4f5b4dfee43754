/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of Neper's tessellations. Edges, signs and equations of the file are passed over: they
 * follow from the loops of the faces. */
#include "complex.h"
#include "hilbert.h"
#include "input_file.h"
#include "neper.h"
#include "vec.h"

#include <stdlib.h>
#include <string.h>

enum { TOKEN_SIZE = 128, MAX_DOMAIN_FACES = 100000 };
/* of the specimen's extent */
static const double flat_tolerance = 1e-6;
static const double weld_length = 1e-10;

struct face {
    int32_t cell[2]; /* -1: none */
    int32_t domain;  /* face of the domain, -1: inside */
    size_t first;    /* in loop */
    int32_t n;
};

struct tess {
    struct brc_context *ctx;
    const char *path;
    char *text;
    size_t size;
    const char *at;
    int line;
    char token[TOKEN_SIZE];
    size_t n_cells, n_vertices, n_faces, n_domain, n_loop;
    double (*seed)[4]; /* with weight; NULL: the file has none */
    double (*vertex)[3];
    struct face *face;
    int32_t *loop;
    double (*centre)[3];      /* of the cells, in the order of the file */
    size_t *order;            /* cell of the file that comes i-th */
    double extent, origin[3]; /* places are relative to origin, 0 where the body is near it */
    int digits;               /* most significant digits of a vertex's coordinate */
    double precision;         /* of the vertices: the last digit of the largest */
};

static int fail(const struct tess *t, const char *what)
{
    BRC_FAIL(t->ctx, BRC_ERR_INPUT, "%s:%d: %s; found '%.40s'", t->path, t->line, what, t->token);
}

/* ---- words and numbers --------------------------------------------------------------------- */

static bool next(struct tess *t)
{
    static const char blanks[] = " \t\r\n";
    for (; *t->at && strchr(blanks, *t->at); t->at++)
        t->line += *t->at == '\n';
    size_t n = strcspn(t->at, blanks), kept = n < TOKEN_SIZE ? n : TOKEN_SIZE - 1;
    memcpy(t->token, t->at, kept);
    t->token[kept] = '\0';
    t->at += n;
    return n > 0;
}

static int skip(struct tess *t, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!next(t))
            return fail(t, "the file ends too soon");
    return 0;
}

static int whole(struct tess *t, long low, long high, long *value)
{
    char *end = t->token;
    if (next(t))
        *value = strtol(t->token, &end, 10);
    if (end == t->token || *end != '\0' || *value < low || *value > high)
        return fail(t, "expected a whole number that fits here");
    return 0;
}

/* A number of things, each of which takes two bytes of the file at least. */
static int count(struct tess *t, size_t *n)
{
    long value, most = (long)(t->size / 2 < INT32_MAX / 64 ? t->size / 2 : INT32_MAX / 64);
    BRC_TRY(whole(t, 1, most, &value));
    *n = (size_t)value;
    return 0;
}

static int real(struct tess *t, double *value)
{
    char *end = t->token;
    if (next(t))
        *value = strtod(t->token, &end);
    if (end == t->token || *end != '\0' || !isfinite(*value))
        return fail(t, "expected a finite number");
    return 0;
}

/* Significant digits of the number that was read last, trailing zeros included; 0 for zero. */
static int significant_digits(const char *token)
{
    int n = 0;
    for (; *token && *token != 'e' && *token != 'E'; token++)
        n += *token >= '0' && *token <= '9' && (n > 0 || *token != '0');
    return n;
}

/* The number of an entry: they count from 1. */
static int number(struct tess *t, size_t i)
{
    long value;
    return whole(t, (long)i + 1, (long)i + 1, &value);
}

/* Goes behind a heading: from the start of the file, or on from here up to a heading of the same
 * or a higher level. */
static int find(struct tess *t, const char *heading, bool is_from_start)
{
    if (is_from_start) {
        t->at = t->text;
        t->line = 1;
    }
    while (next(t))
        if (strcmp(t->token, heading) == 0)
            return 0;
    snprintf(t->token, TOKEN_SIZE, "%s", heading);
    return fail(t, "a part of the file is missing");
}

/* ---- parts of the file --------------------------------------------------------------------- */

static int read_cells(struct tess *t)
{
    long dimension;
    BRC_TRY(find(t, "**general", true));
    BRC_TRY(whole(t, 3, 3, &dimension));
    BRC_TRY(find(t, "**cell", true));
    BRC_TRY(count(t, &t->n_cells));
    while (next(t) && strncmp(t->token, "**", 2) != 0)
        if (strcmp(t->token, "*seed") == 0)
            break;
    if (strcmp(t->token, "*seed") != 0)
        return 0;
    t->seed = brc_alloc(t->ctx, t->n_cells, sizeof *t->seed);
    if (!t->seed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->n_cells; i++) {
        BRC_TRY(number(t, i));
        for (int k = 0; k < 4; k++)
            BRC_TRY(real(t, &t->seed[i][k]));
    }
    return 0;
}

static int read_vertices(struct tess *t)
{
    BRC_TRY(find(t, "**vertex", true));
    BRC_TRY(count(t, &t->n_vertices));
    t->vertex = brc_alloc(t->ctx, t->n_vertices, sizeof *t->vertex);
    if (!t->vertex)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->n_vertices; i++) {
        BRC_TRY(number(t, i));
        for (int k = 0; k < 3; k++) {
            BRC_TRY(real(t, &t->vertex[i][k]));
            int digits = significant_digits(t->token);
            t->digits = digits > t->digits ? digits : t->digits;
        }
        BRC_TRY(skip(t, 1));
    }
    return 0;
}

static int read_face(struct tess *t, size_t i)
{
    size_t n, n_edges;
    BRC_TRY(number(t, i));
    BRC_TRY(count(t, &n));
    if (n < 3 || t->n_loop + n > t->size / 2)
        return fail(t, "a face has three vertices at least");
    t->face[i] = (struct face){{-1, -1}, -1, t->n_loop, (int32_t)n};
    for (size_t k = 0; k < n; k++) {
        long v;
        BRC_TRY(whole(t, 1, (long)t->n_vertices, &v));
        t->loop[t->n_loop++] = (int32_t)v - 1;
    }
    BRC_TRY(count(t, &n_edges));
    return skip(t, n_edges + 4 + 5); /* edges, equation, state and point */
}

static int read_faces(struct tess *t)
{
    BRC_TRY(find(t, "**face", true));
    BRC_TRY(count(t, &t->n_faces));
    t->face = brc_alloc(t->ctx, t->n_faces, sizeof *t->face);
    t->loop = brc_alloc(t->ctx, t->size / 2 + 1, sizeof *t->loop);
    if (!t->face || !t->loop)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->n_faces; i++)
        BRC_TRY(read_face(t, i));
    return 0;
}

static int read_polyhedra(struct tess *t)
{
    size_t n, n_faces;
    BRC_TRY(find(t, "**polyhedron", true));
    BRC_TRY(count(t, &n));
    if (n != t->n_cells)
        return fail(t, "there must be a polyhedron for each cell");
    for (size_t i = 0; i < n; i++) {
        BRC_TRY(number(t, i));
        BRC_TRY(count(t, &n_faces));
        for (size_t k = 0; k < n_faces; k++) {
            long f;
            BRC_TRY(whole(t, -(long)t->n_faces, (long)t->n_faces, &f));
            struct face *face = f == 0 ? NULL : &t->face[labs(f) - 1];
            if (!face || face->cell[1] >= 0 || face->cell[0] == (int32_t)i)
                return fail(t, "a face belongs to one polyhedron, or to two");
            face->cell[face->cell[0] >= 0] = (int32_t)i;
        }
    }
    return 0;
}

/* Which faces lie on which face of the domain. */
static int read_domain(struct tess *t)
{
    size_t n;
    BRC_TRY(find(t, "**domain", true));
    BRC_TRY(find(t, "*face", false));
    BRC_TRY(count(t, &t->n_domain));
    if (t->n_domain > MAX_DOMAIN_FACES)
        return fail(t, "too many faces of the domain");
    for (size_t i = 0; i < t->n_domain; i++) {
        BRC_TRY(number(t, i));
        for (int k = 0; k < 2; k++) { /* its vertices and edges */
            BRC_TRY(count(t, &n));
            BRC_TRY(skip(t, n));
        }
        BRC_TRY(skip(t, 1)); /* type */
        BRC_TRY(count(t, &n));
        BRC_TRY(skip(t, n + 1)); /* parameters and label */
        BRC_TRY(count(t, &n));
        for (size_t k = 0; k < n; k++) {
            long f;
            BRC_TRY(whole(t, 1, (long)t->n_faces, &f));
            t->face[f - 1].domain = (int32_t)i;
        }
    }
    return 0;
}

static int check_faces(const struct tess *t)
{
    for (size_t i = 0; i < t->n_faces; i++) {
        const struct face *f = &t->face[i];
        if (f->cell[0] < 0 || (f->cell[1] < 0) != (f->domain >= 0))
            BRC_FAIL(t->ctx, BRC_ERR_INPUT,
                     "%s: face %zu is neither between two polyhedra nor on a face of the domain",
                     t->path, i + 1);
    }
    return 0;
}

/* ---- geometry ------------------------------------------------------------------------------ */

/* Moves all places to where no digits are lost; middle is that of the body's box. */
static void come_near(struct tess *t, const double middle[3])
{
    brc_convex_origin(middle, t->extent / 2, t->origin);
    for (size_t i = 0; i < t->n_vertices; i++)
        brc_sub(t->vertex[i], t->vertex[i], t->origin);
    for (size_t i = 0; t->seed && i < t->n_cells; i++)
        brc_sub(t->seed[i], t->seed[i], t->origin);
}

static void scale(struct tess *t, double metres)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double largest = 0;
    for (size_t i = 0; t->seed && i < t->n_cells; i++)
        for (int k = 0; k < 4; k++)
            t->seed[i][k] *= metres;
    for (size_t i = 0; i < t->n_vertices; i++) {
        brc_scale(t->vertex[i], t->vertex[i], metres);
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], t->vertex[i][k]);
            high[k] = fmax(high[k], t->vertex[i][k]);
        }
    }
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(low[k]), fabs(high[k])) / metres);
    brc_sub(high, high, low);
    t->extent = brc_norm(high);
    brc_axpy(low, 0.5, high);
    come_near(t, low);
    if (largest > 0)
        t->precision = metres * pow(10, floor(log10(largest)) + 1 - t->digits);
}

/* Area times normal of a face, by its loop, and the mean of its vertices. */
static void measure_face(const struct tess *t, const struct face *f, double area[3],
                         double middle[3])
{
    const int32_t *loop = t->loop + f->first;
    brc_set(area, 0, 0, 0);
    brc_set(middle, 0, 0, 0);
    for (int32_t i = 0; i < f->n; i++)
        brc_axpy(middle, 1.0 / f->n, t->vertex[loop[i]]);
    for (int32_t i = 0; i < f->n; i++) {
        double a[3], b[3], cross[3];
        brc_sub(a, t->vertex[loop[i]], middle);
        brc_sub(b, t->vertex[loop[i + 1 < f->n ? i + 1 : 0]], middle);
        brc_cross(cross, a, b);
        brc_axpy(area, 0.5, cross);
    }
}

/* Means of the faces' middles, which lie inside of convex cells, and the cells' order in space. */
static int place_cells(struct tess *t)
{
    int32_t *n = brc_alloc(t->ctx, t->n_cells, sizeof *n);
    t->centre = brc_alloc(t->ctx, t->n_cells, sizeof *t->centre);
    t->order = brc_alloc(t->ctx, t->n_cells, sizeof *t->order);
    int code = n && t->centre && t->order ? 0 : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < t->n_faces; i++) {
        double area[3], middle[3];
        measure_face(t, &t->face[i], area, middle);
        for (int k = 0; k < 2 && t->face[i].cell[k] >= 0; k++) {
            brc_axpy(t->centre[t->face[i].cell[k]], 1, middle);
            n[t->face[i].cell[k]]++;
        }
    }
    for (size_t i = 0; code == 0 && i < t->n_cells; i++)
        brc_scale(t->centre[i], t->centre[i], 1.0 / n[i]);
    if (code == 0)
        code = brc_hilbert_order(t->ctx, t->centre, t->n_cells, t->order);
    free(n);
    return code;
}

/* The planes of the domain by the outward areas of the faces that lie on them. */
static int make_domain(struct tess *t, struct brc_convex *domain)
{
    struct brc_plane *plane = brc_alloc(t->ctx, t->n_domain, sizeof *plane);
    double(*sum)[3] = brc_alloc(t->ctx, t->n_domain, sizeof *sum);
    double inside[3] = {0, 0, 0};
    int code = plane && sum ? 0 : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < t->n_faces; i++) {
        const struct face *f = &t->face[i];
        double area[3], middle[3], out[3];
        if (f->domain < 0)
            continue;
        measure_face(t, f, area, middle);
        brc_sub(out, middle, t->centre[f->cell[0]]);
        brc_axpy(plane[f->domain].n, brc_dot(area, out) < 0 ? -1 : 1, area);
        brc_axpy(sum[f->domain], brc_norm(area), middle);
    }
    for (size_t i = 0; code == 0 && i < t->n_domain; i++) {
        double area = brc_normalise(plane[i].n, plane[i].n);
        plane[i].d = area > 0 ? brc_dot(plane[i].n, sum[i]) / area : 0;
        plane[i].id = (int32_t)i;
        if (area == 0)
            code =
                brc_error_set(t->ctx, BRC_ERR_INPUT, __FILE__, __LINE__,
                              "%s: face %zu of the domain has no faces of cells", t->path, i + 1);
    }
    for (size_t i = 0; code == 0 && i < t->n_vertices; i++)
        brc_axpy(inside, 1.0 / (double)t->n_vertices, t->vertex[i]);
    if (code == 0)
        code = brc_convex_from_planes(t->ctx, domain, plane, t->n_domain, inside, 2 * t->extent);
    free(plane);
    free(sum);
    return code;
}

static int check_flat(const struct tess *t, size_t i, const double n[3], const double middle[3])
{
    const struct face *f = &t->face[i];
    for (int32_t k = 0; k < f->n; k++) {
        double r[3];
        brc_sub(r, t->vertex[t->loop[f->first + (size_t)k]], middle);
        if (!(fabs(brc_dot(n, r)) <= flat_tolerance * t->extent))
            BRC_FAIL(t->ctx, BRC_ERR_INPUT,
                     "%s: face %zu is not flat; make the tessellation without regularization",
                     t->path, i + 1);
    }
    return 0;
}

/* A face as a facet: out of its lower cell, the loop turned to fit. */
static int add_facet(struct tess *t, struct brc_complex *c, size_t i, const int32_t *number_of)
{
    const struct face *f = &t->face[i];
    int32_t *loop = t->loop + f->first;
    double n[3], middle[3], out[3];
    measure_face(t, f, n, middle);
    brc_normalise(n, n);
    BRC_TRY(check_flat(t, i, n, middle));
    int32_t low = f->cell[0], high = f->cell[1];
    if (high >= 0 && number_of[high] < number_of[low]) {
        low = f->cell[1];
        high = f->cell[0];
    }
    brc_sub(out, middle, t->centre[low]);
    if (brc_dot(n, out) < 0) {
        brc_scale(n, n, -1);
        for (int32_t k = 0; k < f->n / 2; k++) {
            int32_t v = loop[k];
            loop[k] = loop[f->n - 1 - k];
            loop[f->n - 1 - k] = v;
        }
    }
    struct brc_complex_facet facet = {{number_of[low], high < 0 ? -1 : number_of[high]},
                                      high < 0 ? f->domain : BRC_FACE_INNER,
                                      f->n,
                                      0,
                                      {n[0], n[1], n[2]}};
    return brc_complex_add_facet(t->ctx, c, &facet, loop);
}

static int fill_complex(struct tess *t, struct brc_complex *c, const struct brc_convex *domain)
{
    int32_t *number_of = brc_alloc(t->ctx, t->n_cells, sizeof *number_of);
    int code = number_of ? 0 : BRC_ERR_MEMORY;
    for (size_t i = 0; code == 0 && i < t->n_cells; i++)
        number_of[t->order[i]] = (int32_t)i;
    for (size_t v = 0; code == 0 && v < t->n_vertices; v++)
        code = brc_complex_add_vertex(t->ctx, c, t->vertex[v]);
    for (size_t i = 0; code == 0 && i < t->n_faces; i++)
        code = add_facet(t, c, i, number_of);
    free(number_of);
    if (code == 0)
        code = brc_complex_weld(t->ctx, c, weld_length * t->extent);
    return code == 0 ? brc_complex_settle(t->ctx, c, domain) : code;
}

/* The seed, or the centre of the cell where it lies outside of the faces. */
static void keep_seeds_inside(const struct tess *t, struct brc_facets *out)
{
    for (size_t f = 0; f < out->n_facets; f++)
        for (int side = 0; side < 2 && out->cell[f][side] >= 0; side++) {
            int32_t c = out->cell[f][side];
            double d[3];
            brc_sub(d, out->centroid[f], out->seed[c]);
            if ((side == 0 ? 1 : -1) * brc_dot(d, out->normal[f]) <= 0)
                brc_copy(out->seed[c], t->centre[t->order[c]]);
        }
}

static int make_facets(struct tess *t, struct brc_complex *c, bool has_spheres, double volume,
                       struct brc_facets *out)
{
    out->precision = t->precision;
    out->seed = brc_alloc(t->ctx, t->n_cells, sizeof *out->seed);
    out->radius = brc_alloc(t->ctx, t->n_cells, sizeof *out->radius);
    if (!out->seed || !out->radius)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < t->n_cells; i++) {
        size_t own = t->order[i];
        brc_copy(out->seed[i], t->seed ? t->seed[own] : t->centre[own]);
        out->radius[i] = t->seed && has_spheres ? t->seed[own][3] : 0;
    }
    BRC_TRY(brc_complex_finish(t->ctx, c, out));
    if (!has_spheres)
        keep_seeds_inside(t, out);
    return brc_facets_verify(t->ctx, out, volume, t->origin);
}

static int make_all(struct tess *t, double metres, bool has_spheres, struct brc_convex *domain,
                    struct brc_facets *out)
{
    struct brc_complex c;
    double volume, centroid[3], inertia[3][3];
    BRC_TRY(read_cells(t));
    BRC_TRY(read_vertices(t));
    BRC_TRY(read_faces(t));
    BRC_TRY(read_polyhedra(t));
    BRC_TRY(read_domain(t));
    BRC_TRY(check_faces(t));
    scale(t, metres);
    BRC_TRY(place_cells(t));
    BRC_TRY(make_domain(t, domain));
    brc_convex_mass(domain, &volume, centroid, inertia);
    brc_complex_init(&c, t->n_cells);
    int code = fill_complex(t, &c, domain);
    if (code == 0)
        code = make_facets(t, &c, has_spheres, volume, out);
    brc_complex_free(&c);
    if (code == 0 && brc_norm(t->origin) > 0) {
        brc_convex_shift(domain, t->origin);
        brc_facets_shift(out, t->origin);
    }
    return code;
}

static int read_text(struct tess *t)
{
    const struct brc_input in = {
        .key = "specimen.tess", .path = t->path, .largest = BRC_INPUT_LARGEST};
    return brc_input_read(t->ctx, &in, &t->text, &t->size);
}

int brc_neper_read(struct brc_context *ctx, const char *path, double metres, bool has_spheres,
                   struct brc_convex *domain, struct brc_facets *out)
{
    struct tess t = {.ctx = ctx, .path = path};
    int code = read_text(&t);
    if (code == 0)
        code = make_all(&t, metres, has_spheres, domain, out);
    free(t.text);
    free(t.seed);
    free(t.vertex);
    free(t.face);
    free(t.loop);
    free(t.centre);
    free(t.order);
    return code;
}
