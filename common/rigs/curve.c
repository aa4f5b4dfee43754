/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the curve, and what is read off its peak. Tests call it at the end of each step. A row
 * holds means over the steps since the last one, since the force of a single step is noisy and a
 * peak must not be an accident of it. */
#include "common/rigs/curve.h"

#include "common/engine/sim.h"
#include "common/rigs/gauge.h"

#include <math.h>

static const char no_row[] = "no row of the curve: fewer steps than test.sample_steps",
                  no_load[] = "no load in the sense of the test",
                  plateau[] = "the load stays within 1 % over test.plateau of strain: a plateau",
                  no_break[] = "nothing had broken at the peak";
const char brc_curve_no_peak[] =
    "no peak: the load was still rising, or above 0.95 of the largest, at the end";
/* A largest load is a peak once the load has been below this part of it: a run that ends on the way
 * up has no strength, and a result that says otherwise would be too low without a sign of it. */
static const double FALLEN = 0.95;
/* or once it has stayed within this part of itself over test.plateau of strain */
static const double FLAT = 0.01;

const struct brc_rig_view brc_curve_deviator_view = {.strain = "strain_axial",
                                                     .lateral = "strain_lateral",
                                                     .strain_label =
                                                         "axial strain; dashed: lateral strain",
                                                     .stress_label = "deviator"};

/* A gauge strain is `now`, while stress and strain of row i are means over its steps: in fast
 * loading that would set them apart by percents. So it is taken where the platen strain had its
 * mean: on the line from the start, or in later stages, where it may go another way, on that from
 * the last row.
 */
static double at_mean(const struct brc_rig *rig, size_t i, const double *column, double now)
{
    const double *strain = rig->curve.strain;
    if (rig->stage == 0 || i == 0)
        return (rig->strain > 0 ? strain[i] / rig->strain : 1) * now;
    double way = rig->strain - strain[i - 1];
    double part = way != 0 ? (strain[i] - strain[i - 1]) / way : 1;
    return column[i - 1] + part * (now - column[i - 1]);
}

static int add_row(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    struct brc_curve *c = &rig->curve;
    const struct brc_ledger *l = brc_accounts_settle(sim);
    size_t i;
    BRC_TRY(brc_rig_add_row(sim->ctx, rig, &i));
    int across[2] = {0, rig->axis == 2 ? 1 : 2};
    double stored = l->bond + l->contact_normal + l->contact_shear;
    c->step[i] = sim->step;
    c->time[i] = sim->time;
    double steps = (double)rig->n_summed, mean = rig->n_summed > 0 ? rig->strain_sum / steps : 0;
    c->strain[i] = mean;
    c->force[i] = rig->n_summed > 0 ? rig->force_sum / steps : 0;
    c->stress[i] = c->force[i] / rig->section;
    c->strain_axial[i] =
        at_mean(rig, i, c->strain_axial, rig->sense * brc_gauge_strain(sim, rig->axis));
    double lateral = brc_gauge_strain(sim, across[0]) + brc_gauge_strain(sim, across[1]);
    c->strain_lateral[i] = at_mean(rig, i, c->strain_lateral, rig->sense * 0.5 * lateral);
    c->rate[i] = rig->rate;
    c->unbalanced[i] = rig->unbalanced;
    c->kinetic_ratio[i] = stored > 0 ? l->kinetic / stored : 0;
    c->residual[i] = sim->run.ledger ? brc_ledger_residual(l) : 0;
    c->broken[i] = (int64_t)sim->events.table.n;
    rig->force_sum = rig->strain_sum = 0;
    rig->n_summed = 0;
    if (c->force[i] > rig->force_peak) {
        rig->force_peak = c->force[i];
        rig->strain_peak = c->strain[i];
        sim->ledger_at_peak = *l;
    }
    return 0;
}

int brc_curve_sample(struct brc_sim *sim)
{
    return sim->step % sim->rig.params.sample_steps == 0 ? add_row(sim) : 0;
}

