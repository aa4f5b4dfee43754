/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YAML events to a flat list of entries, with the bytes where each stands: the writer puts values
 * back in their place. Anchors, tags and several documents are refused: a case is data that people
 * read. Called through casefile.h by whoever has a case; knows the keys of no section but the top
 * level's. */
#include "common/input/casefile.h"

#include "common/base/grow.h"
#include "common/base/input_file.h"

#include <yaml.h>

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A mapping that is open while the file is read. Levels are an array, not the stack of a recursion:
 * three are allowed, and a deeper file is an error at once. */
struct level {
    char key[BRC_CASEFILE_KEY_SIZE]; /* the key whose value is awaited, "" before a key */
    int line, column;                /* of that key */
    size_t key_begin;                /* byte where it starts */
    int place;                       /* of the mapping in the sections, -1: the root */
    bool has_values;
};

struct reader {
    struct brc_context *ctx;
    struct brc_casefile *c;
    struct level level[BRC_CASEFILE_MAX_LEVELS];
    int depth;               /* open mappings */
    bool is_sequence;        /* inside [...] */
    char *sequence;          /* its texts so far, joined by commas */
    bool is_done;            /* the document has ended */
    size_t n_chars, n_bytes; /* up to the same place of the text */
    size_t begin, end;       /* bytes of the last value */
    int indent;              /* see brc_casefile_entry */
};

/* ---- bytes --------------------------------------------------------------------------------- */

/* Bytes of the UTF-8 character at s, 0 for an invalid or a control character. libyaml would find
 * the same, but name a byte and no line, and values of --set do not pass it. */
