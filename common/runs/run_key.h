/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a result hangs on, as a text and its hash: the name of a run under which its result is kept.
 *
 * The text holds, in the order of the lists:
 *   - the versions of what computes (brc_physics): of the specimen, the engine, what tests share,
 *     the test, the model, and of each law of the model that the case chooses;
 *   - the model, and every key of the sections specimen, test, the test's own, run and the model's
 *     that applies (applies.h) with its value, given or default.
 * Left out are keys that change no bit (BRC_PARAM_COST), and keys at the value that their
 * declaration calls `off`: an option that is added later, and is off, leaves the name as it is; one
 * that is on, a default that changes, or a version that moves makes another name. A file stands
 * there by its content, and a key that was renamed by its older name. */
#ifndef BRC_RUN_KEY_H
#define BRC_RUN_KEY_H

#include "common/runs/case.h"

struct brc_run_key {
    char *text; /* a JSON object in one line, to be freed by the caller; NULL after a failure */
    uint64_t hash;
};
int brc_run_key_make(struct brc_context *ctx, const struct brc_case *run_case,
                     const struct brc_model *model, struct brc_run_key *out);
/* The part of the text that a section makes: `, "section.key": "value"` a key. */
int brc_run_key_section(struct brc_context *ctx, const struct brc_case *run_case,
                        const struct brc_case_section *s, FILE *out);

#endif
