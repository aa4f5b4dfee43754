/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The case that a run keeps in its folder. The user's text is edited rather than written anew:
 * comments say why a value is what it is. What comes out is read back and must make the same
 * parameters, as a kept case that makes another run is worse than none. Called by run.c before the
 * first step. */
#define _XOPEN_SOURCE 700 /* NOLINT(bugprone-reserved-identifier): glibc has realpath so */

#include "common/runs/case_keep.h"

#include "common/runs/applies.h"
#include "common/runs/case_files.h"
#include "common/runs/case_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The absolute path of a file's folder; the file itself may be a link, which stays the name that is
 * kept. Allocated, NULL when there is no such folder. */
static char *folder_of(struct brc_context *ctx, const char *name)
{
    char *folder = brc_alloc(ctx, strlen(name) + 2, 1);
    if (!folder)
        return NULL;
    strcpy(folder, name);
    char *slash = strrchr(folder, '/');
    strcpy(slash ? slash + 1 : folder, ".");
    char *real = realpath(folder, NULL);
    free(folder);
    return real;
}

/* The path from one absolute folder to another, "" or with a slash at its end; -1: it is longer
 * than size. Relative, so that a folder of results can be moved together with its inputs. */
static int path_between(const char *from, const char *to, char *path, size_t size)
{
    size_t same = 0, used = 0;
    for (size_t i = 0;; i++) {
        bool ends = (from[i] == '/' || !from[i]) && (to[i] == '/' || !to[i]);
        if (ends)
            same = i;
        if (!from[i] || from[i] != to[i])
            break;
    }
    path[0] = '\0';
    for (const char *c = from + same; *c && used + 4 < size; c++)
        if (*c == '/' && c[1])
            used += (size_t)snprintf(path + used, size - used, "../");
    const char *rest = to + same + (to[same] == '/');
    int n = snprintf(path + used, size - used, "%s%s", rest, *rest ? "/" : "");
    return used + 4 >= size || used + (size_t)n >= size ? -1 : 0;
}

/* A relative name as the folder dir sees it. One that fits already is left alone, since writing a
 * value anew would lose how the user has written it. */
static int keep_file(struct brc_context *ctx, struct brc_casefile *c, const struct brc_param *p,
                     const char *name, const char *dir)
{
    char path[BRC_TEXT_SIZE] = "";
    const char *slash = strrchr(name, '/'), *last = slash ? slash + 1 : name;
    if (*name == '\0' || *name == '/')
        return 0;
    char *from = realpath(dir, NULL), *to = folder_of(ctx, name);
    bool is_good = from && to && path_between(from, to, path, sizeof path) == 0 &&
                   strlen(path) + strlen(last) < sizeof path;
    free(from);
    free(to);
    if (!is_good)
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "specimen.%s: from %s there is no path of at most %d bytes to %s; name the file by "
            "a path that begins with /, or choose another folder with -o",
            p->key, dir, BRC_TEXT_SIZE - 1, name);
    strcat(path, last);
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(c, "specimen", p->key, brc_specimen_param_list);
    if (e && strcmp(e->text, path) == 0)
        return 0;
    return brc_casefile_write(ctx, c, "specimen", p->key, brc_specimen_param_list, path);
}

/* After the overrides, as those may name files, too. */
static int keep_files(struct brc_context *ctx, const struct brc_case *run_case, const char *dir,
                      struct brc_casefile *c)
{
    for (int i = 0; i < brc_specimen_param_list.n; i++) {
        const struct brc_param *p = &brc_specimen_param_list.params[i];
        if (p->flags & BRC_PARAM_FILE)
            BRC_TRY(keep_file(ctx, c, p, (const char *)&run_case->specimen + p->offset, dir));
    }
    return 0;
}

/* Of several overrides of a key the last one holds, and it alone is written: the earlier ones would
 * be a key that is given twice. */
static int keep_overrides(struct brc_context *ctx, const struct brc_casefile *from,
                          struct brc_casefile *c)
{
    for (size_t i = 0; i < from->n; i++) {
        const struct brc_casefile_entry *e = &from->entries[i];
        struct brc_case_section s;
        if (!brc_case_find_section(NULL, e->section, &s)) /* a key of the top level */
            s.list = brc_casefile_param_list;
        const char *key = brc_casefile_key(e, s.list);
        if (e->is_override && brc_casefile_find_entry(from, e->section, key, s.list) == e)
            BRC_TRY(brc_casefile_write(ctx, c, e->section, key, s.list, e->text));
    }
    return 0;
}

/* Keys of the file that an override has made meaningless: without the override's name they would be
 * errors. */
static int drop_meaningless(struct brc_context *ctx, const struct brc_case *run_case,
                            struct brc_casefile *c)
{
    const char *clause;
    struct brc_case_section s;
    for (int i = 0; brc_case_section(NULL, i, &s); i++)
        for (int k = 0; k < s.list.n; k++) {
            BRC_TRY(brc_applies(ctx, run_case, s.name, &s.list.params[k], &clause));
            if (clause)
                BRC_TRY(brc_casefile_remove(ctx, c, s.name, s.list.params[k].key, s.list));
        }
    return 0;
}

/* From the user's text: overrides become values, then what they have made meaningless goes, then
 * names of files are turned to the folder. The model last: it may come from an option alone. */
static int write_kept(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_model *model, const char *dir, struct brc_casefile *c)
{
    const char *text = run_case->file.text;
    BRC_TRY(brc_casefile_parse(ctx, run_case->file.path, text, strlen(text), c));
    BRC_TRY(keep_overrides(ctx, &run_case->file, c));
    BRC_TRY(drop_meaningless(ctx, run_case, c));
    BRC_TRY(keep_files(ctx, run_case, dir, c));
    if (strcmp(c->head.model, model->name) == 0)
        return 0;
    return brc_casefile_write(ctx, c, "", "model", brc_casefile_param_list, model->name);
}

/* What is kept is read back and compared as states compare cases: by all that a run hangs on. */
static int check_kept(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_model *model, const char *text)
{
    struct brc_case again;
    int code = brc_case_parse(ctx, &again, run_case->file.path, text);
    char *wanted = code == 0 ? brc_case_text(ctx, run_case, model) : NULL;
    char *got = code == 0 ? brc_case_text(ctx, &again, model) : NULL;
    if (code == 0)
        code = !wanted || !got ? BRC_ERR_MEMORY : brc_case_same(ctx, wanted, got);
    free(wanted);
    free(got);
    brc_case_free(&again);
    return code;
}

int brc_case_keep(struct brc_context *ctx, const struct brc_case *run_case,
                  const struct brc_model *model, const char *dir, char **text)
{
    struct brc_casefile c;
    int code = write_kept(ctx, run_case, model, dir, &c);
    if (code == 0)
        code = check_kept(ctx, run_case, model, c.text);
    *text = code == 0 ? c.text : NULL;
    if (code == 0)
        c.text = NULL;
    brc_casefile_free(&c);
    return code;
}