static size_t utf8_length(const unsigned char *s, size_t left)
{
    static const uint32_t lowest[] = {0, 0, 0x80, 0x800, 0x10000}; /* no longer than needed */
    size_t n = s[0] < 0x80 ? 1 : s[0] < 0xc0 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    if (n == 0 || n > left || s[0] > 0xf4)
        return 0;
    uint32_t code = n == 1 ? s[0] : s[0] & (0xffu >> (n + 1));
    for (size_t i = 1; i < n; i++) {
        if ((s[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (s[i] & 0x3f);
    }
    bool is_control = (code < 0x20 && code != '\t' && code != '\n' && code != '\r') ||
                      (code >= 0x7f && code < 0xa0);
    bool is_surrogate = code >= 0xd800 && code < 0xe000;
    bool is_mark = code == 0xfeff || code >= 0x110000; /* byte order mark, too large */
    return code < lowest[n] || is_control || is_surrogate || is_mark ? 0 : n;
}

/* Bytes up to the first that starts no character, size when all do. */
static size_t good_bytes(const char *text, size_t size)
{
    size_t i = 0;
    for (size_t n = 1; i < size && n > 0; i += n)
        n = utf8_length((const unsigned char *)text + i, size - i);
    return i;
}

bool brc_casefile_is_text(const char *text)
{
    return good_bytes(text, strlen(text)) == strlen(text);
}

/* Before libyaml sees a byte: what it says of bad ones has no line. */
static int check_bytes(struct brc_context *ctx, const char *path, const char *text, size_t size)
{
    int line = 1;
    if (size > BRC_CASEFILE_MAX_BYTES)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: the case file is larger than %d bytes", path,
                 BRC_CASEFILE_MAX_BYTES);
    size_t good = good_bytes(text, size);
    if (good == size)
        return 0;
    for (size_t i = 0; i < good; i++)
        line += text[i] == '\n';
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "%s:%d: byte 0x%02x starts no valid UTF-8 text or is a control character; save the "
             "file as plain UTF-8 without byte order mark",
             path, line, (unsigned char)text[good]);
}

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

/* ---- YAML events --------------------------------------------------------------------------- */

static int fail_at(struct reader *r, int line, const char *what)
{
    BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s", r->c->path, line, what);
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

/* The value has been read: a key may follow. */
static void end_key(struct level *level)
{
    level->key[0] = '\0';
    level->has_values = true;
}

/* The key whose value comes now: an entry at the level it belongs to. */
static int add_value(struct reader *r, const char *text, int line)
{
    struct level *top = &r->level[r->depth - 1];
    const char *name[3] = {r->depth > 1 ? r->level[0].key : "", r->depth > 2 ? r->level[1].key : "",
                           top->key};
    BRC_TRY(add_entry(r->ctx, r->c, name, text, line));
    struct brc_casefile_entry *e = &r->c->entries[r->c->n - 1];
    e->key_begin = top->key_begin;
    e->place = top->place;
    e->begin = r->begin;
    e->end = r->end;
    e->indent = r->indent;
    end_key(top);
    return 0;
}

/* A sequence is one value, "a, b, c": the lists know triples, and --set writes them so. */
static int add_item(struct reader *r, const char *text)
{
    size_t old = strlen(r->sequence), n = strlen(text);
    char *longer = brc_realloc(r->ctx, r->sequence, old + n + 3, 1);
    if (!longer)
        return BRC_ERR_MEMORY;
    r->sequence = longer;
    strcat(strcat(longer, old ? ", " : ""), text);
    return 0;
}

static int read_key(struct reader *r, const yaml_event_t *event, int line)
{
    struct level *top = &r->level[r->depth - 1];
    const char *text = (const char *)event->data.scalar.value;
    char where[BRC_CASEFILE_WHERE_SIZE];
    BRC_TRY(check_name(r->ctx, text, event->data.scalar.length,
                       brc_casefile_where(r->c, line, false, where)));
    snprintf(top->key, sizeof top->key, "%s", text);
    top->line = line;
    top->column = (int)event->start_mark.column;
    top->key_begin = byte_at(r, &event->start_mark);
    return 0;
}

/* A key without a value is an empty section where it can be one. A number as a key is the second
 * half of one with a decimal comma, `{length: 1,5 m}`: to YAML that is two keys. */
static int read_null(struct reader *r)
{
    struct level *top = &r->level[r->depth - 1];
    if (isdigit((unsigned char)top->key[0]))
        BRC_FAIL(r->ctx, BRC_ERR_INPUT,
                 "%s:%d: '%s' follows a comma: in braces and brackets a comma ends a value, so "
                 "write numbers with a decimal point",
                 r->c->path, top->line, top->key);
    if (r->depth > 1 || brc_params_find(brc_casefile_param_list, top->key))
        BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s: has no value; write one or leave the key out",
                 r->c->path, top->line, top->key);
    BRC_TRY(add_section(r->ctx, r->c, top->key, top->line));
    struct brc_casefile_place *s = &r->c->sections[r->c->n_sections - 1];
    s->form = BRC_CASEFILE_NULL;
    s->begin = r->begin;
    s->end = r->end;
    end_key(top);
    return 0;
}

/* A key, a value, or an item of a sequence, by what is open. An empty plain value is YAML's null;
 * in quotes it is a text. */
static int read_scalar(struct reader *r, const yaml_event_t *event, int line)
{
    const char *text = (const char *)event->data.scalar.value;
    size_t n = event->data.scalar.length;
    bool is_plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    if (r->depth == 0)
        return fail_at(r, line, "a case file is a mapping, `key: value`; this is a lone value");
    struct level *top = &r->level[r->depth - 1];
    for (size_t i = 0; i < n; i++)
        if ((unsigned char)text[i] < 0x20)
            return fail_at(r, line, "a value must be one line without control characters");
    if (!r->is_sequence && top->key[0] != '\0') {
        r->begin = byte_at(r, &event->start_mark);
        r->indent = 0;
    }
    end_value(r, &event->end_mark);
    if (r->is_sequence)
        return add_item(r, text);
    if (top->key[0] == '\0')
        return read_key(r, event, line);
    if (is_plain && (n == 0 || strcmp(text, "~") == 0 || strcmp(text, "null") == 0))
        return read_null(r);
    return add_value(r, text, top->line);
}

static struct brc_casefile_place *place_of(struct reader *r, const struct level *level)
{
    return level->place < 0 ? &r->c->root : &r->c->sections[level->place];
}

/* A mapping under a section is a group of keys, `interaction: {rule: gap, gap: 1 mm}`; it has a
 * place of its own, where the writer adds keys to it. */
static int open_mapping(struct reader *r, const yaml_event_t *event, int line)
{
    char name[2 * BRC_CASEFILE_KEY_SIZE];
    bool is_flow = event->data.mapping_start.style == YAML_FLOW_MAPPING_STYLE;
    if (r->is_sequence)
        return fail_at(r, line, "a sequence holds plain values, no mappings");
    if (r->depth > 0 && r->level[r->depth - 1].key[0] == '\0')
        return fail_at(r, line, "a key must be a plain word");
    if (r->depth == BRC_CASEFILE_MAX_LEVELS)
        return fail_at(r, line, "mappings are nested deeper than 3 levels; join keys as a_b");
    if (r->depth > 0) {
        snprintf(name, sizeof name, "%s%s%s", r->level[0].key, r->depth > 1 ? "." : "",
                 r->depth > 1 ? r->level[1].key : "");
        BRC_TRY(add_section(r->ctx, r->c, name, r->level[r->depth - 1].line));
    }
    r->level[r->depth] = (struct level){.place = r->depth > 0 ? (int)r->c->n_sections - 1 : -1};
    struct brc_casefile_place *place = place_of(r, &r->level[r->depth]);
    place->form = is_flow ? BRC_CASEFILE_FLOW : BRC_CASEFILE_BLOCK;
    place->indent = (int)event->start_mark.column;
    r->begin = byte_at(r, &event->start_mark);
    r->end = r->begin + is_flow;
    r->depth++;
    return 0;
}

/* A mapping in braces ends behind its brace, one on lines of its own with its last value: libyaml's
 * mark of the latter lies at the next key, behind comments that are not its own. */
static int close_mapping(struct reader *r, const yaml_event_t *event)
{
    r->depth--;
    const struct level *closed = &r->level[r->depth];
    struct brc_casefile_place *place = place_of(r, closed);
    place->end = r->end;
    if (place->form == BRC_CASEFILE_FLOW) {
        if (!closed->has_values)
            place->form = BRC_CASEFILE_EMPTY;
        end_value(r, &event->end_mark);
    }
    if (r->depth > 0)
        end_key(&r->level[r->depth - 1]);
    return 0;
}

static int open_sequence(struct reader *r, const yaml_event_t *event, int line)
{
    int column = (int)event->start_mark.column;
    if (r->depth == 0)
        return fail_at(r, line, "a case file is a mapping, `key: value`; this is a sequence");
    if (r->is_sequence || r->level[r->depth - 1].key[0] == '\0')
        return fail_at(r, line, "a sequence must be the value of a key and hold plain values");
    /* where a value takes its place: the dashes of a sequence may stand in the column of its key,
     * another value may not */
    int key = r->level[r->depth - 1].column;
    bool is_flow = event->data.sequence_start.style == YAML_FLOW_SEQUENCE_STYLE;
    r->begin = byte_at(r, &event->start_mark);
    r->indent = is_flow || column > key ? 0 : key + 2 - column;
    r->is_sequence = true;
    r->sequence = brc_alloc(r->ctx, 1, 1);
    return r->sequence ? 0 : BRC_ERR_MEMORY;
}

static int close_sequence(struct reader *r, const yaml_event_t *event)
{
    if (r->c->text[r->begin] == '[')
        end_value(r, &event->end_mark);
    int code = add_value(r, r->sequence, r->level[r->depth - 1].line);
    free(r->sequence);
    r->sequence = NULL;
    r->is_sequence = false;
    return code;
}

/* Anchors, aliases and tags are YAML's way to programs; a case file is data. Scalars, sequences and
 * mappings begin with anchor and tag, aliases with the anchor, so that any of the union's members
 * shows them (C17, 6.5.2.3). */
static int refuse_extras(struct reader *r, const yaml_event_t *event, int line)
{
    bool has_tag = event->type == YAML_SCALAR_EVENT || event->type == YAML_SEQUENCE_START_EVENT ||
                   event->type == YAML_MAPPING_START_EVENT;
    if (event->type == YAML_ALIAS_EVENT || (has_tag && event->data.scalar.anchor))
        return fail_at(r, line,
                       "anchors and aliases (&name, *name) are not accepted; write the "
                       "value out at each place");
    if (has_tag && event->data.scalar.tag)
        return fail_at(r, line, "tags (!name) are not accepted; write the plain value");
    return 0;
}

/* Stream and document events carry nothing here, but that a second document is refused: which of
 * the two would be the case? */
static int read_event(struct reader *r, const yaml_event_t *event)
{
    int line = (int)event->start_mark.line + 1;
    BRC_TRY(refuse_extras(r, event, line));
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return r->is_done ? fail_at(r, line, "a case file holds one document; this is a second")
                          : 0;
    case YAML_DOCUMENT_END_EVENT:
        r->is_done = true;
        return 0;
    case YAML_SCALAR_EVENT:
        return read_scalar(r, event, line);
    case YAML_MAPPING_START_EVENT:
        return open_mapping(r, event, line);
    case YAML_MAPPING_END_EVENT:
        return close_mapping(r, event);
    case YAML_SEQUENCE_START_EVENT:
        return open_sequence(r, event, line);
    case YAML_SEQUENCE_END_EVENT:
        return close_sequence(r, event);
    default:
        return 0;
    }
}

