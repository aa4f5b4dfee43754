/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/fuzz.h"

#include "common/output/h5.h"
#include "common/output/io_h5.h"
#include "common/runs/case.h"
#include "common/runs/case_text.h"
#include "tests/fuzz_aid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 256, PARAMS_SIZE = 4096, N_STEPS = 40 };

/* A small simulation that has come some way, made once. */
static struct scene {
    struct brc_context ctx;
    struct brc_specimen specimen;
    struct brc_test_params test;
    struct brc_run_params run;
    const struct brc_model *model;
    void *params;
    struct brc_sim sim;
    char hash[17], specimen_hash[17];
    bool is_ready;
} scene;

/* Bytes that ask for changes; 0 for ever past their end, which changes nothing. */
struct wishes {
    const uint8_t *at, *end;
};

static uint8_t take(struct wishes *w)
{
    return w->at < w->end ? *w->at++ : 0;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void set(struct brc_param_list list, void *values, const char *key, const char *text)
{
    FUZZ_MUST(brc_params_set(&scene.ctx, list, values, "", key, text, "fuzz") == 0);
}

static int start(struct brc_context *ctx, struct brc_sim *sim)
{
    const struct brc_test test = brc_rigs_test(&scene.test, NULL);
    return brc_sim_create(ctx, sim, scene.model, scene.params, &scene.specimen, &test, &scene.run);
}

static const struct brc_h5_text texts[] = {{"parameters", "specimen.seed = 1\nrun.dt = 0 s\n"}};
static const struct brc_h5_extra extra = {texts, 1, NULL, 0};

static void keep_text(const char *name, char to[17])
{
    char *text;
    FUZZ_MUST(brc_h5_read_text(&scene.ctx, fuzz_path(), name, &text) == 0);
    snprintf(to, 17, "%s", text);
    free(text);
}

static void make_scene(void)
{
    struct brc_specimen_params p;
    struct brc_context *ctx = &scene.ctx;
    if (scene.is_ready)
        return;
    FUZZ_MUST(brc_params_defaults(ctx, brc_specimen_param_list, &p) == 0);
    FUZZ_MUST(brc_params_defaults(ctx, brc_test_param_list, &scene.test) == 0);
    FUZZ_MUST(brc_params_defaults(ctx, brc_run_param_list, &scene.run) == 0);
    set(brc_specimen_param_list, &p, "shape", "box");
    set(brc_specimen_param_list, &p, "grains", "grid");
    set(brc_specimen_param_list, &p, "cells", "2, 2, 2");
    set(brc_specimen_param_list, &p, "size", "1 cm, 1 cm, 1 cm");
    set(brc_test_param_list, &scene.test, "loading", "fixed");
    set(brc_test_param_list, &scene.test, "rate", "1e-4 1/s");
    scene.model = brc_registry_at(brc_registry_count() - 1);
    scene.params = calloc(1, scene.model->params.owner_size + 1);
    FUZZ_MUST(scene.params && brc_params_defaults(ctx, scene.model->params, scene.params) == 0);
    FUZZ_MUST(brc_specimen_create(ctx, &p, &scene.specimen) == 0);
    FUZZ_MUST(start(ctx, &scene.sim) == 0);
    for (int i = 0; i < N_STEPS; i++)
        FUZZ_MUST(brc_sim_step(&scene.sim) == 0);
    FUZZ_MUST(brc_h5_save(ctx, fuzz_path(), &scene.sim, &extra) == 0);
    keep_text("state_hash", scene.hash);
    keep_text("specimen_hash", scene.specimen_hash);
    scene.is_ready = true;
}

/* ---- a file with changes ------------------------------------------------------------------- */

/* A text of the provenance: as it is, left out, other, or no text at all. */
static void put_text(struct brc_h5_file *f, struct wishes *w, const char *name, const char *text)
{
    char path[NAME_SIZE], other[NAME_SIZE] = "";
    const struct brc_h5_array numbers = {.name = path, .type = BRC_F64, .rows = 2, .width = 3};
    snprintf(path, sizeof path, "provenance/%s", name);
    switch (take(w) % 8) {
    case 5:
        break;
    case 6:
        for (size_t n = take(w) % sizeof other, i = 0; i < n; i++)
            other[i] = (char)(1 + take(w) % 255);
        brc_h5_put_text(f, path, other);
        break;
    case 7:
        brc_h5_put_array(f, &numbers, (double[6]){0}, false);
        break;
    default:
        brc_h5_put_text(f, path, text);
    }
}

/* Another shape, type or name for a dataset. */
static void change_array(struct wishes *w, struct brc_h5_array *a)
{
    switch (take(w) % 6) {
    case 0:
        a->rows += take(w);
        break;
    case 1:
        a->rows = a->rows > 0 ? take(w) % a->rows : 1;
        break;
    case 2:
        a->width = 1 + take(w) % 9;
        break;
    case 3:
        a->type = (enum brc_type)(take(w) % 4);
        break;
    case 4:
        a->is_flat = !a->is_flat;
        break;
    default:
        a->unit = a->meaning = NULL;
    }
}

static void put_field(struct brc_h5_file *f, struct wishes *w, const struct brc_state_part *part,
                      int i)
{
    const struct brc_field *field = &part->set.fields[i];
    char name[NAME_SIZE];
    size_t size = brc_field_size(field);
    uint8_t wish = take(w) % 16;
    struct brc_h5_array a = {.rows = part->n, .type = field->type, .width = field->width};
    a.unit = field->unit;
    snprintf(name, sizeof name, "%s/%s", part->path, field->name);
    a.name = name;
    if (wish == 15)
        return;
    char *rows = calloc(part->n + 256, 8 * 9); /* enough for any changed shape */
    FUZZ_MUST(rows != NULL);
    for (size_t row = 0; row < part->n; row++)
        memcpy(rows + row * size, brc_state_value(part, i, row), size);
    for (int k = wish >= 12 && wish < 14 && part->n > 0 ? 1 + take(w) % 4 : 0; k > 0; k--)
        for (size_t at = (take(w) + 256u * take(w)) % (part->n * size), j = 0; j < 4; j++)
            if (at + j < part->n * size)
                rows[at + j] = (char)take(w);
    if (wish == 14)
        change_array(w, &a);
    brc_h5_put_array(f, &a, rows, false);
    free(rows);
}

static void put_part(struct brc_h5_file *f, struct wishes *w, const struct brc_state_part *part)
{
    uint8_t wish = take(w) % 16;
    size_t rows = part->n;
    if (wish == 15)
        return;
    brc_h5_put_group(f, part->path);
    if (wish == 14)
        rows = take(w);
    if (wish == 13)
        for (int i = 0; i < 8; i++)
            rows = rows << 8 | take(w);
    if (wish != 12)
        brc_h5_put_count(f, part->path, "rows", rows);
    for (int i = 0; i < part->set.n; i++)
        if (part->set.fields[i].flags & BRC_STATE)
            put_field(f, w, part, i);
}

/* The state of an intact simulation, written as io_h5.c writes it but for the wishes. */
static void write_changed(struct wishes *w)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_state state;
    struct brc_h5_file f;
    FUZZ_MUST(brc_h5_create(&ctx, fuzz_path(), &brc_checksum_state, &f) == 0);
    brc_h5_put_group(&f, "provenance");
    put_text(&f, w, "model", scene.model->name);
    put_text(&f, w, "specimen_hash", scene.specimen_hash);
    put_text(&f, w, "parameters", texts[0].text);
    put_text(&f, w, "state_hash", scene.hash);
    brc_state_list(&scene.sim, &state);
    for (int i = 0; i < state.n; i++)
        put_part(&f, w, &state.part[i]);
    FUZZ_MUST(brc_h5_finish(&f, 0) == 0);
}

