/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file is checked before it is opened, since opening some devices does something, and again once
 * it is open, since it may have been replaced in between. */
#include "common/base/input_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* What a pipe holds on Linux: one read takes all that is there. */
enum { FIRST_SIZE = 1 << 16 };

static int fail_read(struct brc_context *ctx, const struct brc_input *in, const char *why)
{
    if (in->key)
        BRC_FAIL(ctx, BRC_ERR_IO, "%s: cannot read '%s': %s", in->key, in->path, why);
    BRC_FAIL(ctx, BRC_ERR_IO, "cannot read %s%s%s: %s", in->noun ? in->noun : "",
             in->noun ? " " : "", in->path, why);
}

static int fail_large(struct brc_context *ctx, const struct brc_input *in, size_t largest)
{
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s%s%s: %s is larger than %zu bytes%s", in->key ? in->key : "",
             in->key ? ": " : "", in->path, in->noun ? in->noun : "the file", largest,
             largest < in->largest ? ", the most that is read from a pipe; copy it to a file first"
                                   : "");
}

static size_t largest_of(const struct brc_input *in, FILE *file)
{
    struct stat status;
    bool is_pipe = fstat(fileno(file), &status) == 0 && S_ISFIFO(status.st_mode);
    return is_pipe && in->largest > BRC_INPUT_LARGEST_PIPE ? BRC_INPUT_LARGEST_PIPE : in->largest;
}

static int check_kind(struct brc_context *ctx, const struct brc_input *in,
                      const struct stat *status)
{
    if (S_ISDIR(status->st_mode))
        return fail_read(ctx, in, "it is a folder, not a file");
    if (S_ISFIFO(status->st_mode) && in->is_plain)
        return fail_read(ctx, in, "it is a pipe; copy it to a file first");
    if (!S_ISREG(status->st_mode) && !S_ISFIFO(status->st_mode))
        return fail_read(ctx, in, "it is a device or a socket; give a file, or a pipe that ends");
    if (S_ISREG(status->st_mode) && (uint64_t)status->st_size > in->largest)
        return fail_large(ctx, in, in->largest);
    return 0;
}

/* Opening a terminal or a tape may do something, and a pipe without a writer waits: hence the check
 * before. The file may be another one by then: hence the check after. */
int brc_input_open(struct brc_context *ctx, const struct brc_input *in, FILE **file, size_t *size)
{
    struct stat status;
    *file = NULL;
    if (stat(in->path, &status) != 0)
        return fail_read(ctx, in, strerror(errno));
    BRC_TRY(check_kind(ctx, in, &status));
    *file = fopen(in->path, "rb");
    if (!*file)
        return fail_read(ctx, in, strerror(errno));
    int code = fstat(fileno(*file), &status) == 0 ? check_kind(ctx, in, &status)
                                                  : fail_read(ctx, in, strerror(errno));
    if (code != 0) {
        fclose(*file);
        *file = NULL;
    }
    if (size)
        *size = (size_t)status.st_size;
    return code;
}

/* The size that the system tells is a first guess only: it tells none for pipes. */
static int read_all(struct brc_context *ctx, const struct brc_input *in, FILE *file, size_t guess,
                    char **text, size_t *n)
{
    size_t largest = largest_of(in, file), cap = guess < largest ? guess + 1 : FIRST_SIZE;
    for (*n = 0;; cap = cap < FIRST_SIZE ? FIRST_SIZE : 2 * cap) {
        if (cap > largest + 1)
            cap = largest + 1;
        char *longer = brc_realloc(ctx, *text, cap + 1, 1);
        if (!longer)
            return BRC_ERR_MEMORY;
        *text = longer;
        errno = 0;
        *n += fread(*text + *n, 1, cap - *n, file);
        (*text)[*n] = '\0';
        if (ferror(file))
            return fail_read(ctx, in, strerror(errno));
        if (*n > largest)
            return fail_large(ctx, in, largest);
        if (feof(file))
            return 0;
    }
}

int brc_input_read(struct brc_context *ctx, const struct brc_input *in, char **text, size_t *n)
{
    FILE *file;
    size_t size;
    *text = NULL;
    *n = 0;
    BRC_TRY(brc_input_open(ctx, in, &file, &size));
    int code = read_all(ctx, in, file, size, text, n);
    fclose(file);
    if (code != 0) {
        free(*text);
        *text = NULL;
    }
    return code;
}
