/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/param_lists.h"

#include "common/input/units.h"

#include <stdlib.h>
#include <string.h>

static size_t kind_size(enum brc_param_kind kind)
{
    static const size_t size[] = {
        [BRC_REAL] = sizeof(double),  [BRC_INT] = sizeof(int),    [BRC_CHOICE] = sizeof(int),
        [BRC_FLAG] = sizeof(int),     [BRC_TEXT] = BRC_TEXT_SIZE, [BRC_REAL3] = 3 * sizeof(double),
        [BRC_INT3] = 3 * sizeof(int),
    };
    return size[kind];
}

/* The declaration alone, without its default. */
static int check_declaration(struct brc_context *ctx, struct brc_param_list list, int i,
                             const char *place)
{
    const struct brc_param *p = &list.params[i];
    double factor;
    if (*p->key == '\0' ||
        strspn(p->key, "abcdefghijklmnopqrstuvwxyz0123456789_") != strlen(p->key))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the key is not in snake case", place);
    if (brc_params_find(list, p->key) != p)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the key is declared twice", place);
    if (p->renamed && brc_params_find(list, p->renamed))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the older name '%s' is a key", place, p->renamed);
    if ((p->flags & BRC_PARAM_FILE && p->kind != BRC_TEXT) ||
        (p->flags & BRC_PARAM_AXIS && p->kind != BRC_CHOICE && p->kind != BRC_FLAG))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the flags do not fit the kind", place);
    if (!p->meaning || !*p->meaning)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the meaning is missing", place);
    if (p->offset + kind_size(p->kind) > list.owner_size)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the member lies outside its struct", place);
    if ((p->kind == BRC_CHOICE || p->kind == BRC_FLAG) && (!p->choices || !*p->choices))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the choices are missing", place);
    return brc_units_factor(ctx, p->unit, p->unit, place, &factor);
}

/* The range is an interval, seen by setting any value: one outside of it is a fault of the value.
 */
static int check_interval(struct brc_context *ctx, struct brc_param_list list,
                          const struct brc_param *p, void *values, const char *title)
{
    char text[64];
    struct brc_context quiet = BRC_CONTEXT_INIT;
    snprintf(text, sizeof text, "1%s%s", brc_unit_blank(p->unit), brc_unit_shown(p->unit));
    if (brc_params_set(&quiet, list, values, title, p->key, text, "declaration") !=
        BRC_ERR_INTERNAL)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s", quiet.message);
}

/* Default in range, and the same bits after writing and reading. */
static int check_default(struct brc_context *ctx, struct brc_param_list list,
                         const struct brc_param *p, void *values, void *again, const char *title)
{
    char text[BRC_TEXT_SIZE];
    memset(values, 0, list.owner_size);
    memset(again, 0, list.owner_size);
    BRC_TRY(brc_params_set(ctx, list, values, title, p->key, p->default_text, "declaration"));
    brc_params_text(p, values, text, sizeof text);
    BRC_TRY(brc_params_set(ctx, list, again, title, p->key, text, "declaration"));
    if (memcmp(values, again, list.owner_size) != 0)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the default '%s' is written as '%s', which differs",
                 p->key, p->default_text, text);
    return 0;
}

int param_list_check(struct brc_context *ctx, const char *title, struct brc_param_list list)
{
    char place[320];
    char *values = brc_alloc(ctx, 2, list.owner_size);
    int code = values ? 0 : BRC_ERR_MEMORY;
    for (int i = 0; i < list.n && code == 0; i++) {
        const struct brc_param *p = &list.params[i];
        snprintf(place, sizeof place, "declaration: %s.%s", title, p->key);
        code = check_declaration(ctx, list, i, place);
        if (code == 0)
            code = check_interval(ctx, list, p, values, title);
        if (code == 0 && p->default_text)
            code = check_default(ctx, list, p, values, values + list.owner_size, title);
    }
    free(values);
    return code;
}
