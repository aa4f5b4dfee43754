/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case: its file read and checked as a whole, all sections of all models included, so that a
 * mistake anywhere ends before any work is done. */
#ifndef BRC_CASE_H
#define BRC_CASE_H

#include "common/engine/sim.h"
#include "common/input/casefile.h"
#include "common/rigs/rigs.h"
#include "common/output/output.h"
#include "common/runs/case_sections.h"

enum { BRC_CASE_N_COMMON = 4, BRC_CASE_MAX_SECTIONS = BRC_CASE_N_COMMON + 32 + BRC_MAX_RIGS };

struct brc_case {
    struct brc_casefile file;
    char name[BRC_CASEFILE_KEY_SIZE * 2]; /* of the case: its file name without folder and ending */
    struct brc_specimen_params specimen;
    struct brc_test_params test;
    struct brc_run_params run;
    struct brc_output_params output;
    /* One filled struct a section. The common ones are the members above, so a case must not be
     * copied; those of models and tests are owned, and are known by their lists alone. */
    void *values[BRC_CASE_MAX_SECTIONS];
};

/* Reads a case with n overrides "section.key=value". Files that the case names are looked up from
 * the folder of the case file (from the working folder when the case comes through a pipe), those
 * of overrides from the working folder. Freed by brc_case_free, also after a failure. */
int brc_case_read(struct brc_context *ctx, struct brc_case *run_case, const char *path,
                  const char *const *overrides, int n);
/* The same from a text that path names, without overrides. */
int brc_case_parse(struct brc_context *ctx, struct brc_case *run_case, const char *path,
                   const char *text);
/* The case with n further overrides. */
int brc_case_change(struct brc_context *ctx, const struct brc_case *run_case,
                    const char *const *overrides, int n, struct brc_case *out);
void brc_case_free(struct brc_case *run_case);
/* A simulation of the case with one of its models on the specimen that it has made, which must
 * outlive it. */
int brc_case_sim(struct brc_context *ctx, const struct brc_case *run_case,
                 const struct brc_model *model, const struct brc_specimen *specimen,
                 struct brc_sim *sim);
/* Puts "file:line: " before a message about bad input that names a key as section.key: where the
 * case gives that key, or its section, its value. For failures after brc_case_read. */
void brc_case_locate(struct brc_context *ctx, const struct brc_case *run_case);

#endif
