/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "seeds.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

void brc_seeds_free(struct brc_seeds *s)
{
    free(s->x);
    free(s->radius);
    *s = (struct brc_seeds){0};
}

int brc_seeds_grid(struct brc_context *ctx, const struct brc_specimen_params *p,
                   struct brc_seeds *out)
{
    const int *cells = p->cells;
    double count = (double)cells[0] * cells[1] * cells[2];
    *out = (struct brc_seeds){0};
    if (count > 1e7)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "specimen.cells gives %g seeds, at most 1e7 are allowed",
                 count);
    double edge = p->size[0] / cells[0];
    for (int k = 1; k < 3; k++)
        if (fabs(p->size[k] / cells[k] - edge) > 1e-6 * edge)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "specimen.size / specimen.cells is %g x %g x %g m; the cells must be cubes",
                     edge, p->size[1] / cells[1], p->size[2] / cells[2]);
    out->n = (size_t)count;
    out->x = brc_alloc(ctx, out->n, sizeof *out->x);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    if (!out->x || !rng) {
        brc_seeds_free(out);
        return BRC_ERR_MEMORY;
    }
    gsl_rng_set(rng, (unsigned long)p->seed);
    for (size_t i = 0; i < out->n; i++) {
        const int at[3] = {(int)(i % (size_t)cells[0]), (int)(i / (size_t)cells[0]) % cells[1],
                           (int)(i / (size_t)cells[0]) / cells[1]};
        for (int k = 0; k < 3; k++) {
            double offset = 0.5 + p->jitter * (gsl_rng_uniform(rng) - 0.5);
            out->x[i][k] = p->size[k] * (at[k] + offset) / cells[k];
        }
    }
    gsl_rng_free(rng);
    return 0;
}
