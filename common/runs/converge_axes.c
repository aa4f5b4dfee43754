/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One setting at a time is changed: the errors of several together say nothing about what to
 * choose. The reference takes a finer loading and half the step, and is run coarser in each to tell
 * its own uncertainty. */
#include "common/runs/converge_axes.h"

#include "common/runs/run_key.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COARSEST = 64 }; /* loading and rate, times that of the case */
static const double REFERENCE_STEP = 0.5;

/* An axis that every case has: how its key follows from a factor on what the case says. */
struct ladder {
    const char *name;
    enum brc_converge_role role;
    int n_factors; /* 0: by twos, from one over --refine to COARSEST */
    double factors[5];
    const char *why; /* may be left out, as `put` says false of its first factor */
    bool (*put)(struct brc_converge_setting *s, const struct brc_case *run_case,
                const struct brc_converge_model *m, double factor);
};

/* ---- one setting --------------------------------------------------------------------------- */

/* Overrides as the command line has them: a setting can be repeated by hand from its line in the
 * record. */
static void __attribute__((format(printf, 2, 3)))
add_line(struct brc_converge_setting *s, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(s->line[s->n_lines++], sizeof s->line[0], format, args);
    va_end(args);
}

/* Specimens have the seed of the case and those that follow it: a ladder that is repeated with more
 * of them finds its earlier runs in the record. */
int brc_converge_case(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_converge_setting *s, int i, struct brc_case *out)
{
    /* files for a look at a run are not wanted */
    const char *line[BRC_CONVERGE_MAX_LINES + 5] = {
        "output.plots=off", "output.frames=0", "output.frame_strain=0", "output.frame_steps=0"};
    char seed[64];
    int n = 4;
    snprintf(seed, sizeof seed, "specimen.seed=%d", run_case->specimen.seed + i);
    if (i > 0) /* seeds of a file have no number */
        line[n++] = seed;
    for (int k = 0; k < s->n_lines; k++)
        line[n++] = s->line[k];
    return brc_case_change(ctx, run_case, line, n, out);
}

static int make_key(struct brc_context *ctx, const struct brc_case *run_case,
                    const struct brc_model *model, uint64_t *hash)
{
    struct brc_run_key key;
    BRC_TRY(brc_run_key_make(ctx, run_case, model, &key));
    *hash = key.hash;
    free(key.text);
    return 0;
}

/* Adds the setting unless the case refuses its values, on any specimen: a rung out of range is no
 * reason to give up the others. */
static int add(struct brc_context *ctx, const struct brc_converge_options *options,
               struct brc_converge_model *m, const struct brc_converge_setting *setting)
{
    if (m->n == BRC_CONVERGE_MAX_SETTINGS)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "more than %d settings of %s; name fewer axes", m->n,
                 m->model->name);
    struct brc_converge_setting *s = &m->setting[m->n];
    *s = *setting;
    for (int i = 0; i < options->seeds; i++) {
        struct brc_context own = BRC_CONTEXT_INIT;
        struct brc_case run_case;
        int code = brc_converge_case(&own, options->run.run_case, s, i, &run_case);
        if (code == 0)
            code = make_key(&own, &run_case, m->model, &s->run[i].key);
        brc_case_free(&run_case);
        if (code == BRC_ERR_INPUT) {
            brc_log(ctx, "%s %s is left out: %s", s->axis, s->label, own.message);
            return 0;
        }
        if (code != 0)
            BRC_FAIL(ctx, code, "%s", own.message);
    }
    m->n++;
    return 0;
}

/* The weight is that of the axes on which the work goes with the number of steps; those on which it
 * goes otherwise set their own. */
static struct brc_converge_setting make(const char *axis, enum brc_converge_role role,
                                        double factor)
{
    return (struct brc_converge_setting){
        .axis = axis, .role = role, .fineness = 1 / factor, .weight = 1 / factor};
}

static void label(struct brc_converge_setting *s, const char *key, double value)
{
    snprintf(s->label, sizeof s->label, "%s=%.4g", key, value);
}

/* ---- ladders ------------------------------------------------------------------------------- */

/* The step, times a factor, as a part of the stable limit; scaled masses go with its square. Up to
 * twice the step of the case; what is above the stable limit is told by its runs. A step that is
 * given is an error above the limit, and one that is a part of it stays below it. */
static bool put_step(struct brc_converge_setting *s, const struct brc_case *run_case,
                     const struct brc_converge_model *m, double factor)
{
    const struct brc_run_params *run = &run_case->run;
    (void)m;
    if (run->regime == BRC_QUASI_STATIC) {
        double margin = run->mass_margin / (factor * factor);
        add_line(s, "run.mass_margin=%.9g", margin);
        label(s, "mass_margin", margin);
        return true;
    }
    if (run->dt > 0) {
        add_line(s, "run.dt=%.9g s", factor * run->dt);
        label(s, "dt", factor * run->dt);
        return factor <= 1;
    }
    add_line(s, "run.dt_margin=%.9g", factor * run->dt_margin);
    label(s, "dt_margin", factor * run->dt_margin);
    return factor * run->dt_margin <= 0.95;
}

