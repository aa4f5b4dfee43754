/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of names for messages ("a, b, c"), and the name that was probably meant by one that is
 * unknown. For readers of case files and of the command line. Knows nothing of what the names stand
 * for: parameter lists (params.h) and models use it, not the reverse. */
#ifndef BRC_NAMES_H
#define BRC_NAMES_H

#include "common/base/brc.h"

/* NAME_SIZE is also the longest name that distances are measured for: the algorithm keeps one row
 * on the stack, and no key or choice is near that length. */
enum { BRC_NAMES_SIZE = 600, BRC_NAME_SIZE = 128, BRC_HINT_SIZE = 160 };

/* Adds a name to the list "a, b", which starts as "". A list that is full ends in "...": a message
 * that names most of the choices helps more than one that fails. */
void brc_names_add(char *list, size_t size, const char *name);

/* Edit distance without regard to case; INT_MAX for names that are too long. */
int brc_names_distance(const char *a, const char *b);

/* A search for the name nearest to a text: {.text = text}, then each name, then the hint. */
struct brc_nearest {
    const char *text;
    char name[BRC_NAME_SIZE]; /* the nearest so far; "": none yet */
    int distance;
};
void brc_nearest_add(struct brc_nearest *n, const char *name);
/* "; did you mean 'name'?", or "" where no name is near; returns hint. */
const char *brc_nearest_hint(const struct brc_nearest *n, char hint[BRC_HINT_SIZE]);

#endif
