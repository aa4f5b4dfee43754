/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first failure is kept and later ones are dropped: those that follow while a caller cleans up
 * say less about the cause. Messages are one line whatever they quote, so that scripts can count
 * them. */
#include "common/base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int brc_error_set(struct brc_context *ctx, int code, const char *file, int line, const char *format,
                  ...)
{
    if (ctx->code != 0)
        return code;
    ctx->code = code;
    ctx->file = file;
    ctx->line = line;
    va_list args;
    va_start(args, format);
    int n = vsnprintf(ctx->message, sizeof ctx->message, format, args);
    va_end(args);
    if (n >= BRC_MESSAGE_SIZE)
        strcpy(ctx->message + sizeof ctx->message - 4, "...");
    /* one line, whatever a bad file has put into it */
    for (char *c = ctx->message; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    return code;
}

int brc_error_exit_status(int code)
{
    switch (code) {
#define BRC_ERROR_STATUS(name, value, status, text) \
    case name:                                      \
        return status;
        BRC_ERRORS(BRC_ERROR_STATUS)
    default:
        return 1;
    }
}

void brc_error_clear(struct brc_context *ctx)
{
    ctx->code = 0;
    ctx->message[0] = '\0';
    ctx->file = NULL;
    ctx->line = 0;
}

void *brc_alloc_check(struct brc_context *ctx, void *block, size_t count, size_t size)
{
    if (!block)
        brc_error_set(ctx, BRC_ERR_MEMORY, __FILE__, __LINE__,
                      "out of memory: %zu items of %zu bytes; use fewer grains or a larger machine",
                      count, size);
    return block;
}

/* Sizes above PTRDIFF_MAX are refused here, since the product could overflow and realloc would then
 * succeed with a small block; calloc looks for itself. */
void *brc_realloc(struct brc_context *ctx, void *old, size_t count, size_t size)
{
    void *block = NULL;
    if (size == 0 || count <= PTRDIFF_MAX / size)
        block = realloc(old, count * size > 0 ? count * size : 1);
    return brc_alloc_check(ctx, block, count, size);
}

void *brc_alloc(struct brc_context *ctx, size_t count, size_t size)
{
    void *block = calloc(count > 0 ? count : 1, size > 0 ? size : 1);
    return brc_alloc_check(ctx, block, count, size);
}

void brc_log(const struct brc_context *ctx, const char *format, ...)
{
    if (ctx->quiet)
        return;
    va_list args;
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
}
