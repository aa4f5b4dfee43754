/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/runs/task.h"

#include <inttypes.h>
#include <stdio.h>

int brc_task_folder(struct brc_context *ctx, const char *dir, const char *group, uint64_t key,
                    char path[BRC_PATH_SIZE])
{
    char name[64];
    snprintf(name, sizeof name, "%s/%016" PRIx64, group, key);
    return brc_folder_path(ctx, dir, name, path);
}

static int check_place(struct brc_context *ctx, const struct brc_run_options *o)
{
    int code = brc_run_check_folder(ctx, o);
    return code == BRC_ERR_INPUT ? (ctx->code = BRC_ERR_USAGE) : code;
}

int brc_task_run(struct brc_context *ctx, const struct brc_case *run_case,
                 const struct brc_model *model, const char *dir, bool goes_on,
                 struct brc_progress *progress, struct brc_summary *out)
{
    struct brc_specimen specimen = {0};
    bool has_begun = brc_run_has_begun(dir);
    goes_on = goes_on && has_begun && brc_folder_has(dir, "state.h5");
    const struct brc_run_options options = {.run_case = run_case,
                                            .model = model,
                                            .specimen = &specimen,
                                            .dir = dir,
                                            .is_resumed = goes_on,
                                            .is_forced = has_begun && !goes_on,
                                            .progress = progress};
    int code = brc_specimen_create(ctx, &run_case->specimen, &specimen);
    if (code == 0)
        code = check_place(ctx, &options);
    if (code == 0)
        code = brc_run(ctx, &options, out);
    brc_specimen_free(&specimen);
    return code;
}

bool brc_task_is_result(int code)
{
    return code == BRC_ERR_BLOWUP || code == BRC_ERR_ENERGY || code == BRC_ERR_INPUT ||
           code == BRC_ERR_GEOMETRY;
}
