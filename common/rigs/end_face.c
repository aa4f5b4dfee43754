/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Area, middle and second moments of a specimen's flat end, from its facets, so that a beam may
 * have any section: a box, a prism that stands for a cylinder, imported cells. Called by tests that
 * load an end; it knows the specimen alone. */
#include "common/rigs/end_face.h"

#include "common/geometry/vec.h"
#include "common/specimen/specimen.h"

#include <math.h>

/* In the plane of the end: distance in lengths of the specimen, and deviation of the normal. What
 * the digits of a tessellation read from a file allow (as in platens.c). */
static const double ON_END = 1e-6;

struct brc_end brc_end_of(const struct brc_specimen *s, int axis, bool is_high)
{
    double low[3], high[3];
    brc_specimen_extent(s, low, high);
    return (struct brc_end){.axis = axis,
                            .sense = is_high ? 1 : -1,
                            .plane = is_high ? high[axis] : low[axis],
                            .allowed = ON_END * (high[axis] - low[axis])};
}

bool brc_end_has(const struct brc_specimen *s, struct brc_end end, size_t facet)
{
    const struct brc_facets *f = &s->facets;
    return f->cell[facet][1] < 0 && end.sense * f->normal[facet][end.axis] > 1 - ON_END &&
           fabs(f->centroid[facet][end.axis] - end.plane) < end.allowed;
}

/* Second moments of the end about its middle: along, across, mixed. */
struct moments {
    double along, across, mixed;
};

/* Over a triangle the integral of a product of two linear functions is the area over 12 times the
 * sum of the products at the corners and the product of the sums. */
static void add_triangle(struct moments *m, double area, double x[3][2])
{
    double sum[2] = {x[0][0] + x[1][0] + x[2][0], x[0][1] + x[1][1] + x[2][1]};
    m->along += area / 12 * sum[0] * sum[0];
    m->across += area / 12 * sum[1] * sum[1];
    m->mixed += area / 12 * sum[0] * sum[1];
    for (int i = 0; i < 3; i++) {
        m->along += area / 12 * x[i][0] * x[i][0];
        m->across += area / 12 * x[i][1] * x[i][1];
        m->mixed += area / 12 * x[i][0] * x[i][1];
    }
}

static void add_facet(const struct brc_facets *f, size_t facet, int along, int across,
                      struct brc_end_face *out, struct moments *m)
{
    size_t first = f->first[facet], n = f->first[facet + 1] - first;
    double corner[3][2];
    for (size_t k = 0; k < n; k++) {
        const double *at[3] = {f->vertex[f->loop[first]], f->vertex[f->loop[first + k]],
                               f->vertex[f->loop[first + (k + 1) % n]]};
        double a[3], b[3], c[3];
        for (int i = 0; i < 3; i++) {
            corner[i][0] = at[i][along] - out->middle[along];
            corner[i][1] = at[i][across] - out->middle[across];
            out->farthest = fmax(out->farthest, fabs(corner[i][0]));
        }
        brc_sub(a, at[1], at[0]);
        brc_sub(b, at[2], at[0]);
        brc_cross(c, a, b);
        add_triangle(m, 0.5 * brc_norm(c), corner); /* facets are convex */
    }
}

/* A section whose principal axes are not along the direction bends sideways, too: what its
 * deflection along the direction counts with is the inverse of the inverse tensor's component. */
void brc_end_face_measure(const struct brc_specimen *s, struct brc_end end, int along,
                          struct brc_end_face *out)
{
    const struct brc_facets *f = &s->facets;
    struct moments m = {0};
    int across = 3 - end.axis - along;
    *out = (struct brc_end_face){0};
    for (size_t i = 0; i < f->n_facets; i++)
        if (brc_end_has(s, end, i)) {
            out->area += f->area[i];
            brc_axpy(out->middle, f->area[i], f->centroid[i]);
        }
    if (out->area == 0)
        return;
    brc_scale(out->middle, out->middle, 1 / out->area);
    for (size_t i = 0; i < f->n_facets; i++)
        if (brc_end_has(s, end, i))
            add_facet(f, i, along, across, out, &m);
    out->second = m.along - m.mixed * m.mixed / m.across;
}
