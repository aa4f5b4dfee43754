/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dodecahedra.h"

#include "common/geometry/vec.h"
#include "tests/near.h"
#include "tests/rotate.h"

#include <stdio.h>

static const char DODECAHEDRA[] = "tests/data/dodecahedra-512.txt";

void dodecahedra_read(struct dodecahedra *d)
{
    FILE *file = fopen(DODECAHEDRA, "r");
    char line[512];
    size_t n_vertices = 0;
    assert_non_null(file);
    d->n = 0;
    while (fgets(line, sizeof line, file)) {
        if (line[0] == 'r')
            assert_int_equal(sscanf(line, "r %lf", &d->radius), 1);
        if (line[0] == 'v' && n_vertices < 20) {
            double *v = d->vertex[n_vertices++];
            assert_int_equal(sscanf(line, "v %lf %lf %lf", &v[0], &v[1], &v[2]), 3);
        }
        if (line[0] == 'b' && d->n < 512) {
            double *x = d->x[d->n], *q = d->q[d->n];
            assert_int_equal(sscanf(line, "b %lf %lf %lf %lf %lf %lf %lf", &x[0], &x[1], &x[2],
                                    &q[0], &q[1], &q[2], &q[3]),
                             7);
            d->n++;
        }
    }
    fclose(file);
    assert_int_equal(n_vertices, 20);
    assert_int_equal(d->n, 512);
}

/* Face normals of a dodecahedron from its vertices: the five that are farthest along each of the
 * twelve directions through the vertices of the dual icosahedron; found as sums of triples. */
size_t dodecahedra_planes(const struct dodecahedra *d, struct brc_plane *planes)
{
    size_t n = 0;
    for (int i = 0; i < 20; i++)
        for (int j = 0; j < i; j++)
            for (int k = 0; k < j; k++) {
                double u[3], v[3], m[3];
                brc_sub(u, d->vertex[j], d->vertex[i]);
                brc_sub(v, d->vertex[k], d->vertex[i]);
                brc_cross(m, u, v);
                brc_normalise(m, m);
                if (brc_dot(m, d->vertex[i]) < 0)
                    brc_scale(m, m, -1);
                double height = brc_dot(m, d->vertex[i]);
                bool is_face = true, is_new = true;
                for (int l = 0; l < 20; l++)
                    is_face &= brc_dot(m, d->vertex[l]) < height * (1 + 1e-9);
                for (size_t l = 0; l < n; l++)
                    is_new &= brc_dot(m, planes[l].n) < 0.99;
                if (is_face && is_new) {
                    brc_copy(planes[n].n, m);
                    planes[n].d = height;
                    planes[n].id = (int32_t)n;
                    n++;
                }
            }
    return n;
}

void dodecahedra_place(const struct dodecahedra *d, size_t body, const struct brc_plane *from,
                       double out, struct brc_plane *to)
{
    for (int i = 0; i < 12; i++) {
        brc_quat_rotate(to[i].n, d->q[body], from[i].n);
        to[i].d = from[i].d + out + brc_dot(to[i].n, d->x[body]);
        to[i].id = i;
    }
}
