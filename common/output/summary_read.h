/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A summary.json of this program, read back: for what looks at runs that have ended long ago. */
#ifndef BRC_SUMMARY_READ_H
#define BRC_SUMMARY_READ_H

#include "common/base/error.h"

/* The text of dir/summary.json, to be freed; an error where there is none that a run has written.
 */
int brc_summary_read(struct brc_context *ctx, const char *dir, char **text);
/* A text of the top level ("model", "state_hash"); "" where there is none. */
void brc_summary_text(const char *summary, const char *key, char *value, size_t size);
/* A result by name: false where the summary has none of that name. NAN: not measured, and note
 * says why. */
bool brc_summary_result(const char *summary, const char *name, double *value, char *note,
                        size_t size);

#endif
