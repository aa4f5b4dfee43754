/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the tree of the file to groups with axes. Keys of the top level hold for all groups; a group
 * adds to them, and what it says itself wins. Called by sweep.c; whether keys and values are good
 * is judged with the cases (sweep_runs.c), which have the lists. */
#include "common/runs/sweep_file.h"

#include "common/base/input_file.h"
#include "common/base/names.h"
#include "common/input/casefile.h"
#include "common/input/casefile_tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_VALUES = 10000 };

struct reader {
    struct brc_context *ctx;
    struct brc_pool *pool;
    const char *path;
};

static int fail_at(const struct reader *r, int line, const char *name, const char *what)
{
    BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s: %s", r->path, line, name, what);
}

static void *make(const struct reader *r, size_t n, size_t size)
{
    return brc_pool_alloc(r->ctx, r->pool, n, size);
}

/* "a.b", or "a" where there is no b. */
static const char *join(const struct reader *r, const char *a, const char *dot, const char *b)
{
    char *text = make(r, strlen(a) + strlen(dot) + strlen(b) + 1, 1);
    return text ? strcat(strcat(strcpy(text, a), dot), b) : NULL;
}

/* ---- assignments --------------------------------------------------------------------------- */

/* A plain value, or a sequence of such as one text "a, b, c": triples. */
static const char *text_of(const struct reader *r, const struct brc_tree *t)
{
    const char *text = t->text;
    for (size_t i = 0; t->kind == BRC_TREE_LIST && text && i < t->n; i++)
        text =
            t->item[i].kind == BRC_TREE_TEXT ? join(r, text, i ? ", " : "", t->item[i].text) : "";
    return text;
}

static int add(const struct reader *r, struct brc_sweep_assignments *set, const char *key,
               const char *text, int line)
{
    struct brc_sweep_assignment *item = make(r, set->n + 1, sizeof *item);
    if (!item || !key || !text)
        return BRC_ERR_MEMORY;
    if (set->n > 0)
        memcpy(item, set->item, set->n * sizeof *item);
    item[set->n++] = (struct brc_sweep_assignment){key, text, line};
    set->item = item;
    return 0;
}

/* `specimen: {seed: 2}` and `specimen.seed: 2` alike, nested mappings included. */
static int read_set(const struct reader *r, const struct brc_tree *t, const char *prefix,
                    struct brc_sweep_assignments *set)
{
    if (t->kind != BRC_TREE_MAP)
        return fail_at(r, t->line, t->key, "takes a mapping, `{section.key: value}`");
    for (size_t i = 0; i < t->n; i++) {
        const struct brc_tree *item = &t->item[i];
        const char *key = join(r, prefix, *prefix ? "." : "", item->key);
        if (item->kind == BRC_TREE_NOTHING)
            return fail_at(r, item->line, item->key, "has no value");
        BRC_TRY(item->kind == BRC_TREE_MAP ? (key ? read_set(r, item, key, set) : BRC_ERR_MEMORY)
                                           : add(r, set, key, text_of(r, item), item->line));
    }
    return 0;
}

/* ---- axes ---------------------------------------------------------------------------------- */

/* The value for each of the keys "a, b" that the axis is named by. */
static int read_value(const struct reader *r, const struct brc_sweep_axis *axis, const char *text,
                      int line, struct brc_sweep_value *out)
{
    *out = (struct brc_sweep_value){.label = text};
    if (!text)
        return BRC_ERR_MEMORY;
    if (!*text)
        return fail_at(r, line, axis->name, "a value of the axis is empty");
    for (const char *at = axis->name; *(at += strspn(at, ", ")) != '\0';) {
        size_t n = strcspn(at, ", ");
        char *key = make(r, n + 1, 1);
        if (key)
            memcpy(key, at, n);
        BRC_TRY(add(r, &out->set, key, text, line));
        at += n;
    }
    return 0;
}

