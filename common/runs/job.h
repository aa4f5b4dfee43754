/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A job: a case file read and judged as a whole, all sections of all models included, so that a
 * mistake anywhere ends before any work is done. */
#ifndef BRC_JOB_H
#define BRC_JOB_H

#include "common/input/casefile.h"
#include "common/output/output.h"
#include "common/engine/sim.h"

enum { BRC_JOB_MAX_MODELS = 32 };

struct brc_job {
    struct brc_case file;
    char name[BRC_CASE_KEY_SIZE * 2]; /* of the case: its file name without folder and ending */
    struct brc_specimen_params specimen;
    struct brc_test_params test;
    struct brc_run_params run;
    struct brc_output_params output;
    int n_models;                           /* registered */
    void *model_params[BRC_JOB_MAX_MODELS]; /* one filled struct a registered model; owned */
};

/* Reads a case with n overrides "section.key=value". Files that the case names are looked up from
 * the folder of the case file (from the working folder when the case comes through a pipe), those
 * of overrides from the working folder. Freed by brc_job_free, also after a failure. */
int brc_job_read(struct brc_context *ctx, struct brc_job *job, const char *path,
                 const char *const *overrides, int n);
/* The same from a text that path names, without overrides. */
int brc_job_parse(struct brc_context *ctx, struct brc_job *job, const char *path, const char *text);
/* The job with n further overrides. */
int brc_job_change(struct brc_context *ctx, const struct brc_job *job, const char *const *overrides,
                   int n, struct brc_job *out);
/* The text of a case in the folder dir, which is there, that makes this job with the model, without
 * any option: overrides are values in it, and files are named as dir sees them. Else it is the
 * user's text. Allocated, to be freed by the caller. */
int brc_job_keep(struct brc_context *ctx, const struct brc_job *job, const struct brc_model *model,
                 const char *dir, char **text);
void brc_job_free(struct brc_job *job);
/* A registered model by name; an unknown one is an error that lists all. */
int brc_job_model(struct brc_context *ctx, const char *name, const struct brc_model **model);
/* The models that a case compares: those that it names, else all; at most cap. */
int brc_job_models(struct brc_context *ctx, const struct brc_job *job,
                   const struct brc_model **model, int cap, int *n);
/* The filled parameters of a model. */
const void *brc_job_params(const struct brc_job *job, const struct brc_model *model);
/* All parameters that a run's states depend on, one "section.key = value" a line; allocated, to be
 * freed by the caller, NULL when out of memory. Names of files are left out: what counts is their
 * content, which the specimen's hash tells. */
char *brc_job_text(struct brc_context *ctx, const struct brc_job *job,
                   const struct brc_model *model);
/* Fails when two such texts differ in more than the conditions that end a run, naming the first
 * key. */
int brc_job_same(struct brc_context *ctx, const char *saved, const char *now);

/* Puts "file:line: " before a message about bad input that names a key as section.key: where the
 * case gives that key, or its section, its value. For failures after brc_job_read. */
void brc_job_locate(struct brc_context *ctx, const struct brc_job *job);

/* The key holds the name of a file. */
bool brc_job_names_file(const char *section, const struct brc_param *p);
/* Two paths lead to one file that is there. */
bool brc_job_is_same_file(const char *name, const char *path);
/* The file at path is the case file or one that it names, by whatever path. */
bool brc_job_is_input(const struct brc_job *job, const char *path);
/* Names of files of the filled job as the working folder sees them. Done by brc_job_read. */
int brc_job_find_files(struct brc_context *ctx, struct brc_job *job);

/* The filled parameters of section number i, see below. */
const void *brc_job_values(const struct brc_job *job, int i);
/* The sections that every case may have, and those of the models: name and list of number i, false
 * past the last. */
bool brc_job_section(int i, const char **name, struct brc_param_list *list);

#endif
