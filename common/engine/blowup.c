/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says that a simulation has become unstable as long as it can be said where: once a velocity is no
 * number, all of them are a few steps later. sim.c calls it when its own checks of a step fail, and
 * runs for the energy; it changes nothing but to bring
 * the ledger up to date. */
#include "common/engine/blowup.h"

#include "common/geometry/vec.h"

#include <stdio.h>
#include <string.h>

enum { TEXT_SIZE = 512 };
/* Near the stable limit the velocities at half steps hold up to 1 / (1 - (dt / limit)^2) times the
 * energy: at 0.9995 of it, a thousand times. */
static const double ENERGY_GROWTH = 1000;
/* Bodies that move by less than this part of the skin in a step are at rest, whatever the ratio. */
static const double REST = 1e-6;

/* ---- the first body ------------------------------------------------------------------------ */

static double path_of(const struct brc_sim *sim, size_t body)
{
    return sim->bodies.path_length[body] - sim->bodies.path_at_rebuild[body];
}

/* In the body's frame: inertia is principal. With the velocities of the half step, so not to be set
 * against the ledger to round-off. */
static double kinetic_of(const struct brc_sim *sim, size_t body)
{
    const struct brc_bodies *b = &sim->bodies;
    double w[3], m[3][3];
    brc_quat_matrix(m, b->q[body]);
    brc_mat_mul_t(w, m, b->w[body]);
    double sum = b->mass[body] * brc_norm2(b->v[body]);
    for (int k = 0; k < 3; k++)
        sum += b->inertia[body][k] * w[k] * w[k];
    return 0.5 * sum;
}

/* The first body without a number, else the one with the largest value. */
static size_t worst_body(const struct brc_sim *sim, size_t n,
                         double (*value)(const struct brc_sim *, size_t))
{
    size_t worst = 0;
    for (size_t i = 0; i < n; i++) {
        double v = value(sim, i);
        if (!isfinite(v))
            return i;
        if (v > value(sim, worst))
            worst = i;
    }
    return worst;
}

/* ---- its contact --------------------------------------------------------------------------- */

/* The set of the body's first contact, contact `at`, whose force is no number, else of that with
 * the largest force; NULL: it has none. */
static const struct brc_contacts *worst_contact(const struct brc_sim *sim, size_t body, size_t *at)
{
    const struct brc_contacts *sets[2] = {&sim->pairs, &sim->platens}, *worst = NULL;
    double largest = -1;
    for (int s = 0; s < 2; s++) {
        const struct brc_contacts *c = sets[s];
        for (size_t r = c->adjacent_first[body]; r < c->adjacent_first[body + 1]; r++) {
            size_t i = c->adjacent[r] / 2;
            double force = brc_norm(c->f[i]);
            force = isfinite(force) ? force : HUGE_VAL;
            if (force <= largest)
                continue;
            largest = force;
            worst = c;
            *at = i;
        }
    }
    return worst;
}

/* The other body, and the state of the contact: what all models have, then the model's scalars by
 * their declared names and units, so that a new model needs no text here. */
static void describe_contact(const struct brc_sim *sim, size_t body, char text[TEXT_SIZE])
{
    static const char *const status[] = {"never bonded", "bonded", "broken"};
    size_t i;
    const struct brc_contacts *c = worst_contact(sim, body, &i);
    snprintf(text, TEXT_SIZE, "it has no contact");
    if (!c)
        return;
    size_t other = (size_t)c->a[i] == body ? (size_t)c->b[i] : (size_t)c->a[i];
    snprintf(text, TEXT_SIZE,
             "its contact with %s %zu (%s): force %g N, stiffness %g N/m, gap %g m, points %d",
             other < sim->bodies.n_grains ? "grain" : "platen", other, status[c->status[i] % 3],
             brc_norm(c->f[i]), c->k[i][0], c->gap[i], c->np[i]);
    for (int k = 0; k < c->model.set.n; k++) {
        const struct brc_field *f = &c->model.set.fields[k];
        bool has_unit = strcmp(f->unit, "1") != 0;
        size_t used = strlen(text);
        if (f->width == 1)
            snprintf(text + used, TEXT_SIZE - used, ", %s %g%s%s", f->name,
                     brc_table_number(&c->model, k, i), has_unit ? " " : "",
                     has_unit ? f->unit : "");
    }
}

