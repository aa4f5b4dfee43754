/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Specimens by their parameters, for the tests of specimens, in a folder of their own that holds
 * their cache and files. */
#ifndef BRC_TESTS_SPECIMENS_H
#define BRC_TESTS_SPECIMENS_H

#include "tests/near.h"

#include "common/geometry/vec.h"
#include "common/specimen/specimen.h"

extern struct brc_context specimens_ctx;
extern char specimens_folder[];
/* Of a group of tests: makes the folder, and removes it when it is empty again. */
int specimens_set_up(void **state);
int specimens_tear_down(void **state);

/* Defaults with key, value pairs set as in a case file; ends with NULL. */
struct brc_specimen_params specimens_params(const char *const *pairs);
#define PARAMS(...) specimens_params((const char *const[]){__VA_ARGS__, NULL})
/* Hash of all that a model reads. */
uint64_t specimens_hash(const struct brc_specimen *s);
/* Cells fill the domain, close, and lie on its planes, all to rounding. */
void specimens_check_facets(const struct brc_specimen *s);
/* A file of the folder. */
char *specimens_path(char path[64], const char *name);
void specimens_write(const char *path, const char *text);

#endif
