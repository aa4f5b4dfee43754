/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Folders and the paths in them: made, checked, and cleared of files. Used by all that writes
 * results or a cache; knows nothing of what the files are. */
#ifndef BRC_FOLDERS_H
#define BRC_FOLDERS_H

#include "common/base/error.h"

/* PATH_MAX of Linux. A path that is longer is an error and never cut: a cut one would name another
 * file. */
enum { BRC_PATH_SIZE = 4096 };

/* dir/name in path; a longer one is BRC_ERR_INPUT. */
int brc_folder_path(struct brc_context *ctx, const char *dir, const char *name,
                    char path[BRC_PATH_SIZE]);
/* Makes a folder and those above it. */
int brc_folder_make(struct brc_context *ctx, const char *dir);
/* Fails unless the folder, or the nearest one above it that is there, takes new files. */
int brc_folder_check_writable(struct brc_context *ctx, const char *dir);
/* dir holds something of that name, be it a link that leads nowhere. */
bool brc_folder_has(const char *dir, const char *name);
/* Removes a file; one that is not there is no failure. */
int brc_folder_remove(struct brc_context *ctx, const char *dir, const char *name);

#endif
