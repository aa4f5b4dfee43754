/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a tessellation in Neper's format with 17 digits, so that it reads back to the same bits;
 * reading is in neper_read.c and neper_parse.c. Called by `breccia export`; knows the specimen and
 * its domain, no model. Neper numbers from 1 and gives edges a direction, which breccia does not
 * store: edges are found anew from the loops. */
#include "common/specimen/neper.h"

#include "common/geometry/edges.h"
#include "common/geometry/vec.h"

#include <stdlib.h>

struct writer {
    FILE *out;
    const struct brc_specimen *s;
    struct brc_edges edges, domain_edges;
    int32_t *domain_edge; /* [edges.n] edge of the domain on which an edge lies, -1: none */
};

/* ---- cells --------------------------------------------------------------------------------- */

static void put_point(FILE *out, const double x[3])
{
    fprintf(out, " %.17g %.17g %.17g", x[0], x[1], x[2]);
}

/* The 0 behind a vertex or an edge is the state that Neper gives it; breccia has none to tell. */
static void put_cells(const struct writer *w)
{
    const struct brc_facets *f = &w->s->facets;
    fprintf(w->out, " **cell\n  %zu\n  *seed\n", f->n_cells);
    for (size_t i = 0; i < f->n_cells; i++) {
        fprintf(w->out, "  %zu", i + 1);
        put_point(w->out, f->seed[i]);
        fprintf(w->out, " %.17g\n", f->radius[i]);
    }
    fprintf(w->out, " **vertex\n %zu\n", f->n_vertices);
    for (size_t v = 0; v < f->n_vertices; v++) {
        fprintf(w->out, "  %zu", v + 1);
        put_point(w->out, f->vertex[v]);
        fputs(" 0\n", w->out);
    }
    fprintf(w->out, " **edge\n %zu\n", w->edges.n);
    for (size_t i = 0; i < w->edges.n; i++) {
        const struct brc_side *e = &w->edges.side[w->edges.first[i]];
        fprintf(w->out, "  %zu %d %d 0\n", i + 1, e->low + 1, e->high + 1);
    }
}

/* "4 1 2 3 4" of the vertices of a polygon and of its edges, which is negative where the polygon
 * runs against it. */
static void put_loop(FILE *out, const struct brc_edges *e, const int32_t *loop, size_t n,
                     bool is_signed)
{
    fprintf(out, " %zu", n);
    for (size_t i = 0; i < n; i++)
        fprintf(out, " %d", loop[i] + 1);
    fprintf(out, "\n    %zu", n);
    for (size_t i = 0; i < n; i++) {
        int32_t u = loop[i], v = loop[i + 1 < n ? i + 1 : 0];
        int32_t number = brc_edges_number(e, u, v) + 1;
        fprintf(out, " %d", is_signed && u > v ? -number : number);
    }
    fputc('\n', out);
}

/* The five zeros are state and point of a face, which say nothing of one that is flat. Planes are
 * written for Neper's tools; breccia's own reader takes the vertices. */
static void put_faces(const struct writer *w)
{
    const struct brc_facets *f = &w->s->facets;
    fprintf(w->out, " **face\n %zu\n", f->n_facets);
    for (size_t i = 0; i < f->n_facets; i++) {
        fprintf(w->out, "  %zu", i + 1);
        put_loop(w->out, &w->edges, f->loop + f->first[i], f->first[i + 1] - f->first[i], true);
        fprintf(w->out, "    %.17g", brc_dot(f->normal[i], f->centroid[i]));
        put_point(w->out, f->normal[i]);
        fputs("\n    0 0 0 0 0\n", w->out);
    }
    fprintf(w->out, " **polyhedron\n %zu\n", f->n_cells);
    for (size_t c = 0; c < f->n_cells; c++) {
        fprintf(w->out, "  %zu %zu", c + 1, f->cell_first[c + 1] - f->cell_first[c]);
        for (size_t k = f->cell_first[c]; k < f->cell_first[c + 1]; k++) {
            int32_t facet = f->cell_facet[k];
            fprintf(w->out, " %d", f->cell[facet][0] == (int32_t)c ? facet + 1 : -facet - 1);
        }
        fputc('\n', w->out);
    }
}

/* ---- domain -------------------------------------------------------------------------------- */

/* The edge of the domain between two of its faces, -1: they have none in common. */
static int32_t edge_between(const struct brc_edges *e, int32_t a, int32_t b)
{
    for (size_t i = 0; i < e->n; i++) {
        const struct brc_side *side = &e->side[e->first[i]];
        if ((side[0].face == a && side[1].face == b) || (side[0].face == b && side[1].face == a))
            return (int32_t)i;
    }
    return -1;
}

/* An edge with facets on two faces of the domain lies on the edge between these. */
static void find_domain_edges(struct writer *w)
{
    const struct brc_facets *f = &w->s->facets;
    for (size_t i = 0; i < w->edges.n; i++) {
        int32_t face[2] = {-1, -1};
        for (size_t k = w->edges.first[i]; k < w->edges.first[i + 1]; k++) {
            int32_t facet = w->edges.side[k].face;
            if (f->cell[facet][1] >= 0 || face[1] >= 0)
                continue;
            int32_t own = (int32_t)brc_convex_face(&w->s->domain, f->face[facet]);
            if (own != face[0])
                face[face[0] >= 0] = own;
        }
        w->domain_edge[i] = face[1] < 0 ? -1 : edge_between(&w->domain_edges, face[0], face[1]);
    }
}

