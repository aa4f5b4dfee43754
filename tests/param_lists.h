/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Judges declarations of parameters, for tests over every list. The program itself relies on them:
 * it would find a fault of a list only when a case gives that key. */
#ifndef BRC_TESTS_PARAM_LISTS_H
#define BRC_TESTS_PARAM_LISTS_H

#include "common/input/params.h"

/* Keys unique and in snake case, units known, ranges readable, defaults in range, and each default
 * the same after writing and reading. */
int param_list_check(struct brc_context *ctx, const char *title, struct brc_param_list list);

#endif
