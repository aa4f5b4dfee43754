/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that a case names: where they are, and that no result takes their place. Called as a
 * case is read, and by all that writes. */
#ifndef BRC_CASE_FILES_H
#define BRC_CASE_FILES_H

#include "common/runs/case.h"

/* Names of files of the filled case as the working folder sees them. Done by brc_case_read. */
int brc_case_find_files(struct brc_context *ctx, struct brc_case *run_case);
/* Two paths lead to one file that is there. */
bool brc_case_is_same_file(const char *name, const char *path);
/* The file at path is the case file or one that it names, by whatever path. */
bool brc_case_is_input(const struct brc_case *run_case, const char *path);

#endif
