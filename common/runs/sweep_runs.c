/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All cases are read, with all their overrides, before one run starts: a slip in the last of a
 * thousand runs would else be found after days. They are dropped again, as a thousand would fill
 * the memory; the process of a run reads its own anew. */
#include "common/runs/sweep_runs.h"

#include "common/rigs/readings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Files for a look at a run are made where the runs are kept alone. */
static const char *const quiet_output[] = {"output.plots=off", "output.frames=0",
                                           "output.frame_strain=0", "output.frame_steps=0"};
enum { N_QUIET = sizeof quiet_output / sizeof quiet_output[0] };

/* One run on its way. */
struct maker {
    struct brc_context *ctx;
    struct brc_sweep_runs *runs;
    const struct brc_sweep_group *group;
    struct brc_sweep_run *run;
    struct brc_sweep_assignments all; /* in the order in which they count */
    const char *model;                /* "": that of the case */
    /* the case with what the group sets, from which factors count; read when one is met */
    struct brc_case base;
    const char *base_path;
    const struct brc_sweep_group *base_group;
};

static int fail_at(const struct maker *m, int line, const char *name, const char *what)
{
    BRC_FAIL(m->ctx, BRC_ERR_INPUT, "%s:%d: %s: %s", m->runs->plan->path, line, name, what);
}

static char *make_text(const struct maker *m, const char *a, const char *b, const char *c)
{
    size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = brc_pool_alloc(m->ctx, m->runs->pool, size, 1);
    if (text)
        snprintf(text, size, "%s%s%s", a, b, c);
    return text;
}

/* A name of the sweep file is seen from its folder, one of the command line from the working
 * folder. */
static const char *seen_from_file(const struct maker *m, const struct brc_sweep_assignment *a)
{
    const char *path = m->runs->plan->path, *slash = strrchr(path, '/');
    char folder[BRC_PATH_SIZE];
    if (a->line == 0 || !slash || a->text[0] == '/' || !a->text[0])
        return a->text;
    snprintf(folder, sizeof folder, "%.*s", (int)(slash - path) + 1, path);
    return make_text(m, folder, a->text, "");
}

/* ---- messages ------------------------------------------------------------------------------ */

/* The assignment that a message about an override is of: it begins with its key. */
static const struct brc_sweep_assignment *find_source(const struct maker *m, const char *message)
{
    const struct brc_sweep_assignment *found = NULL;
    size_t longest = 0;
    for (size_t i = 0; i < m->all.n; i++) {
        size_t n = strlen(m->all.item[i].key);
        if (n >= longest && strncmp(message, m->all.item[i].key, n) == 0) {
            found = &m->all.item[i];
            longest = n;
        }
    }
    return found;
}

/* A case that cannot be read is told with the line that names it, the last one. */
static int fail_case(const struct maker *m)
{
    char said[BRC_MESSAGE_SIZE];
    int line = m->group->line;
    for (size_t i = 0; i < m->all.n; i++)
        if (strcmp(m->all.item[i].key, "case") == 0 && m->all.item[i].line > 0)
            line = m->all.item[i].line;
    snprintf(said, sizeof said, "%s", m->ctx->message);
    brc_error_clear(m->ctx);
    BRC_FAIL(m->ctx, BRC_ERR_IO, "%s:%d: case: %s", m->runs->plan->path, line, said);
}

/* Readers of cases know of overrides that they come from --set; here they come from a line. */
static int relocate(const struct maker *m, int code)
{
    static const char mark[] = "--set: ";
    struct brc_context *ctx = m->ctx;
    char said[BRC_MESSAGE_SIZE];
    if (code == BRC_ERR_IO) /* of the case itself */
        return fail_case(m);
    if (strncmp(ctx->message, mark, sizeof mark - 1) != 0)
        return code;
    snprintf(said, sizeof said, "%s", ctx->message + sizeof mark - 1);
    const struct brc_sweep_assignment *a = find_source(m, said);
    if (a && a->line == 0)
        return code;
    brc_error_clear(ctx);
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s:%d: %s", m->runs->plan->path, a ? a->line : m->group->line,
             said);
}

/* ---- factors ------------------------------------------------------------------------------- */

/* "0.5x"; NAN for another text. */
static double factor_of(const char *text)
{
    char *end;
    double factor = strtod(text, &end);
    return end != text && strcmp(end, "x") == 0 && isfinite(factor) ? factor : NAN;
}