/* "1..8"; *n 0: the text is another one. */
static int read_range(const struct reader *r, const struct brc_tree *t, long *first, size_t *n)
{
    char *end, *behind;
    *n = 0;
    *first = strtol(t->text, &end, 10);
    if (end == t->text || strncmp(end, "..", 2) != 0)
        return 0;
    long last = strtol(end + 2, &behind, 10);
    if (*behind || behind == end + 2 || last < *first || last - *first >= MAX_VALUES)
        return fail_at(r, t->line, t->key, "a range is `first..last`, ascending, as 1..8");
    *n = (size_t)(last - *first + 1);
    return 0;
}

static int read_list(const struct reader *r, const struct brc_tree *t, struct brc_sweep_axis *axis)
{
    long first;
    size_t n;
    char number[32];
    BRC_TRY(read_range(r, t, &first, &n));
    bool is_range = n > 0;
    axis->n = is_range ? n : t->kind == BRC_TREE_TEXT ? 1 : t->n;
    axis->value = make(r, axis->n, sizeof *axis->value);
    for (size_t i = 0; axis->value && i < axis->n; i++) {
        const struct brc_tree *item = t->kind == BRC_TREE_LIST ? &t->item[i] : t;
        snprintf(number, sizeof number, "%ld", first + (long)i);
        const char *text = is_range ? join(r, number, "", "") : text_of(r, item);
        BRC_TRY(read_value(r, axis, text, item->line, &axis->value[i]));
        for (size_t k = 0; k < i; k++)
            if (strcmp(axis->value[k].label, text) == 0)
                return fail_at(r, item->line, axis->name, "has the same value twice");
    }
    return axis->value ? 0 : BRC_ERR_MEMORY;
}

/* Values that have names of their own, each of several keys. */
static int read_named(const struct reader *r, const struct brc_tree *t, struct brc_sweep_axis *axis)
{
    axis->n = t->n;
    axis->value = make(r, axis->n, sizeof *axis->value);
    for (size_t i = 0; axis->value && i < axis->n; i++) {
        axis->value[i].label = t->item[i].key;
        BRC_TRY(read_set(r, &t->item[i], "", &axis->value[i].set));
    }
    return axis->value ? 0 : BRC_ERR_MEMORY;
}

/* The names of axes are columns of the tables, beside these. */
static int check_name(const struct reader *r, const struct brc_tree *t)
{
    static const char *const taken[] = {"group",  "quantity", "unit",   "n",       "mean",
                                        "ci_low", "ci_high",  "cpu_s",  "runs",    "code",
                                        "key",    "steps",    "failed", "message", "wall_s"};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++)
        if (strcmp(taken[i], t->key) == 0)
            return fail_at(r, t->line, t->key,
                           "is a column of the tables; give the axis another name");
    return 0;
}

static int read_axis(const struct reader *r, const struct brc_tree *t, struct brc_sweep_axis *axis)
{
    BRC_TRY(check_name(r, t));
    *axis = (struct brc_sweep_axis){.name = t->key, .line = t->line};
    BRC_TRY(t->kind == BRC_TREE_MAP ? read_named(r, t, axis) : read_list(r, t, axis));
    if (axis->n == 0 || t->kind == BRC_TREE_NOTHING)
        return fail_at(r, t->line, t->key,
                       "the axis has no value; list them, as [1, 2, 3] or 1..3, or leave it out");
    if (axis->n > MAX_VALUES)
        return fail_at(r, t->line, t->key, "the axis has more than 10000 values");
    return 0;
}

/* An axis of the same name takes the place of that of the top level, so that a group may have
 * fewer seeds. */
static int read_axes(const struct reader *r, const struct brc_tree *t, struct brc_sweep_group *g)
{
    if (t->kind != BRC_TREE_MAP)
        return fail_at(r, t->line, "axes", "takes a mapping, `{section.key: [value, value]}`");
    struct brc_sweep_axis *axis = make(r, g->n_axes + t->n, sizeof *axis);
    if (!axis)
        return BRC_ERR_MEMORY;
    if (g->n_axes > 0)
        memcpy(axis, g->axis, g->n_axes * sizeof *axis);
    g->axis = axis;
    for (size_t i = 0; i < t->n; i++) {
        size_t k = 0;
        while (k < g->n_axes && strcmp(axis[k].name, t->item[i].key) != 0)
            k++;
        BRC_TRY(read_axis(r, &t->item[i], &axis[k]));
        g->n_axes += k == g->n_axes;
    }
    return 0;
}

