/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run of many: from its case to a summary, in a folder of its own that is found again by the
 * run's key. Called in the processes of sweeps and ladders; it knows neither. */
#ifndef BRC_TASK_H
#define BRC_TASK_H

#include "common/base/folders.h"
#include "common/runs/run.h"

/* dir/<group>/<key>: where the run lies while it is unfinished, whatever is asked for the next
 * time. */
int brc_task_folder(struct brc_context *ctx, const char *dir, const char *group, uint64_t key,
                    char path[BRC_PATH_SIZE]);
/* Makes the specimen and runs. A run that was stopped goes on from its state where goes_on; one
 * that has saved none starts anew. What is in the way of a run (its folder) is BRC_ERR_USAGE, so
 * that it is not taken for a fault of the case. */
int brc_task_run(struct brc_context *ctx, const struct brc_case *run_case,
                 const struct brc_model *model, const char *dir, bool goes_on,
                 struct brc_progress *progress, struct brc_summary *out);
/* Whether a failure is what the case leads to: to do the run again would give it again. */
bool brc_task_is_result(int code);

#endif
