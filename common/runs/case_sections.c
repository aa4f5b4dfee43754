/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sections of a case by number: four common ones, one a model, one a test that has keys of its
 * own. Models and tests are asked from their registries, so that a new one needs no line here.
 * Everything that walks over a case (reading, checking, keeping, printing) does so by these
 * numbers. */
#include "common/runs/case_sections.h"

#include "common/runs/case.h"

#include <string.h>

enum { N_COMMON = 4 };

/* A section: four common ones, whose values lie in the case, then one a model, then those of tests
 * that have keys of their own. */
struct section {
    const char *name;
    struct brc_param_list list;
    size_t offset; /* of common values */
    void *values;  /* of others; NULL without a case */
};

/* Sections in their order; the models' and tests' values are NULL without a case, for callers that
 * ask for names and lists alone. */
static bool find_section(const struct brc_case *run_case, int i, struct section *s)
{
    const struct section common[N_COMMON] = {
        {"specimen", brc_specimen_param_list, offsetof(struct brc_case, specimen), NULL},
        {"test", brc_test_param_list, offsetof(struct brc_case, test), NULL},
        {"run", brc_run_param_list, offsetof(struct brc_case, run), NULL},
        {"output", brc_output_param_list, offsetof(struct brc_case, output), NULL}};
    int n_models = brc_registry_count(), left = i - N_COMMON - n_models;
    if (i < N_COMMON) {
        *s = common[i];
        return true;
    }
    if (left < 0) {
        const struct brc_model *model = brc_registry_at(i - N_COMMON);
        void *values = run_case ? run_case->model_params[i - N_COMMON] : NULL;
        *s = (struct section){model->name, model->params, 0, values};
        return true;
    }
    for (int k = 0; k < brc_rigs_count(); k++) {
        const struct brc_rig_type *rig = brc_rigs_at(k);
        if (rig->params.n == 0 || left-- > 0)
            continue;
        *s = (struct section){rig->name, rig->params, 0, run_case ? run_case->rig_params[k] : NULL};
        return true;
    }
    return false;
}

bool brc_case_section(int i, const char **name, struct brc_param_list *list)
{
    struct section s;
    if (!find_section(NULL, i, &s))
        return false;
    *name = s.name;
    *list = s.list;
    return true;
}

void *brc_case_section_values(struct brc_case *run_case, int i)
{
    struct section s = {0};
    find_section(run_case, i, &s);
    return i < N_COMMON ? (char *)run_case + s.offset : s.values;
}

const void *brc_case_values(const struct brc_case *run_case, int i)
{
    struct section s = {0};
    find_section(run_case, i, &s);
    return i < N_COMMON ? (const char *)run_case + s.offset : s.values;
}

int brc_case_find_section(const char *name, struct brc_param_list *list)
{
    const char *section;
    for (int i = 0; brc_case_section(i, &section, list); i++)
        if (strcmp(section, name) == 0)
            return i;
    return -1;
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

/* By address: a model that is not registered (of a test) has no section. */
const void *brc_case_params(const struct brc_case *run_case, const struct brc_model *model)
{
    for (int i = 0; i < run_case->n_models; i++)
        if (brc_registry_at(i) == model)
            return run_case->model_params[i];
    return NULL;
}