/* Two axes that set one key: the one would undo the other without a word. */
static int check_axes(const struct reader *r, const struct brc_sweep_group *g)
{
    for (size_t a = 0; a < g->n_axes; a++)
        for (size_t b = 0; b < a; b++) {
            const struct brc_sweep_assignments *x = &g->axis[a].value[0].set,
                                               *y = &g->axis[b].value[0].set;
            for (size_t i = 0; i < x->n; i++)
                for (size_t k = 0; k < y->n; k++)
                    if (strcmp(x->item[i].key, y->item[k].key) == 0)
                        BRC_FAIL(r->ctx, BRC_ERR_INPUT,
                                 "%s:%d: %s: is set by the axis %s, too, in line %d; leave it out "
                                 "of one of the two",
                                 r->path, g->axis[a].line, x->item[i].key, g->axis[b].name,
                                 g->axis[b].line);
        }
    return 0;
}

/* ---- lists of names ------------------------------------------------------------------------ */

static int read_names(const struct reader *r, const struct brc_tree *t, const char ***name,
                      size_t *n)
{
    *n = t->kind == BRC_TREE_TEXT ? 1 : t->n;
    *name = make(r, *n + 1, sizeof **name);
    for (size_t i = 0; *name && i < *n; i++) {
        const struct brc_tree *item = t->kind == BRC_TREE_TEXT ? t : &t->item[i];
        if (item->kind != BRC_TREE_TEXT)
            return fail_at(r, item->line, t->key, "takes names, `[a, b]`");
        (*name)[i] = item->text;
    }
    return *name ? 0 : BRC_ERR_MEMORY;
}

/* Seeds where nothing is said: they are what one averages over. Of names at the top level a group
 * may lack some. */
static int read_over(const struct reader *r, const struct brc_tree *t, bool is_common,
                     struct brc_sweep_group *g)
{
    const char *seed = "specimen.seed";
    const char **name = &seed;
    size_t n = 1;
    if (t)
        BRC_TRY(read_names(r, t, &name, &n));
    for (size_t a = 0; a < g->n_axes; a++)
        g->axis[a].is_over = false;
    for (size_t i = 0; i < n; i++) {
        char all[BRC_NAMES_SIZE] = "";
        bool is_found = false;
        for (size_t a = 0; a < g->n_axes; a++) {
            bool is = strcmp(g->axis[a].name, name[i]) == 0;
            g->axis[a].is_over = g->axis[a].is_over || is;
            is_found = is_found || is;
            brc_names_add(all, sizeof all, g->axis[a].name);
        }
        if (!is_found && !is_common && t)
            BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: over: no axis '%.60s'; there are: %s", r->path,
                     t->line, name[i], all);
    }
    return 0;
}

/* ---- the file ------------------------------------------------------------------------------ */

static const char *const group_keys[] = {"case", "set", "axes", "over", "collect"};
static const char *const top_keys[] = {"breccia", "title", "cache", "groups"};
enum { N_GROUP = sizeof group_keys / sizeof group_keys[0] };
enum { N_TOP = sizeof top_keys / sizeof top_keys[0] };

static int check_keys(const struct reader *r, const struct brc_tree *t, bool is_top)
{
    for (size_t i = 0; i < t->n; i++) {
        char all[BRC_NAMES_SIZE] = "", hint[BRC_HINT_SIZE];
        struct brc_nearest nearest = {.text = t->item[i].key};
        bool is_known = false;
        for (size_t k = 0; k < N_GROUP + (is_top ? N_TOP : 0); k++) {
            const char *key = k < N_GROUP ? group_keys[k] : top_keys[k - N_GROUP];
            is_known = is_known || strcmp(key, t->item[i].key) == 0;
            brc_names_add(all, sizeof all, key);
            brc_nearest_add(&nearest, key);
        }
        if (!is_known)
            BRC_FAIL(r->ctx, BRC_ERR_INPUT, "%s:%d: %s: unknown key of a %s; allowed %s%s", r->path,
                     t->item[i].line, t->item[i].key, is_top ? "sweep" : "group", all,
                     brc_nearest_hint(&nearest, hint));
    }
    return 0;
}

