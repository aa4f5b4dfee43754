/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header holds size and hash of all that follows, as text that a person can read. It is
 * compared as a whole with the one that the content makes, so that damage to the header is found as
 * well. HDF5's own checksums do not serve: they are of single chunks, where a filter is asked for,
 * and in the oldest format, the one that is written here (h5.c), there are none of its metadata. */
#include "common/output/checksum_header.h"

#include "common/base/table.h"
#include "common/base/input_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_SIZE = 1 << 14 }; /* a multiple of 8: the hash goes on between blocks */
/* States: 2: with a hash of the specimen. 3: the case holds its overrides as values. 4: accounts of
 * the grains, stages of the loading. 5: forces of cracks. */
const struct brc_checksum_kind brc_checksum_state = {"state", 5};
const struct brc_checksum_kind brc_checksum_frame = {"frame", 1};
const struct brc_checksum_kind brc_checksum_tables = {"tables", 1};
static const char advice[] = "use an undamaged copy, or start the run anew with --force";

enum { MARK_SIZE = 64 }; /* more than any kind's name needs */

/* What a header says. */
struct header {
    int format;
    uint64_t size, hash;
};

/* What a header begins with; returns its length. */
static size_t make_mark(const struct brc_checksum_kind *kind, char mark[MARK_SIZE])
{
    return (size_t)snprintf(mark, MARK_SIZE, "breccia %s, format ", kind->name);
}

/* Filled up with line breaks: `head` shows a text and then stops, and the last byte is as much
 * compared as the first. */
static void print_header(const struct brc_checksum_kind *kind, const struct header *s,
                         char text[BRC_CHECKSUM_SIZE])
{
    char mark[MARK_SIZE];
    make_mark(kind, mark);
    memset(text, '\n', BRC_CHECKSUM_SIZE);
    int n = snprintf(text, BRC_CHECKSUM_SIZE,
                     "%s%d\nbytes %" PRIu64 "\nhash %016" PRIx64 "\n"
                     "From byte %d on this is an HDF5 file, which any HDF5 reader opens as it is;\n"
                     "bytes is the size of the whole, hash is that of what follows this block.\n",
                     mark, s->format, s->size, s->hash, BRC_CHECKSUM_SIZE);
    text[n] = '\n';
}

/* Size of a file and hash of all behind the header, read in blocks: the file may be larger than
 * what memory is left beside a simulation. */
static int measure(struct brc_context *ctx, const char *path, FILE *file, struct header *s)
{
    char block[BLOCK_SIZE];
    size_t n;
    s->size = BRC_CHECKSUM_SIZE;
    s->hash = BRC_HASH_SEED;
    errno = 0;
    bool is_good = fseek(file, BRC_CHECKSUM_SIZE, SEEK_SET) == 0;
    while (is_good && (n = fread(block, 1, sizeof block, file)) > 0) {
        s->hash = brc_hash_bytes(block, n, s->hash);
        s->size += n;
    }
    if (!is_good || ferror(file))
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot read %s: %s", path, strerror(errno));
    return 0;
}

void brc_checksum_make(char header[BRC_CHECKSUM_SIZE], const struct brc_checksum_kind *kind,
                       const void *bytes, size_t n)
{
    const struct header s = {kind->format, BRC_CHECKSUM_SIZE + n,
                             brc_hash_bytes(bytes, n, BRC_HASH_SEED)};
    print_header(kind, &s, header);
}

/* From what is told apart at a glance to what takes reading all: kind, format, size, content. Each
 * has a message of its own, since what to do differs. */
static int check_file(struct brc_context *ctx, const char *path, FILE *file, size_t size,
                      const struct brc_checksum_kind *kind)
{
    char text[BRC_CHECKSUM_SIZE + 1] = "", expected[BRC_CHECKSUM_SIZE], mark[MARK_SIZE];
    size_t length = make_mark(kind, mark);
    struct header said = {0}, found = {.format = kind->format};
    if (fread(text, 1, BRC_CHECKSUM_SIZE, file) != BRC_CHECKSUM_SIZE ||
        strncmp(text, mark, length) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "cannot read %s: it is not a %s file of breccia, is cut short, or is of a version "
                 "before %s; %s",
                 path, kind->name, BRC_VERSION, advice);
    /* as far as they are there: the header is compared as a whole below */
    sscanf(text + length, "%d\nbytes %" SCNu64 "\nhash %" SCNx64, &said.format, &said.size,
           &said.hash);
    if (said.format != kind->format)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s has the %s format %d, breccia %s reads %d; resume with the version that "
                 "wrote it, or start the run anew with --force",
                 path, kind->name, said.format, BRC_VERSION, kind->format);
    found.size = size;
    if (size == said.size) /* else there is no need to read it */
        BRC_TRY(measure(ctx, path, file, &found));
    if (found.size != said.size)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "%s has %" PRIu64 " bytes, it was saved with %" PRIu64 ": it is cut short or "
                 "overwritten; %s",
                 path, found.size, said.size, advice);
    print_header(kind, &found, expected);
    if (memcmp(text, expected, BRC_CHECKSUM_SIZE) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "%s is damaged: its content does not match its hash; %s", path,
                 advice);
    return 0;
}

int brc_checksum_check(struct brc_context *ctx, const char *path,
                       const struct brc_checksum_kind *kind)
{
    const struct brc_input in = {.path = path, .largest = SIZE_MAX, .is_plain = true};
    FILE *file;
    size_t size;
    BRC_TRY(brc_input_open(ctx, &in, &file, &size));
    int code = check_file(ctx, path, file, size, kind);
    fclose(file);
    return code;
}

/* A file that cannot be opened has no header: who needs to know why opens it himself. */
bool brc_checksum_is_there(const char *path, const struct brc_checksum_kind *kind)
{
    char text[MARK_SIZE], mark[MARK_SIZE];
    size_t length = make_mark(kind, mark);
    const struct brc_input in = {.path = path, .largest = SIZE_MAX, .is_plain = true};
    struct brc_context quiet = BRC_CONTEXT_INIT;
    FILE *file;
    bool is_there = brc_input_open(&quiet, &in, &file, NULL) == 0 &&
                    fread(text, length, 1, file) == 1 && memcmp(text, mark, length) == 0;
    if (file)
        fclose(file);
    return is_there;
}
