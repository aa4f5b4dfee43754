/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A YAML document to a flat list of entries, with the bytes where each stands: the writer puts
 * values back in their place. Called through casefile.h by whoever has a case; knows the keys of no
 * section but the top level's.
 *
 * The document is loaded as a whole and then walked through, rather than read event by event: what
 * a value belongs to is then known from where it is, and need not be kept beside a stack. A case
 * has a page or two, so that memory does not count. */
#include "common/input/casefile.h"

#include "common/base/grow.h"
#include "common/base/input_file.h"
#include "common/input/casefile_yaml.h"

#include <yaml.h>

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What stays the same while a document is walked through, and the last value. */
struct reader {
    struct brc_context *ctx;
    struct brc_casefile *c;
    yaml_document_t *document;
    const char *key[BRC_CASEFILE_MAX_LEVELS]; /* from the top level to the one that is being read */
    size_t n_chars, n_bytes;                  /* up to the same place of the text */
    size_t key_begin, begin, end;             /* bytes of the last key and value */
};

/* A key with its value, and the mapping that they are in. */
struct pair {
    const yaml_node_t *key, *value;
    int depth; /* of the key: 0 at the top level */
    int place; /* of the mapping in the sections, -1: the root */
};

static char *copy_text(struct brc_context *ctx, const char *text, size_t size)
{
    char *copy = brc_alloc(ctx, size + 1, 1);
    return copy ? memcpy(copy, text, size) : NULL;
}

/* ---- building the list --------------------------------------------------------------------- */

/* Dots stand between section and key in messages and in --set, so that no key may hold one. */
static int check_name(struct brc_context *ctx, const char *name, size_t n, const char *where)
{
    if (n == 0 || n >= BRC_CASEFILE_KEY_SIZE || memchr(name, '.', n) || memchr(name, '\0', n))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' is not a key; a key has 1 to %d characters and no dot", where, name,
                 BRC_CASEFILE_KEY_SIZE - 1);
    return 0;
}

/* A section that --set has opened may be opened by the file as well, since a case is also read anew
 * from its text; two mappings of the file may not share a name: readers of YAML keep the one or the
 * other. */
static int add_section(struct brc_context *ctx, struct brc_casefile *c, const char *name, int line)
{
    const struct brc_casefile_place *old = brc_casefile_find_section(c, name);
    if (old && old->line > 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s:%d: %s: given twice, first in line %d; keep one of the two", c->path, line,
                 name, old->line);
    BRC_GROW(ctx, c->sections, c->cap_sections, c->n_sections + 1);
    struct brc_casefile_place *s = &c->sections[c->n_sections++];
    *s = (struct brc_casefile_place){.line = line};
    snprintf(s->name, sizeof s->name, "%s", name);
    return 0;
}

/* Adds section.key, or section.parent_key where there is a parent, with a copy of text. Whether a
 * key is given twice is found when its section is read: only the section's list knows which names
 * mean the same. */
static int add_entry(struct brc_context *ctx, struct brc_casefile *c, const char *const name[3],
                     const char *text, int line)
{
    struct brc_casefile_entry e = {.line = line, .is_override = line == 0};
    char where[BRC_CASEFILE_WHERE_SIZE];
    const char *parent = name[1], *key = name[2];
    brc_casefile_where(c, line, e.is_override, where);
    snprintf(e.section, sizeof e.section, "%s", name[0]);
    int n = snprintf(e.key, sizeof e.key, "%s%s%s", parent, *parent ? "_" : "", key);
    if (n >= (int)sizeof e.key)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: the key %s.%s.%s is longer than %d characters", where,
                 name[0], parent, key, BRC_CASEFILE_KEY_SIZE - 1);
    if (strcmp(key, "rule") == 0)
        snprintf(e.parent, sizeof e.parent, "%s", parent);
    if (c->n == BRC_CASEFILE_MAX_ENTRIES)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: more than %d keys in one case", where,
                 BRC_CASEFILE_MAX_ENTRIES);
    BRC_GROW(ctx, c->entries, c->cap, c->n + 1);
    e.text = copy_text(ctx, text, strlen(text));
    if (!e.text)
        return BRC_ERR_MEMORY;
    c->entries[c->n++] = e;
    return 0;
}

