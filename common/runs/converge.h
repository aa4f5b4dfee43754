/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What accuracy costs: a case run over ladders of its numerical settings, one at a time, on several
 * specimens, against a reference with a finer loading and a smaller step. docs/speed-and-error.md
 * says how errors are judged. */
#ifndef BRC_CONVERGE_H
#define BRC_CONVERGE_H

#include "common/runs/converge_stats.h"
#include "common/runs/case.h"

enum { BRC_CONVERGE_MAX_SEEDS = 64, BRC_CONVERGE_MAX_SETTINGS = 96, BRC_CONVERGE_MAX_REFINE = 256 };
enum { BRC_CONVERGE_MAX_MODELS = 16, BRC_CONVERGE_MAX_AXES = 32 };

struct brc_converge_order {
    const struct brc_case *run_case;
    const char *model;          /* this one alone; NULL: those of the case */
    const char *dir;            /* of converge*, beside those of other commands */
    const char *observable;     /* name of a result */
    const char *axes;           /* names, separated by commas; "": all */
    int seeds, refine, jobs;    /* specimens; factor of the finest loading; runs at a time */
    bool is_resumed, is_forced; /* resumed: finished runs are kept, unfinished ones go on */
};

/* Runs what is missing, prints the table and writes converge.txt, converge.csv (a line a setting),
 * converge_runs.csv (a line a run) and the chart. Start no MPI before. */
int brc_converge(struct brc_context *ctx, const struct brc_converge_order *order);

/* ---- settings ------------------------------------------------------------------------------ */

enum brc_converge_role {
    BRC_CONVERGE_CASE,      /* as written */
    BRC_CONVERGE_REFERENCE, /* it, and those that tell its uncertainty */
    BRC_CONVERGE_LADDER,    /* an error that falls with cost */
    BRC_CONVERGE_CHOICE,    /* a choice of the model: a difference, no error */
    BRC_CONVERGE_GRAINS     /* other specimens */
};

/* A run of a setting on one specimen, as the record keeps it. */
struct brc_converge_run {
    uint64_t key; /* of all parameters of the run */
    bool is_done;
    char ended_by[64];
    int64_t steps;
    double dt, cpu_s;
    double result[BRC_MAX_RESULTS];
};

struct brc_converge_setting {
    char axis[BRC_CASEFILE_KEY_SIZE];
    enum brc_converge_role role;
    char label[128]; /* the key that the axis is about, and its value; no comma */
    char text[512];  /* overrides "section.key=value", one a line */
    double fineness; /* on its ladder; the case has 1 */
    double weight;   /* expected cost over that of the case */
    struct brc_converge_run run[BRC_CONVERGE_MAX_SEEDS];
};

/* The settings of a model. The first four are the case, the reference, and the reference with its
 * loading, and its loading and step, one rung coarser. */
enum {
    BRC_CONVERGE_AT_CASE,
    BRC_CONVERGE_AT_REFERENCE,
    BRC_CONVERGE_AT_STEP,
    BRC_CONVERGE_AT_LOADING,
    BRC_CONVERGE_N_FIXED
};
struct brc_converge_model {
    const struct brc_model *model;
    struct brc_test_params test; /* with its automatic rates filled in */
    uint64_t specimen; /* hash of the case's own: what files that it names hold is a part of it */
    double mean_rate;  /* 1/s, of the case up to the peak, first specimen; 0: not run yet */
    int n;
    struct brc_converge_setting *setting; /* BRC_CONVERGE_MAX_SETTINGS */
};

struct brc_converge_axes {
    int n;
    char name[BRC_CONVERGE_MAX_AXES][BRC_CASEFILE_KEY_SIZE];
};

/* The names of a list, or all that the case has; an unknown one is an error that names all. */
int brc_converge_read_axes(struct brc_context *ctx, const struct brc_converge_order *order,
                           const struct brc_converge_model *models, int n_models,
                           struct brc_converge_axes *axes);
/* The first settings; then, when the mean rate is known, those of the axes. A value out of a key's
 * range is left out, with a log line. */
int brc_converge_first_settings(struct brc_context *ctx, const struct brc_converge_order *order,
                                struct brc_converge_model *m);
int brc_converge_axis_settings(struct brc_context *ctx, const struct brc_converge_order *order,
                               const struct brc_converge_axes *axes, struct brc_converge_model *m);
/* The case of a setting on specimen number i; freed by brc_case_free, also after a failure. */
int brc_converge_job(struct brc_context *ctx, const struct brc_case *run_case,
                     const struct brc_converge_setting *s, int i, struct brc_case *out);

/* ---- results ------------------------------------------------------------------------------- */

/* What all runs measure: names and units of the results. */
struct brc_converge_study {
    const struct brc_converge_order *order;
    struct brc_result results[BRC_MAX_RESULTS]; /* values are of no use */
    int n_results, observable;
    int n_models;
    struct brc_converge_model model[BRC_CONVERGE_MAX_MODELS];
};

/* A setting over its specimens. */
struct brc_converge_row {
    const struct brc_converge_setting *setting;
    double value;                    /* mean of the observable */
    struct brc_converge_error error; /* choices and grains: difference to the case */
    double steps, cpu_s;             /* medians */
    int n_good;                      /* runs that reached the end and measured it */
    bool is_case;                    /* a rung that is the case as written */
};

/* A model's rows, in the order of its settings. */
struct brc_converge_report {
    const struct brc_converge_model *model;
    struct brc_converge_error loading, step; /* parts of the reference's uncertainty */
    double reference, uncertainty, scatter;  /* the latter two relative */
    int n;
    struct brc_converge_row row[BRC_CONVERGE_MAX_SETTINGS];
    struct brc_converge_rung rung[BRC_CONVERGE_MAX_SETTINGS]; /* of the ladders, with CPU time */
    int rung_row[BRC_CONVERGE_MAX_SETTINGS], n_rungs;
    int cheapest[2]; /* rows, within 1 % and 5 %; -1: none */
};

extern const double brc_converge_within[2]; /* 1 % and 5 % */

void brc_converge_judge(const struct brc_converge_study *study, int model,
                        struct brc_converge_report *out);
/* Its error is smaller than this, with chance and the reference's uncertainty counted against it.
 */
bool brc_converge_is_shown(const struct brc_converge_report *r, int i, double error);
void brc_converge_print(FILE *out, const struct brc_converge_study *study,
                        const struct brc_converge_report *report);
int brc_converge_csv(struct brc_context *ctx, const struct brc_converge_study *study,
                     const struct brc_converge_report *report);
/* converge.gp and converge.png */
int brc_converge_plot(struct brc_context *ctx, const struct brc_converge_study *study,
                      const struct brc_converge_report *report);

#endif
