/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keys that other keys make meaningless: `diameter` of a box, `dt` in the quasi-static regime. Each
 * parameter declares when it applies (brc_param.applies); this judges what a case gives. */
#ifndef BRC_APPLIES_H
#define BRC_APPLIES_H

#include "common/runs/case.h"

/* Whether the key applies with the values of the case: NULL in *clause, else the clause that fails,
 * up to its end or a comma. An expression that cannot be read is an internal error. */
int brc_applies(struct brc_context *ctx, const struct brc_case *run_case, const char *section,
                const struct brc_param *p, const char **clause);
/* Judges the keys that the case gives in this section of it. One that does
 * not apply is an error that names those that do in its place; but where an override of --set is
 * what makes a key of the file meaningless, the key gets its default: the user has said that this
 * run is another one. */
int brc_applies_check(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_case_section *section);

#endif