/* A test whose load is given has no rate to refine (a cantilever): then steps alone are. */
static bool has_rate(const struct brc_case *run_case)
{
    return brc_rigs_uses(brc_rigs_at(run_case->test.kind), "loading");
}

/* Finer adaptive loading. Below the target of the case the smallest rate must not hold the rate up,
 * so it falls along. */
static bool put_target(struct brc_converge_setting *s, const struct brc_case *run_case,
                       const struct brc_converge_model *m, double factor)
{
    if (!has_rate(run_case))
        return false;
    add_line(s, "test.loading=adaptive");
    add_line(s, "test.target=%.9g", factor * m->test.target);
    if (factor < 1 && m->test.rate_min > 0)
        add_line(s, "test.rate_min=%.9g 1/s", factor * m->test.rate_min);
    label(s, "target", factor * m->test.target);
    return true;
}

/* Fixed loading around the rate of the case, or around the mean rate that its adaptive loading has
 * found, to two digits: so the ladder stays where more specimens change that mean a little. */
static bool put_rate(struct brc_converge_setting *s, const struct brc_case *run_case,
                     const struct brc_converge_model *m, double factor)
{
    char text[32];
    double rate = m->test.rate;
    if (!has_rate(run_case))
        return false;
    if (m->test.loading == BRC_LOADING_ADAPTIVE) {
        snprintf(text, sizeof text, "%.1e", m->mean_rate);
        rate = strtod(text, NULL);
    }
    add_line(s, "test.loading=fixed");
    add_line(s, "test.rate=%.9g 1/s", factor * rate);
    label(s, "rate", factor * rate);
    return rate > 0;
}

/* Grains larger by a factor; false where the specimen has none to choose. */
static bool put_grains(struct brc_converge_setting *s, const struct brc_case *run_case,
                       const struct brc_converge_model *m, double factor)
{
    const struct brc_specimen_params *p = &run_case->specimen;
    (void)m;
    s->weight = pow(factor, -4); /* as many grains, and as many steps across one */
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
    }
    snprintf(s->label, sizeof s->label, "size x %.4g", factor);
    return s->n_lines > 0;
}

static const struct ladder ladders[] = {
    {"step", BRC_CONVERGE_LADDER, 5, {0.25, 0.5, 1, 1.41421356, 2}, NULL, put_step},
    {"loading", BRC_CONVERGE_LADDER, 0, {0}, "its load is given", put_target},
    {"rate", BRC_CONVERGE_LADDER, 0, {0}, "no rate was found", put_rate},
    {"grains", BRC_CONVERGE_GRAINS, 3, {0.8, 1, 1.25}, "its grains are given", put_grains}};
enum { N_LADDERS = sizeof ladders / sizeof ladders[0] };

/* Rungs from the finest; the first that `put` refuses ends the ladder, as all that follow are
 * coarser. */
static int add_ladder(struct brc_context *ctx, const struct brc_converge_options *options,
                      struct brc_converge_model *m, const struct ladder *l)
{
    double factor = 1.0 / options->refine;
    for (int i = 0; l->n_factors > 0 ? i < l->n_factors : factor <= COARSEST; i++, factor *= 2) {
        if (l->n_factors > 0)
            factor = l->factors[i];
        struct brc_converge_setting s = make(l->name, l->role, factor);
        if (l->put(&s, options->run.run_case, m, factor)) {
            BRC_TRY(add(ctx, options, m, &s));
            continue;
        }
        if (i == 0)
            brc_log(ctx, "%s: %s, so the axis %s is left out", m->model->name, l->why, l->name);
        break;
    }
    return 0;
}

/* ---- axes ---------------------------------------------------------------------------------- */

static bool is_choice(const struct brc_param *p)
{
    return p->kind == BRC_CHOICE || p->kind == BRC_FLAG;
}

/* Every value of a model's choice, whatever the case says. */
static int add_choice(struct brc_context *ctx, const struct brc_converge_options *options,
                      struct brc_converge_model *m, const char *key)
{
    const struct brc_param *p = brc_params_find(m->model->params, key);
    if (!p || !is_choice(p)) /* of another model */
        return 0;
    for (const char *at = p->choices; *at;) {
        struct brc_converge_setting s = make(key, BRC_CONVERGE_CHOICE, 1);
        size_t length = strcspn(at, "|");
        snprintf(s.label, sizeof s.label, "%s=%.*s", key, (int)length, at);
        add_line(&s, "%s.%s", m->model->name, s.label);
        BRC_TRY(add(ctx, options, m, &s));
        at += length + (at[length] != '\0');
    }
    return 0;
}

