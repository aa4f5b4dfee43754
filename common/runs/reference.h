/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What this build has, for the reader of the terminal: keys, models, tests, as they declare
 * themselves. */
#ifndef BRC_REFERENCE_H
#define BRC_REFERENCE_H

#include "common/base/error.h"

/* The keys of a section, of all where it is NULL; an unknown one is BRC_ERR_USAGE. */
int brc_reference_params(struct brc_context *ctx, const char *section);
void brc_reference_models(void);
/* With the keys that each uses, and what it measures. */
void brc_reference_tests(void);

#endif
