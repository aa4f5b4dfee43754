/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every key enters unless its declaration says that it need not: to forget a declaration costs
 * computing time, never a wrong result. A list of keys that differ from their defaults would be
 * shorter, but a default that changes would go unnoticed. Called for each run of a sweep or a
 * ladder before it starts; knows no file but those that the case names. */
#include "common/runs/run_key.h"

#include "common/base/input_file.h"
#include "common/runs/applies.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct writer {
    struct brc_context *ctx;
    const struct brc_case *run_case;
    const struct brc_model *model;
    FILE *out;
};

/* ---- versions ------------------------------------------------------------------------------ */

/* `when` is judged as if it were the condition of a key of the section. */
static int put_versions(const struct writer *w, const struct brc_physics *list, const char *section)
{
    for (const struct brc_physics *p = list; p && p->part; p++) {
        const struct brc_param as_key = {.key = p->part, .applies = p->when};
        const char *clause;
        BRC_TRY(brc_applies(w->ctx, w->run_case, section, &as_key, &clause));
        if (!clause)
            fprintf(w->out, "%s %d, ", p->part, p->version);
    }
    return 0;
}

static int put_physics(const struct writer *w)
{
    const struct brc_rig_type *rig = brc_rigs_at(w->run_case->test.kind);
    BRC_TRY(put_versions(w, brc_specimen_physics, "specimen"));
    BRC_TRY(put_versions(w, brc_engine_physics, "run"));
    BRC_TRY(put_versions(w, brc_rigs_physics, "test"));
    BRC_TRY(put_versions(w, w->model->physics, w->model->name));
    fprintf(w->out, "%s %d", rig->name, rig->physics);
    return 0;
}

/* ---- keys ---------------------------------------------------------------------------------- */

/* Compared as texts that are read back: `off` is written as a user would write it. */
static int is_off(const struct writer *w, const struct brc_case_section *s,
                  const struct brc_param *p, bool *is)
{
    char now[BRC_TEXT_SIZE], off[BRC_TEXT_SIZE];
    *is = false;
    if (!p->off)
        return 0;
    void *values = brc_alloc(w->ctx, 1, s->list.owner_size);
    if (!values)
        return BRC_ERR_MEMORY;
    int code = brc_params_set(w->ctx, s->list, values, s->name, p->key, p->off, "off");
    *is = strcmp(brc_params_text(p, s->values, now, sizeof now),
                 brc_params_text(p, values, off, sizeof off)) == 0;
    free(values);
    return code;
}

static int put_file(const struct writer *w, const char *path)
{
    const struct brc_input in = {.path = path, .largest = BRC_INPUT_LARGEST, .is_plain = true};
    char *text;
    size_t n;
    if (!*path) {
        fputs("\"\"", w->out);
        return 0;
    }
    BRC_TRY(brc_input_read(w->ctx, &in, &text, &n));
    fprintf(w->out, "\"digest %016" PRIx64 "\"", brc_hash_bytes(text, n, BRC_HASH_SEED));
    free(text);
    return 0;
}

static int put_key(const struct writer *w, const struct brc_case_section *s,
                   const struct brc_param *p)
{
    const char *clause;
    char value[BRC_TEXT_SIZE];
    bool is = false;
    BRC_TRY(brc_applies(w->ctx, w->run_case, s->name, p, &clause));
    if (!clause)
        BRC_TRY(is_off(w, s, p, &is));
    if (clause || is || p->flags & BRC_PARAM_COST)
        return 0;
    fprintf(w->out, ", \"%s.%s\": ", s->name, p->renamed ? p->renamed : p->key);
    if (p->flags & BRC_PARAM_FILE)
        return put_file(w, (const char *)s->values + p->offset);
    brc_output_json_text(w->out, brc_params_text(p, s->values, value, sizeof value));
    return 0;
}

int brc_run_key_section(struct brc_context *ctx, const struct brc_case *run_case,
                        const struct brc_case_section *s, FILE *out)
{
    const struct writer w = {ctx, run_case, NULL, out};
    for (int i = 0; i < s->list.n; i++)
        BRC_TRY(put_key(&w, s, &s->list.params[i]));
    return 0;
}

static int put_all(const struct writer *w)
{
    const char *const section[] = {"specimen", "test", brc_rigs_at(w->run_case->test.kind)->name,
                                   "run", w->model->name};
    fputs("{\"physics\": \"", w->out);
    BRC_TRY(put_physics(w));
    fprintf(w->out, "\", \"model\": \"%s\"", w->model->name);
    for (size_t i = 0; i < sizeof section / sizeof section[0]; i++) {
        struct brc_case_section s; /* without keys where a test has none of its own */
        brc_case_find_section(w->run_case, section[i], &s);
        BRC_TRY(brc_run_key_section(w->ctx, w->run_case, &s, w->out));
    }
    fputc('}', w->out);
    return 0;
}

int brc_run_key_make(struct brc_context *ctx, const struct brc_case *run_case,
                     const struct brc_model *model, struct brc_run_key *out)
{
    size_t n;
    *out = (struct brc_run_key){0};
    FILE *stream = open_memstream(&out->text, &n);
    const struct writer w = {ctx, run_case, model, stream};
    int code = stream ? put_all(&w) : BRC_ERR_MEMORY;
    if (stream && fclose(stream) != 0 && code == 0)
        code = BRC_ERR_MEMORY;
    if (code == 0) {
        out->hash = brc_hash_bytes(out->text, n, BRC_HASH_SEED);
        return 0;
    }
    free(out->text);
    out->text = NULL;
    return brc_error_set(ctx, code, __FILE__, __LINE__, "no memory for the key of a run");
}
