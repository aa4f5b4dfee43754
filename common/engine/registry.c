/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Table checks, defaults and lookup of the models by name. */
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

static int accept(struct brc_context *ctx, const void *params, const struct brc_specimen *specimen)
{
    (void)ctx, (void)params, (void)specimen;
    return 0;
}

static int create_nothing(struct brc_sim *sim, void **state)
{
    (void)sim;
    *state = NULL;
    return 0;
}

static void free_nothing(void *state)
{
    (void)state;
}

static void select_nothing(struct brc_sim *sim, void *state)
{
    (void)sim, (void)state;
}

static int break_nothing(struct brc_sim *sim, void *state, size_t first)
{
    (void)sim, (void)state, (void)first;
    return 0;
}

static int restore_nothing(struct brc_sim *sim, void *state)
{
    (void)sim, (void)state;
    return 0;
}

static double whole_strength(const struct brc_sim *sim, const void *state, size_t row)
{
    (void)sim, (void)state, (void)row;
    return 1;
}

static void describe_nothing(const struct brc_sim *sim, const void *state, char *text, size_t size)
{
    (void)sim, (void)state;
    if (size > 0)
        text[0] = '\0';
}

int brc_model_complete(struct brc_context *ctx, const struct brc_model *model,
                       struct brc_model *complete)
{
    *complete = *model;
#define REQUIRE(operation)                                                               \
    if (!model->operation)                                                               \
    BRC_FAIL(ctx, BRC_ERR_INTERNAL, "model %s lacks the required operation " #operation, \
             model->name ? model->name : "(unnamed)")
    REQUIRE(name);
    REQUIRE(shape);
    REQUIRE(bond);
    REQUIRE(pairs);
    REQUIRE(forces);
    REQUIRE(platens);
    REQUIRE(energy);
    REQUIRE(springs);
#undef REQUIRE
#define DEFAULT(operation, function) \
    if (!complete->operation)        \
    complete->operation = function
    DEFAULT(check, accept);
    DEFAULT(create, create_nothing);
    DEFAULT(free, free_nothing);
    DEFAULT(select, select_nothing);
    DEFAULT(after_break, break_nothing);
    DEFAULT(restore, restore_nothing);
    DEFAULT(strength_left, whole_strength);
    DEFAULT(describe, describe_nothing);
#undef DEFAULT
    return 0;
}
