/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cores from loops of vertices. Called once for each grain as a run starts, so that it searches
 * where an index would do: cores have some tens of edges. */
#include "polyhedra/shape.h"

#include "common/base/grow.h"
#include "common/geometry/vec.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

void poly_shapes_free(struct poly_shapes *s)
{
    free(s->first);
    free(s->vertex);
    free(s->end);
    free(s->edge);
    free(s->face);
    free(s->side);
    free(s->link);
    free(s->star_first);
    free(s->star);
    memset(s, 0, sizeof *s);
}

/* Room for one more body. Edges are counted as half of the sides, since each lies between two
 * faces; whether that is so is found when they are filled. */
static int reserve(struct brc_context *ctx, struct poly_shapes *s, const struct brc_convex *solid)
{
    size_t n = s->n, n_sides = solid->first[solid->n_faces];
    BRC_GROW(ctx, s->first, s->cap[0], n + 2);
    if (n == 0)
        s->first[0] = (struct poly_first){0};
    const struct poly_first *at = &s->first[n];
    size_t n_vertices = at->vertex + solid->n_vertices, n_edges = at->edge + n_sides / 2;
    BRC_GROW(ctx, s->vertex, s->cap[1], n_vertices);
    BRC_GROW(ctx, s->end, s->cap[2], n_edges);
    BRC_GROW(ctx, s->edge, s->cap[3], n_edges);
    BRC_GROW(ctx, s->face, s->cap[4], at->face + solid->n_faces);
    BRC_GROW(ctx, s->side, s->cap[5], at->side + n_sides);
    BRC_GROW(ctx, s->link, s->cap[6], at->side + n_sides);
    BRC_GROW(ctx, s->star_first, s->cap[7], n_vertices + n + 1);
    BRC_GROW(ctx, s->star, s->cap[8], 2 * n_edges);
    return 0;
}

/* The plane is put through the mean of the vertices. Sides follow the loop, which is
 * counter-clockwise as seen from outside, as the outward normals of the sides want it. */
static void fill_face(struct poly_shapes *s, const struct brc_convex *solid, size_t f)
{
    struct poly_face *face = s->face + s->first[s->n].face + f;
    struct poly_side *side = s->side + s->first[s->n].side + solid->first[f];
    struct poly_link *link = s->link + s->first[s->n].side + solid->first[f];
    size_t first = solid->first[f], n = solid->first[f + 1] - first;
    double mean[3], along[3];
    brc_copy(mean, solid->vertex[solid->loop[first]]);
    for (size_t k = 1; k < n; k++)
        brc_add(mean, mean, solid->vertex[solid->loop[first + k]]);
    brc_scale(mean, mean, 1 / (double)n);
    brc_copy(face->n, solid->plane[f].n);
    face->d = brc_dot(face->n, mean);
    face->first = (int32_t)first;
    face->n_sides = (int32_t)n;
    for (size_t k = 0; k < n; k++) {
        link[k] = (struct poly_link){.v = solid->loop[first + k], .edge = -1};
        brc_sub(along, solid->vertex[solid->loop[first + (k + 1) % n]], solid->vertex[link[k].v]);
        brc_cross(side[k].m, along, face->n);
        brc_normalise(side[k].m, side[k].m);
        side[k].off = brc_dot(side[k].m, solid->vertex[link[k].v]);
    }
}

static int32_t side_end(const struct poly_face *face, const struct poly_link *link, int32_t k)
{
    int32_t last = face->first + face->n_sides - 1;
    return link[k == last ? face->first : k + 1].v;
}

/* Finds the side of another face that runs the other way, from v1 to v0: the second side of e. On a
 * closed surface whose faces are all seen from outside, two that meet run along their edge in
 * opposite senses. */
static bool find_twin(struct poly_edge *e, const struct poly_face *face, size_t n_faces,
                      const struct poly_link *link, int32_t v0, int32_t v1)
{
    for (size_t f = 0; f < n_faces; f++)
        for (int32_t k = face[f].first; k < face[f].first + face[f].n_sides; k++)
            if (link[k].v == v1 && side_end(&face[f], link, k) == v0) {
                e->side[1] = k;
                e->face[1] = (int32_t)f;
                return true;
            }
    return false;
}

/* An edge gets its number when the first of its sides is met. A side without a twin is a hole in
 * the surface, a twin that has its edge already is where three faces meet: neither is the surface
 * of a body, and walks over it might not end. */