/* The constant text of that name: settings keep it, and outlive the list of the command line. */
static const char *find_axis(const struct brc_converge_axes *axes, const char *name)
{
    for (int i = 0; i < axes->n; i++)
        if (strcmp(axes->name[i], name) == 0)
            return axes->name[i];
    return NULL;
}

/* Once, though models may share the name of a choice, and the user may name an axis twice. */
static int add_axis(struct brc_context *ctx, struct brc_converge_axes *axes, const char *name)
{
    if (find_axis(axes, name))
        return 0;
    if (axes->n == BRC_CONVERGE_MAX_AXES)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--axes: more than %d", BRC_CONVERGE_MAX_AXES);
    axes->name[axes->n++] = name;
    return 0;
}

/* All that there are, or those that are meant when none is named. */
static int list_axes(struct brc_context *ctx, const struct brc_converge_study *study, bool is_all,
                     struct brc_converge_axes *axes)
{
    axes->n = 0;
    for (int i = 0; i < N_LADDERS; i++)
        BRC_TRY(add_axis(ctx, axes, ladders[i].name));
    for (int i = 0; i < study->n_models; i++)
        for (int k = 0; k < study->model[i].model->params.n; k++) {
            const struct brc_param *p = &study->model[i].model->params.params[k];
            if (is_all ? is_choice(p) : p->flags & BRC_PARAM_AXIS)
                BRC_TRY(add_axis(ctx, axes, p->key));
        }
    return 0;
}

/* A name that is none is an error that lists all: a ladder without the axis that was meant would
 * take hours to show it. */
int brc_converge_read_axes(struct brc_context *ctx, const struct brc_converge_study *study,
                           struct brc_converge_axes *axes)
{
    struct brc_converge_axes all;
    char names[BRC_NAMES_SIZE] = "", name[BRC_CASEFILE_KEY_SIZE];
    BRC_TRY(list_axes(ctx, study, true, &all));
    axes->n = 0;
    for (const char *at = study->options->axes; *at;) {
        size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        const char *found = find_axis(&all, name);
        for (int i = 0; !found && i < all.n; i++)
            brc_names_add(names, sizeof names, all.name[i]);
        if (!found)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "--axes: no axis '%.60s'; there are: %s", name, names);
        BRC_TRY(add_axis(ctx, axes, found));
        at += length + (at[length] != '\0');
    }
    return axes->n > 0 ? 0 : list_axes(ctx, study, false, axes);
}

/* ---- all of a model ------------------------------------------------------------------------ */

/* The reference and its coarser likes, as their names say; a test without a rate has a finer step
 * alone. Where a model has approximations of its own the reference does without. */
static void put_reference(struct brc_converge_setting *s, const struct brc_converge_options *o,
                          const struct brc_converge_model *m, int which)
{
    bool is_driven = has_rate(o->run.run_case);
    double loading = is_driven ? (which == BRC_CONVERGE_AT_LOADING ? 2.0 : 1.0) / o->refine : 1;
    double step = which == BRC_CONVERGE_AT_REFERENCE ? REFERENCE_STEP : 1;
    *s = make("reference", BRC_CONVERGE_REFERENCE, 1);
    put_step(s, o->run.run_case, m, step);
    if (m->test.loading == BRC_LOADING_ADAPTIVE)
        put_target(s, o->run.run_case, m, loading);
    else
        put_rate(s, o->run.run_case, m, loading);
    if (brc_params_find(m->model->params, "evaluation"))
        add_line(s, "%s.evaluation=literal", m->model->name);
    s->weight = 1 / (loading * step);
    if (is_driven)
        snprintf(s->label, sizeof s->label, "loading x 1/%g step x %g", 1 / loading, step);
    else
        snprintf(s->label, sizeof s->label, "step x %g", step);
}

/* They lie at fixed places, by which report and table find them; so one that is out of range ends
 * the ladder, while a rung of an axis would be left out. */
int brc_converge_first_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                                struct brc_converge_model *m)
{
    for (int i = 0; i < BRC_CONVERGE_N_FIXED; i++) {
        struct brc_converge_setting s = make("case", BRC_CONVERGE_CASE, 1);
        snprintf(s.label, sizeof s.label, "as written");
        if (i != BRC_CONVERGE_AT_CASE)
            put_reference(&s, options, m, i);
        BRC_TRY(add(ctx, options, m, &s));
        if (m->n == i)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "the reference %s is out of range; use another --refine",
                     s.label);
    }
    return 0;
}

int brc_converge_axis_settings(struct brc_context *ctx, const struct brc_converge_options *options,
                               const struct brc_converge_axes *axes, struct brc_converge_model *m)
{
    for (int i = 0; i < axes->n; i++) {
        int k = 0;
        while (k < N_LADDERS && strcmp(axes->name[i], ladders[k].name) != 0)
            k++;
        BRC_TRY(k < N_LADDERS ? add_ladder(ctx, options, m, &ladders[k])
                              : add_choice(ctx, options, m, axes->name[i]));
    }
    return 0;
}
