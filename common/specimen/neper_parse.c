/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words and numbers of Neper's tessellation files. Edges, signs and equations are passed over:
 * they follow from the loops of the faces. Nothing of the file is trusted: each number has a range
 * by what was read before, so that neither memory nor an index can be asked for by a damaged one.
 * Sections are looked for by their headings, from the start of the file, so that those of newer
 * versions that are not known here do no harm. Called by neper_read.c alone. */
#include "common/specimen/neper_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* More than any domain of flat faces has; each of them is compared with each other one. */
enum { MAX_DOMAIN_FACES = 100000 };

/* With the line and the word that stands there: files have as many lines as vertices, and the
 * message has to show which part was taken for another. */
static int fail(const struct brc_neper_file *t, const char *what)
{
    BRC_FAIL(t->ctx, BRC_ERR_INPUT, "%s:%d: %s; found '%.40s'", t->path, t->line, what, t->token);
}

/* ---- words and numbers --------------------------------------------------------------------- */

/* The next word, cut where it is longer than any that means something; lines are counted for
 * messages. */
static bool next(struct brc_neper_file *t)
{
    static const char blanks[] = " \t\r\n";
    for (; *t->at && strchr(blanks, *t->at); t->at++)
        t->line += *t->at == '\n';
    size_t n = strcspn(t->at, blanks), kept = n < BRC_NEPER_TOKEN ? n : BRC_NEPER_TOKEN - 1;
    memcpy(t->token, t->at, kept);
    t->token[kept] = '\0';
    t->at += n;
    return n > 0;
}

static int skip(struct brc_neper_file *t, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!next(t))
            return fail(t, "the file ends too soon");
    return 0;
}

/* The end of the text is no special case: the word is empty then, and not a number. */
static int whole(struct brc_neper_file *t, long low, long high, long *value)
{
    char *end = t->token;
    if (next(t))
        *value = strtol(t->token, &end, 10);
    if (end == t->token || *end != '\0' || *value < low || *value > high)
        return fail(t, "expected a whole number that fits here");
    return 0;
}

/* A number of things, each of which takes two bytes of the file at least. */
static int count(struct brc_neper_file *t, size_t *n)
{
    long value, most = (long)(t->size / 2 < INT32_MAX / 64 ? t->size / 2 : INT32_MAX / 64);
    BRC_TRY(whole(t, 1, most, &value));
    *n = (size_t)value;
    return 0;
}

/* A count and as many words that are passed over. */
static int skip_list(struct brc_neper_file *t)
{
    size_t n;
    BRC_TRY(count(t, &n));
    return skip(t, n);
}

static int real(struct brc_neper_file *t, double *value)
{
    char *end = t->token;
    if (next(t))
        *value = strtod(t->token, &end);
    if (end == t->token || *end != '\0' || !isfinite(*value))
        return fail(t, "expected a finite number");
    return 0;
}

/* Significant digits of the number that was read last, trailing zeros included; 0 for zero. The
 * file does not say with how many digits it was written, and what counts as flat or closed hangs on
 * it. */
static int significant_digits(const char *token)
{
    int n = 0;
    for (; *token && *token != 'e' && *token != 'E'; token++)
        n += *token >= '0' && *token <= '9' && (n > 0 || *token != '0');
    return n;
}

/* The number of an entry: they count from 1. */
static int number(struct brc_neper_file *t, size_t i)
{
    long value;
    return whole(t, (long)i + 1, (long)i + 1, &value);
}

/* Goes behind a heading: from the start of the file, or on from here up to a heading of the same
 * or a higher level. */
static int find(struct brc_neper_file *t, const char *heading, bool is_from_start)
{
    if (is_from_start) {
        t->at = t->text;
        t->line = 1;
    }
    while (next(t))
        if (strcmp(t->token, heading) == 0)
            return 0;
    snprintf(t->token, BRC_NEPER_TOKEN, "%s", heading);
    return fail(t, "a part of the file is missing");
}

