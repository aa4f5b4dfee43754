/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Crack initiation and crack damage as laboratories read them (Martin and Chandler 1994; Nicksiar
 * and Martin 2012). Cracks along the load open across it: what the specimen widens beyond its
 * elastic part tells of them. Two ways to CI, since each has a weakness: crack volumetric strain
 * hangs on E and nu of the elastic part and on a tolerance, the lateral response on CD alone.
 * Called when results are asked for; in tension there is neither, as volume grows from the start.
 */
#include "common/rigs/crack_stress.h"

#include "common/engine/sim.h"

#include <math.h>

static const char no_reversal[] =
    "the volumetric strain had not risen and turned round before the peak",
                  no_cracks[] = "the crack volumetric strain had not left its largest value before "
                                "the peak",
                  no_response[] = "the lateral strain grew no faster than at the start";

/* Crack volumetric strain has left its largest value once it is below by this part of the elastic
 * volumetric strain at the peak: a hundredth is what E and nu, fitted low on the curve, are worth
 * there. */
static const double LEFT = 0.01;

const struct brc_quantity brc_compression_quantities[BRC_N_COMPRESSION_RESULTS] = {
    BRC_COMPRESSION_QUANTITIES};

static struct brc_measured at_row(const struct brc_strains *r, size_t row, const char *note)
{
    return (struct brc_measured){note ? NAN : r->stress[row], note};
}

static double volumetric(const struct brc_strains *r, size_t i)
{
    return r->axial[i] + 2 * r->lateral[i];
}

/* Row of the largest volumetric strain; r->n where that is the last, as it has not turned, or the
 * first, as it has never risen. */
static size_t reversal(const struct brc_strains *r)
{
    size_t most = 0;
    for (size_t i = 1; i < r->n; i++)
        if (volumetric(r, i) > volumetric(r, most))
            most = i;
    return most > 0 && most + 1 < r->n ? most : r->n;
}

/* The last row within the tolerance of the largest crack volumetric strain; r->n: it never left. */
static size_t leaves_largest(const struct brc_strains *r, double elastic)
{
    double most = -HUGE_VAL, left = LEFT * fabs(elastic) * r->stress[r->n - 1];
    size_t last = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < r->n; i++) {
            double crack = volumetric(r, i) - elastic * r->stress[i];
            if (pass == 0)
                most = fmax(most, crack);
            else if (crack >= most - left)
                last = i;
        }
    return last + 1 < r->n ? last : r->n;
}

/* The row up to the last one where the lateral lengthening is furthest below the straight line from
 * the first row to the last; r->n: it is above it everywhere. */
static size_t lateral_response(const struct brc_strains *r, size_t last)
{
    double span = r->stress[last] - r->stress[0], most = 0;
    double slope = span > 0 ? (r->lateral[last] - r->lateral[0]) / span : 0;
    size_t row = r->n;
    for (size_t i = 0; i < last; i++) {
        double line = r->lateral[0] + slope * (r->stress[i] - r->stress[0]);
        double above = r->lateral[i] - line; /* lengthening is negative */
        if (above > most) {
            most = above;
            row = i;
        }
    }
    return row;
}

void brc_crack_stresses(const struct brc_strains *rows, double E, double nu,
                        struct brc_measured out[BRC_N_CRACK_STRESSES])
{
    size_t n = rows->n, turn = reversal(rows), left = leaves_largest(rows, (1 - 2 * nu) / E);
    size_t bend = turn < n ? lateral_response(rows, turn) : n;
    out[0] = at_row(rows, bend, turn == n ? no_reversal : bend == n ? no_response : NULL);
    out[1] = at_row(rows, left, left == n ? no_cracks : NULL);
    out[2] = at_row(rows, turn, turn == n ? no_reversal : NULL);
}

/* nu is measured last of what is needed: its note is that of anything that is missing. */
void brc_compression_results(const struct brc_sim *sim, struct brc_measured *out)
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_curve *c = &rig->curve;
    brc_core_results(sim, out);
    const char *note = brc_curve_why_no_peak(rig);
    note = note ? note : out[1].note;
    if (note) {
        for (int i = 0; i < BRC_N_CRACK_STRESSES; i++)
            out[BRC_N_CORE_RESULTS + i] = (struct brc_measured){NAN, note};
        return;
    }
    size_t first = (size_t)rig->stage_row;
    const struct brc_strains rows = {c->stress + first, c->strain_axial + first,
                                     c->strain_lateral + first,
                                     brc_curve_peak_row(rig) + 1 - first};
    brc_crack_stresses(&rows, out[0].value, out[1].value, out + BRC_N_CORE_RESULTS);
}
