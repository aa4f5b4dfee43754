/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the ledger's terms add up to, and whether a run can be trusted. Terms are booked where they
 * arise: by models, platens, integrator, mass scaling and loading. */
#include "common/engine/ledger.h"

#include <math.h>

double brc_ledger_imbalance(const struct brc_ledger *l)
{
    double sum = -l->start;
#define BRC_LEDGER_SUM(name, sign, meaning) sum += (sign)*l->name;
    BRC_LEDGER_TERMS(BRC_LEDGER_SUM)
#undef BRC_LEDGER_SUM
    return sum;
}

static double work_of(const struct brc_ledger *l)
{
    return fabs(l->boundary) + fabs(l->gravity) + fabs(l->start);
}

/* Part of the energy that went through the specimen; 1 for energy out of nothing. */
static double part_of_work(const struct brc_ledger *l, double energy)
{
    double scale = work_of(l);
    if (scale > 0)
        return fabs(energy) / scale;
    return energy != 0 ? 1 : 0;
}

double brc_ledger_residual(const struct brc_ledger *l)
{
    return part_of_work(l, brc_ledger_imbalance(l));
}

static double drift_of(const struct brc_ledger *l, const double stored[3])
{
    double kept = l->bond + l->contact_normal + l->contact_shear;
    return kept - (stored[0] + stored[1] + stored[2]);
}

double brc_ledger_drift(const struct brc_ledger *l, const double stored[3])
{
    return part_of_work(l, drift_of(l, stored));
}

/* Both errors count in energy first, in parts of the work only then: of a specimen that nothing has
 * loaded any part is large. The comparison is written so that values that are no numbers fail it.
 */
enum brc_energy_check brc_ledger_check(const struct brc_ledger *l, const double stored[3],
                                       double noise)
{
    double lost = fabs(brc_ledger_imbalance(l)), moved = fabs(drift_of(l, stored));
    double scale = fmax(work_of(l), noise);
    if (lost <= noise && moved <= noise)
        return BRC_ENERGY_GOOD;
    if (!(lost < BRC_ENERGY_ERROR * scale && moved < BRC_ENERGY_ERROR * scale))
        return BRC_ENERGY_WRONG;
    return fmax(lost, moved) < BRC_ENERGY_DOUBT * scale ? BRC_ENERGY_GOOD : BRC_ENERGY_DOUBTFUL;
}
