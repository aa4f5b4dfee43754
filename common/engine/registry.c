/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The models that were linked in, by number and name, and what each must have. An operation that a
 * model leaves out is NULL, and whoever would call it looks first: a function that does nothing
 * would be a second way to say the same. */
#include "common/engine/model.h"

#include <string.h>

#define BRC_MODEL(symbol) extern const struct brc_model symbol;
#include "registry_list.h"
#undef BRC_MODEL

static const struct brc_model *const registered[] = {
#define BRC_MODEL(symbol) &symbol,
#include "registry_list.h"
#undef BRC_MODEL
    NULL};

int brc_registry_count(void)
{
    return (int)(sizeof registered / sizeof registered[0]) - 1;
}

const struct brc_model *brc_registry_at(int i)
{
    return registered[i];
}

const struct brc_model *brc_registry_find(const char *name)
{
    for (int i = 0; i < brc_registry_count(); i++)
        if (strcmp(registered[i]->name, name) == 0)
            return registered[i];
    return NULL;
}

int brc_model_check(struct brc_context *ctx, const struct brc_model *m)
{
    const struct {
        const char *operation;
        bool is_there;
    } required[] = {{"name", m->name},     {"shape", m->shape},    {"bond", m->bond},
                    {"pairs", m->pairs},   {"forces", m->forces},  {"platens", m->platens},
                    {"energy", m->energy}, {"springs", m->springs}};
    for (size_t i = 0; i < sizeof required / sizeof required[0]; i++)
        if (!required[i].is_there)
            BRC_FAIL(ctx, BRC_ERR_INTERNAL, "model %s lacks the required operation %s",
                     m->name ? m->name : "(unnamed)", required[i].operation);
    return 0;
}
