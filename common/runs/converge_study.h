/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of `breccia converge` share: settings with their runs, and rows of the table. Data
 * alone; converge_axes makes the settings, converge runs them, converge_report judges the results,
 * converge_table and converge_plot show them, and none of these knows the next. */
#ifndef BRC_CONVERGE_STUDY_H
#define BRC_CONVERGE_STUDY_H

#include "common/runs/converge.h"
#include "common/runs/converge_stats.h"

enum brc_converge_role {
    BRC_CONVERGE_CASE,      /* as written */
    BRC_CONVERGE_REFERENCE, /* it, and those that tell its uncertainty */
    BRC_CONVERGE_LADDER,    /* an error that falls with cost */
    BRC_CONVERGE_CHOICE,    /* a choice of the model: a difference, no error */
    BRC_CONVERGE_GRAINS     /* other specimens */
};

/* Overrides of a setting; the reference has most. */
enum { BRC_CONVERGE_MAX_LINES = 6 };

/* A run of a setting on one specimen, as the record keeps it. */
struct brc_converge_run {
    uint64_t key; /* of the run: run_key.h */
    bool is_done;
    char ended_by[64];
    int64_t steps;
    double dt, cpu_s;
    double result[BRC_MAX_RESULTS];
};

/* A point of a ladder: what is changed of the case, and its runs. Changes are texts, as a user
 * would give them by --set, so that they go through the same checks. */
struct brc_converge_setting {
    const char *axis; /* constant text; settings of one axis follow each other */
    enum brc_converge_role role;
    char label[128]; /* the key that the axis is about, and its value; no comma */
    char line[BRC_CONVERGE_MAX_LINES][160]; /* overrides "section.key=value" */
    int n_lines;
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
    double mean_rate; /* 1/s, of the case up to the peak, first specimen; 0: not run yet */
    int n;
    struct brc_converge_setting *setting; /* BRC_CONVERGE_MAX_SETTINGS */
};

struct brc_converge_axes {
    int n;
    const char *name[BRC_CONVERGE_MAX_AXES]; /* constant texts */
};

/* What all runs measure, and the models with their settings. Filled by converge.c, read by all
 * others. */
struct brc_converge_study {
    const struct brc_converge_options *options;
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
    /* the rows as rungs, with processor time as cost; what is on no ladder has no error */
    struct brc_converge_rung rung[BRC_CONVERGE_MAX_SETTINGS];
    int cheapest[2]; /* rows, within 1 % and 5 %; -1: none */
};

#endif