static bool is_top(const char *key)
{
    return strcmp(key, "case") == 0 || strcmp(key, "model") == 0;
}

/* As an override, with the files' names turned to the working folder. */
static const char *override_of(const struct maker *m, const struct brc_sweep_assignment *a)
{
    char key[BRC_CASEFILE_KEY_SIZE];
    struct brc_case_section s;
    const char *text = a->text;
    if (brc_case_key_at(a->key, &s, key) && brc_params_find(s.list, key)->flags & BRC_PARAM_FILE)
        text = seen_from_file(m, a);
    return text ? make_text(m, a->key, "=", text) : NULL;
}

/* The case without its axes, but for the axis `case`. */
static int read_base(struct maker *m)
{
    const struct brc_sweep_assignments *set = &m->group->set;
    if (m->base_group == m->group && strcmp(m->base_path, m->run->path) == 0)
        return 0;
    const char **line = brc_pool_alloc(m->ctx, m->runs->pool, set->n, sizeof *line);
    int n = 0;
    brc_case_free(&m->base);
    m->base_group = NULL;
    for (size_t i = 0; line && i < set->n; i++)
        if (!is_top(set->item[i].key) && !(line[n++] = override_of(m, &set->item[i])))
            return BRC_ERR_MEMORY;
    if (!line)
        return BRC_ERR_MEMORY;
    BRC_TRY(relocate(m, brc_case_read(m->ctx, &m->base, m->run->path, line, n)));
    m->base_group = m->group;
    m->base_path = m->run->path;
    return 0;
}

/* The value of the case times a factor, in SI, with all digits. */
static int multiply(struct maker *m, struct brc_sweep_assignment *a, double factor)
{
    char key[BRC_CASEFILE_KEY_SIZE], text[160];
    struct brc_case_section s;
    if (!brc_case_key_at(a->key, &s, key))
        return 0; /* the reader of the case tells what is wrong with the key */
    BRC_TRY(read_base(m));
    brc_case_find_section(&m->base, s.name, &s);
    const struct brc_param *p = brc_params_find(s.list, key);
    const void *at = (const char *)s.values + p->offset;
    const char *unit = brc_unit_shown(p->unit);
    const double *x = at;
    double n = p->kind == BRC_INT ? factor * *(const int *)at : 0;
    if (p->kind == BRC_REAL && isfinite(*x))
        snprintf(text, sizeof text, "%.17g %s", factor * *x, unit);
    else if (p->kind == BRC_REAL3)
        snprintf(text, sizeof text, "%.17g %s, %.17g %s, %.17g %s", factor * x[0], unit,
                 factor * x[1], unit, factor * x[2], unit);
    else if (p->kind == BRC_INT && n == round(n))
        snprintf(text, sizeof text, "%.0f", n);
    else
        BRC_FAIL(m->ctx, BRC_ERR_INPUT,
                 "%s:%d: %s: %s is a factor on the value of the case, which is '%s'; write the "
                 "value itself",
                 m->runs->plan->path, a->line, a->key, a->text,
                 brc_params_text(p, s.values, text, sizeof text));
    if (p->kind == BRC_REAL && !*unit)
        text[strlen(text) - 1] = '\0';
    a->text = make_text(m, text, "", "");
    return a->text ? 0 : BRC_ERR_MEMORY;
}

/* ---- one run ------------------------------------------------------------------------------- */

static void put_all(struct maker *m, const struct brc_sweep_assignments *set)
{
    for (size_t i = 0; i < set->n; i++)
        m->all.item[m->all.n++] = set->item[i];
}

/* What the group sets, then the command line, then the axes: --set of a key that an axis gives
 * would be without effect, and is refused. */
