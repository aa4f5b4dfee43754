/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over grain pairs. Its body is written once and instantiated with constant options, so
 * that an option that is off costs nothing. */
#include "step.h"

void poly_world(const struct brc_sim *sim, const struct poly_state *st)
{
    const struct brc_bodies *b = &sim->bodies;
    const struct poly_shapes *s = &st->shapes;
    for (size_t i = 0; i < b->n; i++)
        brc_quat_matrix(st->turn[i], b->q[i]);
    for (size_t i = 0; i < b->n_grains; i++) {
        const double(*m)[3] = (const double(*)[3])st->turn[i];
        for (size_t v = s->vertex_first[i]; v < s->vertex_first[i + 1]; v++)
            for (int k = 0; k < 3; k++)
                st->world[v][k] = b->x[i][k] + brc_dot(m[k], s->vertex[v]);
    }
}

void poly_pair_of(struct poly_pair *p, const struct brc_sim *sim, const struct poly_state *st,
                  int32_t a, int32_t b)
{
    const struct poly_shapes *s = &st->shapes;
    double radius = poly_params_of(sim)->radius;
    *p = (struct poly_pair){.a = poly_core_of(s, (size_t)a),
                            .b = poly_core_of(s, (size_t)b),
                            .xa = sim->bodies.x[a],
                            .xb = sim->bodies.x[b],
                            .ra = (const double(*)[3])st->turn[a],
                            .rb = (const double(*)[3])st->turn[b],
                            .va = (const double(*)[3])(st->world + s->vertex_first[a]),
                            .vb = (const double(*)[3])(st->world + s->vertex_first[b]),
                            .rest = radius + radius,
                            .ell = radius};
}

void poly_pose_bond(struct poly_bond_pose *pose, const struct brc_contacts *c, size_t row,
                    const struct poly_state *st, const struct brc_bodies *bodies, bool torsion)
{
    const struct poly_rows *rows = c->model_columns;
    int32_t a = c->a[row], b = c->b[row];
    const double(*ra)[3] = (const double(*)[3])st->turn[a];
    const double(*rb)[3] = (const double(*)[3])st->turn[b];
    poly_to_space(pose->pa, ra, rows->ca[row]);
    poly_to_space(pose->pb, rb, rows->cb[row]);
    brc_add(pose->pa, pose->pa, bodies->x[a]);
    brc_add(pose->pb, pose->pb, bodies->x[b]);
    poly_to_space(pose->na, ra, rows->na[row]);
    poly_to_space(pose->nb, rb, rows->nb[row]);
    if (torsion) {
        poly_to_space(pose->ta, ra, rows->ta[row]);
        poly_to_space(pose->tb, rb, rows->tb[row]);
    }
}

/* A broken bond: its force is gone at once. What it had stored, less the work that its last force
 * would have done in this step, is dissipated. */
__attribute__((noinline, cold)) static void break_bond(struct brc_sim *sim, size_t row,
                                                       const struct poly_bond *bond,
                                                       const struct poly_bond_result *r,
                                                       const struct poly_motion *m)
{
    struct brc_contacts *c = &sim->pairs;
    struct poly_rows *rows = c->model_columns;
    struct poly_wrench last = {0};
    double unused[3] = {0}, none[6] = {0};
    poly_push_bond(&last, unused, r, bond, m);
    struct brc_event event = {.a = c->a[row],
                              .b = c->b[row],
                              .facet = c->facet[row],
                              .mode = (enum brc_mode)poly_bond_mode(r),
                              .area = rows->area[row],
                              .energy = r->energy - poly_work(none, &last, m)};
    brc_copy(event.x, r->x);
    brc_copy(event.n, r->n);
    c->status[row] = BRC_BROKEN;
    brc_events_add(sim->ctx, &sim->events, sim->step, &event);
    if (sim->run.ledger) {
        sim->ledger.damage += event.energy;
        sim->ledger.bond -= event.energy;
    }
}

