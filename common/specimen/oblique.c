/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A uniform strain along each of some directions is compared with what the same medium without
 * obliqueness would store: that needs no model and no run, and is known before either. Called by
 * the models; knows facets and places of centres only. */
#include "common/specimen/oblique.h"

#include "common/geometry/vec.h"

/* Facets below this part of the mean area have a normal that is rounding. */
static const double LEAST_AREA = 1e-4;
/* Directions that hold less than this part of the volume say nothing: a single layer of grains. */
static const double LEAST_VOLUME = 0.01;

/* Axes, face diagonals and body diagonals of a cube. Not normalised: what a direction stores is
 * compared with what it should store. */
static const double DIRECTION[][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0},
                                      {1, 0, 1},  {1, 0, -1}, {0, 1, 1}, {0, 1, -1}, {1, 1, 1},
                                      {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
enum { N_DIRECTIONS = sizeof DIRECTION / sizeof *DIRECTION };

/* The normal points out of the first cell, so that the cosine is positive where the second centre
 * lies beyond the facet. */
double brc_oblique_cos(const struct brc_facets *f, double (*centre)[3], size_t facet)
{
    double branch[3];
    brc_sub(branch, centre[f->cell[facet][1]], centre[f->cell[facet][0]]);
    return brc_dot(branch, f->normal[facet]) / brc_norm(branch);
}

/* What carries a contact between two grains; rounding has left no area to some facets. */
static bool is_counted(const struct brc_facets *f, size_t facet)
{
    return f->cell[facet][1] >= 0 && f->is_contact[facet] && f->area[facet] > 0;
}

/* Over contacts alone: facets that are none are small, and would lower the mean by which others
 * count as too small to have a normal. */
static double mean_area(const struct brc_facets *f)
{
    double area = 0, n = 0;
    for (size_t i = 0; i < f->n_facets; i++) {
        area += is_counted(f, i) ? f->area[i] : 0;
        n += is_counted(f, i);
    }
    return n > 0 ? area / n : 0;
}

/* A strain along m stores A/d (m . branch)^2 in a facet, twice over the modulus. The sum of
 * A (m . normal) (m . branch) is the volume between the centres, whatever the cells and centres. */
static void add_stored(double stored[2], const struct brc_facets *f, const double branch[3],
                       double part, size_t facet, const double m[3])
{
    double along = brc_dot(m, branch), size = brc_norm(branch);
    stored[0] += part * f->area[facet] * along * along / size;
    stored[1] += f->area[facet] * along * brc_dot(m, f->normal[facet]);
}

/* What a direction stores is divided by the volume that the same facets span, not by that of the
 * specimen: so the layer at the boundary, whose outer facets are left out, does not look soft. */
void brc_oblique_measure(struct brc_oblique *o, const struct brc_facets *f, double (*centre)[3],
                         bool is_projected)
{
    double stored[N_DIRECTIONS][2] = {{0}}, area = 0, sum = 0, least = LEAST_AREA * mean_area(f);
    double volume = 0; /* three times that between the centres */
    *o = (struct brc_oblique){.mean_cos = 1, .soft = 1, .stiff = 1, .reversed = SIZE_MAX};
    for (size_t i = 0; i < f->n_facets; i++) {
        if (!is_counted(f, i) || f->area[i] <= least)
            continue;
        double branch[3], cosine = brc_oblique_cos(f, centre, i);
        brc_sub(branch, centre[f->cell[i][1]], centre[f->cell[i][0]]);
        area += f->area[i];
        sum += f->area[i] * cosine;
        volume += f->area[i] * cosine * brc_norm(branch);
        if (cosine <= 0 && o->reversed == SIZE_MAX)
            o->reversed = i;
        for (int k = 0; k < N_DIRECTIONS; k++)
            add_stored(stored[k], f, branch, is_projected ? cosine : 1, i, DIRECTION[k]);
    }
    if (area <= 0)
        return;
    o->mean_cos = sum / area;
    o->soft = HUGE_VAL;
    o->stiff = 0;
    for (int k = 0; k < N_DIRECTIONS; k++) {
        double part = stored[k][0] / stored[k][1];
        if (!(stored[k][1] > LEAST_VOLUME * volume))
            continue;
        o->soft = fmin(o->soft, part);
        o->stiff = fmax(o->stiff, part);
    }
}
