/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/runs/case_sections.h"

#include "common/runs/case.h"

#include <string.h>

enum { N_COMMON = 4 };

bool brc_case_section(int i, const char **name, struct brc_param_list *list)
{
    static const char *const common[N_COMMON] = {"specimen", "test", "run", "output"};
    const struct brc_param_list *const lists[N_COMMON] = {&brc_specimen_param_list,
                                                          &brc_test_param_list, &brc_run_param_list,
                                                          &brc_output_param_list};
    if (i < N_COMMON) {
        *name = common[i];
        *list = *lists[i];
        return true;
    }
    if (i - N_COMMON >= brc_registry_count())
        return false;
    *name = brc_registry_at(i - N_COMMON)->name;
    *list = brc_registry_at(i - N_COMMON)->params;
    return true;
}

void *brc_case_section_values(struct brc_case *run_case, int i)
{
    void *const common[N_COMMON] = {&run_case->specimen, &run_case->test, &run_case->run,
                                    &run_case->output};
    return i < N_COMMON ? common[i] : run_case->model_params[i - N_COMMON];
}

const void *brc_case_values(const struct brc_case *run_case, int i)
{
    const void *const common[N_COMMON] = {&run_case->specimen, &run_case->test, &run_case->run,
                                          &run_case->output};
    return i < N_COMMON ? common[i] : run_case->model_params[i - N_COMMON];
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

const void *brc_case_params(const struct brc_case *run_case, const struct brc_model *model)
{
    for (int i = 0; i < run_case->n_models; i++)
        if (brc_registry_at(i) == model)
            return run_case->model_params[i];
    return NULL;
}
