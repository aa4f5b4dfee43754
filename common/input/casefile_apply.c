/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Applies the entries of a case to parameter lists, and checks sections. An entry is read here
 * alone, when its section is: before that nothing knows what its key means. */
#include "common/input/casefile.h"

#include <stdio.h>
#include <string.h>

/* Line of an earlier entry of the file that means the same key as entry i, which is the file's too;
 * 0 when there is none. By meaning, not by spelling: `interaction: gap` and `interaction: {rule:
 * gap}` are the same key, and so is an older name. */
static int find_twin(const struct brc_casefile *c, size_t i, struct brc_param_list list)
{
    struct brc_casefile before = *c; /* as far as it was read then; overrides stand behind all */
    const struct brc_casefile_entry *e = &c->entries[i];
    before.n = i;
    e = brc_casefile_find_entry(&before, e->section, brc_casefile_key(e, list), list);
    return e ? e->line : 0;
}

/* After all entries, so that a slip in the name of the key itself is told first, with what was
 * meant. */
static int check_required(struct brc_context *ctx, const struct brc_casefile *c,
                          const char *section, struct brc_param_list list)
{
    char where[BRC_CASEFILE_WHERE_SIZE];
    const struct brc_casefile_place *s = brc_casefile_find_section(c, section);
    for (int i = 0; i < list.n; i++) {
        const struct brc_param *p = &list.params[i];
        if (!p->default_text && !brc_casefile_find_entry(c, section, p->key, list))
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

/* An older name is read and said in the log, once a run: a case of last year still runs, and its
 * owner learns the new name. */
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
                     "%s: %s%s%s: given twice, first in line %d; keep one of the two", where,
                     section, *section ? "." : "", key, twin);
        if (!brc_params_find(list, e->key) && brc_params_renamed(list, e->key))
            brc_log(ctx, "%s: %s.%s is called %s now", where, section, e->key, key);
        BRC_TRY(brc_params_set(ctx, list, values, section, key, e->text, where));
    }
    return check_required(ctx, c, section, list);
}

/* Sections of all models are allowed, be the model run or not, so that one case serves several. */
int brc_casefile_finish(struct brc_context *ctx, const struct brc_casefile *c,
                        const char *const *sections, size_t n)
{
    char where[BRC_CASEFILE_WHERE_SIZE], all[BRC_NAMES_SIZE] = "", hint[BRC_HINT_SIZE];
    for (size_t i = 0; i < c->n_sections; i++) {
        const struct brc_casefile_place *s = &c->sections[i];
        bool is_known = strchr(s->name, '.') != NULL; /* nested: its section was judged */
        for (size_t k = 0; k < n && !is_known; k++)
            is_known = strcmp(s->name, sections[k]) == 0;
        if (is_known)
            continue;
        struct brc_nearest nearest = {.text = s->name};
        for (size_t k = 0; k < n; k++) {
            brc_nearest_add(&nearest, sections[k]);
            brc_names_add(all, sizeof all, sections[k]);
        }
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %s: unknown section; allowed %s%s",
                 brc_casefile_where(c, s->line, s->line == 0, where), s->name, all,
                 brc_nearest_hint(&nearest, hint));
    }
    return 0;
}
