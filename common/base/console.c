/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The descriptors are put right before anything else runs: a library that opens a file would get
 * the number of a closed standard stream, and messages would go into results. Closing tells of a
 * full disk, which printf does not. */
#include "common/base/console.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

/* The wrong way round for 0 and 1: whoever reads or writes there is told. What is said on a closed
 * standard error has no other place to go, and is dropped. open takes the lowest free number. */
int brc_console_open(struct brc_context *ctx)
{
    static const int mode[] = {O_WRONLY, O_RDONLY, O_WRONLY};
    for (int file = 0; file < 3; file++)
        if (fcntl(file, F_GETFD) < 0 && open("/dev/null", mode[file]) != file)
            BRC_FAIL(ctx, BRC_ERR_IO, "cannot open /dev/null in place of closed descriptor %d: %s",
                     file, strerror(errno));
    return 0;
}

/* errno is cleared first: an error of an earlier write has left only the stream's mark, and some
 * older errno would name a wrong reason. */
int brc_console_close(struct brc_context *ctx)
{
    bool has_failed = ferror(stdout);
    errno = 0;
    has_failed = fclose(stdout) != 0 || has_failed;
    if (has_failed)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "cannot write all to standard output%s%s; what is written to files is there",
                 errno ? ": " : "", errno ? strerror(errno) : "");
    return 0;
}

/* Plain words stay as they are, so that a command that is shown can be read; all else stands in
 * single quotes, within which a shell reads nothing. A quote itself ends them, is escaped, and
 * begins them again. */
void brc_console_word(FILE *out, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=./,:%@";
    fputc(' ', out);
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (; *word; word++) {
        if (*word == '\'')
            fputs("'\\''", out);
        else
            fputc(*word, out);
    }
    fputc('\'', out);
}
