/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chart of `breccia converge`: error against cost, a panel a model. */
#ifndef BRC_CONVERGE_PLOT_H
#define BRC_CONVERGE_PLOT_H

#include "common/runs/converge_report.h"

/* converge.gp and converge.png */
int brc_converge_plot(struct brc_context *ctx, const struct brc_converge_study *study,
                      const struct brc_converge_report *report);

#endif
