/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are read: cases, what they name, targets, saved states. A file is a regular one or a
 * pipe that ends, and has at most a stated size; folders and devices are refused before a byte is
 * read, so that /dev/zero and the like neither fill the memory nor hang the program. */
#ifndef BRC_INPUT_FILE_H
#define BRC_INPUT_FILE_H

#include "common/base/error.h"

#include <stdio.h>

/* What is to be read, for messages: the key of the case that names the file, or NULL; then noun
 * says what the file is ("the case file"), or is NULL. */
struct brc_input {
    const char *key, *noun;
    const char *path;
    size_t largest; /* bytes */
    bool is_plain;  /* pipes are refused, too: the file is gone through more than once */
};

/* The largest data files: points, planes, tessellations; and the largest pipe, whose size is known
 * only as it is in memory. Bytes. */
#define BRC_INPUT_LARGEST      ((size_t)1 << 31)
#define BRC_INPUT_LARGEST_PIPE ((size_t)1 << 28)

/* Opens for reading in binary. *size, where size is not NULL, is that of a plain file. */
int brc_input_open(struct brc_context *ctx, const struct brc_input *in, FILE **file, size_t *size);
/* Reads the whole; *text is allocated, to be freed by the caller, and ends with a zero behind its n
 * bytes; NULL after a failure. */
int brc_input_read(struct brc_context *ctx, const struct brc_input *in, char **text, size_t *n);

#endif
