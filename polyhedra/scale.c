/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lengths and stiffnesses that follow from the grains, so that one set of values serves specimens
 * of every size. Called before a run is checked and when its state is made, so that both see the
 * same numbers; may not know cores, which are eroded by what is found here. */
#include "polyhedra/poly.h"

#include <math.h>

/* Facets that carry no contact are left out of the means: a stiffness by them would be that of no
 * contact. */
void poly_scale_measure(struct poly_scale *scale, const struct brc_facets *facets)
{
    double volume = 0, area = 0, distance = 0;
    size_t n = 0;
    for (size_t i = 0; i < facets->n_cells; i++)
        volume += facets->volume[i];
    for (size_t i = 0; i < facets->n_facets; i++) {
        const int32_t *cell = facets->cell[i];
        if (cell[1] < 0 || !facets->is_contact[i])
            continue;
        area += facets->area[i];
        distance += brc_distance(facets->centre[cell[0]], facets->centre[cell[1]]);
        n++;
    }
    scale->size = cbrt(volume / (double)facets->n_cells);
    scale->area = n > 0 ? area / (double)n : scale->size * scale->size;
    scale->distance = n > 0 ? distance / (double)n : scale->size;
}

/* What is given stays. K_n goes with area over distance, as the stiffness of a block of rock
 * between two centres does, so that a specimen of other grains has the same modulus. */
void poly_scale_params(const struct poly_scale *scale, struct poly_params *params)
{
    if (isnan(params->radius))
        params->radius = params->radius_ratio * scale->size;
    if (isnan(params->kn))
        params->kn = params->kn_modulus * scale->area / scale->distance;
    if (isnan(params->kt))
        params->kt = params->kt_ratio * params->kn;
}
