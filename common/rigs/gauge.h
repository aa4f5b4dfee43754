/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strain of the specimen's middle, where platens and grips do not disturb it. */
#ifndef BRC_GAUGE_H
#define BRC_GAUGE_H

#include "common/base/brc.h"

/* Fills rig.has_gauge: whether the gauge holds at least 4 grains whose places along x, y and z have
 * a standard deviation of at least a tenth of the gauge's length along the load, of the specimen's
 * width across it. When platens and grains have their first places. */
void brc_gauge_check(struct brc_sim *sim);
/* Least-squares slope of the displacement along k against the first place along k, over the grains
 * of the gauge; the minus sign makes shortening positive. NAN without a gauge along k. */
double brc_gauge_strain(const struct brc_sim *sim, int k);

#endif
