/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A document to a tree that outlives it. Whole and by recursion, as such files are short; the depth
 * is bounded, so that a hostile one ends with a message and not with the stack. */
#include "common/input/casefile_tree.h"

#include <yaml.h>

#include <string.h>

enum { MAX_DEPTH = 16 };

struct builder {
    struct brc_context *ctx;
    struct brc_pool *pool;
    const struct brc_yaml_text *from;
    yaml_document_t *document;
    struct brc_tree *root;
};

static int fail_at(const struct builder *b, int line, const char *what)
{
    BRC_FAIL(b->ctx, BRC_ERR_INPUT, "%s:%d: %s", b->from->path, line, what);
}

static const char *copy(const struct builder *b, const yaml_node_t *node)
{
    size_t n = node->data.scalar.length;
    char *text = brc_pool_alloc(b->ctx, b->pool, n + 1, 1);
    return text ? memcpy(text, node->data.scalar.value, n) : NULL;
}

/* Unquoted alone: in quotes "null" is a text. */
static bool is_null(const yaml_node_t *node)
{
    const char *text = (const char *)node->data.scalar.value;
    return node->data.scalar.style == YAML_PLAIN_SCALAR_STYLE &&
           (!*text || strcmp(text, "~") == 0 || strcmp(text, "null") == 0);
}

static int read_node(const struct builder *b, int id, int depth, struct brc_tree *out);

static int read_list(const struct builder *b, const yaml_node_t *node, int depth,
                     struct brc_tree *out)
{
    const yaml_node_item_t *first = node->data.sequence.items.start;
    for (size_t i = 0; i < out->n; i++)
        BRC_TRY(read_node(b, first[i], depth + 1, &out->item[i]));
    return 0;
}

/* YAML keeps the first or the last of two keys of one name, as the reader likes; here it is an
 * error. */
static int check_twice(const struct builder *b, const struct brc_tree *map, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (strcmp(map->item[k].key, map->item[i].key) == 0)
            BRC_FAIL(b->ctx, BRC_ERR_INPUT,
                     "%s:%d: %s: given twice, first in line %d; keep one of the two", b->from->path,
                     map->item[i].line, map->item[i].key, map->item[k].line);
    return 0;
}

static int read_map(const struct builder *b, const yaml_node_t *node, int depth,
                    struct brc_tree *out)
{
    const yaml_node_pair_t *first = node->data.mapping.pairs.start;
    for (size_t i = 0; i < out->n; i++) {
        const yaml_node_t *key = yaml_document_get_node(b->document, first[i].key);
        struct brc_tree *item = &out->item[i];
        if (key->type != YAML_SCALAR_NODE)
            return fail_at(b, (int)key->start_mark.line + 1, "a key must be a plain word");
        BRC_TRY(read_node(b, first[i].value, depth + 1, item));
        item->line = (int)key->start_mark.line + 1;
        item->key = copy(b, key);
        if (!item->key)
            return BRC_ERR_MEMORY;
        BRC_TRY(check_twice(b, out, i));
    }
    return 0;
}

static int read_node(const struct builder *b, int id, int depth, struct brc_tree *out)
{
    const yaml_node_t *node = yaml_document_get_node(b->document, id);
    bool is_map = node->type == YAML_MAPPING_NODE;
    *out = (struct brc_tree){.text = "", .line = (int)node->start_mark.line + 1};
    if (depth == MAX_DEPTH)
        return fail_at(b, out->line, "lists and mappings are nested too deep");
    if (node->type == YAML_SCALAR_NODE) {
        out->kind = is_null(node) ? BRC_TREE_NOTHING : BRC_TREE_TEXT;
        out->text = copy(b, node);
        return out->text ? 0 : BRC_ERR_MEMORY;
    }
    out->kind = is_map ? BRC_TREE_MAP : BRC_TREE_LIST;
    out->n = is_map ? (size_t)(node->data.mapping.pairs.top - node->data.mapping.pairs.start)
                    : (size_t)(node->data.sequence.items.top - node->data.sequence.items.start);
    out->item = brc_pool_alloc(b->ctx, b->pool, out->n, sizeof *out->item);
    if (!out->item)
        return BRC_ERR_MEMORY;
    return is_map ? read_map(b, node, depth, out) : read_list(b, node, depth, out);
}

/* libyaml numbers nodes from 1, the root. */
static int read_document(void *user, yaml_document_t *document)
{
    struct builder *b = user;
    b->document = document;
    return read_node(b, 1, 0, b->root);
}

int brc_tree_parse(struct brc_context *ctx, struct brc_pool *pool, const struct brc_yaml_text *from,
                   struct brc_tree *root)
{
    struct builder b = {.ctx = ctx, .pool = pool, .from = from, .root = root};
    *root = (struct brc_tree){.text = ""};
    return brc_yaml_load(ctx, from, read_document, &b);
}

const struct brc_tree *brc_tree_find(const struct brc_tree *map, const char *key)
{
    for (size_t i = 0; map->kind == BRC_TREE_MAP && i < map->n; i++)
        if (strcmp(map->item[i].key, key) == 0)
            return &map->item[i];
    return NULL;
}
