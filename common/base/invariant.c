/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/invariant.h"

#include <stdio.h>
#include <stdlib.h>

/* abort rather than exit: debuggers stop there, and fuzzers count it as a find. */
void brc_assert_failed(const char *condition, const char *file, int line)
{
    fprintf(stderr, "%s:%d: the invariant does not hold: %s\n", file, line, condition);
    abort();
}
