/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tessellation files of Neper (.tess): written in format 3.4, in metres; read in 2.0 and 3.x. So
 * microstructures that Neper makes become specimens, and those of breccia can be meshed or measured
 * by Neper's tools. */
#ifndef BRC_NEPER_H
#define BRC_NEPER_H

#include "common/specimen/specimen.h"

#include <stdio.h>

/* The cells of a specimen with its domain; weights of the seeds are the radii of the spheres. */
int brc_neper_write(struct brc_context *ctx, FILE *out, const struct brc_specimen *s);

/* Cells and domain of a file of which 1 is this many metres; domain face i of the file has the id
 * i. Seeds outside of their cells are replaced by the centres; radii are the weights where
 * has_spheres says so, else 0. Cells must be convex with flat faces. */
int brc_neper_read(struct brc_context *ctx, const char *path, double metres, bool has_spheres,
                   struct brc_convex *domain, struct brc_facets *out);

#endif