/* ---- the document -------------------------------------------------------------------------- */

static int fail_at(struct reader *r, int line, const char *what)
{
    BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s", r->c->path, line, what);
}

static int line_of(const yaml_node_t *node)
{
    return (int)node->start_mark.line + 1;
}

/* Bytes of the text up to a mark, which counts characters. Marks come in ascending order but for
 * few, so that the text is gone through once. */
static size_t byte_at(struct reader *r, const yaml_mark_t *mark)
{
    const char *text = r->c->text;
    if (mark->index < r->n_chars)
        r->n_chars = r->n_bytes = 0;
    for (; r->n_chars < mark->index && text[r->n_bytes]; r->n_chars++)
        do
            r->n_bytes++;
        while (((unsigned char)text[r->n_bytes] & 0xc0) == 0x80);
    return r->n_bytes;
}

/* A block scalar ends on the line behind its own, a value in braces before the blanks that follow:
 * neither line breaks nor blanks belong to what the writer replaces. */
static void end_value(struct reader *r, const yaml_mark_t *mark)
{
    r->end = byte_at(r, mark);
    while (r->end > r->begin && strchr(" \t\r\n", r->c->text[r->end - 1]))
        r->end--;
}

/* The text of a node that must be a plain one: a key, a value or an item of a sequence. */
static int check_scalar(struct reader *r, const yaml_node_t *node)
{
    for (size_t i = 0; i < node->data.scalar.length; i++)
        if (node->data.scalar.value[i] < 0x20)
            return fail_at(r, line_of(node), "a value must be one line without control characters");
    return 0;
}

/* An entry of the mapping that the pair is in. */
static int add_value(struct reader *r, const struct pair *p, const char *text, int indent)
{
    const char *const name[3] = {p->depth > 0 ? r->key[0] : "", p->depth > 1 ? r->key[1] : "",
                                 r->key[p->depth]};
    BRC_TRY(add_entry(r->ctx, r->c, name, text, line_of(p->key)));
    struct brc_casefile_entry *e = &r->c->entries[r->c->n - 1];
    e->key_begin = r->key_begin;
    e->place = p->place;
    e->begin = r->begin;
    e->end = r->end;
    e->indent = indent;
    return 0;
}

/* A key without a value is an empty section where it can be one. A number as a key is the second
 * half of one with a decimal comma, `{length: 1,5 m}`: to YAML that is two keys. */
static int read_null(struct reader *r, const struct pair *p)
{
    const char *key = r->key[p->depth];
    int line = line_of(p->key);
    if (isdigit((unsigned char)key[0]))
        BRC_FAIL(r->ctx, BRC_ERR_INPUT,
                 "%s:%d: '%s' follows a comma: in braces and brackets a comma ends a value, so "
                 "write numbers with a decimal point",
                 r->c->path, line, key);
    if (p->depth > 0 || brc_params_find(brc_casefile_param_list, key))
        BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s: has no value; write one or leave the key out",
                 r->c->path, line, key);
    BRC_TRY(add_section(r->ctx, r->c, key, line));
    struct brc_casefile_place *s = &r->c->sections[r->c->n_sections - 1];
    s->form = BRC_CASEFILE_NULL;
    s->begin = r->begin;
    s->end = r->end;
    return 0;
}

/* An empty plain value is YAML's null; in quotes it is a text. */
static int read_scalar(struct reader *r, const struct pair *p)
{
    const char *text = (const char *)p->value->data.scalar.value;
    BRC_TRY(check_scalar(r, p->value));
    r->begin = byte_at(r, &p->value->start_mark);
    end_value(r, &p->value->end_mark);
    if (p->value->data.scalar.style == YAML_PLAIN_SCALAR_STYLE &&
        (!*text || strcmp(text, "~") == 0 || strcmp(text, "null") == 0))
        return read_null(r, p);
    return add_value(r, p, text, 0);
}

/* A sequence is one value, "a, b, c": the lists know triples, and --set writes them so. One in
 * brackets ends behind them, one on lines of its own with its last item. */