static int fill_edges(struct brc_context *ctx, struct poly_shapes *s,
                      const struct brc_convex *solid)
{
    struct poly_face *face = s->face + s->first[s->n].face;
    struct poly_link *link = s->link + s->first[s->n].side;
    int32_t(*end)[2] = s->end + s->first[s->n].edge;
    struct poly_edge *edge = s->edge + s->first[s->n].edge;
    int32_t n_sides = (int32_t)solid->first[solid->n_faces], n_edges = 0;
    for (int32_t k = 0, f = 0; k < n_sides; k++) {
        f += k == face[f].first + face[f].n_sides;
        if (link[k].edge >= 0)
            continue;
        int32_t v0 = link[k].v, v1 = side_end(&face[f], link, k);
        struct poly_edge e = {.side = {k}, .face = {f}};
        if (!find_twin(&e, face, solid->n_faces, link, v0, v1) || link[e.side[1]].edge >= 0 ||
            n_edges >= n_sides / 2)
            BRC_FAIL(
                ctx, BRC_ERR_GEOMETRY,
                "body %zu: edge %d-%d does not join exactly two faces: not a closed polyhedron",
                s->n, v0, v1);
        edge[n_edges] = e;
        end[n_edges][0] = v0;
        end[n_edges][1] = v1;
        double along[3];
        brc_sub(along, solid->vertex[v1], solid->vertex[v0]);
        if (!(brc_norm2(along) > 0))
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "body %zu: edge %d-%d has no length", s->n, v0, v1);
        link[k].edge = link[e.side[1]].edge = n_edges++;
    }
    s->first[s->n + 1].edge = s->first[s->n].edge + (size_t)n_edges;
    return 0;
}

/* Edges by vertex, since a walk leaves a vertex along one of its edges. */
static void fill_star(struct poly_shapes *s, size_t n_vertices)
{
    size_t n_edges = s->first[s->n + 1].edge - s->first[s->n].edge;
    const int32_t(*end)[2] = (const int32_t(*)[2])(s->end + s->first[s->n].edge);
    int32_t *first = s->star_first + s->first[s->n].vertex + s->n;
    int32_t *star = s->star + 2 * s->first[s->n].edge;
    int32_t n = 0;
    for (size_t v = 0; v < n_vertices; v++) {
        first[v] = n;
        for (size_t e = 0; e < n_edges; e++)
            if (end[e][0] == (int32_t)v || end[e][1] == (int32_t)v)
                star[n++] = (int32_t)e;
    }
    first[n_vertices] = n;
}

int poly_shapes_add(struct brc_context *ctx, struct poly_shapes *s, const struct brc_convex *solid)
{
    size_t n_sides = solid->first[solid->n_faces];
    BRC_TRY(reserve(ctx, s, solid));
    memcpy(s->vertex + s->first[s->n].vertex, solid->vertex,
           solid->n_vertices * sizeof *solid->vertex);
    for (size_t f = 0; f < solid->n_faces; f++)
        fill_face(s, solid, f);
    BRC_TRY(fill_edges(ctx, s, solid));
    fill_star(s, solid->n_vertices);
    s->first[s->n + 1].vertex = s->first[s->n].vertex + solid->n_vertices;
    s->first[s->n + 1].face = s->first[s->n].face + solid->n_faces;
    s->first[s->n + 1].side = s->first[s->n].side + n_sides;
    s->n++;
    return 0;
}

/* Unit quaternion of a rotation matrix, by its largest component. The largest one is 1/2 at least,
 * so that the divisions lose nothing; with a fixed choice the root of a small difference would
 * stand below them. */
static void quat_from_matrix(double q[4], double m[3][3])
{
    double trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0) {
        double s = 2 * sqrt(trace + 1);
        q[0] = s / 4;
        q[1] = (m[2][1] - m[1][2]) / s;
        q[2] = (m[0][2] - m[2][0]) / s;
        q[3] = (m[1][0] - m[0][1]) / s;
        return;
    }
    int i = m[1][1] > m[0][0] ? 1 : 0;
    if (m[2][2] > m[i][i])
        i = 2;
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double s = 2 * sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    q[0] = (m[k][j] - m[j][k]) / s;
    q[1 + i] = s / 4;
    q[1 + j] = (m[j][i] + m[i][j]) / s;
    q[1 + k] = (m[k][i] + m[i][k]) / s;
}

int poly_principal(struct brc_context *ctx, const double inertia[3][3], double moment[3],
                   double q[4])
{
    double a[9], value[3], axes[9], m[3][3], cross[3];
    gsl_matrix_view tensor = gsl_matrix_view_array(a, 3, 3),
                    out = gsl_matrix_view_array(axes, 3, 3);
    gsl_vector_view values = gsl_vector_view_array(value, 3);
    for (int i = 0; i < 9; i++)
        a[i] = inertia[i / 3][i % 3];
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
    if (work == NULL)
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "no memory for principal axes");
    int code = gsl_eigen_symmv(&tensor.matrix, &values.vector, &out.matrix, work);
    gsl_eigen_symmv_free(work);
    if (code != GSL_SUCCESS)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "principal axes: %s", gsl_strerror(code));
    /* Ascending, so that which axis comes first follows from the grain alone, not from how the
     * solver went about it. */
    gsl_eigen_symmv_sort(&values.vector, &out.matrix, GSL_EIGEN_SORT_VAL_ASC);
    brc_copy(moment, value);
    /* columns are axes: right-handed by the third Eigenvectors have no sense, so the solver's three
     * may be a reflection, which is no orientation. */
    double x[3] = {axes[0], axes[3], axes[6]}, y[3] = {axes[1], axes[4], axes[7]};
    brc_cross(cross, x, y);
    for (int i = 0; i < 3; i++)
        brc_set(m[i], x[i], y[i], cross[i]);
    quat_from_matrix(q, m);
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= length;
    return 0;
}
