/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells are divided by commas; one in quotes may hold some, as names of folders do. */
#include "calib/points_file.h"

#include "common/base/input_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST = 1 << 26 };

/* The columns that are read: sigma_1, then sigma_3. */
struct columns {
    int at[2];
    double scale[2]; /* Pa a unit of the column */
};

/* The cell that begins at *at, with its length; moves on to the next one, or to the end. */
static const char *next_cell(const char **at, size_t *length)
{
    const char *cell = *at, *end = cell;
    bool is_quoted = false;
    for (; *end && (is_quoted || *end != ','); end++)
        is_quoted ^= *end == '"';
    *length = (size_t)(end - cell);
    *at = *end ? end + 1 : NULL;
    return cell;
}

/* Factor of "[unit]" behind the name of a column; 0: none that is a stress. */
static double scale_of(const char *unit, size_t length)
{
    static const struct {
        const char *name;
        double scale;
    } known[] = {{"[Pa]", 1}, {"[kPa]", 1e3}, {"[MPa]", 1e6}, {"[GPa]", 1e9}};
    while (length > 0 && *unit == ' ') {
        unit++;
        length--;
    }
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (length == strlen(known[i].name) && strncmp(unit, known[i].name, length) == 0)
            return known[i].scale;
    return 0;
}

static int read_head(struct brc_context *ctx, const char *path, const char *line,
                     const char *suffix, struct columns *c)
{
    static const char *const stress[2] = {"sigma_1", "sigma_3"};
    *c = (struct columns){.at = {-1, -1}};
    for (int k = 0; k < 2; k++) {
        char name[64];
        size_t n = (size_t)snprintf(name, sizeof name, "%s%s", stress[k], suffix), length;
        const char *at = line;
        for (int column = 0; at; column++) {
            const char *cell = next_cell(&at, &length);
            if (length >= n && strncmp(cell, name, n) == 0 && (length == n || cell[n] == ' ')) {
                c->at[k] = column;
                c->scale[k] = scale_of(cell + n, length - n);
            }
        }
        if (c->at[k] < 0)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s:1: no column %s: the first line names the columns, as in 'sigma_3 "
                     "[MPa],sigma_1 [MPa]'",
                     path, name);
        if (c->scale[k] == 0)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s:1: column %s has no unit: write [Pa], [kPa], [MPa] or [GPa] behind it",
                     path, name);
    }
    return 0;
}

/* The two stresses of a line; NAN where a cell is empty. */
static int read_line(struct brc_context *ctx, const char *path, size_t number, const char *line,
                     const struct columns *c, struct calib_peak *point)
{
    double *const to[2] = {&point->sigma_1, &point->sigma_3};
    const char *at = line;
    *point = (struct calib_peak){NAN, NAN};
    for (int column = 0; at; column++) {
        size_t length;
        const char *cell = next_cell(&at, &length);
        for (int k = 0; k < 2; k++) {
            char *end;
            if (column != c->at[k] || length == 0)
                continue;
            *to[k] = strtod(cell, &end) * c->scale[k];
            if (end != cell + length || isinf(*to[k]))
                BRC_FAIL(ctx, BRC_ERR_INPUT, "%s:%zu: '%.*s' is not a stress", path, number,
                         (int)(length < 40 ? length : 40), cell);
        }
    }
    return 0;
}

static int read_lines(struct brc_context *ctx, const char *path, char *text, const char *suffix,
                      struct calib_peak *point, size_t *n)
{
    struct columns columns;
    char *line = text;
    *n = 0;
    for (size_t number = 1; line && (*line || number == 1); number++) {
        char *end = strchr(line, '\n');
        if (end)
            *end = '\0';
        line[strcspn(line, "\r")] = '\0';
        if (number == 1)
            BRC_TRY(read_head(ctx, path, line, suffix, &columns));
        else if (*line)
            BRC_TRY(read_line(ctx, path, number, line, &columns, &point[*n]));
        if (number > 1 && *line && isfinite(point[*n].sigma_1) && isfinite(point[*n].sigma_3))
            (*n)++;
        line = end ? end + 1 : NULL;
    }
    return 0;
}

int calib_points_read(struct brc_context *ctx, const char *path, const char *suffix,
                      struct calib_peak **point, size_t *n)
{
    const struct brc_input in = {
        .noun = "the file of points", .path = path, .largest = LARGEST, .is_plain = true};
    char *text;
    size_t length, n_lines = 1;
    *point = NULL;
    BRC_TRY(brc_input_read(ctx, &in, &text, &length));
    for (size_t i = 0; i < length; i++)
        n_lines += text[i] == '\n';
    *point = brc_alloc(ctx, n_lines, sizeof **point);
    int code = *point ? read_lines(ctx, path, text, suffix, *point, n) : BRC_ERR_MEMORY;
    free(text);
    if (code != 0) {
        free(*point);
        *point = NULL;
    }
    return code;
}
