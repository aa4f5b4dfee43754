/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One setting at a time is changed: the errors of several together say nothing about what to
 * choose. The reference takes a finer loading and half the step, and is run coarser in each to tell
 * its own uncertainty. */
#include "common/runs/converge_axes.h"

#include "common/runs/case_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ladders of every case. */
static const char *const ladders[] = {"step", "loading", "rate", "grains"};
enum { N_LADDERS = sizeof ladders / sizeof ladders[0] };

enum { MAX_LINES = 16 }; /* overrides of a run */
enum { COARSEST = 64 };  /* loading and rate, times that of the case */
static const double REFERENCE_STEP = 0.5;

/* ---- names --------------------------------------------------------------------------------- */

static const struct brc_param *find_choice(const struct brc_model *model, const char *key)
{
    const struct brc_param *p = brc_params_find(model->params, key);
    return p && (p->kind == BRC_CHOICE || p->kind == BRC_FLAG) ? p : NULL;
}

static bool is_axis(const struct brc_converge_model *models, int n_models, const char *name)
{
    for (int i = 0; i < N_LADDERS; i++)
        if (strcmp(name, ladders[i]) == 0)
            return true;
    for (int i = 0; i < n_models; i++)
        if (find_choice(models[i].model, name))
            return true;
    return false;
}

static int add_axis(struct brc_context *ctx, struct brc_converge_axes *axes, const char *name,
                    size_t length)
{
    for (int i = 0; i < axes->n; i++)
        if (strlen(axes->name[i]) == length && strncmp(axes->name[i], name, length) == 0)
            return 0;
    if (axes->n == BRC_CONVERGE_MAX_AXES)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--axes: more than %d", BRC_CONVERGE_MAX_AXES);
    snprintf(axes->name[axes->n++], sizeof axes->name[0], "%.*s", (int)length, name);
    return 0;
}

static int fail_axis(struct brc_context *ctx, const struct brc_converge_model *models, int n_models,
                     const char *name)
{
    char all[BRC_NAMES_SIZE] = "";
    for (int i = 0; i < N_LADDERS; i++)
        brc_names_add(all, sizeof all, ladders[i]);
    for (int i = 0; i < n_models; i++) {
        const struct brc_param_list list = models[i].model->params;
        for (int k = 0; k < list.n; k++)
            if (find_choice(models[i].model, list.params[k].key) &&
                !strstr(all, list.params[k].key))
                brc_names_add(all, sizeof all, list.params[k].key);
    }
    BRC_FAIL(ctx, BRC_ERR_USAGE, "--axes: no axis '%.60s'; there are: %s", name, all);
}

