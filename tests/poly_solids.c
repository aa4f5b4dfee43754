/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_solids.h"

#include "common/geometry/convex.h"
#include "common/geometry/vec.h"

static int add_convex(struct brc_context *ctx, struct poly_shapes *shapes,
                      const struct brc_convex *c)
{
    struct poly_solid solid = {.n_vertices = c->n_vertices,
                               .vertex = (const double(*)[3])c->vertex,
                               .n_faces = c->n_faces,
                               .first = c->first,
                               .loop = c->loop};
    return poly_shapes_add(ctx, shapes, &solid);
}

int solid_box(struct brc_context *ctx, struct poly_shapes *shapes, const double half[3])
{
    struct brc_convex c = {0};
    double low[3];
    brc_scale(low, half, -1);
    int code = brc_convex_box(ctx, &c, low, half);
    if (code == 0)
        code = add_convex(ctx, shapes, &c);
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
        code = add_convex(ctx, shapes, &c);
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
                              .reach =
                                  fmin(poly_shapes_reach(shapes, a), poly_shapes_reach(shapes, b))};
}
