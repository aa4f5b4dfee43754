/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Angles from the normals of breaks, weighted by area. The plane by search: all directions of a
 * lattice on the hemisphere, then smaller and smaller steps from the best of them; a moment of
 * inertia would be cheaper, but it finds the middle of two bands where there are two. Called when
 * results are asked for. */
#include "common/rigs/crack_fabric.h"

#include "common/geometry/vec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_crack_angles
static const struct brc_field fields[] = {BRC_CRACK_ANGLE_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* ---- angles -------------------------------------------------------------------------------- */

/* Of random planes the sine of the angle is uniform. */
static void set_bins(struct brc_crack_angles *a, double area)
{
    for (int k = 0; k < BRC_CRACK_BINS; k++) {
        a->low[k] = k * (BRC_PI / 2) / BRC_CRACK_BINS;
        a->high[k] = (k + 1) * (BRC_PI / 2) / BRC_CRACK_BINS;
        a->random[k] = area * (sin(a->high[k]) - sin(a->low[k]));
    }
}

int brc_crack_angles_measure(struct brc_context *ctx, const struct brc_events *e, int axis,
                             struct brc_crack_angles *out)
{
    struct brc_fieldset set = BRC_FIELDSET(fields, struct brc_crack_angles);
    *out = (struct brc_crack_angles){0};
    brc_table_init(&out->table, "crack_angles", set, out);
    BRC_TRY(brc_table_resize(ctx, &out->table, BRC_CRACK_BINS));
    double *const by_mode[BRC_N_MODES] = {out->tension, out->shear, out->torsion};
    double area = 0, angles = 0, across = 0;
    for (size_t i = 0; i < e->table.n; i++) {
        double sine = fmin(fabs(e->n[i][axis]), 1), angle = asin(sine);
        int bin = (int)(angle / (BRC_PI / 2) * BRC_CRACK_BINS);
        by_mode[e->mode[i]][bin < BRC_CRACK_BINS ? bin : BRC_CRACK_BINS - 1] += e->area[i];
        area += e->area[i];
        angles += e->area[i] * angle;
        across += e->area[i] * sine * sine;
    }
    set_bins(out, area);
    out->mean = area > 0 ? angles / area : NAN;
    out->alignment = area > 0 ? 1 - across / area : NAN;
    return 0;
}

void brc_crack_angles_free(struct brc_crack_angles *a)
{
    brc_table_free(&a->table);
}

/* ---- plane --------------------------------------------------------------------------------- */

/* Directions of the lattice are 7 degrees apart; the best of them are refined. Bins of the offset
 * are a sixteenth of the thickness. */
enum { DIRECTIONS = 400, BEST = 8, HALVINGS = 7, BINS = 16 };

struct search {
    size_t n; /* broken facets */
    double (*x)[3], *area, *bin;
    size_t n_bins;
    double low, width; /* of the bins: all offsets of all directions fit */
};

/* Area in the fullest slab of this normal. */
static double slab_area(struct search *s, const double normal[3])
{
    double sum = 0, most = 0;
    memset(s->bin, 0, s->n_bins * sizeof *s->bin);
    for (size_t i = 0; i < s->n; i++)
        s->bin[(size_t)((brc_dot(s->x[i], normal) - s->low) / s->width)] += s->area[i];
    for (size_t i = 0; i < s->n_bins; i++) {
        sum += s->bin[i] - (i >= BINS ? s->bin[i - BINS] : 0);
        most = fmax(most, sum);
    }
    return most;
}

/* Direction i of a Fibonacci lattice on the hemisphere: the densest that a formula gives. */
static void lattice(int i, double n[3])
{
    double z = (i + 0.5) / DIRECTIONS, turn = i * BRC_PI * (3 - sqrt(5)), r = sqrt(1 - z * z);
    brc_set(n, r * cos(turn), r * sin(turn), z);
}

/* From a direction by steps to eight sides, halved when none is better. */
static double refine(struct search *s, double n[3], double most)
{
    double step = 0.06;
    for (int h = 0; h < HALVINGS; h++, step /= 2) {
        double u[3], v[3], best[3];
        brc_frame(u, v, n);
        brc_copy(best, n);
        for (int k = 0; k < 8; k++) {
            double near[3];
            brc_copy(near, n);
            brc_axpy(near, step * cos(k * BRC_PI / 4), u);
            brc_axpy(near, step * sin(k * BRC_PI / 4), v);
            brc_normalise(near, near);
            double area = slab_area(s, near);
            if (area > most) {
                most = area;
                brc_copy(best, near);
            }
        }
        brc_copy(n, best);
    }
    return most;
}

/* The best few of the lattice, in descending order: their areas and numbers. */
static void keep_best(double area[BEST], int number[BEST], double value, int i)
{
    int k = BEST;
    for (; k > 0 && value > area[k - 1]; k--)
        if (k < BEST) {
            area[k] = area[k - 1];
            number[k] = number[k - 1];
        }
    if (k < BEST) {
        area[k] = value;
        number[k] = i;
    }
}

static void find(struct search *s, struct brc_crack_plane *out)
{
    double area[BEST] = {0}, all = 0;
    int number[BEST] = {0};
    for (size_t i = 0; i < s->n; i++)
        all += s->area[i];
    for (int i = 0; i < DIRECTIONS; i++) {
        double n[3];
        lattice(i, n);
        keep_best(area, number, slab_area(s, n), i);
    }
    for (int k = 0; k < BEST; k++) {
        double n[3];
        lattice(number[k], n);
        double part = refine(s, n, area[k]) / all;
        if (part > out->part) {
            out->part = part;
            brc_copy(out->normal, n);
        }
    }
}

/* Facets with what is broken of them, in place of breaks: a facet may break by seven points. */
static void gather(const struct brc_events *e, const struct brc_facets *f, struct search *s)
{
    for (size_t i = 0; i < e->table.n; i++)
        if (e->facet[i] >= 0 && (size_t)e->facet[i] < f->n_facets)
            s->area[e->facet[i]] += e->area[i];
    for (size_t i = 0; i < f->n_facets; i++)
        if (s->area[i] > 0) {
            brc_copy(s->x[s->n], f->centroid[i]);
            s->area[s->n++] = s->area[i];
        }
}

/* Offsets of all normals lie within the box's half diagonal about its middle. */
static int set_offsets(struct brc_context *ctx, struct search *s, double thickness)
{
    double low[3], high[3], middle[3];
    brc_box_of(low, high, s->x, s->n);
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (low[k] + high[k]);
    for (size_t i = 0; i < s->n; i++)
        brc_sub(s->x[i], s->x[i], middle);
    double half = 0.5 * brc_distance(low, high) + thickness;
    s->width = thickness / BINS;
    s->low = -half;
    s->n_bins = (size_t)(2 * half / s->width) + 2;
    s->bin = brc_alloc(ctx, s->n_bins, sizeof *s->bin);
    return s->bin ? 0 : BRC_ERR_MEMORY;
}

int brc_crack_plane_find(struct brc_context *ctx, const struct brc_events *e,
                         const struct brc_facets *f, double thickness, struct brc_crack_plane *out)
{
    struct search s = {.x = brc_alloc(ctx, f->n_facets, sizeof *s.x),
                       .area = brc_alloc(ctx, f->n_facets, sizeof *s.area)};
    int code = s.x && s.area ? 0 : BRC_ERR_MEMORY;
    *out = (struct brc_crack_plane){0};
    if (code == 0) {
        gather(e, f, &s);
        out->n = s.n;
    }
    if (code == 0 && s.n > 0)
        code = set_offsets(ctx, &s, thickness);
    if (code == 0 && s.n > 0)
        find(&s, out);
    free(s.x);
    free(s.area);
    free(s.bin);
    return code;
}
