/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the fuzz targets. */
#ifndef BRC_TESTS_FUZZ_AID_H
#define BRC_TESTS_FUZZ_AID_H

#include "common/base/error.h"

/* Ends the program where a condition does not hold, so that a fuzzer keeps the input. */
#define FUZZ_MUST(condition) \
    ((condition) ? (void)0 : fuzz_end(__FILE__, __LINE__, #condition, NULL))

_Noreturn void fuzz_end(const char *file, int line, const char *what, const char *more);
/* A failure is recorded with one line of text; success records nothing. */
void fuzz_check_record(const struct brc_context *ctx, int code);
/* Path of a file of this process alone that is removed at the end, and writing it. */
const char *fuzz_path(void);
void fuzz_write(const void *bytes, size_t size);

#endif
