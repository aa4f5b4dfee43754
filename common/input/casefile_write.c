/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Puts values into the text of a case, so that what a run keeps says what has run. The user's
 * words, comments and layout stay: a value takes the place of the one before, a key that the file
 * does not give is added behind the last of its section. Overrides once stood in the kept case as
 * comments; then it made another run than the one that it was kept with.
 *
 * libyaml's emitter is no help: it writes a document anew, without comments, in its own layout. */
#include "common/input/casefile.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes [begin, end) of the text become a line break (where there is one), blanks and the parts.
 * One edit at a time: the next one needs the places of the case that this one has made. */
struct edit {
    size_t begin, end;
    const char *line;
    int indent;
    const char *part[6];
};

/* A value that YAML takes as it is, in every place. Narrower than YAML's own rule, which depends on
 * what is around the value: quotes that were not needed do no harm. */
static bool is_plain(const char *value)
{
    const char *first = value + strspn(value, "+-.");
    size_t n = strlen(value);
    return first - value < 2 && isalnum((unsigned char)*first) && value[n - 1] != ' ' &&
           strcmp(value, "null") != 0 &&
           value[strspn(value, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               " +-./_^*")] == '\0';
}

/* Line breaks of Unicode and what YAML does not print are written as escapes. */
static const char *escape(const char *c)
{
    static const char *const list[][2] = {{"\"", "\\\""},
                                          {"\\", "\\\\"},
                                          {"\xe2\x80\xa8", "\\u2028"},
                                          {"\xe2\x80\xa9", "\\u2029"},
                                          {"\xef\xbf\xbe", "\\ufffe"},
                                          {"\xef\xbf\xbf", "\\uffff"}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++)
        if (strncmp(c, list[i][0], strlen(list[i][0])) == 0)
            return list[i][1];
    return NULL;
}

/* The value as YAML reads it back; allocated, NULL when out of memory. Double quotes, since only
 * they have escapes. An escape has at most six bytes. */
static char *quote(struct brc_context *ctx, const char *value)
{
    char *text = brc_alloc(ctx, 6 * strlen(value) + 3, 1), *at = text;
    if (!text || is_plain(value))
        return text ? strcpy(text, value) : NULL;
    *at++ = '"';
    for (const char *c = value; *c;) {
        const char *escaped = escape(c);
        size_t n = escaped ? strlen(escaped) : 1;
        for (size_t i = 0; i < n; i++)
            *at++ = escaped ? escaped[i] : c[i];
        c += escaped && (unsigned char)*c >= 0x80 ? 3 : 1;
    }
    strcpy(at, "\"");
    return text;
}

static char *edited_text(struct brc_context *ctx, const char *old, const struct edit *e)
{
    size_t n_parts = 0, size = strlen(old) + (size_t)e->indent + 4, n = e->begin;
    for (; n_parts < sizeof e->part / sizeof e->part[0] && e->part[n_parts]; n_parts++)
        size += strlen(e->part[n_parts]);
    char *text = brc_alloc(ctx, size, 1);
    if (!text)
        return NULL;
    memcpy(text, old, n);
    n += (size_t)sprintf(text + n, "%s%*s", e->line ? e->line : "", e->indent, "");
    for (size_t i = 0; i < n_parts; i++)
        n += (size_t)sprintf(text + n, "%s", e->part[i]);
    /* a comment that followed a bracket or a quote would be taken for a part of a plain value */
    sprintf(text + n, "%s%s", old[e->end] == '#' ? " " : "", old + e->end);
    return text;
}

/* Makes the case anew from the edited text: the places of all that follows have moved, and an edit
 * that YAML would read as something else is found here and not when the kept case is run. */
static int apply(struct brc_context *ctx, struct brc_casefile *c, const struct edit *e)
{
    struct brc_casefile fresh;
    char *text = edited_text(ctx, c->text, e);
    if (!text)
        return BRC_ERR_MEMORY;
    int code = brc_casefile_parse(ctx, c->path, text, strlen(text), &fresh);
    free(text);
    brc_casefile_free(code == 0 ? c : &fresh);
    if (code == 0)
        *c = fresh;
    return code;
}

