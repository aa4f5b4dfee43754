/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One list of error codes with texts and exit statuses; the context that records the first failure.
 * Every function that can fail returns int: 0 on success, a negative code of this list otherwise.
 * The context is handed down from the caller and is no variable of the process, so that a program
 * may hold several simulations. Bad input is an error, never a clamped value: whoever asked for
 * something else than what was computed would not notice. Slips of the program itself are
 * BRC_ASSERT (invariant.h). */
#ifndef BRC_ERROR_H
#define BRC_ERROR_H

#include "common/base/brc.h"

/* name, code, exit status of the program, text. Statuses are for scripts and stay what they are;
 * several codes share one where a script would do the same about them. */
#define BRC_ERRORS(X)                                                        \
    X(BRC_OK, 0, 0, "success")                                               \
    X(BRC_ERR_INTERNAL, -1, 1, "internal error")                             \
    X(BRC_ERR_USAGE, -2, 2, "bad command line")                              \
    X(BRC_ERR_INPUT, -3, 3, "bad input")                                     \
    X(BRC_ERR_GEOMETRY, -4, 3, "impossible geometry")                        \
    X(BRC_ERR_IO, -5, 4, "input or output failed")                           \
    X(BRC_ERR_MEMORY, -6, 5, "out of memory")                                \
    X(BRC_ERR_BLOWUP, -7, 6, "the simulation became unstable")               \
    X(BRC_ERR_INTERRUPTED, -8, 7, "interrupted")                             \
    X(BRC_ERR_ENERGY, -9, 8, "the energy does not add up; results are kept") \
    X(BRC_ERR_NOT_BEGUN, -10, 7, "interrupted before anything was saved")    \
    X(BRC_ERR_RUNS, -11, 9, "runs of a sweep failed; the others are kept")

enum brc_error_code {
#define BRC_ERROR_ENUM(name, code, status, text) name = (code),
    BRC_ERRORS(BRC_ERROR_ENUM)
#undef BRC_ERROR_ENUM
};

/* Room for two paths of the largest length; a message that is cut all the same ends in "...". */
enum { BRC_MESSAGE_SIZE = 10000 };

/* The context of a run. Created by the caller with BRC_CONTEXT_INIT; outlives everything else. */
struct brc_context {
    int code; /* first failure, 0 when none */
    /* what went wrong and what to do, one line, without file and line of source */
    char message[BRC_MESSAGE_SIZE];
    const char *file; /* source place of the failure, for developers */
    int line;
    int quiet;                   /* 1: no log lines */
    const struct brc_comm *comm; /* the ranks that share the run; NULL: this process alone */
};

#define BRC_CONTEXT_INIT \
    {                    \
        0                \
    }

/* Records the first failure (later ones are dropped) and returns code. */
int brc_error_set(struct brc_context *ctx, int code, const char *file, int line, const char *format,
                  ...) __attribute__((format(printf, 5, 6)));
/* Exit status of the program for a code; 1 for what is not of the list. */
int brc_error_exit_status(int code);
/* Forgets a recorded failure, so that the context can be used again. */
void brc_error_clear(struct brc_context *ctx);

/* Returns from the calling function with a recorded error. The comma lets compilers see that the
 * result is not 0. */
#define BRC_FAIL(ctx, code, ...) \
    return (void)brc_error_set((ctx), (code), __FILE__, __LINE__, __VA_ARGS__), (code)
/* Propagates a failure. */
#define BRC_TRY(call)              \
    do {                           \
        int brc_try_code = (call); \
        if (brc_try_code != 0)     \
            return brc_try_code;   \
    } while (0)

/* calloc that records BRC_ERR_MEMORY; returns NULL on failure. count 0 gives a valid pointer, so
 * that NULL always means a failure. */
void *brc_alloc(struct brc_context *ctx, size_t count, size_t size);
/* realloc likewise; the old block stays valid on failure. */
void *brc_realloc(struct brc_context *ctx, void *old, size_t count, size_t size);
/* Passes a block of count items on; where it is NULL, records BRC_ERR_MEMORY with their size. */
void *brc_alloc_check(struct brc_context *ctx, void *block, size_t count, size_t size);

/* One log line on standard error, unless ctx->quiet. */
void brc_log(const struct brc_context *ctx, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
