/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Applies the entries of a case to parameter lists, and judges sections. */
#include "common/input/casefile.h"

#include <stdio.h>
#include <string.h>

enum { LONGEST_PATH = 200 }; /* in messages; of longer ones the end is told */

const char *brc_casefile_where(const struct brc_casefile *c, int line, bool is_override,
                               char where[BRC_CASEFILE_WHERE_SIZE])
{
    int n = (int)strlen(c->path);
    bool is_long = n > LONGEST_PATH;
    const char *path = is_long ? c->path + n - LONGEST_PATH : c->path;
    if (is_override)
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "--set");
    else if (line > 0)
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "%s%s:%d", is_long ? "..." : "", path, line);
    else
        snprintf(where, BRC_CASEFILE_WHERE_SIZE, "%s%s", is_long ? "..." : "", path);
    return where;
}

const struct brc_casefile_place *brc_casefile_find_section(const struct brc_casefile *c,
                                                           const char *name)
{
    for (size_t i = 0; i < c->n_sections; i++)
        if (strcmp(c->sections[i].name, name) == 0)
            return &c->sections[i];
    return NULL;
}

const char *brc_casefile_key(const struct brc_casefile_entry *e, struct brc_param_list list)
{
    bool is_short =
        *e->parent && !brc_params_find(list, e->key) && brc_params_find(list, e->parent);
    return is_short ? e->parent : e->key;
}

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

/* Line of another entry of the file that means the same key, 0 when there is none. */
static int find_twin(const struct brc_casefile *c, size_t i, struct brc_param_list list)
{
    const char *key = brc_casefile_key(&c->entries[i], list);
    for (size_t j = 0; j < i; j++) {
        const struct brc_casefile_entry *e = &c->entries[j];
        if (!e->is_override && strcmp(e->section, c->entries[i].section) == 0 &&
            strcmp(brc_casefile_key(e, list), key) == 0)
            return e->line;
    }
    return 0;
}

static int check_required(struct brc_context *ctx, const struct brc_casefile *c,
                          const char *section, struct brc_param_list list)
{
    char where[BRC_CASEFILE_WHERE_SIZE];
    const struct brc_casefile_place *s = brc_casefile_find_section(c, section);
    for (int i = 0; i < list.n; i++) {
        const struct brc_param *p = &list.params[i];
        bool is_given = p->default_text != NULL;
        for (size_t j = 0; j < c->n && !is_given; j++)
            is_given = strcmp(c->entries[j].section, section) == 0 &&
                       strcmp(brc_casefile_key(&c->entries[j], list), p->key) == 0;
        if (!is_given)
            BRC_FAIL(
                ctx, BRC_ERR_INPUT, "%s: %s.%s: required key is missing (%s); allowed %s, unit %s",
                brc_casefile_where(c, s ? s->line : 0, false, where), section, p->key, p->meaning,
                p->choices ? p->choices
                : p->range ? p->range
                           : "any",
                p->unit);
    }
    return 0;
}

int brc_casefile_section(struct brc_context *ctx, const struct brc_casefile *c, const char *section,
                         struct brc_param_list list, void *values)
{
    char where[BRC_CASEFILE_WHERE_SIZE];
    BRC_TRY(brc_params_defaults(ctx, list, values));
    for (size_t i = 0; i < c->n; i++) {
        const struct brc_casefile_entry *e = &c->entries[i];
        if (strcmp(e->section, section) != 0)
            continue;
        const char *key = brc_casefile_key(e, list);
        int twin = e->is_override ? 0 : find_twin(c, i, list);
        brc_casefile_where(c, e->line, e->is_override, where);
        if (twin)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s: %s.%s: given twice, first in line %d; keep one of the two", where,
                     section, key, twin);
        BRC_TRY(brc_params_set(ctx, list, values, section, key, e->text, where));
    }
    return check_required(ctx, c, section, list);
}

/* The nearest of some names, NULL when none is near. */
static const char *nearest_name(const char *name, const char *const *names, size_t n)
{
    const char *nearest = NULL;
    int best = 0;
    for (size_t i = 0; i < n; i++) {
        int d = brc_params_distance(name, names[i]);
        if (!nearest || d < best) {
            nearest = names[i];
            best = d;
        }
    }
    return nearest && brc_params_is_near(name, best) ? nearest : NULL;
}

static void join_names(char *buffer, size_t size, const char *const *names, size_t n)
{
    size_t used = 0;
    buffer[0] = '\0';
    for (size_t i = 0; i < n && used < size; i++)
        used += (size_t)snprintf(buffer + used, size - used, "%s%s", i ? ", " : "", names[i]);
}

int brc_casefile_finish(struct brc_context *ctx, const struct brc_casefile *c,
                        const char *const *sections, size_t n)
{
    char where[BRC_CASEFILE_WHERE_SIZE], all[400];
    for (size_t i = 0; i < c->n_sections; i++) {
        const struct brc_casefile_place *s = &c->sections[i];
        bool is_known = strchr(s->name, '.') != NULL; /* nested: its section was judged */
        for (size_t k = 0; k < n && !is_known; k++)
            is_known = strcmp(s->name, sections[k]) == 0;
        if (is_known)
            continue;
        const char *nearest = nearest_name(s->name, sections, n);
        join_names(all, sizeof all, sections, n);
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %s: unknown section; allowed %s%s%s%s",
                 brc_casefile_where(c, s->line, s->line == 0, where), s->name, all,
                 nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
    }
    return 0;
}