/* `key: value` behind the last key of a mapping. */
static int append(struct brc_context *ctx, struct brc_casefile *c,
                  const struct brc_casefile_place *place, const char *key, const char *value)
{
    size_t at = place->end;
    if (place->form == BRC_CASEFILE_NULL)
        return apply(ctx, c,
                     &(struct edit){place->begin, at, NULL, 1, {"{", key, ": ", value, "}"}});
    if (place->form == BRC_CASEFILE_EMPTY)
        return apply(ctx, c, &(struct edit){at, at, NULL, 0, {key, ": ", value}});
    if (place->form == BRC_CASEFILE_FLOW)
        return apply(ctx, c, &(struct edit){at, at, ",", 1, {key, ": ", value}});
    at += strcspn(c->text + at, "\r\n");
    const char *line = c->text[at] == '\r' ? "\r\n" : "\n";
    return apply(ctx, c, &(struct edit){at, at, line, place->indent, {key, ": ", value}});
}

/* A key that the file gives nowhere; `rule` of a nested mapping stands for the mapping's own key. A
 * section that is missing comes behind the last one, empty at first; its keys then stand in braces,
 * which need no indentation that would have to agree with the user's. */
static int add(struct brc_context *ctx, struct brc_casefile *c, const char *section,
               const char *key, const char *value)
{
    char nested[2 * BRC_CASEFILE_KEY_SIZE];
    snprintf(nested, sizeof nested, "%s.%s", section, key);
    const struct brc_casefile_place *place = brc_casefile_find_section(c, nested);
    if (place)
        return append(ctx, c, place, "rule", value);
    if (!*section)
        return append(ctx, c, &c->root, key, value);
    if (!brc_casefile_find_section(c, section))
        BRC_TRY(append(ctx, c, &c->root, section, "{}"));
    place = brc_casefile_find_section(c, section);
    if (!place)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "the section %s was added, but is not found", section);
    return append(ctx, c, place, key, value);
}

/* Is the entry all that its mapping holds? Nested mappings count: without their section they would
 * be lost with it. */
static bool is_alone(const struct brc_casefile *c, const struct brc_casefile_entry *e)
{
    const char *name = e->place < 0 ? "" : c->sections[e->place].name;
    size_t n = strlen(name);
    for (size_t i = 0; i < c->n; i++)
        if (&c->entries[i] != e && c->entries[i].place == e->place)
            return false;
    for (size_t i = 0; i < c->n_sections; i++) /* nested mappings */
        if (n == 0 || (strncmp(c->sections[i].name, name, n) == 0 && c->sections[i].name[n] == '.'))
            return false;
    return true;
}

/* In braces a key goes with the comma behind it, where there is one; YAML allows a comma before the
 * closing brace, so that the one before the key may stay. On lines of its own it goes with them,
 * and the last of a mapping leaves empty braces: without them the section would have no value. */
int brc_casefile_remove(struct brc_context *ctx, struct brc_casefile *c, const char *section,
                        const char *key, struct brc_param_list list)
{
    const struct brc_casefile_entry *e = brc_casefile_find_entry(c, section, key, list);
    if (!e)
        return 0;
    const struct brc_casefile_place *place = e->place < 0 ? &c->root : &c->sections[e->place];
    struct edit edit = {e->key_begin, e->end, NULL, 0, {""}};
    if (place->form == BRC_CASEFILE_FLOW) {
        size_t comma = e->end + strspn(c->text + e->end, " \t\r\n");
        edit.end = c->text[comma] == ',' ? comma + 1 : e->end;
    } else if (is_alone(c, e)) {
        edit.part[0] = "{}";
    } else {
        while (edit.begin > 0 && c->text[edit.begin - 1] == ' ')
            edit.begin--;
        edit.end += strcspn(c->text + edit.end, "\n");
        edit.end += c->text[edit.end] == '\n';
    }
    return apply(ctx, c, &edit);
}

/* The entry that gives the key its value is the one that is replaced, under whatever name it
 * stands: an older name stays as the user wrote it. */
int brc_casefile_write(struct brc_context *ctx, struct brc_casefile *c, const char *section,
                       const char *key, struct brc_param_list list, const char *value)
{
    const struct brc_casefile_entry *old = brc_casefile_find_entry(c, section, key, list);
    char *text = quote(ctx, value);
    int code = BRC_ERR_MEMORY;
    if (text && old)
        code = apply(ctx, c, &(struct edit){old->begin, old->end, NULL, old->indent, {text}});
    else if (text)
        code = add(ctx, c, section, key, text);
    free(text);
    return code;
}
