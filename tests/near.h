/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparisons of floating-point numbers for cmocka tests. They print both numbers when they fail.
 * Includes cmocka with what it needs, so that a test includes only this. */
#ifndef BRC_TESTS_NEAR_H
#define BRC_TESTS_NEAR_H

#include "common/base/error.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

/* Passes when |value - expected| <= abs + rel |expected|; a NaN never passes. */
#define CHECK_NEAR(value, expected, abs, rel) \
    brc_check_near((value), (expected), (abs), (rel), #value, __FILE__, __LINE__)
/* The same for n values. */
#define CHECK_NEAR_ARRAY(value, expected, n, abs, rel) \
    brc_check_near_array((value), (expected), (n), (abs), (rel), #value, __FILE__, __LINE__)
/* low <= value <= high; a NaN never passes. */
#define CHECK_BETWEEN(value, low, high) \
    brc_check_between((value), (low), (high), #value, __FILE__, __LINE__)
/* The call succeeds; prints the recorded message otherwise. */
#define CHECK_OK(ctx, call) brc_check_code((ctx), (call), 0, NULL, #call, __FILE__, __LINE__)
/* The call fails with this code and a message that holds the text (NULL: any); clears the record.
 */
#define CHECK_FAILS(ctx, call, code, text) \
    brc_check_code((ctx), (call), (code), (text), #call, __FILE__, __LINE__)

static inline void brc_check_near(double value, double expected, double abs, double rel,
                                  const char *what, const char *file, int line)
{
    double allowed = abs + rel * fabs(expected);
    if (fabs(value - expected) <= allowed || value == expected)
        return;
    print_error("%s: %.17g, expected %.17g: off by %.3g, allowed %.3g\n", what, value, expected,
                value - expected, allowed);
    _fail(file, line);
}

static inline void brc_check_near_array(const double *value, const double *expected, size_t n,
                                        double abs, double rel, const char *what, const char *file,
                                        int line)
{
    for (size_t i = 0; i < n; i++) {
        if (!(fabs(value[i] - expected[i]) <= abs + rel * fabs(expected[i])))
            print_error("entry %zu of %zu of ", i, n);
        brc_check_near(value[i], expected[i], abs, rel, what, file, line);
    }
}

static inline void brc_check_between(double value, double low, double high, const char *what,
                                     const char *file, int line)
{
    if (value >= low && value <= high)
        return;
    print_error("%s: %.17g is not in [%.17g, %.17g]\n", what, value, low, high);
    _fail(file, line);
}

static inline void brc_check_code(struct brc_context *ctx, int code, int expected, const char *text,
                                  const char *what, const char *file, int line)
{
    bool has_text = text == NULL || strstr(ctx->message, text) != NULL;
    if (code != expected || !has_text) {
        print_error("%s: code %d, expected %d%s%s; message: %s\n", what, code, expected,
                    text ? " and the text " : "", text ? text : "", ctx->message);
        _fail(file, line);
    }
    if (expected != 0)
        brc_error_clear(ctx);
}

#endif
