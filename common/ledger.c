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

double brc_ledger_residual(const struct brc_ledger *l)
{
    double scale = fabs(l->boundary) + fabs(l->gravity) + fabs(l->start);
    double imbalance = fabs(brc_ledger_imbalance(l));
    if (scale > 0)
        return imbalance / scale;
    return imbalance > 0 ? 1 : 0; /* energy out of nothing */
}
