/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A seal at the start of a binary file tells whether the file is whole before any library parses
 * it: text lines with the format's number, the size of the file and a hash of all that follows. A
 * change of any one byte is noticed always, more with all but certainty; it is no protection
 * against forgery. In HDF5 files the seal is the user block, so every HDF5 reader opens them. */
#ifndef BRC_SEAL_H
#define BRC_SEAL_H

#include "common/base/error.h"

enum { BRC_SEAL_SIZE = 512 };

/* What is sealed; the format counts the changes of what stands in the file. */
struct brc_seal_kind {
    const char *name; /* one word: the first line of the seal is "breccia NAME, format N" */
    int format;
    const char *advice; /* what to do about a damaged file */
};
extern const struct brc_seal_kind brc_seal_state, brc_seal_frame;

/* The seal to stand before n bytes. */
void brc_seal_make(char seal[BRC_SEAL_SIZE], const struct brc_seal_kind *kind, const void *bytes,
                   size_t n);
/* The file begins as a sealed one of this kind does. */
bool brc_seal_is_there(const char *path, const struct brc_seal_kind *kind);
/* Fails unless the file is there, sealed, of this kind and format, and as it was when it was
 * sealed.
 */
int brc_seal_check(struct brc_context *ctx, const char *path, const struct brc_seal_kind *kind);

#endif
