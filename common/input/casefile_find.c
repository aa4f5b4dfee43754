/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where things stand in a case: the place for a message, a section, the entry that gives a key its
 * value. All other files of the reader stand on this one, so it may not call them. */
#include "common/input/casefile.h"

#include <stdio.h>
#include <string.h>

/* Bytes of a path in messages; of longer ones the end is told, which has the name of the file. */
enum { LONGEST_PATH = 200 };

const char *brc_casefile_where(const struct brc_casefile *c, int line, bool is_override,
                               char where[BRC_CASEFILE_WHERE_SIZE])
{
    size_t n = strlen(c->path);
    const char *path = n > LONGEST_PATH ? c->path + n - LONGEST_PATH : c->path;
    const char *dots = path == c->path ? "" : "...";
    if (is_override)
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "--set");
    else if (line > 0)
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "%s%s:%d", dots, path, line);
    else
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "%s%s", dots, path);
    return where;
}

/* A search from the start: a case has a handful of sections. */
const struct brc_casefile_place *brc_casefile_find_section(const struct brc_casefile *c,
                                                           const char *name)
{
    for (size_t i = 0; i < c->n_sections; i++)
        if (strcmp(c->sections[i].name, name) == 0)
            return &c->sections[i];
    return NULL;
}

/* A key of the list wins over what else it could mean, so that a list can have both a and a_rule.
 */
const char *brc_casefile_key(const struct brc_casefile_entry *e, struct brc_param_list list)
{
    const struct brc_param *renamed = brc_params_renamed(list, e->key);
    if (brc_params_find(list, e->key))
        return e->key;
    if (*e->parent && brc_params_find(list, e->parent))
        return e->parent;
    return renamed ? renamed->key : e->key;
}

/* From the end: of several overrides of a key the last one holds, and each stands behind the file's
 * own entries. */
const struct brc_casefile_entry *brc_casefile_find_entry(const struct brc_casefile *c,
                                                         const char *section, const char *key,
                                                         struct brc_param_list list)
{
    for (size_t i = c->n; i > 0; i--) { /* the last one holds */
        const struct brc_casefile_entry *e = &c->entries[i - 1];
        if (strcmp(e->section, section) == 0 && strcmp(brc_casefile_key(e, list), key) == 0)
            return e;
    }
    return NULL;
}
