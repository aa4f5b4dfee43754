/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fuzz_aid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char own_path[64];

_Noreturn void fuzz_end(const char *file, int line, const char *what, const char *more)
{
    fprintf(stderr, "%s:%d: does not hold: %s%s%s\n", file, line, what, more ? ": " : "",
            more ? more : "");
    abort();
}

void fuzz_check_record(const struct brc_context *ctx, int code)
{
    FUZZ_MUST(ctx->code == code);
    FUZZ_MUST(code <= 0 && code != BRC_ERR_INTERNAL);
    FUZZ_MUST((code == 0) == (ctx->message[0] == '\0'));
    for (const char *c = ctx->message; *c; c++)
        if ((unsigned char)*c < 0x20)
            fuzz_end(__FILE__, __LINE__, "a message is one line", ctx->message);
}

static void remove_own(void)
{
    unlink(own_path);
}

const char *fuzz_path(void)
{
    if (!*own_path) {
        const char *folder = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
        snprintf(own_path, sizeof own_path, "%s/breccia-fuzz-%ld", folder, (long)getpid());
        atexit(remove_own);
    }
    return own_path;
}

void fuzz_write(const void *bytes, size_t size)
{
    FILE *file = fopen(fuzz_path(), "wb");
    FUZZ_MUST(file != NULL);
    FUZZ_MUST(fwrite(bytes, 1, size, file) == size);
    FUZZ_MUST(fclose(file) == 0);
}
