/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The standard streams of the program, and words of commands that it prints for the shell. */
#ifndef BRC_CONSOLE_H
#define BRC_CONSOLE_H

#include "common/base/error.h"

#include <stdio.h>

/* First of all: descriptors 0, 1 and 2 that are closed are opened on /dev/null, so that no file or
 * pipe of the program gets their number and messages end in it. Writing to a standard output that
 * was closed still fails. */
int brc_console_open(struct brc_context *ctx);
/* Last of all: closes standard output; fails when not all that was written there has arrived. */
int brc_console_close(struct brc_context *ctx);
/* A blank and a word as POSIX shells read it, in quotes where it must be. */
void brc_console_word(FILE *out, const char *word);

#endif