/* "3 1 5 8": which of n things lie on the part of the domain with this number. */
static void put_members(FILE *out, const int32_t *part_of, size_t n, int32_t part)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += part_of[i] == part;
    fprintf(out, "     %zu", count);
    for (size_t i = 0; i < n; i++)
        if (part_of[i] == part)
            fprintf(out, " %zu", i + 1);
    fputc('\n', out);
}

/* "x0" for boxes, else "f1", as Neper names the faces of its own domains. Edges and vertices have
 * those of their faces, one after the other. */
static void put_label(const struct writer *w, size_t face)
{
    int id = w->s->domain.plane[face].id;
    if (w->s->params.shape == BRC_SHAPE_BOX)
        fprintf(w->out, "%c%d", "xyz"[id / 2], id % 2);
    else
        fprintf(w->out, "f%zu", face + 1);
}

/* Each with the vertex of the cells that lies there. The nearest one is it, by a search through
 * all: a domain has few vertices, and files are written seldom. */
static void put_domain_vertices(const struct writer *w)
{
    const struct brc_convex *d = &w->s->domain;
    const struct brc_facets *f = &w->s->facets;
    fprintf(w->out, "  *vertex\n   %zu\n", d->n_vertices);
    for (size_t v = 0; v < d->n_vertices; v++) {
        size_t nearest = 0;
        for (size_t i = 1; i < f->n_vertices; i++)
            if (brc_distance(f->vertex[i], d->vertex[v]) <
                brc_distance(f->vertex[nearest], d->vertex[v]))
                nearest = i;
        fprintf(w->out, "   %zu", v + 1);
        put_point(w->out, d->vertex[v]);
        fputc(' ', w->out);
        for (size_t face = 0; face < d->n_faces; face++)
            for (size_t i = d->first[face]; i < d->first[face + 1]; i++)
                if (d->loop[i] == (int32_t)v)
                    put_label(w, face);
        fputc('\n', w->out);
        fprintf(w->out, "      1 %zu\n", nearest + 1);
    }
}

static void put_domain_edges(const struct writer *w)
{
    fprintf(w->out, "  *edge\n   %zu\n", w->domain_edges.n);
    for (size_t i = 0; i < w->domain_edges.n; i++) {
        const struct brc_side *e = &w->domain_edges.side[w->domain_edges.first[i]];
        fprintf(w->out, "   %zu 2 %d %d\n     ", i + 1, e->low + 1, e->high + 1);
        put_label(w, (size_t)e[0].face);
        put_label(w, (size_t)e[1].face);
        fputc('\n', w->out);
        put_members(w->out, w->domain_edge, w->edges.n, (int32_t)i);
    }
}

/* A face has a type and its parameters, as in format 3; 2.0 had the equation of a plane alone.
 * Which facets lie on it ends the entry. */
static void put_domain_faces(const struct writer *w)
{
    const struct brc_convex *d = &w->s->domain;
    const struct brc_facets *f = &w->s->facets;
    fprintf(w->out, "  *face\n   %zu\n", d->n_faces);
    for (size_t i = 0; i < d->n_faces; i++) {
        fprintf(w->out, "   %zu", i + 1);
        put_loop(w->out, &w->domain_edges, d->loop + d->first[i], d->first[i + 1] - d->first[i],
                 false);
        fprintf(w->out, "     plane\n     4 %.17g", d->plane[i].d);
        put_point(w->out, d->plane[i].n);
        fputs("\n     ", w->out);
        put_label(w, i);
        fputc('\n', w->out);
        put_members(w->out, f->face, f->n_facets, d->plane[i].id);
    }
}

/* In the order of the format, in which each section names entries of those before it by number. */
static void put_all(const struct writer *w)
{
    fputs("***tess\n **format\n   3.4\n **general\n   3 standard\n", w->out);
    put_cells(w);
    put_faces(w);
    fprintf(w->out, " **domain\n  *general\n   %s\n",
            w->s->params.shape == BRC_SHAPE_BOX ? "cube" : "planes");
    put_domain_vertices(w);
    put_domain_edges(w);
    put_domain_faces(w);
    fputs("***end\n", w->out);
}

/* Edges of the cells and of the domain are numbered apart, as they are two lists of the file. */
static int write_all(struct brc_context *ctx, struct writer *w)
{
    const struct brc_facets *f = &w->s->facets;
    const struct brc_convex *d = &w->s->domain;
    BRC_TRY(brc_edges_find(ctx, &w->edges, f->n_facets, f->first, f->loop));
    BRC_TRY(brc_edges_find(ctx, &w->domain_edges, d->n_faces, d->first, d->loop));
    w->domain_edge = brc_alloc(ctx, w->edges.n, sizeof *w->domain_edge);
    if (!w->domain_edge)
        return BRC_ERR_MEMORY;
    find_domain_edges(w);
    put_all(w);
    return 0;
}

int brc_neper_write(struct brc_context *ctx, FILE *out, const struct brc_specimen *s)
{
    struct writer w = {.out = out, .s = s};
    int code = write_all(ctx, &w);
    free(w.domain_edge);
    brc_edges_free(&w.edges);
    brc_edges_free(&w.domain_edges);
    return code;
}
