/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linearised springs that act, or may act within a step, for the time step (stability.h). From
 * the state alone: the literal evaluation says what touches. */
#include "polyhedra/platen_geometry.h"

/* Faces that are bonded are this near to each other, in radii R. */
static const double FACE_SKIN = 1e-3;

/* Collected for one call; the first error stays and ends it. */
struct springs {
    const struct brc_sim *sim;
    struct brc_springs *out;
    double kn, kt;
    int code;
};

static void add_spring(struct springs *s, int32_t a, int32_t b, const double x[3],
                       struct brc_spring *spring)
{
    spring->a = a;
    spring->b = b;
    brc_sub(spring->ra, x, s->sim->bodies.x[a]);
    brc_sub(spring->rb, x, s->sim->bodies.x[b]);
    if (s->code == 0)
        s->code = brc_springs_add(s->sim->ctx, s->out, spring);
}

static void add_touch(struct springs *s, int32_t a, int32_t b, const struct poly_geometry *t,
                      double mu, bool is_near)
{
    struct brc_spring spring = {
        .kn = s->kn * t->weight, .ks = mu > 0 ? s->kt * t->weight : 0, .is_near = is_near};
    brc_copy(spring.n, t->n);
    add_spring(s, a, b, t->x, &spring);
}

/* Those of contacts without an intact bond; add_listed has the others. */
static void add_active_spring(void *user, const struct poly_active *active)
{
    struct springs *s = user;
    if (s->sim->pairs.status[active->row] != BRC_INTACT)
        add_touch(s, active->a, active->b, &active->geometry, poly_params_of(s->sim)->mu, false);
}

/* Features of a contact that may close in the same step, as when faces meet. Their springs are
 * those that a distance without contact larger by `skin` would give. */
static void add_listed(struct springs *s, const struct poly_state *st, size_t row, double skin,
                       bool is_near)
{
    const struct poly_params *params = poly_params_of(s->sim);
    const struct brc_contacts *c = &s->sim->pairs;
    const struct poly_points *points = c->point_columns;
    struct poly_pair pair;
    poly_pair_of(&pair, s->sim, st, c->a[row], c->b[row]);
    pair.contact_distance += skin;
    for (size_t p = (size_t)c->p0[row], end = p + (size_t)c->np[row]; p < end; p++) {
        struct poly_feature f = poly_point(points, p);
        struct poly_geometry t;
        uint8_t active = points->active[p];
        double margin;
        if (poly_find_contact(&t, &pair, &f, &active, &margin, (enum poly_rule)params->features))
            add_touch(s, c->a[row], c->b[row], &t, params->mu, is_near);
    }
}

/* The same of the vertices listed for a platen. */
static void add_listed_platen(struct springs *s, const struct poly_state *st, size_t row,
                              bool is_near)
{
    const struct brc_contacts *c = &s->sim->platens;
    double mu = brc_sim_platen(s->sim, c->b[row])->friction;
    double skin = is_near ? POLY_PLATEN_SKIN * poly_params_of(s->sim)->radius : 0;
    for (size_t p = (size_t)c->p0[row], end = p + (size_t)c->np[row]; p < end; p++) {
        struct poly_geometry t;
        if (poly_platen_contact(&t, s->sim, st, row, p, skin))
            add_touch(s, c->a[row], c->b[row], &t, mu, is_near);
    }
}

/* An intact bond counts with its tension stiffness, even while it is closed: it may open within a
 * step. */
static void add_bond(struct springs *s, const struct poly_state *st, const struct brc_contacts *c,
                     size_t row)
{
    struct poly_bond bond;
    poly_bond_of_contact(&bond, s->sim, st, c, row);
    struct brc_spring spring = {.kn = bond.kn, .ks = bond.kt, .kt = bond.ktheta};
    brc_copy(spring.n, bond.n);
    add_spring(s, c->a[row], c->b[row], bond.x, &spring);
}

/* A pair of which nothing is near yet: one contact counts already, at x below the centre of a
 * along n, and as stiff across n as along it, because its true place is beside that line. */