/* ---- the target ---------------------------------------------------------------------------- */

/* As a resumed run reads a state: parameters first. */
static int load(struct brc_context *ctx, struct brc_sim *sim)
{
    char *saved;
    BRC_TRY(brc_h5_read_text(ctx, fuzz_path(), "parameters", &saved));
    int code = brc_case_same(ctx, saved, texts[0].text);
    free(saved);
    BRC_TRY(code);
    return brc_h5_load(ctx, fuzz_path(), sim, &extra);
}

int fuzz_state(const uint8_t *data, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_sim sim;
    struct wishes w = {data + 1, data + size};
    make_scene();
    if (size == 0)
        return 0;
    if (data[0] == 0)
        fuzz_write(data + 1, size - 1);
    else
        write_changed(&w);
    FUZZ_MUST(start(&ctx, &sim) == 0);
    int code = load(&ctx, &sim);
    fuzz_check_record(&ctx, code);
    /* what was accepted is a state that was saved: it goes on */
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)brc_sim_hash(&sim));
    FUZZ_MUST(code != 0 || strcmp(hash, scene.hash) == 0);
    for (int i = 0; code == 0 && i < 3; i++)
        FUZZ_MUST(brc_sim_step(&sim) == 0);
    brc_sim_free(&sim);
    return 0;
}
