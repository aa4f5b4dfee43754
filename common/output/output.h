/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text output: the summary of a run as JSON, and tables as CSV. */
#ifndef BRC_OUTPUT_H
#define BRC_OUTPUT_H

#include "common/base/table.h"
#include "common/engine/ledger.h"
#include "common/engine/rig.h"
#include "common/input/params.h"

#include <stdio.h>

#define BRC_OUTPUT_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                       \
    FLAG(plots, "on", "curves and pictures of cracks by gnuplot, where it is installed")    \
    REAL(facet_part, "1", "0.5", "(0, 1]",                                                  \
         "pictures: a facet is drawn when at least this part of its area is broken")        \
    REAL(opening, "1", "0", "[0, 100]",                                                     \
         "pictures: only cracks that have opened or slipped by this many times their mean") \
    CHOICE(view, "auto|side|top", "auto",                                                   \
           "pictures: from the side, or along z; auto: by the test")                        \
    INT(picture_height, "1000", "[200, 8000]", "pictures: pixels", "plots=on")              \
    INT(frames, "0", "[0, 99999]",                                                          \
        "frames for ParaView: this many beside the first, by what happens; 0: none")        \
    REAL(frame_strain, "1", "0", "[0, 10)",                                                 \
         "frames for ParaView: one every so much platen strain; 0: by frames")              \
    INT(frame_steps, "0", "[0, 2000000000]",                                                \
        "frames for ParaView: one every so many steps; 0: by strain")

enum brc_view { BRC_VIEW_AUTO, BRC_VIEW_SIDE, BRC_VIEW_TOP };

/* All of these may change when a run resumes: nothing here has an effect on the run itself. */
struct brc_output_params {
    BRC_PARAM_MEMBERS(BRC_OUTPUT_PARAMS)
};
extern const struct brc_param_list brc_output_param_list;

/* The meshes of a frame for ParaView, and how large one is. */
enum brc_frame_kind { BRC_FRAME_GRAINS, BRC_FRAME_BONDS, BRC_FRAME_CONTACTS, BRC_N_FRAME_KINDS };
struct brc_frame_count {
    const char *name; /* static */
    size_t n_points, n_cells;
};

/* What a run reports. Plain data: a child process sends it to its parent as bytes. */
struct brc_summary {
    char model[64], title[256], case_name[256];
    char ended_by[64]; /* key of the condition that ended the run, "signal" or "failure" */
    bool is_finished;  /* by a condition of the test */
    bool has_peak;     /* the load has passed one */
    int seed;
    size_t n_grains;          /* platens are none */
    size_t n_facets;          /* of the specimen, boundary included */
    size_t n_contacts;        /* rows that carry a spring now, platens included */
    size_t n_contacts_listed; /* rows, those that only watch included */
    size_t n_points;          /* points of those rows, broken ones included */
    size_t n_fragments;       /* sets of grains that bonds hold together, fragments.h */
    size_t n_frames;          /* for ParaView */
    struct brc_frame_count frame[BRC_N_FRAME_KINDS]; /* the last one */
    double n_contacts_mean; /* rows that carry a spring, mean over the steps */
    int64_t steps;
    double dt;
    double cpu_s, wall_s;       /* of the step loop, all parts of a resumed run together */
    double ns_per_contact_step; /* cpu_s over steps and n_contacts_mean */
    double energy_residual, energy_drift, unbalanced_max;
    struct brc_ledger ledger; /* at the end; zeros where energy_check is off */
    struct brc_ledger ledger_at_peak;
    uint64_t state_hash;
    enum brc_energy_check energy_check;
    int n_results;
    struct brc_result results[BRC_MAX_RESULTS];
};

/* The file dir/name as in text_file.h; numbers have 17 digits, what is not a number is null. */
int brc_output_summary(struct brc_context *ctx, const char *dir, const char *name,
                       const struct brc_summary *s);
/* One sentence on the energy of a run that is doubtful or wrong, "" on others; returns text. */
const char *brc_output_energy(const struct brc_summary *s, char *text, size_t size);
/* A result by name, NULL when the test has none of that name. */
const struct brc_result *brc_output_result(const struct brc_summary *s, const char *name);
/* A text in quotes, and a number, as JSON has them: null for what is not a number. */
void brc_output_json_text(FILE *out, const char *text);
void brc_output_json_number(FILE *out, double value);
/* A text as one field of a CSV file, by RFC 4180: in quotes where it holds commas, quotes or line
 * ends. */
void brc_output_cell(FILE *out, const char *text);
/* One column a value of the BRC_STATE fields; the header names them with their units:
 * "step [1],x_1 [m],x_2 [m]". beside: more columns of the same rows; NULL: none. */
int brc_output_csv(struct brc_context *ctx, const char *dir, const char *name,
                   const struct brc_table *t, const struct brc_table *beside);
/* The same to an open stream, whose errors are the caller's. */
void brc_output_table(FILE *out, const struct brc_table *t, const struct brc_table *beside);

#endif
