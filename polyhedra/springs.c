/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linearised springs that act, or may act within a step, for the time step (stability.h). From
 * the state alone: the literal evaluation says what touches. Called when the stable step is
 * measured and, for one contact, when its list is new in the dynamic regime; never in a calm step.
 * A spring too many only makes the step shorter, one too few may make a run blow up: so what may
 * close is counted before it does. */
#include "polyhedra/poly.h"

/* Faces that are bonded are this near to each other, in radii R. */
static const double FACE_SKIN = 1e-3;

/* Collected for one call; the first error stays and ends it. */
struct springs {
    const struct brc_sim *sim;
    const struct poly_state *st;
    struct brc_springs *out;
    double kn, kt; /* N/m, of a pair of grains */
    bool is_near;  /* those that are added do not touch yet */
    int code;
};

static void add_spring(struct springs *s, const struct brc_contacts *c, size_t contact,
                       const double x[3], struct brc_spring *spring)
{
    spring->a = c->a[contact];
    spring->b = c->b[contact];
    brc_sub(spring->ra, x, s->sim->bodies.x[spring->a]);
    brc_sub(spring->rb, x, s->sim->bodies.x[spring->b]);
    if (s->code == 0)
        s->code = brc_springs_add(s->sim->ctx, s->out, spring);
}

/* Without friction there is no tangential spring, however stiff it would be. */
static void add_touch(void *user, const struct poly_active *active)
{
    struct springs *s = user;
    const struct poly_geometry *t = &active->geometry;
    bool is_platen = (size_t)active->b >= s->sim->bodies.n_grains;
    double mu =
        is_platen ? brc_sim_platen(s->sim, active->b)->friction : poly_params_of(s->sim)->mu;
    struct brc_spring spring = {
        .kn = s->kn * t->weight, .ks = mu > 0 ? s->kt * t->weight : 0, .is_near = s->is_near};
    brc_copy(spring.n, t->n);
    add_spring(s, is_platen ? &s->sim->platens : &s->sim->pairs, active->contact, t->x, &spring);
}

/* Features of a contact that touch, or may close in the same step, as when faces meet. Their
 * springs are those that a distance without contact larger by `skin` would give. */
static void add_points(struct springs *s, const struct brc_contacts *c, size_t contact, double skin,
                       bool is_near)
{
    s->is_near = is_near;
    poly_each_touch(s->sim, s->st, c, contact, skin, add_touch, s);
}

/* An intact bond counts with its tension stiffness, even while it is closed: it may open within a
 * step. */
static void add_bond(struct springs *s, const struct brc_contacts *c, size_t contact)
{
    struct poly_bond bond;
    poly_bond_of_contact(&bond, s->sim, s->st, c, contact);
    struct brc_spring spring = {.kn = bond.kn, .ks = bond.kt, .kt = bond.ktheta};
    brc_copy(spring.n, bond.n);
    add_spring(s, c, contact, bond.x, &spring);
}

/* A pair of which nothing is near yet: one contact counts already, halfway between the centres or
 * where the grain's bounding sphere is nearest to the platen, and as stiff across n as along it,
 * because its true place is beside that line. */
static void add_unseen(struct springs *s, const struct brc_contacts *c, size_t contact)
{
    const struct brc_bodies *b = &s->sim->bodies;
    size_t ia = (size_t)c->a[contact];
    double k = fmax(s->kn, s->kt), x[3], d[3];
    struct brc_spring spring = {.kn = k, .ks = k, .is_near = true};
    brc_copy(x, b->x[ia]);
    if (c == &s->sim->platens) {
        brc_copy(spring.n, brc_sim_platen(s->sim, c->b[contact])->n);
        brc_axpy(x, -b->bounding_radius[ia], spring.n);
    } else {
        brc_sub(d, b->x[c->b[contact]], b->x[ia]);
        brc_scale(spring.n, d, 1 / brc_norm(d));
        brc_axpy(x, 0.5, d);
    }
    add_spring(s, c, contact, x, &spring);
}

/* One stiffness for all pairs, as all grains have that of the case. */
static struct springs springs_of(const struct brc_sim *sim, const struct poly_state *st,
                                 struct brc_springs *out)
{
    const struct poly_params *p = poly_params_of(sim);
    return (struct springs){.sim = sim,
                            .st = st,
                            .out = out,
                            .kn = poly_pair_stiffness(p->kn, p->kn),
                            .kt = poly_pair_stiffness(p->kt, p->kt)};
}

/* By what the loop has found in the last step: contacts that touch have their springs in the list
 * already. */
static bool touches(const struct brc_contacts *c, size_t contact)
{
    const struct poly_points *points = c->point_columns;
    for (int32_t k = 0; k < c->np[contact]; k++)
        if (points->active[(size_t)c->p0[contact] + (size_t)k])
            return true;
    return false;
}

/* What a contact without an intact bond may close next. False where nothing is near. */
static bool add_near(struct springs *s, const struct brc_contacts *c, size_t contact)
{
    size_t n = s->out->n;
    bool is_platen = c == &s->sim->platens;
    if (!is_platen && touches(c, contact))
        return true;
    double skin = is_platen ? POLY_PLATEN_SKIN : POLY_LIST_SKIN;
    add_points(s, c, contact, skin * poly_params_of(s->sim)->radius, true);
    return s->out->n > n;
}

/* The faces of a bond touch, but for rounding: all that they have may close with the first load.
 */
static void add_contact(struct springs *s, const struct brc_contacts *c, size_t contact)
{
    bool is_platen = c == &s->sim->platens, is_intact = c->status[contact] == BRC_INTACT;
    double skin = FACE_SKIN * poly_params_of(s->sim)->radius;
    if (is_platen)
        add_points(s, c, contact, 0, false);
    if (is_intact)
        add_bond(s, c, contact);
    if (is_intact && !is_platen)
        add_points(s, c, contact, skin, false);
    if (!is_intact && !add_near(s, c, contact))
        add_unseen(s, c, contact);
}

int poly_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out)
{
    const struct poly_state *st = state;
    struct springs s = springs_of(sim, st, out);
    poly_pose_bodies(sim, st);
    /* Those that touch come first, but for bonded pairs, which add_contact takes with a skin. */
    for (size_t contact = 0; contact < sim->pairs.n; contact++)
        if (sim->pairs.status[contact] != BRC_INTACT)
            add_points(&s, &sim->pairs, contact, 0, false);
    for (size_t contact = 0; contact < sim->pairs.n; contact++)
        add_contact(&s, &sim->pairs, contact);
    for (size_t contact = 0; contact < sim->platens.n; contact++)
        add_contact(&s, &sim->platens, contact);
    return s.code;
}

/* Quasi-static masses are scaled by the stiffness that acts, so that there is nothing to foresee
 * (mass_scaling.c). */
int poly_foresee(struct brc_sim *sim, struct poly_state *st, size_t contact, bool is_platen)
{
    if (sim->run.regime != BRC_DYNAMIC)
        return 0;
    struct springs s = springs_of(sim, st, &st->ahead);
    st->ahead.n = 0;
    add_near(&s, is_platen ? &sim->platens : &sim->pairs, contact);
    BRC_TRY(s.code);
    return brc_stability_foresee(sim, &st->ahead);
}