/* Bond force of an intact row. */
static inline void bond_row(struct brc_sim *sim, const struct poly_state *st, size_t row,
                            const struct poly_motion *m, struct poly_wrench *w, double k[3])
{
    const struct poly_params *params = poly_params_of(sim);
    struct brc_contacts *c = &sim->pairs;
    struct poly_bond bond = poly_bond_of(params, c->model_columns, row);
    struct poly_bond_pose pose;
    struct poly_bond_result r;
    poly_pose_bond(&pose, c, row, st, &sim->bodies, params->torsion);
    poly_bond_law(&r, &bond, &pose, params->torsion);
    if (params->breakable && poly_bond_breaks(&r))
        break_bond(sim, row, &bond, &r, m);
    else
        poly_push_bond(w, k, &r, &bond, m);
}

static inline void law_of_pair(struct poly_spring_law *law, const struct brc_sim *sim, int32_t a,
                               int32_t b, const bool viscous)
{
    const struct poly_params *p = poly_params_of(sim);
    const double *mass = sim->bodies.true_mass;
    double effective = viscous ? mass[a] * mass[b] / (mass[a] + mass[b]) : 0;
    *law = (struct poly_spring_law){.kn = poly_pair_stiffness(p->kn, p->kn),
                                    .kt = poly_pair_stiffness(p->kt, p->kt),
                                    .mu = p->mu,
                                    .gn = p->gn * effective,
                                    .gt = p->gt * effective};
}

__attribute__((always_inline)) static inline void
points_row(struct brc_sim *sim, const struct poly_state *st, size_t row, struct poly_sums *s,
           const struct poly_motion *m, const enum poly_rule rule, const bool friction,
           const bool viscous)
{
    struct brc_contacts *c = &sim->pairs;
    struct poly_points *points = c->point_columns;
    struct brc_ledger *ledger = sim->run.ledger ? &sim->ledger : NULL;
    struct poly_spring_law law;
    struct poly_pair pair;
    poly_pair_of(&pair, sim, st, c->a[row], c->b[row]);
    law_of_pair(&law, sim, c->a[row], c->b[row], viscous);
    struct poly_rows *rows = c->model_columns;
    double room = rows->room[row];
    size_t first = (size_t)c->p0[row], end = first + (size_t)c->np[row];
    size_t awake = first + (size_t)rows->awake[row];
    while (awake < end && room <= points->sleep[awake])
        awake++;
    rows->awake[row] = (int32_t)(awake - first);
    for (size_t p = first; p < awake; p++) {
        struct poly_touch t;
        if (room > points->sleep[p])
            continue;
        struct poly_feature f = poly_point(points, p);
        int32_t *place = f.kind == POLY_VERTEX_B ? &points->i[p] : &points->j[p];
        double sure = room - points->hold[p], margin = sure;
        bool touches = poly_touch_again(&t, &pair, &f, place, &points->active[p], &margin, rule);
        if (rule == POLY_MERGED && sure <= 0)
            points->hold[p] = room - margin;
        if (touches) {
            points->sleep[p] = HUGE_VAL;
            poly_act(ledger, s, &t, &law, m, points, p, friction, viscous);
            if (-t.delta < s->gap)
                s->gap = -t.delta;
            continue;
        }
        double path = rule == POLY_MERGED && f.kind != POLY_EDGES
                          ? -t.delta
                          : poly_free_path(&pair, &f, rule, room);
        points->sleep[p] = room - poly_most(path, 0);
        if (points->weight[p] > 0) {
            if (friction)
                poly_release(ledger, &law, m, points->xi[p], points->weight[p]);
            points->weight[p] = 0;
        }
    }
}

/* Counts the step's relative path against the list's allowance; a's vertices near b move with it
 * too, so its reach is taken that much larger. */
static inline bool keeps_list(const struct brc_sim *sim, const struct poly_rows *rows, size_t row,
                              const struct poly_motion *m)
{
    const double *reach = sim->bodies.reach, rest = 2 * poly_params_of(sim)->radius;
    const struct brc_contacts *c = &sim->pairs;
    rows->room[row] -= poly_relative_path(m, reach[c->a[row]], reach[c->b[row]] + rest);
    return rows->room[row] > 0;
}