/* ---- parts of the file --------------------------------------------------------------------- */

/* The kinds of file that are read: three-dimensional, not periodic, formats 2.0 and 3. Others are
 * refused with the option of Neper that makes a file of the right kind. */
static int read_kind(struct brc_neper_file *t)
{
    long dimension;
    t->at = t->text;
    t->line = 1;
    if (!next(t) || strcmp(t->token, "***tess") != 0)
        return fail(t, "not a tessellation file of Neper (.tess), which begins with ***tess");
    BRC_TRY(find(t, "**format", false));
    BRC_TRY(skip(t, 1));
    t->is_format_2 = strcmp(t->token, "2.0") == 0;
    if (!t->is_format_2 && strncmp(t->token, "3.", 2) != 0)
        return fail(t,
                    "this format is not read, 2.0 and 3.x are: let a newer Neper write the file");
    BRC_TRY(find(t, "**general", false));
    BRC_TRY(whole(t, 1, 3, &dimension));
    if (dimension != 3)
        return fail(t, "the tessellation is two-dimensional, grains have three dimensions: make "
                       "it with -dim 3");
    BRC_TRY(skip(t, 1));
    if (strncmp(t->token, "periodic", 8) == 0)
        return fail(t, "the tessellation is periodic, so that its cells do not fill a body: make "
                       "it without -periodicity");
    return 0;
}

/* Goes to a part of the file that begins with the number of its entries. */
static int begin(struct brc_neper_file *t, const char *heading, bool is_from_start, size_t *n)
{
    BRC_TRY(find(t, heading, is_from_start));
    return count(t, n);
}

/* The numbered entries of a part. Asks first whether the arrays that they fill are there, so that
 * what makes them need not. */
static int read_entries(struct brc_neper_file *t, size_t n,
                        int (*read)(struct brc_neper_file *t, size_t i))
{
    if (t->pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < n; i++) {
        BRC_TRY(number(t, i));
        BRC_TRY(read(t, i));
    }
    return 0;
}

static int read_seed(struct brc_neper_file *t, size_t i)
{
    for (int k = 0; k < 4; k++)
        BRC_TRY(real(t, &t->seed[i][k]));
    return 0;
}

/* Seeds may be missing, and are read all zero then: a tessellation is its cells, and seeds serve
 * only to measure them from, or as the centres of spheres. */
static int read_cells(struct brc_neper_file *t)
{
    BRC_TRY(begin(t, "**cell", true, &t->n_cells));
    t->seed = brc_pool_alloc(t->ctx, &t->pool, t->n_cells, sizeof *t->seed);
    while (!t->has_seeds && next(t) && strncmp(t->token, "**", 2) != 0)
        t->has_seeds = strcmp(t->token, "*seed") == 0;
    return read_entries(t, t->has_seeds ? t->n_cells : 0, read_seed);
}

static int read_vertex(struct brc_neper_file *t, size_t i)
{
    for (int k = 0; k < 3; k++) {
        BRC_TRY(real(t, &t->vertex[i][k]));
        int digits = significant_digits(t->token);
        t->digits = digits > t->digits ? digits : t->digits;
    }
    return skip(t, 1); /* state */
}

/* The loops of all faces lie in one array, made before any is read: a vertex takes two bytes of the
 * file at least, so that half of its size is room enough whatever the file claims. */
static int read_face(struct brc_neper_file *t, size_t i)
{
    size_t n;
    BRC_TRY(count(t, &n));
    if (n < 3 || t->n_loop + n > t->size / 2)
        return fail(t, "a face has three vertices at least");
    t->face[i] = (struct brc_neper_face){{-1, -1}, -1, t->n_loop, (int32_t)n};
    for (size_t k = 0; k < n; k++) {
        long v;
        BRC_TRY(whole(t, 1, (long)t->n_vertices, &v));
        t->loop[t->n_loop++] = (int32_t)v - 1;
    }
    BRC_TRY(skip_list(t)); /* edges */
    return skip(t, 4 + 5); /* equation, state and point */
}

