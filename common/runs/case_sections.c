/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sections of a case by number: four common ones, one a model, one a test that has keys of its
 * own. Models and tests are asked from their registries, so that a new one needs no line here.
 * Everything that walks over a case (reading, checking, keeping, printing) does so by these
 * numbers. */
#include "common/runs/case_sections.h"

#include "common/runs/case.h"

#include <stdio.h>
#include <string.h>

/* Four common sections, then the models', then those of tests that have keys of their own. */
bool brc_case_section(const struct brc_case *run_case, int i, struct brc_case_section *s)
{
    const struct brc_case_section common[BRC_CASE_N_COMMON] = {
        {"specimen", brc_specimen_param_list, NULL},
        {"test", brc_test_param_list, NULL},
        {"run", brc_run_param_list, NULL},
        {"output", brc_output_param_list, NULL}};
    int model = i - BRC_CASE_N_COMMON, left = model - brc_registry_count(), rig = 0;
    if (i < BRC_CASE_N_COMMON) {
        *s = common[i];
    } else if (left < 0) {
        const struct brc_model *m = brc_registry_at(model);
        *s = (struct brc_case_section){m->name, m->params, NULL};
    } else {
        for (; rig < brc_rigs_count(); rig++)
            if (brc_rigs_at(rig)->params.n > 0 && left-- == 0)
                break;
        if (rig == brc_rigs_count())
            return false;
        *s = (struct brc_case_section){brc_rigs_at(rig)->name, brc_rigs_at(rig)->params, NULL};
    }
    s->values = run_case ? run_case->values[i] : NULL;
    return true;
}

/* By a look at each: there are a dozen, and nothing asks for them while a run goes on. A section
 * that is not there has a name and an empty list, in which no key is found: callers that have
 * checked the name before need no branch. */
bool brc_case_find_section(const struct brc_case *run_case, const char *name,
                           struct brc_case_section *s)
{
    for (int i = 0; brc_case_section(run_case, i, s); i++)
        if (strcmp(s->name, name) == 0)
            return true;
    *s = (struct brc_case_section){.name = name};
    return false;
}

/* Whole names alone: of two sections one may begin with the name of the other. */
bool brc_case_key_at(const char *text, struct brc_case_section *s, char key[BRC_CASEFILE_KEY_SIZE])
{
    for (int i = 0; brc_case_section(NULL, i, s); i++) {
        size_t n = strlen(s->name);
        if (strncmp(text, s->name, n) != 0 || text[n] != '.')
            continue;
        size_t length = strspn(text + n + 1, "abcdefghijklmnopqrstuvwxyz0123456789_");
        snprintf(key, BRC_CASEFILE_KEY_SIZE, "%.*s", (int)length, text + n + 1);
        return brc_params_find(s->list, key) != NULL;
    }
    return false;
}

/* By name and not by the place in a registry: a model that is not registered, as those of tests,
 * has no place there, and a test without keys of its own has no section. */
const void *brc_case_values(const struct brc_case *run_case, const char *section)
{
    struct brc_case_section s;
    brc_case_find_section(run_case, section, &s);
    return s.values;
}

int brc_case_model(struct brc_context *ctx, const char *name, const struct brc_model **model)
{
    char all[BRC_NAMES_SIZE] = "";
    *model = brc_registry_find(name);
    if (*model)
        return 0;
    for (int i = 0; i < brc_registry_count(); i++)
        brc_names_add(all, sizeof all, brc_registry_at(i)->name);
    BRC_FAIL(ctx, BRC_ERR_INPUT, "unknown model '%.60s'; there are: %s", name, all);
}

/* In the order of the case's list, which the columns of tables and the panels of pictures follow.
 */
int brc_case_models(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model **model, int cap, int *n)
{
    int n_named = (int)run_case->file.n_models;
    *n = n_named > 0 ? n_named : brc_registry_count();
    if (*n > cap)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%d models to compare, %d at most; name fewer in 'models'", *n,
                 cap);
    for (int i = 0; i < *n; i++) {
        model[i] = brc_registry_at(i);
        if (n_named > 0)
            BRC_TRY(brc_case_model(ctx, run_case->file.models[i], &model[i]));
    }
    return 0;
}
