/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How well the cells of a specimen close and fill the domain, for tests, whose limits are far below
 * those of brc_facets_verify. */
#ifndef BRC_TESTS_QUALITY_H
#define BRC_TESTS_QUALITY_H

#include "common/geometry/vec.h"
#include "common/specimen/facets.h"

struct brc_facets_quality {
    double volume_error;  /* |volume sum / domain volume - 1| */
    double closure_error; /* largest |sum A n| / sum A over a cell */
    double smallest_area; /* m2 */
};

static inline struct brc_facets_quality brc_facets_quality(const struct brc_facets *f,
                                                           double domain_volume)
{
    struct brc_facets_quality q = {0, 0, INFINITY};
    long double volume = 0;
    for (size_t c = 0; c < f->n_cells; c++) {
        double sum[3] = {0, 0, 0}, total = 0;
        volume += (long double)f->volume[c];
        for (size_t k = f->cell_first[c]; k < f->cell_first[c + 1]; k++) {
            int32_t facet = f->cell_facet[k];
            brc_axpy(sum, f->cell[facet][0] == (int32_t)c ? f->area[facet] : -f->area[facet],
                     f->normal[facet]);
            total += f->area[facet];
        }
        q.closure_error = fmax(q.closure_error, brc_norm(sum) / total);
    }
    for (size_t i = 0; i < f->n_facets; i++)
        q.smallest_area = fmin(q.smallest_area, f->area[i]);
    q.volume_error = fabs((double)(volume / (long double)domain_volume) - 1);
    return q;
}

#endif
