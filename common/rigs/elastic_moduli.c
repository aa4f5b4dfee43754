/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moduli as a laboratory reads them: slopes of the curve between two parts of its peak, on the way
 * up. A value that cannot be measured has a note that says what to change. Called by tests at their
 * end; it reads the curve and whether there is a gauge. */
#include "common/rigs/elastic_moduli.h"

#include "common/engine/sim.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

static const char no_gauge[] = "fewer than 4 grains in the gauge, or all close to one place along "
                               "the load",
                  no_lateral[] = "fewer than 4 grains in the gauge, or all close to one place "
                                 "across the load",
                  no_rows[] = "fewer than 2 rows of the curve from test.modulus_low to "
                              "test.modulus_high: lower test.sample_steps or load more slowly",
                  two_rows[] = "only 2 rows of the curve from test.modulus_low to "
                               "test.modulus_high: any line fits them";

const struct brc_quantity brc_core_quantities[BRC_N_CORE_RESULTS] = {BRC_CORE_QUANTITIES};

int brc_moduli_check(struct brc_context *ctx, const struct brc_test_params *t)
{
    if (t->modulus_low < t->modulus_high)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INPUT, "test.modulus_low = %g must be below test.modulus_high = %g",
             t->modulus_low, t->modulus_high);
}

/* Rows between the two parts of the peak, on the way up: [*first, *end). By the force and not by
 * the strain, as the elastic part of a specimen ends at a part of its strength. */
void brc_moduli_rows(const struct brc_rig *rig, size_t *first, size_t *end)
{
    const struct brc_curve *c = &rig->curve;
    double peak = rig->force_peak;
    size_t i = (size_t)rig->stage_row;
    while (i < c->table.n && c->force[i] < rig->params.modulus_low * peak)
        i++;
    *first = i;
    while (i < c->table.n && c->force[i] <= rig->params.modulus_high * peak)
        i++;
    *end = i;
}

struct brc_line brc_line_fit(const double *x, const double *y, size_t n)
{
    double c0, c1, cov00, cov01, cov11, left, all = gsl_stats_tss(y, 1, n);
    gsl_fit_linear(x, 1, y, 1, n, &c0, &c1, &cov00, &cov01, &cov11, &left);
    return (struct brc_line){c1, all > 0 ? 1 - left / all : 1, sqrt(all / (double)n)};
}

static struct brc_measured measured(double value, const char *note)
{
    return (struct brc_measured){note ? NAN : value, note};
}

/* A load that has not fallen yet leaves moduli measurable: the parts are then of the largest load
 * so far. */
void brc_core_results(const struct brc_sim *sim, struct brc_measured *out)
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_curve *c = &rig->curve;
    size_t first, end;
    brc_moduli_rows(rig, &first, &end);
    bool is_gauged = rig->has_gauge[rig->axis];
    bool is_wide = rig->has_gauge[0] && rig->has_gauge[1] && rig->has_gauge[2];
    const char *load = brc_curve_why_no_peak(rig);
    const char *rows = load && load != brc_curve_no_peak ? load : end - first < 2 ? no_rows : NULL;
    const char *axial = rows ? rows : is_gauged ? NULL : no_gauge;
    const char *lateral = axial ? axial : is_wide ? NULL : no_lateral;
    const double *stress = c->stress + first, *strain = c->strain_axial + first;
    const char *few = end - first == 2 ? two_rows : NULL;
    size_t n = end - first;
    const struct brc_line none = {NAN, NAN, NAN};
    struct brc_line e = axial ? none : brc_line_fit(strain, stress, n);
    struct brc_line nu = lateral ? none : brc_line_fit(strain, c->strain_lateral + first, n);
    struct brc_line platen = rows ? none : brc_line_fit(c->strain + first, stress, n);
    out[0] = measured(e.slope, axial);     /* eq:gt12:25 */
    out[1] = measured(-nu.slope, lateral); /* eq:gt12:24 */
    out[2] = measured(platen.slope, rows);
    out[3] = measured(e.r2, axial ? axial : few);
    out[4] = measured(nu.r2, lateral ? lateral : few);
    brc_curve_peak_results(sim, out + BRC_N_MODULI);
}
