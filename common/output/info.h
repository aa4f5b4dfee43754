/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a state or a frame holds, as `breccia info` prints it. */
#ifndef BRC_INFO_H
#define BRC_INFO_H

#include "common/base/error.h"

#include <stdio.h>

int brc_info_print(struct brc_context *ctx, FILE *out, const char *path);

#endif
