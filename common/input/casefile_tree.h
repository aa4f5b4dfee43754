/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YAML, or JSON, as a tree of plain texts with their lines: for files whose keys are not those of
 * parameter lists, as sweeps and the lines of a record. What the texts mean is the caller's. */
#ifndef BRC_CASEFILE_TREE_H
#define BRC_CASEFILE_TREE_H

#include "common/base/pool.h"
#include "common/input/casefile_yaml.h"

enum brc_tree_kind {
    BRC_TREE_NOTHING, /* `axes:`, null */
    BRC_TREE_TEXT,
    BRC_TREE_LIST,
    BRC_TREE_MAP
};
struct brc_tree {
    enum brc_tree_kind kind;
    const char *key;  /* in a map; NULL in a list */
    const char *text; /* of a plain value; "" else */
    int line;         /* 1 is the first */
    size_t n;
    struct brc_tree *item; /* of a list or a map */
};

/* Memory is the pool's. A key given twice in one map is an error, as what YAML forbids here. */
int brc_tree_parse(struct brc_context *ctx, struct brc_pool *pool, const struct brc_yaml_text *from,
                   struct brc_tree *root);
/* NULL: there is none, or the tree is no map. */
const struct brc_tree *brc_tree_find(const struct brc_tree *map, const char *key);

#endif
