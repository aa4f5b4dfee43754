/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a case that stand outside of sections. The version comes first: a case of another
 * format has other keys, so that any further message about it would mislead. */
#include "common/input/casefile.h"

#include <stdio.h>
#include <string.h>

#define BRC_OWNER struct brc_casefile_params
static const struct brc_param case_params[] = {BRC_PARAM_LIST(BRC_CASEFILE_PARAMS)};
#undef BRC_OWNER
const struct brc_param_list brc_casefile_param_list =
    BRC_PARAMS(case_params, struct brc_casefile_params);

/* By the text and not as a number: `breccia: 1.0` is not the key's form, whatever its value. */
static int check_version(struct brc_context *ctx, const struct brc_casefile *c)
{
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(c, "", "breccia", brc_casefile_param_list);
    char here[16];
    snprintf(here, sizeof here, "%d", BRC_CASEFILE_VERSION);
    if (!e)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: breccia: required key is missing; a case file starts with the version of "
                 "its format, `breccia: %s`",
                 c->path, here);
    if (strcmp(e->text, here) != 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s:%d: breccia: '%.60s' is another version of the case format; allowed %s; use "
                 "the breccia that the case was written for, or compare the keys with `breccia "
                 "params` and write `breccia: %s`",
                 c->path, e->line, e->text, here, here);
    return 0;
}

/* Keys and sections that stand in each other's place: a mapping where a text belongs, or a text
 * where a mapping does; the message shows the form. */
static int check_top_level(struct brc_context *ctx, const struct brc_casefile *c)
{
    char where[BRC_CASEFILE_WHERE_SIZE], hint[BRC_HINT_SIZE];
    for (size_t i = 0; i < c->n_sections; i++)
        if (brc_params_find(brc_casefile_param_list, c->sections[i].name))
            BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %s: takes a text, not a mapping",
                     brc_casefile_where(c, c->sections[i].line, c->sections[i].line == 0, where),
                     c->sections[i].name);
    for (size_t i = 0; i < c->n; i++) {
        const struct brc_casefile_entry *e = &c->entries[i];
        if (*e->section || brc_params_find(brc_casefile_param_list, e->key))
            continue;
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: %s: unknown key of the top level; allowed breccia, title, model, models and "
                 "sections, which are mappings `%s: {key: value}`%s",
                 brc_casefile_where(c, e->line, e->is_override, where), e->key, e->key,
                 brc_params_hint(brc_casefile_param_list, e->key, hint));
    }
    return 0;
}

/* Splits `models` at commas and blanks: a sequence of YAML and a text both come as "a, b". Whether
 * there are such models is not known here: input knows no model. */
static int split_models(struct brc_context *ctx, struct brc_casefile *c)
{
    char where[BRC_CASEFILE_WHERE_SIZE];
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(c, "", "models", brc_casefile_param_list);
    c->n_models = 0;
    for (const char *text = c->head.models; *(text += strspn(text, ", ")) != '\0';) {
        size_t n = strcspn(text, ", ");
        if (c->n_models == BRC_CASEFILE_MAX_MODELS || n >= BRC_CASEFILE_KEY_SIZE)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s: models: more than %d names, or a name of more than %d "
                     "characters",
                     c->path, BRC_CASEFILE_MAX_MODELS, BRC_CASEFILE_KEY_SIZE - 1);
        snprintf(c->models[c->n_models++], BRC_CASEFILE_KEY_SIZE, "%.*s", (int)n, text);
        text += n;
        for (size_t k = 0; k + 1 < c->n_models; k++)
            if (strcmp(c->models[k], c->models[c->n_models - 1]) == 0)
                BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: models: %s is named twice; name each model once",
                         brc_casefile_where(c, e->line, e->is_override, where), c->models[k]);
    }
    return 0;
}

int brc_casefile_top_level(struct brc_context *ctx, struct brc_casefile *c)
{
    BRC_TRY(check_version(ctx, c));
    BRC_TRY(check_top_level(ctx, c));
    BRC_TRY(brc_casefile_section(ctx, c, "", brc_casefile_param_list, &c->head));
    return split_models(ctx, c);
}
