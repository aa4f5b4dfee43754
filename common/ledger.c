/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ledger.h"

#include <math.h>

double brc_ledger_imbalance(const struct brc_ledger *l)
{
    double sum = -l->start;
#define BRC_LEDGER_SUM(name, sign, meaning) sum += (sign)*l->name;
    BRC_LEDGER_TERMS(BRC_LEDGER_SUM)
#undef BRC_LEDGER_SUM
    return sum;
}

/* Part of the energy that went through the specimen; 1 for energy out of nothing. */
static double part_of_work(const struct brc_ledger *l, double energy)
{
    double scale = fabs(l->boundary) + fabs(l->gravity) + fabs(l->start);
    if (scale > 0)
        return fabs(energy) / scale;
    return energy != 0 ? 1 : 0;
}

double brc_ledger_residual(const struct brc_ledger *l)
{
    return part_of_work(l, brc_ledger_imbalance(l));
}

double brc_ledger_drift(const struct brc_ledger *l, const double stored[3])
{
    double kept = l->bond + l->contact_normal + l->contact_shear;
    return part_of_work(l, kept - (stored[0] + stored[1] + stored[2]));
}