static int read_items(struct reader *r, const struct pair *p, char **text)
{
    size_t size = 1;
    const yaml_node_item_t *first = p->value->data.sequence.items.start,
                           *end = p->value->data.sequence.items.top;
    const yaml_mark_t *mark = &p->value->end_mark;
    for (const yaml_node_item_t *i = first; i < end; i++) {
        const yaml_node_t *item = yaml_document_get_node(r->document, *i);
        if (item->type != YAML_SCALAR_NODE)
            return fail_at(r, line_of(item),
                           "a sequence holds plain values, no mappings and no sequences");
        BRC_TRY(check_scalar(r, item));
        size += item->data.scalar.length + 2;
        if (r->c->text[r->begin] != '[')
            mark = &item->end_mark;
    }
    end_value(r, mark);
    *text = brc_alloc(r->ctx, size, 1);
    for (const yaml_node_item_t *i = first; *text && i < end; i++)
        strcat(strcat(*text, i > first ? ", " : ""),
               (const char *)yaml_document_get_node(r->document, *i)->data.scalar.value);
    return *text ? 0 : BRC_ERR_MEMORY;
}

/* The dashes of a sequence may stand in the column of its key; another value that takes its place
 * may not, and needs blanks. */
static int read_sequence(struct reader *r, const struct pair *p)
{
    char *text = NULL;
    int column = (int)p->value->start_mark.column, key = (int)p->key->start_mark.column;
    bool is_flow = p->value->data.sequence.style == YAML_FLOW_SEQUENCE_STYLE;
    r->begin = byte_at(r, &p->value->start_mark);
    int code = read_items(r, p, &text);
    if (code == 0)
        code = add_value(r, p, text, is_flow || column > key ? 0 : key + 2 - column);
    free(text);
    return code;
}

static int read_pair(struct reader *r, const struct pair *p);

/* A mapping under a section is a group of keys, `interaction: {rule: gap, gap: 1 mm}`; it has a
 * place of its own, where the writer adds keys to it. One in braces ends behind its brace, one on
 * lines of its own with its last value: libyaml's mark of the latter lies at the next key, behind
 * comments that are not its own. */
static int read_mapping(struct reader *r, const yaml_node_t *node, int depth, int place)
{
    const yaml_node_pair_t *first = node->data.mapping.pairs.start,
                           *end = node->data.mapping.pairs.top;
    bool is_flow = node->data.mapping.style == YAML_FLOW_MAPPING_STYLE;
    enum brc_casefile_form form = !is_flow       ? BRC_CASEFILE_BLOCK
                                  : first == end ? BRC_CASEFILE_EMPTY
                                                 : BRC_CASEFILE_FLOW;
    r->begin = byte_at(r, &node->start_mark);
    r->end = r->begin + is_flow;
    for (const yaml_node_pair_t *i = first; i < end; i++) {
        const struct pair p = {yaml_document_get_node(r->document, i->key),
                               yaml_document_get_node(r->document, i->value), depth, place};
        BRC_TRY(read_pair(r, &p));
    }
    struct brc_casefile_place *s = place < 0 ? &r->c->root : &r->c->sections[place];
    s->form = form;
    s->indent = (int)node->start_mark.column;
    s->end = r->end;
    if (is_flow)
        end_value(r, &node->end_mark);
    return 0;
}

/* The depth is bounded, so that the walk is, too. */
static int open_mapping(struct reader *r, const struct pair *p)
{
    char name[2 * BRC_CASEFILE_KEY_SIZE];
    if (p->depth + 1 == BRC_CASEFILE_MAX_LEVELS)
        return fail_at(r, line_of(p->value),
                       "mappings are nested deeper than 3 levels; join keys as a_b");
    snprintf(name, sizeof name, "%s%s%s", r->key[0], p->depth > 0 ? "." : "",
             p->depth > 0 ? r->key[1] : "");
    BRC_TRY(add_section(r->ctx, r->c, name, line_of(p->key)));
    return read_mapping(r, p->value, p->depth + 1, (int)r->c->n_sections - 1);
}

