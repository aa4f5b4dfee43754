/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a test has measured, from its curve. */
#include "common/engine/rig.h"

#include "common/engine/sim.h"

#include <gsl/gsl_fit.h>
#include <math.h>

static const char
    no_row[] = "no row of the curve: fewer steps than test.sample_steps",
    no_load[] = "no load in the sense of the test",
    no_peak[] = "no peak: the load was still rising, or above 0.95 of the largest, at the end",
    no_gauge[] = "fewer than 4 grains in the gauge, or all close to one place along "
                 "the load",
    no_lateral[] = "fewer than 4 grains in the gauge, or all close to one place "
                   "across the load",
    no_rows[] = "fewer than 2 rows of the curve from test.modulus_low to "
                "test.modulus_high: lower test.sample_steps or load more slowly";
/* A largest load is a peak once the load has been below this part of it. */
static const double FALLEN = 0.95;

double brc_rig_unbalanced_max(const struct brc_sim *sim)
{
    const struct brc_curve *c = &sim->rig.curve;
    double largest = 0, peak = sim->rig.force_peak;
    for (size_t i = 0; i < c->table.n; i++) {
        if (c->force[i] >= 0.1 * peak)
            largest = fmax(largest, c->unbalanced[i]);
        if (c->force[i] == peak)
            break;
    }
    return largest;
}

/* Why the largest load is no strength, NULL where it is. */
static const char *why_no_peak(const struct brc_rig *rig)
{
    const struct brc_curve *c = &rig->curve;
    double peak = rig->force_peak;
    if (c->table.n == 0)
        return no_row;
    if (!(peak > 0))
        return no_load;
    size_t i = 0;
    while (i < c->table.n && c->force[i] != peak)
        i++;
    for (; i < c->table.n; i++)
        if (c->force[i] < FALLEN * peak)
            return NULL;
    return no_peak;
}

/* Rows between the two parts of the peak, on the way up: [*first, *end). */
static void modulus_rows(const struct brc_rig *rig, size_t *first, size_t *end)
{
    const struct brc_curve *c = &rig->curve;
    double peak = rig->force_peak;
    size_t i = 0;
    while (i < c->table.n && c->force[i] < rig->params.modulus_low * peak)
        i++;
    *first = i;
    while (i < c->table.n && c->force[i] <= rig->params.modulus_high * peak)
        i++;
    *end = i;
}

static double slope(const double *x, const double *y, size_t n)
{
    double c0, c1, cov00, cov01, cov11, chi2;
    gsl_fit_linear(x, 1, y, 1, n, &c0, &c1, &cov00, &cov01, &cov11, &chi2);
    return c1;
}

static void add_result(struct brc_result *out, int *n, const char *name, double value,
                       const char *unit, const char *note)
{
    out[(*n)++] = (struct brc_result){name, note ? NAN : value, unit, note};
}

/* Primary slope: force per thickness at half the strain of the peak, over that strain. */
static double brazilian_slope(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double low[3], high[3], half = rig->strain_peak / 2;
    brc_specimen_extent(sim->specimen, low, high);
    size_t i = 0;
    while (rig->curve.strain[i] < half)
        i++;
    return 2 * rig->curve.force[i] / (2 * half * (high[2] - low[2])); /* eq:gt12:17 */
}

static void add_moduli(const struct brc_sim *sim, struct brc_result *out, int *n)
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_curve *c = &rig->curve;
    size_t first, end;
    modulus_rows(rig, &first, &end);
    bool is_gauged = rig->has_gauge[rig->axis];
    bool is_wide = rig->has_gauge[0] && rig->has_gauge[1] && rig->has_gauge[2];
    const char *load = why_no_peak(rig);
    const char *rows = load && load != no_peak ? load : end - first < 2 ? no_rows : NULL;
    const char *axial = rows ? rows : is_gauged ? NULL : no_gauge;
    const char *lateral = axial ? axial : is_wide ? NULL : no_lateral;
    const double *stress = c->stress + first, *strain = c->strain_axial + first;
    size_t k = rows ? 0 : end - first;
    add_result(out, n, "E", axial ? NAN : slope(strain, stress, k), "Pa", axial); /* eq:gt12:25 */
    add_result(out, n, "nu", lateral ? NAN : -slope(strain, c->strain_lateral + first, k), "1",
               lateral); /* eq:gt12:24 */
    add_result(out, n, "E_platen", rows ? NAN : slope(c->strain + first, stress, k), "Pa", rows);
}

int brc_rig_results(const struct brc_sim *sim, struct brc_result out[BRC_MAX_RESULTS])
{
    static const char *const broken[BRC_N_MODES] = {"broken_tension", "broken_shear",
                                                    "broken_torsion"};
    const struct brc_rig *rig = &sim->rig;
    const char *note = why_no_peak(rig);
    int n = 0;
    if (rig->params.kind == BRC_TEST_BRAZILIAN)
        add_result(out, &n, "S", note ? NAN : brazilian_slope(sim), "Pa", note);
    else if (rig->params.kind != BRC_TEST_NONE)
        add_moduli(sim, out, &n);
    if (rig->params.kind != BRC_TEST_NONE) {
        add_result(out, &n, "strength", rig->force_peak / rig->section, "Pa", note);
        add_result(out, &n, "strain_at_peak", rig->strain_peak, "1", note);
        add_result(out, &n, "force_peak", rig->force_peak, "N", note);
    }
    for (int m = 0; m < BRC_N_MODES; m++)
        add_result(out, &n, broken[m], (double)sim->events.count[m], "1", NULL);
    return n;
}
