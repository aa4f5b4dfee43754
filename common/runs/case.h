/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case: its file read and checked as a whole, all sections of all models included, so that a
 * mistake anywhere ends before any work is done. */
#ifndef BRC_CASE_H
#define BRC_CASE_H

#include "common/input/casefile.h"
#include "common/output/output.h"
#include "common/engine/sim.h"

enum { BRC_CASE_MAX_MODELS = 32 };

struct brc_case {
    struct brc_casefile file;
    char name[BRC_CASEFILE_KEY_SIZE * 2]; /* of the case: its file name without folder and ending */
    struct brc_specimen_params specimen;
    struct brc_test_params test;
    struct brc_run_params run;
    struct brc_output_params output;
    int n_models;                            /* registered */
    void *model_params[BRC_CASE_MAX_MODELS]; /* one filled struct a registered model; owned */
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
/* The text of a case in the folder dir, which is there, that makes this case with the model,
 * without any option: overrides are values in it, and files are named as dir sees them. Else it is
 * the user's text. Allocated, to be freed by the caller. */
int brc_case_keep(struct brc_context *ctx, const struct brc_case *run_case,
                  const struct brc_model *model, const char *dir, char **text);
void brc_case_free(struct brc_case *run_case);
/* A registered model by name; an unknown one is an error that lists all. */
int brc_case_model(struct brc_context *ctx, const char *name, const struct brc_model **model);
/* The models that a case compares: those that it names, else all; at most cap. */
int brc_case_models(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model **model, int cap, int *n);
/* The filled parameters of a model. */
const void *brc_case_params(const struct brc_case *run_case, const struct brc_model *model);
/* All parameters that a run's states depend on, one "section.key = value" a line; allocated, to be
 * freed by the caller, NULL when out of memory. Names of files are left out: what counts is their
 * content, which the specimen's hash tells. */
char *brc_case_text(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model *model);
/* Fails when two such texts differ in more than the conditions that end a run, naming the first
 * key. */
int brc_case_same(struct brc_context *ctx, const char *saved, const char *now);

/* Puts "file:line: " before a message about bad input that names a key as section.key: where the
 * case gives that key, or its section, its value. For failures after brc_case_read. */
void brc_case_locate(struct brc_context *ctx, const struct brc_case *run_case);

/* The key holds the name of a file. */
bool brc_case_names_file(const char *section, const struct brc_param *p);
/* Two paths lead to one file that is there. */
bool brc_case_is_same_file(const char *name, const char *path);
/* The file at path is the case file or one that it names, by whatever path. */
bool brc_case_is_input(const struct brc_case *run_case, const char *path);
/* Names of files of the filled case as the working folder sees them. Done by brc_case_read. */
int brc_case_find_files(struct brc_context *ctx, struct brc_case *run_case);

/* The filled parameters of section number i, see below. */
const void *brc_case_values(const struct brc_case *run_case, int i);
/* The sections that every case may have, and those of the models: name and list of number i, false
 * past the last. */
bool brc_case_section(int i, const char **name, struct brc_param_list *list);

#endif
