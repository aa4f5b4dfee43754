/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference of a parameter list, as `breccia params` prints it, docs and completion read it.
 * Declarations are all it knows: no value of a case is shown here. */
#include "common/input/params.h"

#include <string.h>

enum { N_CELLS = 4 };

/* Key, default, allowed and unit, as they are shown. */
static void make_cells(const struct brc_param *p, const char *cell[N_CELLS])
{
    cell[0] = p->key;
    cell[1] = !p->default_text ? "required" : *p->default_text ? p->default_text : "-";
    cell[2] = p->choices ? p->choices : p->range ? p->range : "(-inf, inf)";
    cell[3] = *brc_unit_shown(p->unit) ? p->unit : "-";
    if (p->kind == BRC_TEXT)
        cell[2] = "text";
}

void brc_params_print(FILE *out, const char *title, struct brc_param_list list)
{
    /* widths begin with those of the headings */
    int w[N_CELLS] = {3, 7, 7, 4}; /* of the headings */
    const char *cell[N_CELLS];
    for (int i = 0; i < list.n; i++) {
        make_cells(&list.params[i], cell);
        for (int k = 0; k < N_CELLS; k++)
            if ((int)strlen(cell[k]) > w[k])
                w[k] = (int)strlen(cell[k]);
    }
    fprintf(out, "%s\n  %-*s  %-*s  %-*s  %-*s  %s\n", title, w[0], "key", w[1], "default", w[2],
            "allowed", w[3], "unit", "meaning");
    for (int i = 0; i < list.n; i++) {
        const struct brc_param *p = &list.params[i];
        make_cells(p, cell);
        fprintf(out, "  %-*s  %-*s  %-*s  %-*s  %s%s%s%s%s\n", w[0], cell[0], w[1], cell[1], w[2],
                cell[2], w[3], cell[3], p->meaning, p->applies ? " [only with " : "",
                p->applies ? p->applies : "", p->applies ? "]" : "",
                p->flags & BRC_PARAM_MAY_CHANGE ? " [may change with --resume]" : "");
    }
}