static int read_pair(struct reader *r, const struct pair *p)
{
    char where[BRC_CASEFILE_WHERE_SIZE];
    if (p->key->type != YAML_SCALAR_NODE)
        return fail_at(r, line_of(p->key), "a key must be a plain word");
    BRC_TRY(check_scalar(r, p->key));
    r->key[p->depth] = (const char *)p->key->data.scalar.value;
    BRC_TRY(check_name(r->ctx, r->key[p->depth], p->key->data.scalar.length,
                       brc_casefile_where(r->c, line_of(p->key), false, where)));
    r->key_begin = byte_at(r, &p->key->start_mark);
    return p->value->type == YAML_SCALAR_NODE     ? read_scalar(r, p)
           : p->value->type == YAML_SEQUENCE_NODE ? read_sequence(r, p)
                                                  : open_mapping(r, p);
}

/* ---- interface ----------------------------------------------------------------------------- */

/* From the root on. */
static int read_document(void *user, yaml_document_t *document)
{
    struct reader *r = user;
    r->document = document;
    return read_mapping(r, yaml_document_get_root_node(document), 0, -1);
}

int brc_casefile_parse(struct brc_context *ctx, const char *path, const char *text, size_t size,
                       struct brc_casefile *c)
{
    const struct brc_yaml_text from = {path, "case file", text, size};
    memset(c, 0, sizeof *c);
    c->path = copy_text(ctx, path, strlen(path));
    c->text = copy_text(ctx, text, size);
    if (!c->path || !c->text)
        return BRC_ERR_MEMORY;
    struct reader r = {.ctx = ctx, .c = c};
    BRC_TRY(brc_yaml_load(ctx, &from, read_document, &r));
    return brc_casefile_top_level(ctx, c);
}

/* One reader for all inputs (input_file.h): devices and endless files are refused there. */
int brc_casefile_read(struct brc_context *ctx, const char *path, struct brc_casefile *c)
{
    memset(c, 0, sizeof *c);
    const struct brc_input in = {
        .noun = "the case file", .path = path, .largest = BRC_CASEFILE_MAX_BYTES};
    char *text;
    size_t size;
    BRC_TRY(brc_input_read(ctx, &in, &text, &size));
    int code = brc_casefile_parse(ctx, path, text, size, c);
    free(text);
    return code;
}

/* Read like an entry of the file, with line 0. Dots part section, mapping and key; behind the first
 * = everything is the value, dots and = included. */
int brc_casefile_override(struct brc_context *ctx, struct brc_casefile *c, const char *assignment)
{
    static const char no_form[] = "--set: '%.60s' is not of the form section.key=value";
    char part[BRC_CASEFILE_MAX_LEVELS][BRC_CASEFILE_KEY_SIZE];
    size_t size = strlen(assignment);
    const char *equals = strchr(assignment, '='), *at = assignment;
    int n = 0;
    if (!equals || size > BRC_CASEFILE_MAX_BYTES)
        BRC_FAIL(ctx, BRC_ERR_USAGE, no_form, assignment);
    if (!brc_casefile_is_text(assignment) || strpbrk(assignment, "\t\r\n"))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--set: the value is not one line of UTF-8 text");
    for (; at <= equals; at += strlen(part[n++]) + 1) {
        if (n == BRC_CASEFILE_MAX_LEVELS)
            BRC_FAIL(ctx, BRC_ERR_USAGE, no_form, assignment);
        BRC_TRY(check_name(ctx, at, strcspn(at, ".="), "--set"));
        snprintf(part[n], BRC_CASEFILE_KEY_SIZE, "%.*s", (int)strcspn(at, ".="), at);
    }
    const char *name[3] = {n > 1 ? part[0] : "", n > 2 ? part[1] : "", part[n - 1]};
    if (*name[0] && !brc_casefile_find_section(c, name[0]))
        BRC_TRY(add_section(ctx, c, name[0], 0));
    BRC_TRY(add_entry(ctx, c, name, at + strspn(at, " "), 0));
    return brc_casefile_top_level(ctx, c);
}

void brc_casefile_free(struct brc_casefile *c)
{
    for (size_t i = 0; i < c->n; i++)
        free(c->entries[i].text);
    free(c->entries);
    free(c->sections);
    free(c->path);
    free(c->text);
    memset(c, 0, sizeof *c);
}
