/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/folders.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int brc_folder_path(struct brc_context *ctx, const char *dir, const char *name,
                    char path[BRC_PATH_SIZE])
{
    if (snprintf(path, BRC_PATH_SIZE, "%s/%s", dir, name) >= BRC_PATH_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "the path %.80s... is too long", dir);
    return 0;
}

/* The slash at the end makes the last part like those before it. */
int brc_folder_make(struct brc_context *ctx, const char *dir)
{
    char part[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, "", part));
    for (char *c = part + 1; *c; c++) {
        if (*c != '/')
            continue;
        *c = '\0';
        struct stat status;
        if (mkdir(part, 0777) != 0 && errno != EEXIST)
            BRC_FAIL(ctx, BRC_ERR_IO, "cannot make the folder %s: %s", part, strerror(errno));
        if (stat(part, &status) == 0 && !S_ISDIR(status.st_mode))
            BRC_FAIL(ctx, BRC_ERR_IO, "%s is not a folder; choose another with -o", part);
        *c = '/';
    }
    return 0;
}

/* Without making anything: a run that is refused later must leave no folder. access() is asked
 * rather than the mode bits, which do not know of read-only mounts. */
int brc_folder_check_writable(struct brc_context *ctx, const char *dir)
{
    char path[BRC_PATH_SIZE];
    struct stat status;
    BRC_TRY(brc_folder_path(ctx, dir, "", path));
    while (stat(path, &status) != 0) {
        char *slash = strrchr(path, '/');
        if (slash == path || !slash)
            snprintf(path, sizeof path, slash ? "/" : ".");
        else
            *slash = '\0';
    }
    if (!S_ISDIR(status.st_mode))
        BRC_FAIL(ctx, BRC_ERR_IO, "%s is not a folder; choose another with -o", path);
    if (access(path, W_OK | X_OK) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write to the folder %s: %s; choose another with -o", path,
                 strerror(errno));
    return 0;
}

/* lstat, as a link that leads nowhere is somebody's file, too, and would be written through. */
bool brc_folder_has(const char *dir, const char *name)
{
    char path[BRC_PATH_SIZE];
    struct brc_context quiet = BRC_CONTEXT_INIT;
    struct stat status;
    return brc_folder_path(&quiet, dir, name, path) == 0 && lstat(path, &status) == 0;
}

int brc_folder_remove(struct brc_context *ctx, const char *dir, const char *name)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, name, path));
    if (unlink(path) != 0 && errno != ENOENT)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot remove %s: %s", path, strerror(errno));
    return 0;
}
