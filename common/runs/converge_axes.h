/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a ladder: which keys of the case change, and to what. Called by converge.c. */
#ifndef BRC_CONVERGE_AXES_H
#define BRC_CONVERGE_AXES_H

#include "common/runs/converge_study.h"

/* The names that the options list, or those that are meant when they list none; an unknown one is
 * an error that names all. The models of the study must be known. */
int brc_converge_read_axes(struct brc_context *ctx, const struct brc_converge_study *study,
                           struct brc_converge_axes *axes);
/* The first settings; then, when the mean rate is known, those of the axes. A value out of a key's
 * range is left out, with a log line. */
int brc_converge_first_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                                struct brc_converge_model *m);
int brc_converge_axis_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                               const struct brc_converge_axes *axes, struct brc_converge_model *m);
/* The case of a setting on specimen number i; freed by brc_case_free, also after a failure. */
int brc_converge_case(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_converge_setting *s, int i, struct brc_case *out);

#endif
