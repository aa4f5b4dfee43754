/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a state or a frame holds, as `breccia info` prints it: case, seed, version, step, and each
 * field with its unit and meaning. */
#ifndef BRC_INFO_H
#define BRC_INFO_H

#include "common/base/error.h"

#include <stdio.h>

/* Fails on a file that is neither of the two, or is damaged; what was printed before that stands.
 */
int brc_info_print(struct brc_context *ctx, FILE *out, const char *path);

#endif
