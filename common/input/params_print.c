/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference of a parameter list, as `breccia params` prints it. */
#include "common/input/params.h"

#include <string.h>

/* What a value may be, for the reference. */
static const char *allowed_text(const struct brc_param *p)
{
    if (p->kind == BRC_CHOICE || p->kind == BRC_FLAG)
        return p->choices;
    if (p->kind == BRC_TEXT)
        return "text";
    return p->range ? p->range : "(-inf, inf)";
}

static const char *default_shown(const struct brc_param *p)
{
    if (!p->default_text)
        return "required";
    return *p->default_text ? p->default_text : "-";
}

static const char *unit_shown(const struct brc_param *p)
{
    return strcmp(p->unit, "1") == 0 ? "-" : p->unit;
}

static void widen(int *width, const char *text)
{
    if ((int)strlen(text) > *width)
        *width = (int)strlen(text);
}

void brc_params_print(FILE *out, const char *title, struct brc_param_list list)
{
    int w[4] = {3, 7, 7, 4};
    for (int i = 0; i < list.n; i++) {
        widen(&w[0], list.params[i].key);
        widen(&w[1], default_shown(&list.params[i]));
        widen(&w[2], allowed_text(&list.params[i]));
        widen(&w[3], unit_shown(&list.params[i]));
    }
    fprintf(out, "%s\n  %-*s  %-*s  %-*s  %-*s  %s\n", title, w[0], "key", w[1], "default", w[2],
            "allowed", w[3], "unit", "meaning");
    for (int i = 0; i < list.n; i++) {
        const struct brc_param *p = &list.params[i];
        fprintf(out, "  %-*s  %-*s  %-*s  %-*s  %s%s%s%s%s\n", w[0], p->key, w[1], default_shown(p),
                w[2], allowed_text(p), w[3], unit_shown(p), p->meaning,
                p->applies ? " [only with " : "", p->applies ? p->applies : "",
                p->applies ? "]" : "",
                p->flags & BRC_PARAM_MAY_CHANGE ? " [may change with --resume]" : "");
    }
}
