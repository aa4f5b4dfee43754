/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_solids.h"

#include "common/geometry/vec.h"

/* The normal of a loop is along half the sum of cross products about its first vertex, and the mean
 * of all vertices is inside a convex body. */
void solid_planes(struct brc_convex *c, struct brc_plane *plane)
{
    double middle[3] = {0, 0, 0};
    c->plane = plane;
    for (size_t v = 0; v < c->n_vertices; v++)
        brc_axpy(middle, 1 / (double)c->n_vertices, c->vertex[v]);
    for (size_t f = 0; f < c->n_faces; f++) {
        size_t n = c->first[f + 1] - c->first[f];
        int32_t *loop = c->loop + c->first[f];
        const double *corner = c->vertex[loop[0]];
        double area[3] = {0, 0, 0}, a[3], b[3], out[3];
        for (size_t k = 1; k + 1 < n; k++) {
            brc_sub(a, c->vertex[loop[k]], corner);
            brc_sub(b, c->vertex[loop[k + 1]], corner);
            brc_cross(out, a, b);
            brc_add(area, area, out);
        }
        brc_sub(out, corner, middle);
        bool is_inward = brc_dot(area, out) < 0;
        brc_scale(plane[f].n, area, (is_inward ? -1 : 1) / brc_norm(area));
        for (size_t k = 0; is_inward && k < n / 2; k++) {
            int32_t v = loop[k];
            loop[k] = loop[n - 1 - k];
            loop[n - 1 - k] = v;
        }
    }
}

double solid_reach(const struct poly_shapes *shapes, size_t body)
{
    struct poly_core c = poly_core_of(shapes, body);
    double reach = 0;
    for (int32_t v = 0; v < c.n_vertices; v++)
        reach = fmax(reach, brc_norm(c.vertex[v]));
    return reach;
}

int solid_box(struct brc_context *ctx, struct poly_shapes *shapes, const double half[3])
{
    struct brc_convex c = {0};
    double low[3];
    brc_scale(low, half, -1);
    int code = brc_convex_box(ctx, &c, low, half);
    if (code == 0)
        code = poly_shapes_add(ctx, shapes, &c);
    brc_convex_free(&c);
    return code;
}

double solid_uniform(unsigned *seed)
{
    return rand_r(seed) / (RAND_MAX + 1.0);
}

void solid_rotation(double q[4], unsigned *seed)
{
    double length = 0;
    for (int k = 0; k < 4; k++) {
        q[k] = solid_uniform(seed) + solid_uniform(seed) - 1;
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(length);
}

int solid_random(struct brc_context *ctx, struct poly_shapes *shapes, unsigned *seed, double size)
{
    enum { N = 14 };
    struct brc_plane plane[N];
    struct brc_convex c = {0};
    const double centre[3] = {0, 0, 0};
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++)
            plane[i].n[k] = solid_uniform(seed) - 0.5;
        if (i < 6)
            brc_set(plane[i].n, (i / 2 == 0) * (i % 2 - 0.5), (i / 2 == 1) * (i % 2 - 0.5),
                    (i / 2 == 2) * (i % 2 - 0.5));
        brc_normalise(plane[i].n, plane[i].n);
        plane[i].d = size * (0.7 + 0.3 * solid_uniform(seed));
        plane[i].id = i;
    }
    int code = brc_convex_from_planes(ctx, &c, plane, N, centre, 3 * size);
    if (code == 0)
        code = poly_shapes_add(ctx, shapes, &c);
    brc_convex_free(&c);
    return code;
}

void solid_place(struct solid_pose *pose, const struct poly_shapes *shapes, size_t body)
{
    struct poly_core c = poly_core_of(shapes, body);
    free(pose->v);
    pose->v = malloc((size_t)c.n_vertices * sizeof *pose->v);
    brc_quat_matrix(pose->m, pose->q);
    for (int32_t v = 0; v < c.n_vertices; v++)
        for (int k = 0; k < 3; k++)
            pose->v[v][k] = pose->x[k] + brc_dot(pose->m[k], c.vertex[v]);
}

struct poly_pair solid_pair(const struct poly_shapes *shapes, size_t a, const struct solid_pose *pa,
                            size_t b, const struct solid_pose *pb, double radius)
{
    return (struct poly_pair){.a = poly_core_of(shapes, a),
                              .b = poly_core_of(shapes, b),
                              .xa = pa->x,
                              .xb = pb->x,
                              .ra = (const double(*)[3])pa->m,
                              .rb = (const double(*)[3])pb->m,
                              .va = (const double(*)[3])pa->v,
                              .vb = (const double(*)[3])pb->v,
                              .contact_distance = 2 * radius,
                              .fade = radius,
                              .reach = fmin(solid_reach(shapes, a), solid_reach(shapes, b))};
}
