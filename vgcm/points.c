/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the points of a facet lie. Called once for each facet as contacts are made; knows the facet
 * alone, neither its contact nor the line of centres. */
#include "vgcm/points.h"

#include "common/geometry/vec.h"

int vgcm_points_count(enum vgcm_points_rule rule, size_t n)
{
    return rule == VGCM_POINTS_ONE ? 1 : (int)n + 1;
}

/* Squared ratio of the principal second moments of a facet that counts as a sliver. */
static const double SLIVER = 1e-10;

/* Symmetric 2 x 2 matrices as {xx, xy, yy}. */
static double determinant(const double m[3])
{
    return m[0] * m[2] - m[1] * m[1];
}

/* The symmetric b with b from b = to: the geometric mean of from's inverse and to. A sliver, too
 * thin for its determinant to be known, keeps its shape and takes the polar moment. Of the many
 * maps that turn one second moment into the other it is the one that is symmetric: it stretches and
 * does not turn, so that a facet that is right already stays as it is. */
static void map_between(double b[3], const double from[3], const double to[3])
{
    double trace = from[0] + from[2], scale_all = sqrt((to[0] + to[2]) / trace);
    if (determinant(from) <= SLIVER * trace * trace || determinant(to) <= 0) {
        brc_set(b, scale_all, 0, scale_all);
        return;
    }
    double root_from = sqrt(determinant(from)), root_to = sqrt(determinant(to));
    double sum[3] = {from[2] / root_from + to[0] / root_to, -from[1] / root_from + to[1] / root_to,
                     from[0] / root_from + to[2] / root_to};
    double scale = sqrt(root_to / root_from / determinant(sum));
    brc_scale(b, sum, scale);
}

/* Second moment of a weight at r. */
static void add_square(double m[3], double weight, const double r[2])
{
    m[0] += weight * r[0] * r[0];
    m[1] += weight * r[0] * r[1];
    m[2] += weight * r[1] * r[1];
}

/* The areas of the paper's points give a facet's area and centroid, but put too much of it at the
 * corners: bending is 2.67 times as stiff as it should be in a triangle. A change of the areas
 * alone cannot mend that for every polygon without negative ones; a change of the places can. Draws
 * the points in about the centroid by the linear map that turns their second moments into those of
 * the facet: weights, area and centroid stay. */
static void draw_in(const double centroid[3], const double normal[3], size_t n, double (*x)[3],
                    const double *area)
{
    double s[3], t[3], d[3], have[3] = {0, 0, 0}, want[3] = {0, 0, 0}, b[3];
    brc_frame(s, t, normal);
    for (size_t i = 0; i < n; i++) {
        double e[3], r[2], q[2];
        brc_sub(d, x[i], centroid);
        brc_sub(e, x[(i + 1) % n], centroid);
        r[0] = brc_dot(d, s), r[1] = brc_dot(d, t);
        q[0] = brc_dot(e, s), q[1] = brc_dot(e, t);
        add_square(have, area[i], r);
        double triangle = (r[0] * q[1] - r[1] * q[0]) / 2, sum[2] = {r[0] + q[0], r[1] + q[1]};
        add_square(want, triangle / 12, r);
        add_square(want, triangle / 12, q);
        add_square(want, triangle / 12, sum);
    }
    map_between(b, have, want);
    for (size_t i = 0; i < n; i++) {
        brc_sub(d, x[i], centroid);
        double r[2] = {brc_dot(d, s), brc_dot(d, t)};
        brc_copy(x[i], centroid);
        brc_axpy(x[i], b[0] * r[0] + b[1] * r[1], s);
        brc_axpy(x[i], b[1] * r[0] + b[2] * r[1], t);
    }
}

/* A third of each triangle about the centroid to each of its corners: linear functions over the
 * triangle are integrated exactly by that, which is why area and centroid are the facet's. */
void vgcm_points_place(enum vgcm_points_rule rule, const struct brc_facets *facets, size_t facet,
                       double (*x)[3], double *area)
{
    size_t first = facets->first[facet], n = facets->first[facet + 1] - first;
    const double *centroid = facets->centroid[facet], *normal = facets->normal[facet];
    if (rule == VGCM_POINTS_ONE) {
        brc_copy(x[0], centroid);
        area[0] = facets->area[facet];
        return;
    }
    for (size_t i = 0; i <= n; i++) {
        area[i] = 0;
        brc_copy(x[i], i < n ? facets->vertex[facets->loop[first + i]] : centroid);
    }
    for (size_t i = 0; i < n; i++) {
        size_t next = (i + 1) % n;
        double a[3], b[3], c[3];
        brc_sub(a, x[i], centroid);
        brc_sub(b, x[next], centroid);
        brc_cross(c, a, b);
        double third = brc_dot(c, normal) / 6; /* of the triangle; text below eq:vgcm:29 */
        area[i] += third;
        area[next] += third;
        area[n] += third;
    }
    if (rule == VGCM_POINTS_EXACT)
        draw_in(centroid, normal, n, x, area);
}
