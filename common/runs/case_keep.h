/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The case that a run keeps in its folder, so that the folder alone can be run again. Called by
 * run.c. */
#ifndef BRC_CASE_KEEP_H
#define BRC_CASE_KEEP_H

#include "common/runs/case.h"

/* The text of a case in the folder dir, which is there, that makes this case with the model,
 * without any option: overrides are values in it, and files are named as dir sees them. Else it is
 * the user's text. Allocated, to be freed by the caller. */
int brc_case_keep(struct brc_context *ctx, const struct brc_case *run_case,
                  const struct brc_model *model, const char *dir, char **text);

#endif
