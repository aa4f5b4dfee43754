/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sections of a case, by number: those that every case may have, one a registered model, one a
 * test that has keys of its own; and the models themselves. The lowest part of the case: reading,
 * keeping and checking stand on it. */
#ifndef BRC_CASE_SECTIONS_H
#define BRC_CASE_SECTIONS_H

#include "common/input/casefile.h"
#include "common/rigs/rigs.h"

struct brc_case;

struct brc_case_section {
    const char *name;
    struct brc_param_list list;
    void *values; /* the case's struct of the section; NULL where no case was given */
};

/* Section number i, false past the last. Numbers are those of this build: they are not saved. The
 * case may be NULL, for callers that ask for names and lists alone. */
bool brc_case_section(const struct brc_case *run_case, int i, struct brc_case_section *s);
/* By name; false, and a section without a list, where there is none. */
bool brc_case_find_section(const struct brc_case *run_case, const char *name,
                           struct brc_case_section *s);
/* The section and key that text begins with as "section.key"; false where it does not. Messages and
 * the texts of states name keys so. */
bool brc_case_key_at(const char *text, struct brc_case_section *s, char key[BRC_CASEFILE_KEY_SIZE]);
/* The values of a section alone; NULL where there is none, as of a test without keys of its own. */
const void *brc_case_values(const struct brc_case *run_case, const char *section);

/* A registered model by name; an unknown one is an error that lists all. */
int brc_case_model(struct brc_context *ctx, const char *name, const struct brc_model **model);
/* The models that a case compares: those that it names, in its order, else all; at most cap. An
 * unknown name is an error that lists all, and so are more than cap. */
int brc_case_models(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model **model, int cap, int *n);

#endif
