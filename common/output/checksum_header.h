/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A checksum header, which stands at the start of a binary file, tells whether the file is whole
 * before any library parses it: text lines with the format's number, the size of the file and a
 * hash of all that follows. A change of any one byte is noticed always, more with all but
 * certainty; it does not protect against forgery. In HDF5 files the header is the user block, so
 * every HDF5 reader opens them. */
#ifndef BRC_CHECKSUM_H
#define BRC_CHECKSUM_H

#include "common/base/error.h"

enum { BRC_CHECKSUM_SIZE = 512 };

/* What has such a header; the format counts the changes of what stands in the file. */
struct brc_checksum_kind {
    const char *name; /* one word: the first line of the header is "breccia NAME, format N" */
    int format;
};
extern const struct brc_checksum_kind brc_checksum_state, brc_checksum_frame, brc_checksum_tables;

/* The header to stand before n bytes. Equal bytes have equal headers. */
void brc_checksum_make(char header[BRC_CHECKSUM_SIZE], const struct brc_checksum_kind *kind,
                       const void *bytes, size_t n);
/* The file begins with a header of this kind. */
bool brc_checksum_is_there(const char *path, const struct brc_checksum_kind *kind);
/* Fails unless the file is there, of this kind and format, and as it was when it was written. Reads
 * the whole file: the price of a library that crashes on what is damaged. */
int brc_checksum_check(struct brc_context *ctx, const char *path,
                       const struct brc_checksum_kind *kind);

#endif
