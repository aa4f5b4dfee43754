/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that a case names. Names in a case are seen from its folder, those of --set from the
 * working folder, as a shell would complete them. Files are compared by device and inode: links and
 * `..` make paths useless for that. */
#include "common/runs/case_files.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* A case that comes through a pipe has no folder of its own. */
static bool has_folder(const char *path)
{
    struct stat status;
    return strchr(path, '/') && (stat(path, &status) != 0 || S_ISREG(status.st_mode));
}

/* A name that is an override, absolute, or of a case from a pipe stays as it is. */
static int find_file(struct brc_context *ctx, const struct brc_case *run_case, const char *key,
                     char *name)
{
    const char *path = run_case->file.path, *slash = strrchr(path, '/');
    char found[BRC_TEXT_SIZE];
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(&run_case->file, "specimen", key, brc_specimen_param_list);
    if (!e || e->is_override || *name == '\0' || *name == '/' || !has_folder(path))
        return 0;
    int n = snprintf(found, sizeof found, "%.*s%s", (int)(slash - path) + 1, path, name);
    if (n >= (int)sizeof found)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s:%d: specimen.%s: the path %.*s%s is longer than %d bytes; start breccia in a "
                 "folder that is nearer to it",
                 path, e->line, key, (int)(slash - path) + 1, path, name, BRC_TEXT_SIZE - 1);
    memcpy(name, found, sizeof found);
    return 0;
}

/* Which keys name files is said by their declarations, so that a new one needs no line here. */
int brc_case_find_files(struct brc_context *ctx, struct brc_case *run_case)
{
    for (int i = 0; i < brc_specimen_param_list.n; i++) {
        const struct brc_param *p = &brc_specimen_param_list.params[i];
        if (p->flags & BRC_PARAM_FILE)
            BRC_TRY(find_file(ctx, run_case, p->key, (char *)&run_case->specimen + p->offset));
    }
    return 0;
}

bool brc_case_is_same_file(const char *name, const char *path)
{
    struct stat a, b;
    return *name && stat(name, &a) == 0 && stat(path, &b) == 0 && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

bool brc_case_is_input(const struct brc_case *run_case, const char *path)
{
    bool is_input = brc_case_is_same_file(run_case->file.path, path);
    for (int i = 0; i < brc_specimen_param_list.n; i++) {
        const struct brc_param *p = &brc_specimen_param_list.params[i];
        if (p->flags & BRC_PARAM_FILE)
            is_input = is_input ||
                       brc_case_is_same_file((const char *)&run_case->specimen + p->offset, path);
    }
    return is_input;
}
