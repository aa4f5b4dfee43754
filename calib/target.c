/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A target file is read as a case file is: the same units, ranges and messages, and no second
 * reader to keep in step. */
#include "calib/target.h"
#include "common/input/casefile.h"

#include <stdio.h>
#include <string.h>

const struct calib_quantity calib_quantities[CALIB_N_QUANTITIES] = {
#define CALIB_QUANTITY_ROW(code, name, unit, range, test, result, meaning) \
    {name, unit, range, test, result, meaning},
    CALIB_QUANTITIES(CALIB_QUANTITY_ROW)
#undef CALIB_QUANTITY_ROW
};

/* One section of a target file; unit and range are those of its quantity. */
#define CALIB_TARGET_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)       \
    REAL(value, "1", NULL, NULL, "mean value")                                \
    REAL(deviation, "1", "0", "[0, inf)", "standard deviation; 0: not known") \
    TEXT(source, "", "where the value is from")

struct target_params {
    BRC_PARAM_MEMBERS(CALIB_TARGET_PARAMS)
};
#define BRC_OWNER struct target_params
static const struct brc_param target_params[] = {BRC_PARAM_LIST(CALIB_TARGET_PARAMS)};
#undef BRC_OWNER

enum { N_TARGET_PARAMS = sizeof target_params / sizeof target_params[0] };

/* The list of a section is made from that of any by putting in what its quantity is: eight lists
 * would say the same eight times. */
static int read_target(struct brc_context *ctx, const struct brc_casefile *c, int quantity,
                       struct calib_target *out)
{
    const struct calib_quantity *q = &calib_quantities[quantity];
    struct brc_param params[N_TARGET_PARAMS];
    struct target_params values;
    char zero[32];
    snprintf(zero, sizeof zero, "0%s%s", brc_unit_blank(q->unit), brc_unit_shown(q->unit));
    memcpy(params, target_params, sizeof params);
    params[0].unit = q->unit;
    params[0].range = q->range;
    params[0].meaning = q->meaning;
    params[1].unit = q->unit;
    params[1].default_text = zero;
    struct brc_param_list list = BRC_PARAMS(params, struct target_params);
    BRC_TRY(brc_casefile_section(ctx, c, q->name, list, &values));
    out->quantity = (enum calib_quantity_code)quantity;
    out->value = values.value;
    out->deviation = values.deviation;
    memcpy(out->source, values.source, sizeof out->source);
    return 0;
}

/* Sections by name, as models have theirs in a case; a rock without any is an error, since every
 * fit would be perfect. */
static int read_targets(struct brc_context *ctx, const struct brc_casefile *c,
                        struct calib_targets *out)
{
    const char *names[CALIB_N_QUANTITIES];
    for (int i = 0; i < CALIB_N_QUANTITIES; i++)
        names[i] = calib_quantities[i].name;
    BRC_TRY(brc_casefile_finish(ctx, c, names, CALIB_N_QUANTITIES));
    memcpy(out->title, c->head.title, sizeof out->title);
    for (int i = 0; i < CALIB_N_QUANTITIES; i++)
        if (brc_casefile_find_section(c, names[i]))
            BRC_TRY(read_target(ctx, c, i, &out->target[out->n++]));
    if (out->n == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: no target; write at least one section such as `%s: "
                 "{value: 25.8 GPa}`",
                 c->path, names[0]);
    return 0;
}

int calib_targets_read(struct brc_context *ctx, const char *path, struct calib_targets *out)
{
    struct brc_casefile c;
    memset(out, 0, sizeof *out);
    int code = brc_casefile_read(ctx, path, &c);
    if (code == 0)
        code = read_targets(ctx, &c, out);
    brc_casefile_free(&c);
    return code;
}

const struct calib_target *calib_targets_find(const struct calib_targets *t,
                                              enum calib_quantity_code quantity)
{
    for (size_t i = 0; i < t->n; i++)
        if (t->target[i].quantity == quantity)
            return &t->target[i];
    return NULL;
}
