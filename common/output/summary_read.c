/* SPDX-License-Identifier: GPL-3.0-or-later */
/* By the form in which output.c writes it: a key begins a line, and no text of the file holds a
 * line break (json_text), so that what looks like a key is one. A library for JSON would read what
 * nobody writes. Anything but a number that this reads is "not measured", never 0. */
#include "common/output/summary_read.h"

#include "common/base/folders.h"
#include "common/base/input_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST = 1 << 20, KEY_SIZE = 128 };

/* Both ends are looked at: a summary appears whole or not at all (text_file.h), but a copy of one
 * may have been cut, and another program's file may have the name. */
int brc_summary_read(struct brc_context *ctx, const char *dir, char **text)
{
    char path[BRC_PATH_SIZE];
    const struct brc_input in = {
        .noun = "the summary of a run", .path = path, .largest = LARGEST, .is_plain = true};
    size_t n;
    *text = NULL;
    if (!brc_folder_has(dir, "summary.json"))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s holds no summary.json: name the folder of a run that has ended, as "
                 "results/<case>/<model>",
                 dir);
    BRC_TRY(brc_folder_path(ctx, dir, "summary.json", path));
    BRC_TRY(brc_input_read(ctx, &in, text, &n));
    if (n > 0 && strncmp(*text, "{\n  \"model\": ", 13) == 0 && strstr(*text, "\n  \"results\": {"))
        return 0;
    free(*text);
    *text = NULL;
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s is not a summary that breccia has written whole", path);
}

/* The text behind an opening quote, up to the one that closes it. Escapes stay as they are: what is
 * asked for are names, hashes and this program's own notes, which have none. */
static void copy_text(const char *at, char *value, size_t size)
{
    size_t n = 0;
    while (at[n] && at[n] != '"' && n + 1 < size)
        n += at[n] == '\\' && at[n + 1] && n + 2 < size ? 2 : 1;
    snprintf(value, size, "%.*s", (int)n, at);
}

void brc_summary_text(const char *summary, const char *key, char *value, size_t size)
{
    char line[KEY_SIZE];
    snprintf(line, sizeof line, "\n  \"%s\": \"", key);
    const char *at = strstr(summary, line);
    copy_text(at ? at + strlen(line) : "", value, size);
}

/* Each result is one line, so that a note is looked for up to its end and is never that of the next
 * one. */
bool brc_summary_result(const char *summary, const char *name, double *value, char *note,
                        size_t size)
{
    static const char mark[] = "\"note\": \"";
    char line[KEY_SIZE], *end;
    *value = NAN;
    *note = '\0';
    snprintf(line, sizeof line, "\n    \"%s\": {\"value\": ", name);
    const char *at = strstr(summary, line);
    if (!at)
        return false;
    at += strlen(line);
    double number = strtod(at, &end);
    if (end > at && isfinite(number))
        *value = number;
    size_t length = strcspn(at, "\n");
    const char *said = strstr(at, mark);
    if (said && said < at + length)
        copy_text(said + sizeof mark - 1, note, size);
    return true;
}
