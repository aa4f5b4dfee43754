/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text files that appear complete or not at all. For tables, summaries, scripts and kept cases;
 * states and frames, which have a checksum, are written by output/h5.c. */
#ifndef BRC_TEXT_FILE_H
#define BRC_TEXT_FILE_H

#include "common/base/folders.h"

#include <stdio.h>

/* A file that is written beside its place, with .part after its name, and renamed by the end. */
struct brc_text_file {
    FILE *out;
    char path[BRC_PATH_SIZE], part[BRC_PATH_SIZE];
};

/* dir/name; with dir NULL name is the whole path. After a failure there is nothing to end. */
int brc_text_file_begin(struct brc_context *ctx, struct brc_text_file *t, const char *dir,
                        const char *name);
/* Puts the file in its place; what was there stays when that fails, as on a full disk. */
int brc_text_file_end(struct brc_context *ctx, struct brc_text_file *t);
/* Ends it without a file, after a failure of what writes it. */
void brc_text_file_drop(struct brc_text_file *t);
/* A file with this text, from begin to end. */
int brc_text_file_write(struct brc_context *ctx, const char *dir, const char *name,
                        const char *text);

#endif
