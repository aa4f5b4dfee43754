/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sections of a case, by number: those that every case may have, then one a registered model;
 * and the models themselves. The lowest part of the case: reading, keeping and checking stand on
 * it. */
#ifndef BRC_CASE_SECTIONS_H
#define BRC_CASE_SECTIONS_H

#include "common/input/params.h"
#include "common/rigs/rigs.h"

struct brc_case;

/* Name and list of section number i, false past the last. Numbers are those of this build: they are
 * not saved. */
bool brc_case_section(int i, const char **name, struct brc_param_list *list);
/* The number of a section and its list; -1, and a list of no use, where there is none. */
int brc_case_find_section(const char *name, struct brc_param_list *list);
/* The filled parameters of section number i. */
const void *brc_case_values(const struct brc_case *run_case, int i);
void *brc_case_section_values(struct brc_case *run_case, int i);

/* A registered model by name; an unknown one is an error that lists all. */
int brc_case_model(struct brc_context *ctx, const char *name, const struct brc_model **model);
/* The models that a case compares: those that it names, in its order, else all; at most cap. An
 * unknown name is an error that lists all, and so are more than cap. */
int brc_case_models(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model **model, int cap, int *n);
/* The filled parameters of a model. */
const void *brc_case_params(const struct brc_case *run_case, const struct brc_model *model);

#endif
