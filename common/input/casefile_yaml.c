/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What libyaml takes is judged before and after it: its own messages name bytes and tokens where a
 * reader needs lines and what to do. Called by casefile.c and casefile_tree.c. */
#include "common/input/casefile_yaml.h"

#include "common/input/casefile.h"

#include <yaml.h>

#include <string.h>

struct loader {
    struct brc_context *ctx;
    const struct brc_yaml_text *from;
    int (*act)(void *user, yaml_document_t *document);
    void *user;
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
static int check_bytes(const struct loader *l)
{
    const char *text = l->from->text;
    int line = 1;
    if (l->from->size > BRC_CASEFILE_MAX_BYTES)
        BRC_FAIL(l->ctx, BRC_ERR_INPUT, "%s: the %s is larger than %d bytes", l->from->path,
                 l->from->noun, BRC_CASEFILE_MAX_BYTES);
    size_t good = good_bytes(text, l->from->size);
    if (good == l->from->size)
        return 0;
    for (size_t i = 0; i < good; i++)
        line += text[i] == '\n';
    BRC_FAIL(l->ctx, BRC_ERR_INPUT,
             "%s:%d: byte 0x%02x starts no valid UTF-8 text or is a control character; save the "
             "file as plain UTF-8 without byte order mark",
             l->from->path, line, (unsigned char)text[good]);
}

/* ---- the document -------------------------------------------------------------------------- */

static int fail_at(const struct loader *l, size_t line, const char *what)
{
    BRC_FAIL(l->ctx, BRC_ERR_INPUT, "%s:%zu: %s", l->from->path, line + 1, what);
}

/* What YAML says of a line. Of a tab it says "found character that cannot start any token", which
 * helps nobody who does not see tabs. */
static int fail_yaml(const struct loader *l, const yaml_parser_t *parser)
{
    const char *line = l->from->text;
    for (size_t i = 0; i < parser->problem_mark.line && strchr(line, '\n'); i++)
        line = strchr(line, '\n') + 1;
    size_t blanks = strspn(line, " \t");
    bool has_tab = memchr(line, '\t', blanks) != NULL;
    BRC_FAIL(l->ctx, BRC_ERR_INPUT, "%s:%d: not valid YAML: %s%s%s%s", l->from->path,
             (int)parser->problem_mark.line + 1,
             has_tab ? "the line is indented by a tab, indent it by blanks; " : "",
             parser->problem ? parser->problem : "unreadable", parser->context ? ", " : "",
             parser->context ? parser->context : "");
}

/* Anchors, aliases and tags are YAML's way to programs; a case file is data. Looked for in the
 * words of the file, as a document that is loaded has none left. Where the words end in an error
 * the loader meets it, too. */
static int refuse_extras(const struct loader *l, yaml_parser_t *parser)
{
    yaml_token_t token;
    int code = 0;
    for (bool is_end = false; !is_end && code == 0 && yaml_parser_scan(parser, &token);) {
        size_t line = token.start_mark.line;
        if (token.type == YAML_ANCHOR_TOKEN || token.type == YAML_ALIAS_TOKEN)
            code = fail_at(l, line,
                           "anchors and aliases (&name, *name) are not accepted; write the value "
                           "out at each place");
        else if (token.type == YAML_TAG_TOKEN)
            code = fail_at(l, line, "tags (!name) are not accepted; write the plain value");
        is_end = token.type == YAML_STREAM_END_TOKEN;
        yaml_token_delete(&token);
    }
    return code;
}

/* A case or a sweep is one mapping. Which of two documents would be the case? */
static int check_root(const struct loader *l, int n, const yaml_document_t *document,
                      const yaml_node_t *root)
{
    char what[200];
    const char *noun = l->from->noun;
    if (n > 0)
        snprintf(what, sizeof what, "a %s holds one document; this is a second", noun);
    else if (root->type != YAML_MAPPING_NODE)
        snprintf(what, sizeof what, "a %s is a mapping, `key: value`; this is a %s", noun,
                 root->type == YAML_SCALAR_NODE ? "lone value" : "sequence");
    else
        return 0;
    return fail_at(l, n > 0 ? document->start_mark.line : root->start_mark.line, what);
}

/* An empty document has no root, and so has what follows the last one. */
static int read_documents(const struct loader *l, yaml_parser_t *parser)
{
    int code = 0;
    for (int n = 0; code == 0; n++) {
        yaml_document_t document;
        if (!yaml_parser_load(parser, &document))
            return fail_yaml(l, parser);
        const yaml_node_t *root = yaml_document_get_root_node(&document);
        code = root ? check_root(l, n, &document, root) : 0;
        if (root && code == 0)
            code = l->act(l->user, &document);
        yaml_document_delete(&document);
        if (!root)
            break;
    }
    return code;
}

/* Goes through the text from its start. */
static int parse(const struct loader *l, int (*act)(const struct loader *l, yaml_parser_t *parser))
{
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        BRC_FAIL(l->ctx, BRC_ERR_MEMORY, "out of memory for the YAML parser");
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)l->from->text, l->from->size);
    int code = act(l, &parser);
    yaml_parser_delete(&parser);
    return code;
}

int brc_yaml_load(struct brc_context *ctx, const struct brc_yaml_text *from,
                  int (*act)(void *user, yaml_document_t *document), void *user)
{
    const struct loader l = {ctx, from, act, user};
    BRC_TRY(check_bytes(&l));
    BRC_TRY(parse(&l, refuse_extras));
    return parse(&l, read_documents);
}
