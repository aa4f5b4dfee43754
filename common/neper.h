/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tessellation files of Neper (.tess), format 3.4, in metres. */
#ifndef BRC_NEPER_H
#define BRC_NEPER_H

#include "specimen.h"

#include <stdio.h>

/* The cells of a specimen with its domain; weights of the seeds are the radii of the spheres. */
int brc_neper_write(struct brc_context *ctx, FILE *out, const struct brc_specimen *s);

#endif
