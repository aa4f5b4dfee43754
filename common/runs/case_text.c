/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameters of a run, one a line. Text rather than a hash of the values: a state that does not
 * fit can then say which key differs, and what it was. Names of files are left out (what counts is
 * their content, by the specimen's hash), and so is the section of output, which changes no bit of
 * a run. */
#include "common/runs/case_text.h"

#include "common/rigs/loading.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 512 };

/* Grows the text by the section; NULL, with the text freed, when there is no memory. */
static char *add_section(struct brc_context *ctx, char *text, const char *section,
                         struct brc_param_list list, const void *values)
{
    char line[LINE_SIZE], value[BRC_TEXT_SIZE];
    size_t used = text ? strlen(text) : 0;
    char *grown = brc_realloc(ctx, text, used + (size_t)list.n * LINE_SIZE + 1, 1);
    if (!grown) {
        free(text);
        return NULL;
    }
    grown[used] = '\0';
    for (int i = 0; i < list.n; i++) {
        if (list.params[i].flags & BRC_PARAM_FILE)
            continue;
        brc_params_text(&list.params[i], values, value, sizeof value);
        int n = snprintf(line, sizeof line, "%s.%s = %s\n", section, list.params[i].key, value);
        memcpy(grown + used, line, (size_t)n + 1);
        used += (size_t)n;
    }
    return grown;
}

/* All that a state hangs on, in the order of the sections; of models and tests only the ones that
 * run. */
char *brc_case_text(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model *model)
{
    /* an automatic rate as a number: it hangs on strain_max, which may change when a run goes on */
    struct brc_test_params test = run_case->test;
    const struct brc_rig_type *rig = brc_rigs_at(test.kind);
    if (brc_rigs_uses(rig, "rate"))
        test.rate = brc_loading_start_rate(&test);
    char *text = add_section(ctx, NULL, "specimen", brc_specimen_param_list, &run_case->specimen);
    if (text)
        text = add_section(ctx, text, "test", brc_test_param_list, &test);
    if (text)
        text = add_section(ctx, text, rig->name, rig->params, brc_case_values(run_case, rig->name));
    if (text)
        text = add_section(ctx, text, "run", brc_run_param_list, &run_case->run);
    if (text)
        text = add_section(ctx, text, model->name, model->params,
                           brc_case_values(run_case, model->name));
    return text;
}

/* Whether the "section.key" that the line begins with may differ between the parts of one run. */
static bool may_change(const char *line)
{
    char section[BRC_CASEFILE_KEY_SIZE], key[BRC_CASEFILE_KEY_SIZE];
    struct brc_case_section s;
    size_t dot = strcspn(line, ". \n");
    if (line[dot] != '.')
        return false;
    snprintf(section, sizeof section, "%.*s", (int)dot, line);
    snprintf(key, sizeof key, "%.*s", (int)strcspn(line + dot + 1, " "), line + dot + 1);
    const struct brc_param *p =
        brc_case_find_section(NULL, section, &s) ? brc_params_find(s.list, key) : NULL;
    return p && p->flags & BRC_PARAM_MAY_CHANGE;
}

/* Line by line in step, as both texts come from the same lists; other lists are of another version.
 */
int brc_case_same(struct brc_context *ctx, const char *saved, const char *now)
{
    while (*saved && *now) {
        size_t a = strcspn(saved, "\n"), b = strcspn(now, "\n"), key = strcspn(now, " ");
        bool equal = a == b && strncmp(saved, now, a) == 0;
        bool is_allowed = strncmp(saved, now, key + 1) == 0 && may_change(now);
        if (!equal && !is_allowed)
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "the saved state was made with '%.*s', the case says '%.*s'; resume with "
                     "unchanged parameters (--set included%s) or start anew with --force",
                     (int)a, saved, (int)b, now,
                     strncmp(now, "test.rate ", 10) == 0
                         ? "; an automatic rate follows test.strain_max: give the first one"
                         : "");
        saved += a + (saved[a] != '\0');
        now += b + (now[b] != '\0');
    }
    if (*saved || *now)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "the saved state has other parameters than this version; "
                 "resume with the version that wrote it");
    return 0;
}
