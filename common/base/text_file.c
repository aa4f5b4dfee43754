/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/text_file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

/* Beside its place and not in a folder for temporary files, since rename works within one file
 * system only. */
int brc_text_file_begin(struct brc_context *ctx, struct brc_text_file *t, const char *dir,
                        const char *name)
{
    int n = snprintf(t->path, sizeof t->path, "%s%s%s", dir ? dir : "", dir ? "/" : "", name);
    if (n >= BRC_PATH_SIZE ||
        snprintf(t->part, sizeof t->part, "%s.part", t->path) >= BRC_PATH_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "the path %.80s... is too long", t->path);
    t->out = fopen(t->part, "w");
    if (!t->out)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", t->part, strerror(errno));
    return 0;
}

/* Forced to disk before it is renamed: after a power cut some file systems would keep the new name
 * with no content. */
int brc_text_file_end(struct brc_context *ctx, struct brc_text_file *t)
{
    bool is_good = fflush(t->out) == 0 && !ferror(t->out) && fsync(fileno(t->out)) == 0;
    is_good = fclose(t->out) == 0 && is_good;
    if (is_good && rename(t->part, t->path) == 0)
        return 0;
    int reason = errno;
    unlink(t->part);
    BRC_FAIL(ctx, BRC_ERR_IO,
             "cannot write %s: %s; what was saved before stays: make room or choose another folder",
             t->path, strerror(reason));
}

void brc_text_file_drop(struct brc_text_file *t)
{
    fclose(t->out);
    unlink(t->part);
}

int brc_text_file_write(struct brc_context *ctx, const char *dir, const char *name,
                        const char *text)
{
    struct brc_text_file t;
    BRC_TRY(brc_text_file_begin(ctx, &t, dir, name));
    fputs(text, t.out);
    return brc_text_file_end(ctx, &t);
}