/* From a tenth of the peak on, since at the start there is hardly a contact force to compare with;
 * up to the peak, since a collapse is out of balance by nature. */
double brc_curve_unbalanced_max(const struct brc_sim *sim)
{
    const struct brc_curve *c = &sim->rig.curve;
    double largest = 0, peak = sim->rig.force_peak;
    for (size_t i = (size_t)sim->rig.stage_row; i < c->table.n; i++) {
        if (c->force[i] >= 0.1 * peak)
            largest = fmax(largest, c->unbalanced[i]);
        if (c->force[i] == peak)
            break;
    }
    return largest;
}

size_t brc_curve_peak_row(const struct brc_rig *rig)
{
    const struct brc_curve *c = &rig->curve;
    size_t i = (size_t)rig->stage_row;
    while (i < c->table.n && c->force[i] != rig->force_peak)
        i++;
    return i;
}

/* A load that stays: hardening against softening, as of a confined or a frictional specimen. */
static bool is_plateau(const struct brc_rig *rig)
{
    const struct brc_curve *c = &rig->curve;
    size_t i = c->table.n, first = (size_t)rig->stage_row;
    double low = HUGE_VAL, high = 0, length = rig->params.plateau;
    while (i > first && fabs(c->strain[c->table.n - 1] - c->strain[i - 1]) <= length) {
        i--;
        low = fmin(low, c->force[i]);
        high = fmax(high, c->force[i]);
    }
    return length > 0 && i > first && low >= (1 - FLAT) * high && high > 0;
}

const char *brc_curve_why_no_peak(const struct brc_rig *rig)
{
    const struct brc_curve *c = &rig->curve;
    double peak = rig->force_peak;
    if (c->table.n == 0)
        return no_row;
    if (!(peak > 0))
        return no_load;
    for (size_t i = brc_curve_peak_row(rig); i < c->table.n; i++)
        if (c->force[i] < FALLEN * peak)
            return NULL;
    return is_plateau(rig) ? NULL : brc_curve_no_peak;
}

/* A peak that is a plateau says so beside its value. */
static const char *peak_note(const struct brc_rig *rig)
{
    size_t last = rig->curve.table.n - 1;
    bool has_fallen = rig->curve.force[last] < FALLEN * rig->force_peak;
    return !has_fallen && is_plateau(rig) ? plateau : NULL;
}

/* Of the area that is broken at the peak, not of the whole that could break: a part of what the
 * specimen itself needs to fail, so that a first weak bond is no onset, and tests compare. */
static const double FIRST_PART = 0.01;

static struct brc_measured first_broken(const struct brc_sim *sim, const char *no_peak)
{
    const struct brc_curve *c = &sim->rig.curve;
    const struct brc_events *e = &sim->events;
    if (no_peak)
        return (struct brc_measured){NAN, no_peak};
    int64_t last = c->step[brc_curve_peak_row(&sim->rig)];
    double area = 0, sum = 0;
    size_t k = 0, row = 0;
    for (; k < e->table.n && e->step[k] <= last; k++)
        area += e->area[k];
    if (k == 0)
        return (struct brc_measured){NAN, no_break};
    for (k = 0; k < e->table.n && (sum += e->area[k]) < FIRST_PART * area; k++)
        ;
    while (c->step[row] < e->step[k]) /* ends at the peak's row */
        row++;
    return (struct brc_measured){c->stress[row], NULL};
}

void brc_curve_peak_results(const struct brc_sim *sim, struct brc_measured *out)
{
    const struct brc_rig *rig = &sim->rig;
    const char *note = brc_curve_why_no_peak(rig);
    const double value[] = {rig->force_peak / rig->section, rig->strain_peak - rig->stage_strain,
                            rig->force_peak};
    for (int i = 0; i < 3; i++)
        out[i] = (struct brc_measured){note ? NAN : value[i], note ? note : peak_note(rig)};
    out[3] = first_broken(sim, note);
}
