/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The models of a case on one specimen, each in a process of its own, side by side. */
#ifndef BRC_COMPARE_H
#define BRC_COMPARE_H

#include "common/runs/run.h"

/* Runs all models of the case on the specimen, as many at a time as there are processors; prints
 * the table and writes it to dir/compare.txt, and draws both models' curves and cracks. The results
 * of a model go to dir/<model>; resumed: models with a state go on, the others start. Start no MPI
 * before: the models run in forked processes. */
int brc_compare(struct brc_context *ctx, const struct brc_run_options *options);

/* A unit to show a value in. */
struct brc_shown {
    double factor;
    const char *unit;
};
/* Pascals as GPa or MPa, strains in per cent, by the name and the largest value of the row. */
struct brc_shown brc_compare_unit(const char *name, const char *unit, double largest);
/* Four digits, a dash for what is not a number; returns text. */
enum { BRC_DIGITS_SIZE = 40 };
const char *brc_compare_digits(double value, char text[BRC_DIGITS_SIZE]);
/* A line of dashes. */
void brc_compare_rule(FILE *out, int width);
/* The table: one row a value, one column a summary; also of a single run. All summaries are of the
 * same test. */
void brc_compare_table(FILE *out, const struct brc_summary *const *summary, int n);

#endif
