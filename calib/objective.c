/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Residuals are differences in standard deviations: targets have different units and are known to
 * different certainty. A run that gives no value is an error that names its test: any number in its
 * place would lead the search on. What to do about such an error is the minimiser's decision; there
 * is none here, so that any that takes residuals can be put in front. */
#include "calib/objective.h"

#include "common/rigs/rigs.h"

#include <math.h>
#include <string.h>

/* Number of the test that measures a target, -1: none does. By name, so that calib need not know
 * which tests there are. */
static int test_of(const struct calib_target *t)
{
    const char *name = calib_quantities[t->quantity].test;
    return name ? brc_rigs_find(name) : -1;
}

size_t calib_objective_size(const struct calib_objective *o)
{
    size_t n = 0;
    for (size_t i = 0; i < o->targets->n; i++)
        n += test_of(&o->targets->target[i]) >= 0;
    return n;
}

/* A variable must be a real key of the list, free once, with bounds that the list accepts. */
static int check_variable(struct brc_context *ctx, const struct calib_objective *o, size_t i,
                          struct brc_param_list list)
{
    const struct calib_variable *v = &o->variables[i];
    const struct brc_param *p = brc_params_find(list, v->key);
    if (!p || p->kind != BRC_REAL) {
        char hint[BRC_HINT_SIZE];
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "calibration: %s.%s is not a quantity of the model%s; `breccia params %s` lists them",
            o->model, v->key, brc_params_hint(list, v->key, hint), o->model);
    }
    if (!(v->low < v->high) || !isfinite(v->low) || !isfinite(v->high))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: %s.%s has the bounds %g and %g %s; allowed finite bounds, the first "
                 "below the second",
                 o->model, v->key, v->low, v->high, p->unit);
    for (size_t j = 0; j < i; j++)
        if (strcmp(v->key, o->variables[j].key) == 0)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "calibration: %s.%s is a variable twice", o->model,
                     v->key);
    return 0;
}

/* Not more variables than targets: a search would otherwise have a whole surface of answers and
 * report one. */
int calib_objective_check(struct brc_context *ctx, const struct calib_objective *o,
                          struct brc_param_list list)
{
    if (o->n == 0 || calib_objective_size(o) < o->n)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: %zu variables for %zu targets that a test measures; allowed 1 to as "
                 "many variables as such targets",
                 o->n, calib_objective_size(o));
    if (!(o->relative_deviation > 0) || !isfinite(o->relative_deviation))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: the relative deviation %g of targets without one must be above 0",
                 o->relative_deviation);
    for (size_t i = 0; i < o->n; i++)
        BRC_TRY(check_variable(ctx, o, i, list));
    return 0;
}

/* An error and no clamp: a clamped point would give the search a value for a place at which it
 * never was. */
static int check_bounds(struct brc_context *ctx, const struct calib_objective *o, const double *x)
{
    for (size_t i = 0; i < o->n; i++) {
        const struct calib_variable *v = &o->variables[i];
        if (!(x[i] >= v->low && x[i] <= v->high))
            BRC_FAIL(ctx, BRC_ERR_INPUT, "calibration: %s.%s = %g is outside its bounds [%g, %g]",
                     o->model, v->key, x[i], v->low, v->high);
    }
    return 0;
}

/* A target whose deviation is not known counts as known to a stated part of itself, the same for
 * all. */
static int add_residual(struct brc_context *ctx, const struct calib_objective *o,
                        const struct calib_target *t, const struct brc_summary *summary,
                        struct calib_evaluation *out)
{
    const struct calib_quantity *q = &calib_quantities[t->quantity];
    const struct brc_result *measured = brc_output_result(summary, q->result);
    if (!measured || !isfinite(measured->value))
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "calibration: the %s test of %s gave no %s%s%s; run its case alone and look at the "
            "curve",
            q->test, o->model, q->result, measured && measured->note ? ": " : "",
            measured && measured->note ? measured->note : "");
    struct calib_residual *r = &out->residual[out->n++];
    r->quantity = t->quantity;
    r->target = t->value;
    r->deviation = t->deviation > 0 ? t->deviation : o->relative_deviation * fabs(t->value);
    if (!(r->deviation > 0))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "calibration: the target %s is 0 and has no deviation; give one", q->name);
    r->measured = measured->value;
    r->residual = (r->measured - r->target) / r->deviation;
    out->cost += 0.5 * r->residual * r->residual;
    return 0;
}

/* Whether a target asks for the test. A test that several ask for is run once: all their values are
 * results of one run. */
static bool is_asked(const struct calib_objective *o, int test)
{
    for (size_t i = 0; i < o->targets->n; i++)
        if (test_of(&o->targets->target[i]) == test)
            return true;
    return false;
}

/* All tests first, then the residuals in the order of the targets, which is what a search with
 * vectors needs to stay the same. */
int calib_objective_evaluate(struct brc_context *ctx, const struct calib_objective *o,
                             const double *x, struct calib_evaluation *out)
{
    struct brc_summary summary[BRC_MAX_RIGS];
    memset(out, 0, sizeof *out);
    BRC_TRY(check_bounds(ctx, o, x));
    for (int test = 0; test < brc_rigs_count(); test++) {
        if (!is_asked(o, test))
            continue;
        const struct calib_trial trial = {o->model, test, o->n, o->variables, x};
        memset(&summary[test], 0, sizeof summary[test]);
        BRC_TRY(o->runner.run(ctx, o->runner.user, &trial, &summary[test]));
        out->cpu_s += summary[test].cpu_s;
        out->n_runs++;
    }
    for (size_t i = 0; i < o->targets->n; i++) {
        const struct calib_target *t = &o->targets->target[i];
        int test = test_of(t);
        if (test >= 0)
            BRC_TRY(add_residual(ctx, o, t, &summary[test], out));
    }
    return 0;
}