/* What t says of the group; over is read when all axes are known. */
static int read_group(const struct reader *r, const struct brc_tree *t, struct brc_sweep_group *g)
{
    const struct brc_tree *file = brc_tree_find(t, "case"), *set = brc_tree_find(t, "set"),
                          *axes = brc_tree_find(t, "axes"), *names = brc_tree_find(t, "collect");
    if (file && file->kind != BRC_TREE_TEXT)
        return fail_at(r, file->line, "case",
                       "takes the name of a file; several are an axis, `axes: {case: [a, b]}`");
    if (file)
        BRC_TRY(add(r, &g->set, "case", file->text, file->line));
    if (set)
        BRC_TRY(read_set(r, set, "", &g->set));
    if (axes)
        BRC_TRY(read_axes(r, axes, g));
    if (!names)
        return 0;
    g->collect_line = names->line;
    return read_names(r, names, &g->collect, &g->n_collect);
}

static int read_groups(const struct reader *r, const struct brc_tree *top,
                       struct brc_sweep_plan *out)
{
    const struct brc_tree *groups = brc_tree_find(top, "groups"),
                          *over = brc_tree_find(top, "over");
    struct brc_sweep_group common = {.name = "all", .line = 1};
    if (groups && (groups->kind != BRC_TREE_MAP || groups->n == 0))
        return fail_at(r, groups->line, "groups", "takes a mapping, `{name: {axes: ...}}`");
    BRC_TRY(read_group(r, top, &common));
    out->n_groups = groups ? groups->n : 1;
    out->group = make(r, out->n_groups, sizeof *out->group);
    for (size_t i = 0; out->group && i < out->n_groups; i++) {
        struct brc_sweep_group *g = &out->group[i];
        const struct brc_tree *t = groups ? &groups->item[i] : NULL, *own = NULL;
        *g = common;
        if (t) {
            g->name = t->key;
            g->line = t->line;
            if (t->kind == BRC_TREE_TEXT || t->kind == BRC_TREE_LIST)
                return fail_at(r, t->line, t->key, "a group is a mapping, `{axes: ...}`");
            BRC_TRY(check_keys(r, t, false));
            BRC_TRY(read_group(r, t, g));
            own = brc_tree_find(t, "over");
        }
        BRC_TRY(read_over(r, own ? own : over, groups && !own, g));
        BRC_TRY(check_axes(r, g));
    }
    return out->group ? 0 : BRC_ERR_MEMORY;
}

static int read_top(const struct reader *r, const struct brc_tree *top, struct brc_sweep_plan *out)
{
    const struct brc_tree *version = brc_tree_find(top, "breccia"),
                          *title = brc_tree_find(top, "title"),
                          *cache = brc_tree_find(top, "cache");
    char here[16];
    snprintf(here, sizeof here, "%d", BRC_CASEFILE_VERSION);
    if (!version || strcmp(version->text, here) != 0)
        BRC_FAIL(r->ctx, BRC_ERR_INPUT,
                 "%s:%d: breccia: a sweep file starts with the version of its format, `breccia: "
                 "%s`",
                 r->path, version ? version->line : 1, here);
    BRC_TRY(check_keys(r, top, true));
    out->path = r->path;
    out->title = title ? title->text : "";
    out->cache = cache ? cache->text : "";
    return read_groups(r, top, out);
}

int brc_sweep_file_read(struct brc_context *ctx, struct brc_pool *pool, const char *path,
                        struct brc_sweep_plan *out)
{
    const struct brc_input in = {
        .noun = "the sweep file", .path = path, .largest = BRC_CASEFILE_MAX_BYTES};
    const struct reader r = {ctx, pool, path};
    struct brc_tree top;
    char *text;
    size_t n;
    BRC_TRY(brc_input_read(ctx, &in, &text, &n));
    const struct brc_yaml_text from = {path, "sweep file", text, n};
    int code = brc_tree_parse(ctx, pool, &from, &top);
    free(text);
    *out = (struct brc_sweep_plan){0};
    return code ? code : read_top(&r, &top, out);
}