/* A face that two polyhedra claim is inner; the sign of the claim would tell its direction, which
 * the reader finds from the vertices. */
static int read_polyhedron(struct brc_neper_file *t, size_t i)
{
    long n_faces, f;
    BRC_TRY(whole(t, 0, (long)t->n_faces, &n_faces));
    for (long k = 0; k < n_faces; k++) {
        BRC_TRY(whole(t, -(long)t->n_faces, (long)t->n_faces, &f));
        struct brc_neper_face *face = f == 0 ? NULL : &t->face[labs(f) - 1];
        if (!face || face->cell[1] >= 0 || face->cell[0] == (int32_t)i)
            return fail(t, "a face belongs to one polyhedron, or to two");
        face->cell[face->cell[0] >= 0] = (int32_t)i;
    }
    return 0;
}

/* What a face of the domain is: a type with parameters, or in format 2.0 the equation of a plane.
 */
static int read_domain_type(struct brc_neper_file *t, size_t i)
{
    if (t->is_format_2)
        return skip(t, 4);
    BRC_TRY(skip(t, 1));
    t->is_curved[i] = strcmp(t->token, "plane") != 0;
    return skip_list(t);
}

/* Which faces lie on a face of the domain. */
static int read_domain_face(struct brc_neper_file *t, size_t i)
{
    size_t n;
    BRC_TRY(skip_list(t)); /* its vertices */
    BRC_TRY(skip_list(t)); /* its edges */
    BRC_TRY(read_domain_type(t, i));
    BRC_TRY(skip(t, 1)); /* label */
    BRC_TRY(count(t, &n));
    for (size_t k = 0; k < n; k++) {
        long f;
        BRC_TRY(whole(t, 1, (long)t->n_faces, &f));
        t->face[f - 1].domain = (int32_t)i;
    }
    return 0;
}

/* Either a second polyhedron or a face of the domain, not both and not neither. */
static int check_faces(const struct brc_neper_file *t)
{
    for (size_t i = 0; i < t->n_faces; i++) {
        const struct brc_neper_face *f = &t->face[i];
        if (f->cell[0] < 0 || (f->cell[1] < 0) != (f->domain >= 0))
            BRC_FAIL(t->ctx, BRC_ERR_INPUT,
                     "%s: face %zu is neither between two polyhedra nor on a face of the domain",
                     t->path, i + 1);
    }
    return 0;
}

/* Parts that name entries of others by number come after those, so that each number has a range. */
int brc_neper_parse(struct brc_neper_file *t)
{
    size_t n;
    BRC_TRY(read_kind(t));
    BRC_TRY(read_cells(t));
    BRC_TRY(begin(t, "**vertex", true, &t->n_vertices));
    t->vertex = brc_pool_alloc(t->ctx, &t->pool, t->n_vertices, sizeof *t->vertex);
    BRC_TRY(read_entries(t, t->n_vertices, read_vertex));
    BRC_TRY(begin(t, "**face", true, &t->n_faces));
    t->face = brc_pool_alloc(t->ctx, &t->pool, t->n_faces, sizeof *t->face);
    t->loop = brc_pool_alloc(t->ctx, &t->pool, t->size / 2 + 1, sizeof *t->loop);
    BRC_TRY(read_entries(t, t->n_faces, read_face));
    BRC_TRY(begin(t, "**polyhedron", true, &n));
    if (n != t->n_cells)
        return fail(t, "there must be a polyhedron for each cell");
    BRC_TRY(read_entries(t, n, read_polyhedron));
    BRC_TRY(find(t, "**domain", true));
    BRC_TRY(begin(t, "*face", false, &t->n_domain));
    if (t->n_domain > MAX_DOMAIN_FACES)
        return fail(t, "too many faces of the domain");
    t->is_curved = brc_pool_alloc(t->ctx, &t->pool, t->n_domain, 1);
    BRC_TRY(read_entries(t, t->n_domain, read_domain_face));
    return check_faces(t);
}
