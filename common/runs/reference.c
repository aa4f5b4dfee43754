/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/runs/reference.h"

#include "common/rigs/readings.h"
#include "common/runs/case_sections.h"
#include "common/runs/case.h"

#include <stdio.h>
#include <string.h>

/* One section, or all. The lists are those of the reader of case files, so that what is printed is
 * what is read. */
int brc_reference_params(struct brc_context *ctx, const char *section)
{
    struct brc_case_section s;
    char hint[BRC_HINT_SIZE];
    struct brc_nearest nearest = {.text = section};
    bool is_found = false;
    for (int i = 0; brc_case_section(NULL, i, &s); i++) {
        if (section)
            brc_nearest_add(&nearest, s.name);
        if (section && strcmp(section, s.name) != 0)
            continue;
        if (is_found)
            putchar('\n');
        brc_params_print(stdout, s.name, s.list);
        is_found = true;
    }
    if (!is_found)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "no section '%.60s'%s; breccia params lists all", section,
                 brc_nearest_hint(&nearest, hint));
    return 0;
}

/* With the papers that they are from, by which readers know them; the names are no more than keys
 * of cases. */
void brc_reference_models(void)
{
    for (int i = 0; i < brc_registry_count(); i++)
        printf("%-12s %s\n", brc_registry_at(i)->name, brc_registry_at(i)->citation);
}

static void print_quantities(const struct brc_quantity *q, int n)
{
    for (int i = 0; i < n; i++)
        printf("  %-20s %-3s %s\n", q[i].name, q[i].unit, q[i].meaning);
}

/* As the tests declare themselves: one that is added stands here, with its keys and what it
 * measures, without a line of this file. */
void brc_reference_tests(void)
{
    for (int i = 0; i < brc_rigs_count(); i++) {
        const struct brc_rig_type *rig = brc_rigs_at(i);
        printf("%s: %s\n  keys: %s\n", rig->name, rig->meaning, rig->keys);
        print_quantities(rig->quantities, rig->n_quantities);
    }
    printf("every test:\n");
    print_quantities(brc_readings_quantities, BRC_N_READINGS);
}