__attribute__((always_inline)) static inline void
pairs_loop(struct brc_sim *sim, struct poly_state *st, const enum poly_rule rule,
           const bool friction, const bool viscous)
{
    struct brc_contacts *c = &sim->pairs;
    struct poly_rows *rows = c->model_columns;
    for (size_t row = 0; row < c->n; row++) {
        bool listed = c->np[row] > 0;
        if (!listed && poly_is_awake(sim, c, row)) {
            if (poly_list_row(sim, st, row) != 0)
                return;
        } else if (poly_is_idle(c, row)) {
            continue;
        }
        int32_t a = c->a[row], b = c->b[row];
        struct poly_motion m;
        poly_start_motion(&m, sim, a, b);
        if (listed && !keeps_list(sim, rows, row, &m) && poly_list_row(sim, st, row) != 0)
            return;
        struct poly_sums s = {.gap =
                                  rows->wake[row] - sim->bodies.travel[a] - sim->bodies.travel[b]};
        struct poly_wrench bond = {0};
        if (c->status[row] == BRC_INTACT)
            bond_row(sim, st, row, &m, &bond, s.k);
        if (c->np[row] > 0)
            points_row(sim, st, row, &s, &m, rule, friction, viscous);
        poly_finish_row(c, row, &s, &bond, &m);
        poly_store_k(c, row, s.k);
        if (sim->run.ledger)
            poly_account(&sim->ledger, rows, row, &s, &bond, &m, viscous);
    }
}

/* flatten: everything is inlined, so that the constants reach the last branch. */
#define PAIRS_LOOP(rule, friction, viscous)                                                       \
    __attribute__((flatten)) static void loop_##rule##_##friction##viscous(struct brc_sim *sim,   \
                                                                           struct poly_state *st) \
    {                                                                                             \
        pairs_loop(sim, st, rule, friction, viscous);                                             \
    }
#define PAIRS_LOOPS(rule)  \
    PAIRS_LOOP(rule, 0, 0) \
    PAIRS_LOOP(rule, 0, 1) \
    PAIRS_LOOP(rule, 1, 0) \
    PAIRS_LOOP(rule, 1, 1)
PAIRS_LOOPS(POLY_CLOSED)
PAIRS_LOOPS(POLY_STRICT)
PAIRS_LOOPS(POLY_MERGED)

#define PAIRS_TABLE(rule)                                                      \
    {                                                                          \
        loop_##rule##_00, loop_##rule##_01, loop_##rule##_10, loop_##rule##_11 \
    }

poly_loop *poly_choose_pairs(const struct brc_sim *sim)
{
    static poly_loop *const loops[3][4] = {PAIRS_TABLE(POLY_CLOSED), PAIRS_TABLE(POLY_STRICT),
                                           PAIRS_TABLE(POLY_MERGED)};
    const struct poly_params *p = poly_params_of(sim);
    int friction = p->mu > 0 && p->kt > 0;
    int viscous = sim->run.regime == BRC_DYNAMIC && (p->gn > 0 || p->gt > 0);
    return loops[p->features][2 * friction + viscous];
}

void poly_forces(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    poly_world(sim, st);
    st->pairs_loop(sim, st);
}

void poly_each_active(const struct brc_sim *sim, const struct poly_state *st,
                      void (*visit)(void *user, const struct poly_active *active), void *user)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct poly_points *points = c->point_columns;
    enum poly_rule rule = (enum poly_rule)poly_params_of(sim)->features;
    poly_world(sim, st);
    for (size_t row = 0; row < c->n; row++) {
        struct poly_pair pair;
        poly_pair_of(&pair, sim, st, c->a[row], c->b[row]);
        for (int32_t k = 0; k < c->np[row]; k++) {
            size_t p = (size_t)c->p0[row] + (size_t)k;
            struct poly_active found = {.a = c->a[row],
                                        .b = c->b[row],
                                        .row = row,
                                        .point = p,
                                        .feature = poly_point(points, p)};
            uint8_t active = points->active[p];
            if (poly_touch(&found.touch, &pair, &found.feature, poly_remembered(&found.feature),
                           &active, rule))
                visit(user, &found);
        }
    }
}