/* ---- the message --------------------------------------------------------------------------- */

/* Which key to change hangs on what has chosen the step. */
static void advise(const struct brc_sim *sim, char text[TEXT_SIZE])
{
    const struct brc_run_params *p = &sim->run;
    const char *model = sim->model.name;
    if (p->regime == BRC_QUASI_STATIC)
        snprintf(text, TEXT_SIZE,
                 "raise run.mass_margin (now %g), load more slowly (test.rate, test.rate_max; now "
                 "%g 1/s) or lower the stiffness of %s",
                 p->mass_margin, sim->rig.rate, model);
    else if (p->dt > 0)
        snprintf(text, TEXT_SIZE,
                 "lower run.dt (now %g s, the stable limit was %g s), let run.dt_margin choose it "
                 "(run.dt = 0 s), load more slowly (test.rate) or lower the stiffness of %s",
                 p->dt, sim->dt_limit, model);
    else
        snprintf(text, TEXT_SIZE,
                 "lower run.dt_margin (now %g; the time step is %g s, the stable limit was %g s), "
                 "load more slowly (test.rate) or lower the stiffness of %s",
                 p->dt_margin, sim->dt, sim->dt_limit, model);
}

static int report(const struct brc_sim *sim, size_t body, const char *what)
{
    const double *x = sim->bodies.x[body];
    char contact[TEXT_SIZE], advice[TEXT_SIZE];
    describe_contact(sim, body, contact);
    advise(sim, advice);
    BRC_FAIL(sim->ctx, BRC_ERR_BLOWUP,
             "unstable at step %lld, time %g s: %s %zu at %g %g %g m %s; %s; %s",
             (long long)sim->step, sim->time, body < sim->bodies.n_grains ? "grain" : "platen",
             body, x[0], x[1], x[2], what, contact, advice);
}

int brc_blowup_path(const struct brc_sim *sim)
{
    char what[TEXT_SIZE];
    size_t body = worst_body(sim, sim->bodies.n, path_of);
    snprintf(what, sizeof what, "moved by %g m at once (%d skins of %g m are too much)",
             path_of(sim, body), BRC_BLOWUP_SKINS, sim->skin);
    return report(sim, body, what);
}

int brc_blowup_number(const struct brc_sim *sim)
{
    return report(sim, worst_body(sim, sim->bodies.n_grains, kinetic_of),
                  "has a velocity that is no number");
}

int brc_blowup_energy(struct brc_sim *sim)
{
    const struct brc_ledger *l = &sim->ledger;
    const struct brc_bodies *b = &sim->bodies;
    /* in each step, so first by what the ledger has at hand: gravity only adds to it */
    if (!sim->run.ledger ||
        fabs(l->kinetic) <= ENERGY_GROWTH * (fabs(l->start) + fabs(l->boundary)))
        return 0;
    brc_accounts_settle(sim);
    double given = fabs(l->start) + fabs(l->boundary) + fabs(l->gravity);
    if (fabs(l->kinetic) <= ENERGY_GROWTH * given)
        return 0;
    /* seldom: exactly, body by body */
    double kinetic = 0, mass = 0, slow = REST * sim->skin / sim->dt;
    for (size_t i = 0; i < b->n_grains; i++) {
        kinetic += kinetic_of(sim, i);
        mass += b->mass[i];
    }
    if (kinetic <= ENERGY_GROWTH * given + 0.5 * mass * slow * slow)
        return 0;
    char what[TEXT_SIZE];
    size_t body = worst_body(sim, b->n_grains, kinetic_of);
    snprintf(what, sizeof what,
             "has %g J of the kinetic energy of %g J, where the sample was given only %g J",
             kinetic_of(sim, body), kinetic, given);
    return report(sim, body, what);
}
