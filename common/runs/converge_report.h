/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors and costs of the settings of a model, from its finished runs: what table and chart show.
 */
#ifndef BRC_CONVERGE_REPORT_H
#define BRC_CONVERGE_REPORT_H

#include "common/runs/converge_study.h"

extern const double brc_converge_within[2]; /* 1 % and 5 % */

/* From the finished runs of model number `model`; runs that are not done count as lost. */
void brc_converge_report_make(const struct brc_converge_study *study, int model,
                              struct brc_converge_report *out);
/* Its error is smaller than this, with chance and the reference's uncertainty counted against it.
 */
bool brc_converge_is_shown(const struct brc_converge_report *r, int i, double error);

#endif
