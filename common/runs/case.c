/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case from its file to filled structs. The order of the steps matters: sections first, then
 * names of sections, then whether keys apply, which depends on values; files last, since overrides
 * count from another folder. All sections are read whatever model and test are chosen, so that a
 * mistake in one that this run does not use is found by this run, not by the next. */
#include "common/runs/case.h"

#include "common/runs/applies.h"
#include "common/runs/case_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Case files are called by their names in titles, logs and folders: without folder and ending, but
 * for a name that is nothing but an ending. */
static void set_name(struct brc_case *run_case, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(run_case->name, sizeof run_case->name, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(run_case->name, '.');
    if (dot && dot != run_case->name)
        *dot = '\0';
}

/* A struct for each model and test, chosen or not: all their sections are read. Those of the common
 * sections are members of the case, which the rest of the program reads by their types; the table
 * of values has them, too, so that a walk over the sections finds all alike. */
static int make_room(struct brc_context *ctx, struct brc_case *run_case)
{
    void *const common[BRC_CASE_N_COMMON] = {&run_case->specimen, &run_case->test, &run_case->run,
                                             &run_case->output};
    struct brc_case_section s;
    memcpy(run_case->values, common, sizeof common);
    for (int i = BRC_CASE_N_COMMON; brc_case_section(NULL, i, &s); i++) {
        if (i == BRC_CASE_MAX_SECTIONS)
            BRC_FAIL(ctx, BRC_ERR_INTERNAL, "models and tests have more than %d sections", i);
        run_case->values[i] = brc_alloc(ctx, 1, s.list.owner_size);
        if (!run_case->values[i])
            return BRC_ERR_MEMORY;
    }
    return 0;
}

/* The test with its parameters, which stay the case's: what outlives it makes its own copy
 * (rig.c). */
static struct brc_test test_of(const struct brc_case *run_case)
{
    const char *name = brc_rigs_at(run_case->test.kind)->name;
    return brc_rigs_test(&run_case->test, brc_case_values(run_case, name));
}

/* The polygon that stands for a circle is the test's choice where the case makes none. */
static void choose_sides(struct brc_case *run_case)
{
    struct brc_specimen_params *s = &run_case->specimen;
    if (s->sides == 0 && s->grains != BRC_GRAINS_MESH)
        s->sides = brc_rigs_at(run_case->test.kind)->sides;
}

/* A section, or a key of the top level, that stands as if it were a key of another section: in YAML
 * two spaces too many, and the plain message, "unknown key", would not say so. */
static int check_indents(struct brc_context *ctx, const struct brc_case *run_case)
{
    const struct brc_casefile *c = &run_case->file;
    struct brc_case_section s;
    for (int i = 0; brc_case_section(NULL, i, &s); i++)
        for (size_t k = 0; k < c->n_sections; k++) {
            const char *name = c->sections[k].name, *dot = strchr(name, '.');
            if (dot && strcmp(dot + 1, s.name) == 0)
                BRC_FAIL(ctx, BRC_ERR_INPUT,
                         "%s:%d: %s is a section, but it is indented under %.*s; write it in the "
                         "first column",
                         c->path, c->sections[k].line, s.name, (int)(dot - name), name);
        }
    for (size_t k = 0; k < c->n; k++) {
        const struct brc_casefile_entry *e = &c->entries[k];
        if (*e->section && !e->is_override && brc_params_find(brc_casefile_param_list, e->key))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s:%d: %s is a key of the top level, but it is indented under %s; write it "
                     "in the first column",
                     c->path, e->line, e->key, e->section);
    }
    return 0;
}

/* A key that is unknown or has a bad value comes before one that does not apply: whether a key
 * applies is decided by the values of others. */
static int check_sections(struct brc_context *ctx, struct brc_case *run_case)
{
    const char *names[BRC_CASE_MAX_SECTIONS];
    struct brc_case_section s;
    int n = 0;
    BRC_TRY(check_indents(ctx, run_case));
    for (; brc_case_section(run_case, n, &s); n++) {
        names[n] = s.name;
        BRC_TRY(brc_casefile_section(ctx, &run_case->file, s.name, s.list, s.values));
    }
    BRC_TRY(brc_casefile_finish(ctx, &run_case->file, names, (size_t)n));
    for (int i = 0; brc_case_section(run_case, i, &s); i++)
        BRC_TRY(brc_applies_check(ctx, run_case, &s));
    struct brc_test test = test_of(run_case);
    int code = brc_rig_check(ctx, &test);
    if (code != 0)
        brc_case_locate(ctx, run_case);
    choose_sides(run_case);
    return code;
}

static int start(struct brc_context *ctx, struct brc_case *run_case, const char *path)
{
    memset(run_case, 0, sizeof *run_case);
    set_name(run_case, path);
    if (!brc_casefile_is_text(run_case->name))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "the name of the case file is not valid UTF-8 text, and it stands in the results; "
                 "rename the file");
    return make_room(ctx, run_case);
}