int brc_converge_read_axes(struct brc_context *ctx, const struct brc_converge_options *options,
                           const struct brc_converge_model *models, int n_models,
                           struct brc_converge_axes *axes)
{
    axes->n = 0;
    for (const char *at = options->axes; *at;) {
        size_t length = strcspn(at, ",");
        char name[BRC_CASEFILE_KEY_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (!is_axis(models, n_models, name))
            return fail_axis(ctx, models, n_models, name);
        BRC_TRY(add_axis(ctx, axes, at, length));
        at += length + (at[length] != '\0');
    }
    if (axes->n > 0)
        return 0;
    for (int i = 0; i < N_LADDERS; i++)
        BRC_TRY(add_axis(ctx, axes, ladders[i], strlen(ladders[i])));
    for (int i = 0; i < n_models; i++)
        for (int k = 0; k < models[i].model->params.n; k++) {
            const struct brc_param *p = &models[i].model->params.params[k];
            if (p->flags & BRC_PARAM_AXIS)
                BRC_TRY(add_axis(ctx, axes, p->key, strlen(p->key)));
        }
    return 0;
}

/* ---- one setting --------------------------------------------------------------------------- */

static void add_line(struct brc_converge_setting *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* An override, a line of the setting's text. */
static void add_line(struct brc_converge_setting *s, const char *format, ...)
{
    char line[160];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    size_t used = strlen(s->text);
    snprintf(s->text + used, sizeof s->text - used, "%s\n", line);
}

int brc_converge_case(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_converge_setting *s, int i, struct brc_case *out)
{
    /* files for a look at a run are not wanted */
    const char *line[MAX_LINES] = {"output.plots=off", "output.frames=0", "output.frame_strain=0",
                                   "output.frame_steps=0"};
    char text[sizeof s->text], seed[64], *rest = text;
    int n = 4;
    snprintf(seed, sizeof seed, "specimen.seed=%d", run_case->specimen.seed + i);
    if (i > 0) /* seeds of a file have no number */
        line[n++] = seed;
    memcpy(text, s->text, sizeof text);
    while (n < MAX_LINES && (line[n] = strtok_r(rest, "\n", &rest)))
        n++;
    return brc_case_change(ctx, run_case, line, n, out);
}

static int make_key(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_converge_model *m, uint64_t *key)
{
    const struct brc_model *model = m->model;
    char *text = brc_case_text(ctx, run_case, model);
    if (!text)
        return BRC_ERR_MEMORY;
    *key = brc_hash_bytes(text, strlen(text), brc_hash_bytes(model->name, strlen(model->name), 0));
    *key = brc_hash_bytes(BRC_VERSION, strlen(BRC_VERSION), *key);
    *key = brc_hash_bytes(&m->specimen, sizeof m->specimen, *key);
    free(text);
    return 0;
}

/* Judges the setting on all specimens; *is_good tells whether its values are in range. */
static int check(struct brc_context *ctx, const struct brc_converge_options *options,
                 const struct brc_converge_model *m, struct brc_converge_setting *s, bool *is_good)
{
    *is_good = true;
    for (int i = 0; i < options->seeds && *is_good; i++) {
        struct brc_context own = BRC_CONTEXT_INIT;
        struct brc_case run_case;
        int code = brc_converge_case(&own, options->run_case, s, i, &run_case);
        if (code == 0)
            code = make_key(&own, &run_case, m, &s->run[i].key);
        brc_case_free(&run_case);
        if (code == BRC_ERR_INPUT) {
            brc_log(ctx, "%s %s is left out: %s", s->axis, s->label, own.message);
            *is_good = false;
        } else if (code != 0) {
            BRC_FAIL(ctx, code, "%s", own.message);
        }
    }
    return 0;
}

static int add(struct brc_context *ctx, const struct brc_converge_options *options,
               struct brc_converge_model *m, const struct brc_converge_setting *s)
{
    bool is_good;
    if (m->n == BRC_CONVERGE_MAX_SETTINGS)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "more than %d settings of %s; name fewer axes", m->n,
                 m->model->name);
    m->setting[m->n] = *s;
    BRC_TRY(check(ctx, options, m, &m->setting[m->n], &is_good));
    m->n += is_good;
    return 0;
}

static struct brc_converge_setting make(const char *axis, enum brc_converge_role role,
                                        double factor)
{
    struct brc_converge_setting s = {.role = role, .fineness = 1 / factor, .weight = 1 / factor};
    snprintf(s.axis, sizeof s.axis, "%s", axis);
    return s;
}

static void label(struct brc_converge_setting *s, const char *key, double value)
{
    snprintf(s->label, sizeof s->label, "%s=%.4g", key, value);
}

/* ---- ladders ------------------------------------------------------------------------------- */

/* The step, times a factor, as a part of the stable limit; scaled masses go with its square. */
static void put_step(struct brc_converge_setting *s, const struct brc_run_params *run,
                     double factor)
{
    if (run->regime == BRC_QUASI_STATIC) {
        double margin = run->mass_margin / (factor * factor);
        add_line(s, "run.mass_margin=%.9g", margin);
        label(s, "mass_margin", margin);
    } else if (run->dt > 0) {
        add_line(s, "run.dt=%.9g s", factor * run->dt);
        label(s, "dt", factor * run->dt);
    } else {
        add_line(s, "run.dt_margin=%.9g", factor * run->dt_margin);
        label(s, "dt_margin", factor * run->dt_margin);
    }
}

static void put_target(struct brc_converge_setting *s, const struct brc_test_params *t,
                       double factor)
{
    add_line(s, "test.loading=adaptive");
    add_line(s, "test.target=%.9g", factor * t->target);
    /* below the target of the case the smallest rate must not hold the rate up */
    if (factor < 1 && t->rate_min > 0)
        add_line(s, "test.rate_min=%.9g 1/s", factor * t->rate_min);
    label(s, "target", factor * t->target);
}

static void put_rate(struct brc_converge_setting *s, double rate)
{
    add_line(s, "test.loading=fixed");
    add_line(s, "test.rate=%.9g 1/s", rate);
    label(s, "rate", rate);
}

/* The case's own kind of loading, times a factor. */
static void put_loading(struct brc_converge_setting *s, const struct brc_test_params *t,
                        double factor)
{
    if (t->loading == BRC_LOADING_ADAPTIVE)
        put_target(s, t, factor);
    else
        put_rate(s, factor * t->rate);
}

/* Up to twice the step of the case; what is above the stable limit is told by its runs. A step
 * that is given is an error above the limit, and one that is a part of it stays below it. */
static double largest_step(const struct brc_run_params *run)
{
    if (run->regime == BRC_QUASI_STATIC)
        return 2;
    return run->dt > 0 ? 1 : 0.95 / run->dt_margin;
}

static int add_step(struct brc_context *ctx, const struct brc_converge_options *options,
                    struct brc_converge_model *m)
{
    static const double factors[] = {0.25, 0.5, 1, 1.41421356, 2};
    const struct brc_run_params *run = &options->run_case->run;
    for (int i = 0; i < 5; i++) {
        struct brc_converge_setting s = make("step", BRC_CONVERGE_LADDER, factors[i]);
        if (factors[i] > largest_step(run))
            break;
        put_step(&s, run, factors[i]);
        BRC_TRY(add(ctx, options, m, &s));
    }
    return 0;
}

static int add_loading(struct brc_context *ctx, const struct brc_converge_options *options,
                       struct brc_converge_model *m)
{
    for (int k = 1; k <= COARSEST * options->refine; k *= 2) {
        double factor = (double)k / options->refine;
        struct brc_converge_setting s = make("loading", BRC_CONVERGE_LADDER, factor);
        put_target(&s, &m->test, factor);
        BRC_TRY(add(ctx, options, m, &s));
    }
    return 0;
}

/* Two digits. */
static double rounded(double rate)
{
    char text[32];
    snprintf(text, sizeof text, "%.1e", rate);
    return strtod(text, NULL);
}

/* Around the rate of the case, or the mean rate that its adaptive loading has found. */
static int add_rate(struct brc_context *ctx, const struct brc_converge_options *options,
                    struct brc_converge_model *m)
{
    bool is_fixed = m->test.loading == BRC_LOADING_FIXED;
    double base = is_fixed ? m->test.rate : rounded(m->mean_rate);
    if (!(base > 0)) {
        brc_log(ctx, "%s: no peak was found, so the axis rate is left out", m->model->name);
        return 0;
    }
    for (int k = 1; k <= COARSEST * options->refine; k *= 2) {
        double factor = (double)k / options->refine;
        struct brc_converge_setting s = make("rate", BRC_CONVERGE_LADDER, factor);
        put_rate(&s, factor * base);
        BRC_TRY(add(ctx, options, m, &s));
    }
    return 0;
}

/* ---- choices and grains -------------------------------------------------------------------- */

static int add_choice(struct brc_context *ctx, const struct brc_converge_options *options,
                      struct brc_converge_model *m, const char *key)
{
    const struct brc_param *p = find_choice(m->model, key);
    if (!p)
        return 0;
    for (const char *at = p->choices; *at;) {
        struct brc_converge_setting s = make(key, BRC_CONVERGE_CHOICE, 1);
        size_t length = strcspn(at, "|");
        add_line(&s, "%s.%s=%.*s", m->model->name, key, (int)length, at);
        snprintf(s.label, sizeof s.label, "%s=%.*s", key, (int)length, at);
        BRC_TRY(add(ctx, options, m, &s));
        at += length + (at[length] != '\0');
    }
    return 0;
}

/* Grains larger by a factor; false where the specimen has none to choose. */
static bool put_grains(struct brc_converge_setting *s, const struct brc_specimen_params *p,
                       double factor)
{
    if (p->grains == BRC_GRAINS_PACKING) {
        add_line(s, "specimen.diameter_min=%.9g m", factor * p->diameter_min);
        add_line(s, "specimen.diameter_max=%.9g m", factor * p->diameter_max);
        if (p->count > 0)
            add_line(s, "specimen.count=%.0f", fmax(p->count / pow(factor, 3), 1));
    } else if (p->grains == BRC_GRAINS_GRID) {
        double n[3];
        for (int k = 0; k < 3; k++)
            n[k] = fmax(round(p->cells[k] / factor), 1);
        add_line(s, "specimen.cells=%.0f, %.0f, %.0f", n[0], n[1], n[2]);
    } else if (p->grains == BRC_GRAINS_MESH) {
        add_line(s, "specimen.triangle_area=%.9g m2", factor * factor * p->triangle_area);
    } else {
        return false;
    }
    snprintf(s->label, sizeof s->label, "size x %.4g", factor);
    return true;
}

static int add_grains(struct brc_context *ctx, const struct brc_converge_options *options,
                      struct brc_converge_model *m)
{
    static const double factors[] = {0.8, 1, 1.25};
    for (int i = 0; i < 3; i++) {
        struct brc_converge_setting s = make("grains", BRC_CONVERGE_GRAINS, factors[i]);
        s.weight = pow(factors[i], -4); /* as many grains, and as many steps across one */
        if (put_grains(&s, &options->run_case->specimen, factors[i]))
            BRC_TRY(add(ctx, options, m, &s));
        else if (i == 0)
            brc_log(ctx, "the grains of this specimen are given, so the axis grains is left out");
    }
    return 0;
}

/* ---- all of a model ------------------------------------------------------------------------ */

int brc_converge_first_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                                struct brc_converge_model *m)
{
    double finest = 1.0 / options->refine;
    for (int i = 0; i < BRC_CONVERGE_N_FIXED; i++) {
        struct brc_converge_setting s = make(
            "reference", i == BRC_CONVERGE_AT_CASE ? BRC_CONVERGE_CASE : BRC_CONVERGE_REFERENCE, 1);
        if (i == BRC_CONVERGE_AT_CASE) {
            snprintf(s.axis, sizeof s.axis, "case");
            snprintf(s.label, sizeof s.label, "as written");
        } else {
            double factor = i == BRC_CONVERGE_AT_LOADING ? 2 * finest : finest;
            double step = i == BRC_CONVERGE_AT_REFERENCE ? REFERENCE_STEP : 1;
            put_step(&s, &options->run_case->run, step);
            put_loading(&s, &m->test, factor);
            if (find_choice(m->model, "evaluation"))
                add_line(&s, "%s.evaluation=literal", m->model->name);
            s.weight = 1 / (factor * step);
            snprintf(s.label, sizeof s.label, "loading x 1/%g step x %g", 1 / factor, step);
        }
        int before = m->n;
        BRC_TRY(add(ctx, options, m, &s));
        if (m->n == before)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "the reference %s is out of range; use another --refine",
                     s.label);
    }
    return 0;
}

int brc_converge_axis_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                               const struct brc_converge_axes *axes, struct brc_converge_model *m)
{
    int (*const act[N_LADDERS])(struct brc_context *, const struct brc_converge_options *,
                                struct brc_converge_model *) = {add_step, add_loading, add_rate,
                                                                add_grains};
    for (int i = 0; i < axes->n; i++) {
        int k = 0;
        while (k < N_LADDERS && strcmp(axes->name[i], ladders[k]) != 0)
            k++;
        BRC_TRY(k < N_LADDERS ? act[k](ctx, options, m)
                              : add_choice(ctx, options, m, axes->name[i]));
    }
    return 0;
}