static int collect(struct maker *m)
{
    const struct brc_sweep_group *g = m->group;
    size_t n = g->set.n + (size_t)m->runs->n_set;
    for (size_t a = 0; a < g->n_axes; a++)
        n += g->axis[a].value[m->run->at[a]].set.n;
    m->all = (struct brc_sweep_assignments){0};
    m->all.item = brc_pool_alloc(m->ctx, m->runs->pool, n, sizeof *m->all.item);
    if (!m->all.item)
        return BRC_ERR_MEMORY;
    put_all(m, &g->set);
    for (int i = 0; i < m->runs->n_set; i++) {
        const char *text = m->runs->set[i], *equals = strchr(text, '=');
        char *key = make_text(m, text, "", "");
        if (!equals || !key)
            BRC_FAIL(m->ctx, BRC_ERR_USAGE, "--set: '%.60s' is not of the form section.key=value",
                     text);
        key[equals - text] = '\0';
        m->all.item[m->all.n++] = (struct brc_sweep_assignment){key, equals + 1, 0};
    }
    size_t n_given = m->all.n;
    for (size_t a = 0; a < g->n_axes; a++)
        put_all(m, &g->axis[a].value[m->run->at[a]].set);
    for (size_t i = g->set.n; i < n_given; i++)
        for (size_t k = n_given; k < m->all.n; k++)
            if (strcmp(m->all.item[i].key, m->all.item[k].key) == 0)
                BRC_FAIL(m->ctx, BRC_ERR_USAGE, "--set: %s is given by an axis of %s",
                         m->all.item[i].key, m->runs->plan->path);
    return 0;
}

/* The overrides of the run; factors are worked out when the case is known. */
static int make_overrides(struct maker *m)
{
    struct brc_sweep_run *run = m->run;
    run->override =
        brc_pool_alloc(m->ctx, m->runs->pool, m->all.n + N_QUIET, sizeof *run->override);
    if (!run->override)
        return BRC_ERR_MEMORY;
    for (int i = 0; i < N_QUIET && !m->runs->keeps; i++)
        run->override[run->n_overrides++] = quiet_output[i];
    for (size_t i = 0; i < m->all.n; i++) {
        struct brc_sweep_assignment *a = &m->all.item[i];
        double factor = i >= m->group->set.n ? factor_of(a->text) : NAN;
        if (is_top(a->key))
            continue;
        if (isfinite(factor))
            BRC_TRY(multiply(m, a, factor));
        const char *line = override_of(m, a);
        if (!line)
            return BRC_ERR_MEMORY;
        run->override[run->n_overrides++] = line;
    }
    return 0;
}

/* `case` and `model`, of which the last holds. */
static int find_case(struct maker *m)
{
    m->model = "";
    m->run->path = NULL;
    for (size_t i = 0; i < m->all.n; i++) {
        if (strcmp(m->all.item[i].key, "model") == 0)
            m->model = m->all.item[i].text;
        if (strcmp(m->all.item[i].key, "case") == 0)
            m->run->path = seen_from_file(m, &m->all.item[i]);
    }
    return m->run->path ? 0
                        : fail_at(m, m->group->line, m->group->name,
                                  "no case; add `case: FILE`, from the folder of this file");
}

static int find_model(struct maker *m, const struct brc_case *run_case)
{
    const char *name = *m->model ? m->model : run_case->file.head.model;
    if (!*name)
        return fail_at(m, m->group->line, m->group->name,
                       "no model; add `axes: {model: [NAME, NAME]}`, or `model: NAME` to the case");
    int code = brc_case_model(m->ctx, name, &m->run->model);
    for (size_t i = m->all.n; code != 0 && i-- > 0;)
        if (strcmp(m->all.item[i].key, "model") == 0 && m->all.item[i].line > 0) {
            char said[BRC_NAMES_SIZE];
            snprintf(said, sizeof said, "%.590s", m->ctx->message);
            brc_error_clear(m->ctx);
            return fail_at(m, m->all.item[i].line, "model", said);
        }
    return code;
}

static int check_collected(const struct maker *m)
{
    const struct brc_sweep_group *g = m->group;
    const struct brc_rig_type *rig = m->run->rig;
    for (size_t i = 0; i < g->n_collect; i++) {
        char all[BRC_NAMES_SIZE] = "";
        bool is_known = false;
        for (int k = 0; k < rig->n_quantities + BRC_N_READINGS; k++) {
            const struct brc_quantity *q = k < rig->n_quantities
                                               ? &rig->quantities[k]
                                               : &brc_readings_quantities[k - rig->n_quantities];
            is_known = is_known || strcmp(q->name, g->collect[i]) == 0;
            brc_names_add(all, sizeof all, q->name);
        }
        if (!is_known)
            BRC_FAIL(m->ctx, BRC_ERR_INPUT,
                     "%s:%d: collect: %s does not measure '%.60s'; there "
                     "are: %s",
                     m->runs->plan->path, g->collect_line, rig->name, g->collect[i], all);
    }
    return 0;
}