/* What YAML says of a line. Of a tab it says "found character that cannot start any token", which
 * helps nobody who does not see tabs. */
static int fail_yaml(struct reader *r, const yaml_parser_t *parser)
{
    const char *line = r->c->text;
    for (size_t i = 0; i < parser->problem_mark.line && strchr(line, '\n'); i++)
        line = strchr(line, '\n') + 1;
    size_t blanks = strspn(line, " \t");
    bool has_tab = memchr(line, '\t', blanks) != NULL;
    BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: not valid YAML: %s%s%s%s", r->c->path,
             (int)parser->problem_mark.line + 1,
             has_tab ? "the line is indented by a tab, indent it by blanks; " : "",
             parser->problem ? parser->problem : "unreadable", parser->context ? ", " : "",
             parser->context ? parser->context : "");
}

/* Events are freed one by one, also those that were refused. */
static int read_events(struct reader *r, yaml_parser_t *parser)
{
    yaml_event_t event;
    for (bool is_end = false; !is_end;) {
        if (!yaml_parser_parse(parser, &event))
            return fail_yaml(r, parser);
        int code = read_event(r, &event);
        is_end = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
        BRC_TRY(code);
    }
    return 0;
}

static int parse_yaml(struct brc_context *ctx, struct brc_casefile *c, size_t size)
{
    struct reader r = {.ctx = ctx, .c = c};
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory for the YAML parser");
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)c->text, size);
    int code = read_events(&r, &parser);
    yaml_parser_delete(&parser);
    free(r.sequence);
    return code;
}

/* ---- interface ----------------------------------------------------------------------------- */

int brc_casefile_parse(struct brc_context *ctx, const char *path, const char *text, size_t size,
                       struct brc_casefile *c)
{
    memset(c, 0, sizeof *c);
    BRC_TRY(check_bytes(ctx, path, text, size));
    c->path = copy_text(ctx, path, strlen(path));
    c->text = copy_text(ctx, text, size);
    if (!c->path || !c->text)
        return BRC_ERR_MEMORY;
    BRC_TRY(parse_yaml(ctx, c, size));
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
    if (good_bytes(assignment, size) < size || strpbrk(assignment, "\t\r\n"))
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
