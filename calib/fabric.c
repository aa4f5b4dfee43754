/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over facets, made once for a specimen: the guess and its inverse then cost nothing. Areas
 * are eroded in the same way as the polyhedra model does, else the two would disagree about small
 * facets. */
#include "calib/fabric.h"
#include "common/specimen/erosion.h"
#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

/* Area that each of the cell's faces keeps when its planes move in by r; first side: the low cell.
 */
static int erode_cell(struct brc_context *ctx, const struct brc_facets *f, size_t cell, double r,
                      struct brc_erosion *work, double (*area)[2])
{
    BRC_TRY(brc_erosion_begin(ctx, work, f, cell));
    BRC_TRY(brc_erosion_core(ctx, work, r, f->centre[cell]));
    return brc_erosion_areas(ctx, work, area);
}

/* Areas that bonds have: those of the facets, or the mean of the eroded faces; a face that erosion
 * removes on either side has none. */
static int bond_areas(struct brc_context *ctx, const struct brc_facets *f,
                      const struct calib_fabric_rules *rules, double *area)
{
    struct brc_erosion work = {0};
    int code = 0;
    memcpy(area, f->area, f->n_facets * sizeof *area);
    if (!rules->is_eroded)
        return 0;
    double(*side)[2] = brc_alloc(ctx, f->n_facets, sizeof *side);
    if (!side)
        return BRC_ERR_MEMORY;
    for (size_t c = 0; c < f->n_cells && code == 0; c++)
        code = erode_cell(ctx, f, c, rules->rounding, &work, side);
    for (size_t i = 0; i < f->n_facets; i++)
        area[i] = side[i][0] > 0 && side[i][1] > 0 ? 0.5 * (side[i][0] + side[i][1]) : 0;
    brc_erosion_free(&work);
    free(side);
    return code;
}

/* Sums over all inner facets, in the end the divisors of the others. */
struct totals {
    double seeds, centres; /* m3: sum of A d by the seeds and by the centres, along the normal */
    size_t n_bonds;
};

/* Bonds join cells, so that their sums take the centres; contacts of spheres join seeds, those that
 * are nearer than the two radii and the gap (the rule of vgcm). */
static void add_facet(const struct brc_facets *f, size_t i, double bond_area,
                      const struct calib_fabric_rules *rules, struct calib_fabric *sum,
                      struct totals *all)
{
    const int32_t *cell = f->cell[i];
    double centres[3], d_seeds = brc_distance(f->seed[cell[0]], f->seed[cell[1]]);
    brc_sub(centres, f->centre[cell[1]], f->centre[cell[0]]);
    double d = brc_dot(centres, f->normal[i]);
    double length = rules->is_length_of_gap ? 2 * rules->rounding : brc_norm(centres);
    all->seeds += f->area[i] * d_seeds;
    all->centres += f->area[i] * d;
    if (f->is_contact[i]) {
        all->n_bonds++;
        sum->bond += bond_area * d * d / length;
        sum->corners += (double)(f->first[i + 1] - f->first[i]) * d * d;
        sum->stretch += d / length;
    }
    double radii = brc_facets_radius(f, (size_t)cell[0]) + brc_facets_radius(f, (size_t)cell[1]);
    if (f->is_contact[i] && d_seeds < radii + rules->gap) {
        sum->n_contacts++;
        sum->mean_distance += d_seeds;
        sum->coverage += f->area[i] * d_seeds;
    }
}

/* The boundary layer is left out of the volume as its facets are of the sums: else a small specimen
 * would seem soft. */
int calib_fabric_measure(struct brc_context *ctx, const struct brc_facets *facets,
                         const struct calib_fabric_rules *rules, struct calib_fabric *out)
{
    struct totals all = {0, 0, 0};
    memset(out, 0, sizeof *out);
    if ((rules->is_eroded || rules->is_length_of_gap) && !(rules->rounding > 0))
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "first guess: eroded areas and the gap as strain length need a sphero-radius above "
            "0");
    double *area = brc_alloc(ctx, facets->n_facets, sizeof *area);
    if (!area)
        return BRC_ERR_MEMORY;
    int code = bond_areas(ctx, facets, rules, area);
    for (size_t i = 0; i < facets->n_facets && code == 0; i++)
        if (facets->cell[i][1] >= 0)
            add_facet(facets, i, area[i], rules, out, &all);
    free(area);
    BRC_TRY(code);
    if (out->n_contacts == 0 || all.n_bonds == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "first guess: no facet of the specimen is a contact");
    out->volume = all.centres / 3;
    out->mean_distance /= (double)out->n_contacts;
    out->coverage /= all.seeds;
    out->bond /= all.centres;
    out->corners /= all.centres;
    out->stretch /= (double)all.n_bonds;
    return 0;
}
