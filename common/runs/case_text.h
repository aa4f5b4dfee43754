/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameters of a run as text: what states keep to know whether the case that resumes them is
 * theirs. run.c and case_keep.c call it; it knows sections and parameters, and no file. */
#ifndef BRC_CASE_TEXT_H
#define BRC_CASE_TEXT_H

#include "common/runs/case.h"

/* All parameters that a run's states depend on, one "section.key = value" a line; allocated, to be
 * freed by the caller, NULL when out of memory. Names of files are left out: what counts is their
 * content, which the specimen's hash tells. */
char *brc_case_text(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model *model);
/* Fails when two such texts differ in more than the conditions that end a run, naming the first
 * key. */
int brc_case_same(struct brc_context *ctx, const char *saved, const char *now);

#endif
