/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of `breccia converge`: for readers, and as CSV. */
#ifndef BRC_CONVERGE_TABLE_H
#define BRC_CONVERGE_TABLE_H

#include "common/runs/converge_report.h"

/* report: one a model of the study. The CSV file is converge.csv in the folder of the options. */
void brc_converge_print(FILE *out, const struct brc_converge_study *study,
                        const struct brc_converge_report *report);
int brc_converge_csv(struct brc_context *ctx, const struct brc_converge_study *study,
                     const struct brc_converge_report *report);

#endif
