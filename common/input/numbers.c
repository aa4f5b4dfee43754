/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strtod in a loop rather than scanf, which reads past a number that is too large and cannot tell
 * where a line ends. Rows keep their line for messages of whoever checks the values. For points and
 * planes of specimens; knows neither. */
#include "common/input/numbers.h"

#include "common/base/grow.h"
#include "common/base/input_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a line, which is far more than 8 numbers of 17 digits: a longer one is no row but the
 * sign of another kind of file. */
enum { LINE_SIZE = 510 };

struct reader {
    struct brc_context *ctx;
    const char *key, *path, *form;
    int low, high, line;
    struct brc_numbers *out;
    size_t cap_value, cap_line;
};

void brc_numbers_free(struct brc_numbers *t)
{
    free(t->value);
    free(t->line);
    *t = (struct brc_numbers){0};
}

/* Every message about a line gives the form of a good one: whoever has the wrong file sees it at
 * once. */
static int fail_at(const struct reader *r, const char *what)
{
    BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s: %s:%d: %s; expected '%s', finite numbers only", r->key,
             r->path, r->line, what, r->form);
}

/* The numbers of a line; -1 when something else stands there, high + 1 when there are more. */
static int split(const char *text, double *value, int high)
{
    int n = 0;
    for (;; n++) {
        char *end;
        text += strspn(text, " \t\r\n");
        if (*text == '\0' || n > high)
            return n;
        double number = strtod(text, &end);
        if (end == text || !isfinite(number))
            return -1;
        value[n] = number;
        text = end;
    }
}

/* Comments and empty lines are no rows. The width of the first row is that of all: a file in which
 * it changes has lost a column somewhere. */
static int read_line(struct reader *r, char *text)
{
    double value[BRC_NUMBERS_MAX_WIDTH + 1];
    struct brc_numbers *t = r->out;
    if (strlen(text) > LINE_SIZE)
        return fail_at(r, "the line is too long");
    text[strcspn(text, "#")] = '\0';
    int n = split(text, value, r->high);
    if (n == 0)
        return 0;
    if (n < r->low || n > r->high || (t->n > 0 && n != t->width))
        return fail_at(r, n < 0 ? "no row of numbers" : "too few or too many numbers");
    if (t->n == BRC_NUMBERS_MAX_ROWS)
        return fail_at(r, "more than 1e7 rows");
    t->width = n;
    size_t used = t->n * (size_t)n;
    BRC_GROW(r->ctx, t->value, r->cap_value, used + (size_t)n);
    BRC_GROW(r->ctx, t->line, r->cap_line, t->n + 1);
    memcpy(t->value + used, value, (size_t)n * sizeof *value);
    t->line[t->n++] = r->line;
    return 0;
}

/* Lines are cut in place, in the text as it was read. A byte 0 would end the text early, and the
 * rest of the file would be lost without a word. */
static int read_lines(struct reader *r, char *text, size_t size)
{
    char *next;
    if (strlen(text) < size)
        BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s: '%s' is not a text file: it holds a byte 0", r->key,
                 r->path);
    for (char *line = text; *line; line = next) {
        next = line + strcspn(line, "\n");
        if (*next)
            *next++ = '\0';
        r->line++;
        BRC_TRY(read_line(r, line));
    }
    if (r->out->n == 0)
        BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s: '%s' holds no row; expected one '%s' a line", r->key,
                 r->path, r->form);
    return 0;
}

int brc_numbers_read(struct brc_context *ctx, const char *key, const char *path, const char *form,
                     int low, int high, struct brc_numbers *out)
{
    struct reader r = {ctx, key, path, form, low, high, 0, out, 0, 0};
    const struct brc_input in = {.key = key, .path = path, .largest = BRC_INPUT_LARGEST};
    char *text;
    size_t size;
    *out = (struct brc_numbers){0};
    BRC_TRY(brc_input_read(ctx, &in, &text, &size));
    int code = read_lines(&r, text, size);
    free(text);
    if (code != 0)
        brc_numbers_free(out);
    return code;
}