static int check_case(struct maker *m)
{
    struct brc_sweep_run *run = m->run;
    struct brc_case run_case;
    int code = relocate(m, brc_sweep_run_case(m->ctx, run, &run_case));
    if (code == 0)
        code = find_model(m, &run_case);
    if (code == 0) {
        run->rig = brc_rigs_at(run_case.test.kind);
        run->name = make_text(m, run_case.name, "", "");
        code =
            run->name ? brc_run_key_make(m->ctx, &run_case, run->model, &run->key) : BRC_ERR_MEMORY;
    }
    brc_case_free(&run_case);
    return code ? code : check_collected(m);
}

static int make_run(struct maker *m)
{
    BRC_TRY(collect(m));
    BRC_TRY(find_case(m));
    BRC_TRY(make_overrides(m));
    return check_case(m);
}

/* ---- all runs ------------------------------------------------------------------------------ */

/* What is averaged over turns slowest: a sweep that was stopped has whole tables of fewer seeds. */
static void find_place(const struct brc_sweep_group *g, size_t number, size_t *at)
{
    for (int is_over = 0; is_over < 2; is_over++)
        for (size_t a = g->n_axes; a-- > 0;)
            if (g->axis[a].is_over == (is_over == 1)) {
                at[a] = number % g->axis[a].n;
                number /= g->axis[a].n;
            }
}

static int count(struct brc_context *ctx, struct brc_sweep_runs *runs)
{
    runs->n = 0;
    for (size_t i = 0; i < runs->plan->n_groups; i++) {
        const struct brc_sweep_group *g = &runs->plan->group[i];
        size_t n = 1;
        for (size_t a = 0; a < g->n_axes && n <= BRC_SWEEP_MAX_RUNS; a++)
            n *= g->axis[a].n;
        runs->n += n;
        if (runs->n > BRC_SWEEP_MAX_RUNS)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "%s:%d: %s: more than %d runs; give its axes fewer values",
                     runs->plan->path, g->line, g->name, BRC_SWEEP_MAX_RUNS);
    }
    return 0;
}

/* Values that have no effect (a key of the other model) make equal runs: they are done once. */
static void find_first(struct brc_sweep_runs *runs, size_t i)
{
    size_t k = 0;
    while (runs->run[k].key.hash != runs->run[i].key.hash ||
           strcmp(runs->run[k].key.text, runs->run[i].key.text) != 0)
        k++;
    runs->run[i].first = k;
}

static int make_group(struct maker *m, size_t *i)
{
    size_t n = 1;
    for (size_t a = 0; a < m->group->n_axes; a++)
        n *= m->group->axis[a].n;
    for (size_t number = 0; number < n; number++, (*i)++) {
        size_t *at = brc_pool_alloc(m->ctx, m->runs->pool, m->group->n_axes, sizeof *at);
        if (!at)
            return BRC_ERR_MEMORY;
        find_place(m->group, number, at);
        m->run = &m->runs->run[*i];
        m->run->group = m->group;
        m->run->at = at;
        BRC_TRY(make_run(m));
        find_first(m->runs, *i);
    }
    return 0;
}

int brc_sweep_runs_make(struct brc_context *ctx, struct brc_sweep_runs *runs)
{
    size_t i = 0;
    BRC_TRY(count(ctx, runs));
    runs->run = brc_alloc(ctx, runs->n, sizeof *runs->run);
    if (!runs->run)
        return BRC_ERR_MEMORY;
    struct maker m = {.ctx = ctx, .runs = runs};
    int code = 0;
    for (size_t k = 0; k < runs->plan->n_groups && code == 0; k++) {
        m.group = &runs->plan->group[k];
        code = make_group(&m, &i);
    }
    brc_case_free(&m.base);
    return code;
}

void brc_sweep_runs_free(struct brc_sweep_runs *runs)
{
    for (size_t i = 0; runs->run && i < runs->n; i++)
        free(runs->run[i].key.text);
    free(runs->run);
    runs->run = NULL;
}

int brc_sweep_run_case(struct brc_context *ctx, const struct brc_sweep_run *run,
                       struct brc_case *out)
{
    return brc_case_read(ctx, out, run->path, run->override, run->n_overrides);
}

const char *brc_sweep_run_label(const struct brc_sweep_run *run, char *text, size_t size)
{
    const struct brc_sweep_group *g = run->group;
    size_t n = (size_t)snprintf(text, size, "%s", g->name);
    for (size_t a = 0; a < g->n_axes && n < size; a++)
        n += (size_t)snprintf(text + n, size - n, " %s=%s", g->axis[a].name,
                              g->axis[a].value[run->at[a]].label);
    return text;
}