static void add_near(struct springs *s, const struct brc_contacts *c, size_t row, const double x[3],
                     const double n[3])
{
    double k = fmax(s->kn, s->kt);
    struct brc_spring spring = {.kn = k, .ks = k, .is_near = true};
    brc_copy(spring.n, n);
    add_spring(s, c->a[row], c->b[row], x, &spring);
}

static void add_near_grains(struct springs *s, size_t row)
{
    const struct brc_contacts *c = &s->sim->pairs;
    const double *xa = s->sim->bodies.x[c->a[row]];
    double d[3], n[3], x[3];
    brc_sub(d, s->sim->bodies.x[c->b[row]], xa);
    brc_scale(n, d, 1 / brc_norm(d));
    brc_copy(x, xa);
    brc_axpy(x, 0.5, d);
    add_near(s, c, row, x, n);
}

static void add_near_platen(struct springs *s, size_t row)
{
    const struct brc_contacts *c = &s->sim->platens;
    const struct brc_bodies *b = &s->sim->bodies;
    const double *n = brc_sim_platen(s->sim, c->b[row])->n;
    double x[3];
    brc_copy(x, b->x[c->a[row]]);
    brc_axpy(x, -b->bounding_radius[c->a[row]], n);
    add_near(s, c, row, x, n);
}

static struct springs springs_of(const struct brc_sim *sim, struct brc_springs *out)
{
    const struct poly_params *p = poly_params_of(sim);
    return (struct springs){.sim = sim,
                            .out = out,
                            .kn = poly_pair_stiffness(p->kn, p->kn),
                            .kt = poly_pair_stiffness(p->kt, p->kt)};
}

static bool touches(const struct brc_contacts *c, size_t row)
{
    const struct poly_points *points = c->point_columns;
    for (int32_t k = 0; k < c->np[row]; k++)
        if (points->active[(size_t)c->p0[row] + (size_t)k])
            return true;
    return false;
}

static void add_near_contact(struct springs *s, const struct poly_state *st, size_t row)
{
    size_t n = s->out->n;
    if (touches(&s->sim->pairs, row))
        return;
    add_listed(s, st, row, POLY_LIST_SKIN * poly_params_of(s->sim)->radius, true);
    if (s->out->n == n)
        add_near_grains(s, row);
}

/* The faces of a bond touch, but for rounding: all that they have may close with the first load. */
static void add_contact(struct springs *s, const struct poly_state *st, size_t row)
{
    const struct brc_contacts *c = &s->sim->pairs;
    if (c->status[row] != BRC_INTACT) {
        add_near_contact(s, st, row);
        return;
    }
    add_bond(s, st, c, row);
    add_listed(s, st, row, FACE_SKIN * poly_params_of(s->sim)->radius, false);
}

static void add_platen(struct springs *s, const struct poly_state *st, size_t row)
{
    const struct brc_contacts *c = &s->sim->platens;
    add_listed_platen(s, st, row, false);
    size_t n = s->out->n;
    if (c->status[row] == BRC_INTACT) {
        add_bond(s, st, c, row);
        return;
    }
    add_listed_platen(s, st, row, true);
    if (s->out->n == n)
        add_near_platen(s, row);
}

int poly_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out)
{
    const struct poly_state *st = state;
    struct springs s = springs_of(sim, out);
    poly_each_active(sim, st, add_active_spring, &s);
    for (size_t row = 0; row < sim->pairs.n; row++)
        add_contact(&s, st, row);
    for (size_t row = 0; row < sim->platens.n; row++)
        add_platen(&s, st, row);
    return s.code;
}

int poly_foresee(struct brc_sim *sim, struct poly_state *st, size_t row, bool is_platen)
{
    if (sim->run.regime != BRC_DYNAMIC)
        return 0;
    struct springs s = springs_of(sim, &st->ahead);
    st->ahead.n = 0;
    if (is_platen)
        add_listed_platen(&s, st, row, true);
    else if (!touches(&sim->pairs, row))
        add_listed(&s, st, row, POLY_LIST_SKIN * poly_params_of(sim)->radius, true);
    BRC_TRY(s.code);
    return brc_stability_foresee(sim, &st->ahead);
}
