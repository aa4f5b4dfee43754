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

/* The values are given apart from the case, since the text of one section is not all the case's. */
static void put_section(FILE *out, const char *section, struct brc_param_list list,
                        const void *values)
{
    char value[BRC_TEXT_SIZE];
    for (int i = 0; i < list.n; i++)
        if (!(list.params[i].flags & BRC_PARAM_FILE))
            fprintf(out, "%s.%s = %s\n", section, list.params[i].key,
                    brc_params_text(&list.params[i], values, value, sizeof value));
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
    /* a stream that grows: how long a value's text is hangs on its unit and its digits */
    char *text = NULL;
    size_t n;
    FILE *out = open_memstream(&text, &n);
    if (out) {
        put_section(out, "specimen", brc_specimen_param_list, &run_case->specimen);
        put_section(out, "test", brc_test_param_list, &test);
        put_section(out, rig->name, rig->params, brc_case_values(run_case, rig->name));
        put_section(out, "run", brc_run_param_list, &run_case->run);
        put_section(out, model->name, model->params, brc_case_values(run_case, model->name));
    }
    if (out && fclose(out) == 0)
        return text;
    free(text);
    brc_error_set(ctx, BRC_ERR_MEMORY, __FILE__, __LINE__, "no memory for the text of the case");
    return NULL;
}

/* Whether the "section.key" that the line begins with may differ between the parts of one run. */
static bool may_change(const char *line)
{
    char key[BRC_CASEFILE_KEY_SIZE];
    struct brc_case_section s;
    return brc_case_key_at(line, &s, key) &&
           brc_params_find(s.list, key)->flags & BRC_PARAM_MAY_CHANGE;
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