/* Reads on from the case itself. Overrides last: they are text like the file's, and hold against
 * it. */
static int finish(struct brc_context *ctx, struct brc_case *run_case, const char *const *overrides,
                  int n)
{
    for (int k = 0; k < n; k++)
        BRC_TRY(brc_casefile_override(ctx, &run_case->file, overrides[k]));
    BRC_TRY(check_sections(ctx, run_case));
    return brc_case_find_files(ctx, run_case);
}

int brc_case_read(struct brc_context *ctx, struct brc_case *run_case, const char *path,
                  const char *const *overrides, int n)
{
    BRC_TRY(start(ctx, run_case, path));
    BRC_TRY(brc_casefile_read(ctx, path, &run_case->file));
    return finish(ctx, run_case, overrides, n);
}

int brc_case_parse(struct brc_context *ctx, struct brc_case *run_case, const char *path,
                   const char *text)
{
    BRC_TRY(start(ctx, run_case, path));
    BRC_TRY(brc_casefile_parse(ctx, path, text, strlen(text), &run_case->file));
    return finish(ctx, run_case, NULL, 0);
}

/* Overrides are given again by their text, not by their values: files that they name, and what they
 * make meaningless, are judged anew. */
static int repeat_override(struct brc_context *ctx, struct brc_casefile *c,
                           const struct brc_casefile_entry *e)
{
    size_t size = strlen(e->text) + 3 * BRC_CASEFILE_KEY_SIZE;
    char *assignment = brc_alloc(ctx, size, 1);
    if (!assignment)
        return BRC_ERR_MEMORY;
    snprintf(assignment, size, "%s%s%s%s=%s", e->section, *e->section ? "." : "",
             *e->parent ? e->parent : e->key, *e->parent ? ".rule" : "", e->text);
    int code = brc_casefile_override(ctx, c, assignment);
    free(assignment);
    return code;
}

/* From the text again and not from the structs: what further overrides make meaningless, and the
 * files that they name, must be judged as in a case that had them from the start. */
int brc_case_change(struct brc_context *ctx, const struct brc_case *run_case,
                    const char *const *overrides, int n, struct brc_case *out)
{
    const char *text = run_case->file.text;
    BRC_TRY(start(ctx, out, run_case->file.path));
    BRC_TRY(brc_casefile_parse(ctx, run_case->file.path, text, strlen(text), &out->file));
    for (size_t i = 0; i < run_case->file.n; i++)
        if (run_case->file.entries[i].is_override)
            BRC_TRY(repeat_override(ctx, &out->file, &run_case->file.entries[i]));
    return finish(ctx, out, overrides, n);
}

int brc_case_sim(struct brc_context *ctx, const struct brc_case *run_case,
                 const struct brc_model *model, const struct brc_specimen *specimen,
                 struct brc_sim *sim)
{
    struct brc_test test = test_of(run_case);
    return brc_sim_create(ctx, sim, model, brc_case_values(run_case, model->name), specimen, &test,
                          &run_case->run);
}

void brc_case_free(struct brc_case *run_case)
{
    for (int i = BRC_CASE_N_COMMON; i < BRC_CASE_MAX_SECTIONS; i++)
        free(run_case->values[i]);
    brc_casefile_free(&run_case->file);
    memset(run_case, 0, sizeof *run_case);
}

/* ---- places in messages --------------------------------------------------------------------- */

/* The first section.key in text, at the beginning of a word; false when there is none. */
static bool find_key(const char *text, struct brc_case_section *s, char key[BRC_CASEFILE_KEY_SIZE])
{
    for (const char *c = text; *c; c++)
        if ((c == text || strchr(" '(", c[-1])) && brc_case_key_at(c, s, key))
            return true;
    return false;
}

/* Deeper code names a key as section.key and knows no lines; here, where the file is known, the
 * place is put before its message. The message stays as it is where it names none. */
void brc_case_locate(struct brc_context *ctx, const struct brc_case *run_case)
{
    char key[BRC_CASEFILE_KEY_SIZE], where[BRC_CASEFILE_WHERE_SIZE];
    struct brc_case_section section;
    bool is_input =
        ctx->code == BRC_ERR_INPUT || ctx->code == BRC_ERR_GEOMETRY || ctx->code == BRC_ERR_IO;
    if (!is_input || !find_key(ctx->message, &section, key))
        return;
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(&run_case->file, section.name, key, section.list);
    const struct brc_casefile_place *s = brc_casefile_find_section(&run_case->file, section.name);
    brc_casefile_where(&run_case->file, e ? e->line : s ? s->line : 0, e && e->is_override, where);
    size_t n = strlen(where), left = sizeof ctx->message - n - 3;
    memmove(ctx->message + n + 2, ctx->message, left);
    ctx->message[sizeof ctx->message - 1] = '\0';
    memcpy(ctx->message, where, n);
    memcpy(ctx->message + n, ": ", 2);
}
