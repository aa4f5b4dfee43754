/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every contact model owes to the framework, whatever its law. Runs over every registered
 * model and the null model. */
#include "tests/fixture.h"
#include "tests/rotate.h"

#include <stdio.h>
#include <stdlib.h>

/* Settings of the models here: no viscosity, grains of 1 cm; modulus makes forces of strains. */
struct subject {
    const char *name;
    const char *elastic;
    const char *breaking;
    double modulus;
    double stable_part; /* of the step limit; less where springs begin and end within a step */
};
static const struct subject SUBJECTS[] = {
    {"polyhedra", FIXTURE_TABLE_1 "; gn: 0 1/s; evaluation: literal",
     FIXTURE_TABLE_1 "; gn: 0 1/s; eps_th: 5e-4; theta_th: 2e-3 rad", 20e9, 0.7},
    {"vgcm",
     "interaction: all; e_bar: 20 GPa; eta: 0.3; sigma_t: 1 TPa; tau: 1 TPa; softening: none",
     "interaction: all; e_bar: 20 GPa; eta: 0.3; " FIXTURE_ENERGIES, 20e9, 0.95},
    {"null", "", "", 1e9, 0.95},
};

static struct subject subject(const struct brc_model *model)
{
    for (size_t i = 0; i < sizeof SUBJECTS / sizeof SUBJECTS[0]; i++)
        if (fixture_is(model, SUBJECTS[i].name))
            return SUBJECTS[i];
    return (struct subject){model->name, "", "", 1e9, 0.95}; /* a model added later: its defaults */
}

static const double H = 1e-2;

static void build_pack(struct fixture *f)
{
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; "
                        "jitter: 0.7; seed: 3");
}

/* Random motion of every grain: displacements of about strain x H a step. */
static void shake(struct fixture *f, double strain, int n)
{
    for (int step = 0; step < n; step++) {
        for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
            double v[3], w[3];
            for (int k = 0; k < 3; k++) {
                v[k] = strain * H * fixture_draw(f);
                w[k] = strain * fixture_draw(f);
            }
            fixture_velocity(f, i, v, w);
        }
        fixture_carry(f, 1);
    }
    fixture_rest(f);
}

/* Force of a strain on a facet, for tolerances. */
static double force_of(const struct subject *s, double strain)
{
    return s->modulus * H * H * strain;
}

static void forces_balance(void **state)
{
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        struct subject s = subject(model);
        const char *tests[3] = {"kind: none", "kind: compression; friction: 0.5",
                                "kind: tension; grip: full"};
        for (int t = 0; t < 3; t++) {
            double balance[2];
            fixture_sim(f, model, s.elastic, tests[t], "");
            shake(f, 1e-5, 3);
            fixture_balance(f, balance);
            /* sums of some hundred forces and of arms of 5 cm: 1e-14 each */
            CHECK_NEAR(balance[0], 0, 1e-13, 0);
            CHECK_NEAR(balance[1], 0, 1e-12, 0);
            CHECK_NEAR(fixture_third_law(f), 0, 1e-12, 0);
            if (!fixture_is(model, "null"))
                assert_true(fixture_largest_force(f) > force_of(&s, 1e-6));
        }
    }
}

static void gather_is_the_sum_of_rows(void **state)
{
    /* the framework's sums against a plain accumulation, which adds in another order */
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject(fixture_model(i));
        fixture_sim(f, fixture_model(i), s.elastic, "rate: 1e-6 1/s; loading: fixed", "");
        fixture_steps(f, 20);
        struct brc_bodies *b = &f->sim.bodies;
        double(*sums)[6] = test_calloc(b->n, sizeof *sums);
        for (size_t k = 0; k < b->n; k++) {
            brc_copy(sums[k], b->f[k]);
            brc_copy(sums[k] + 3, b->t[k]);
        }
        const struct brc_contacts *sets[2] = {&f->sim.pairs, &f->sim.platens};
        double size = 1e-300;
        /* the moments of pairs are not kept where the model adds them itself */
        bool has_moments = !(f->sim.model.flags & BRC_MODEL_ADDS);
        for (int c = 0; c < 2; c++)
            for (size_t r = 0; r < sets[c]->n; r++) {
                const int32_t end[2] = {sets[c]->a[r], sets[c]->b[r]};
                brc_axpy(sums[end[0]], 1, sets[c]->f[r]);
                brc_axpy(sums[end[1]], -1, sets[c]->f[r]);
                brc_axpy(sums[end[0]] + 3, -1, sets[c]->ta[r]);
                brc_axpy(sums[end[1]] + 3, -1, sets[c]->tb[r]);
                size += brc_norm(sets[c]->f[r]);
            }
        for (size_t k = 0; k < b->n; k++) {
            CHECK_NEAR(brc_norm(sums[k]), 0, 1e-13 * size, 0);
            if (has_moments)
                CHECK_NEAR(brc_norm(sums[k] + 3), 0, 1e-13 * size * H, 0);
        }
        test_free(sums);
    }
}

static void translation_gives_no_force(void **state)
{
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        struct subject s = subject(model);
        const double v[3] = {0.7 * H, -0.4 * H, 0.3 * H}, zero[3] = {0, 0, 0};
        fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
        for (size_t k = 0; k < f->sim.bodies.n; k++)
            fixture_velocity(f, k, v, zero);
        fixture_carry(f, 1);
        /* places of 4 cm are known to 7e-18 m, that is a strain of 1e-15 */
        CHECK_NEAR(fixture_largest_force(f), 0, force_of(&s, 2e-14), 0);
        assert_int_equal(f->sim.events.table.n, 0);
    }
}

/* Turns everything about the origin by phi in n exact steps; velocities are those of the chords. */
static void turn(struct fixture *f, const double phi[3], int n)
{
    double step[3], q[4];
    brc_scale(step, phi, 1.0 / n);
    brc_quat_from_rotation(q, step);
    for (int i = 0; i < n; i++) {
        for (size_t k = 0; k < f->sim.bodies.n; k++) {
            double x[3];
            brc_quat_rotate(x, q, f->sim.bodies.x[k]);
            brc_sub(x, x, f->sim.bodies.x[k]);
            fixture_velocity(f, k, x, step);
        }
        fixture_carry(f, 1);
    }
}

static void rotation_at_once_gives_no_force(void **state)
{
    /* models whose displacements are total (no memory of the path) bear any angle in one go */
    struct fixture *f = *state;
    build_pack(f);
    const struct brc_model *model = brc_registry_find("polyhedra");
    struct subject s = subject(model);
    for (int i = 0; i < 8; i++) {
        double phi[3], q[4], u[3] = {0.3, -0.2, 0.1};
        fixture_free_sim(f, model, s.elastic, "");
        fixture_draw_unit(f, phi);
        brc_scale(phi, phi, BRC_PI * (i + 1) / 8);
        brc_quat_from_rotation(q, phi);
        fixture_place(f, q, u);
        fixture_list(f);
        fixture_forces(f);
        /* places of 40 cm: 1e-16 m, a strain of 1e-14, times the springs of a facet */
        CHECK_NEAR(fixture_largest_force(f), 0, force_of(&s, 1e-12), 0);
        CHECK_NEAR(fixture_stored(f), 0, force_of(&s, 1e-12) * 1e-12 * H, 0);
        assert_int_equal(f->sim.events.table.n, 0);
    }
}

static double drift_of_turn(struct fixture *f, const struct brc_model *model, int n)
{
    struct subject s = subject(model);
    fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
    turn(f, (double[3]){0.9, -0.5, 1.2}, n); /* 91 degrees about a skew axis */
    return fixture_largest_force(f) / force_of(&s, 1);
}

static void rotation_in_steps_drifts_little(void **state)
{
    /* strain that a turn of 90 degrees leaves behind: nothing where displacements are total; of the
     * second order or better in the step where they are summed up (91 degrees in 200 steps: 8 mrad
     * each, third order each) */
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        double drift = drift_of_turn(f, fixture_model(i), 200);
        double finer = drift_of_turn(f, fixture_model(i), 400);
        print_message("%s: turned by 91 degrees, strain left: %.2e in 200 steps, %.2e in 400\n",
                      fixture_model(i)->name, drift, finer);
        CHECK_NEAR(drift, 0, 2e-5, 0);
        if (drift > 1e-11)
            CHECK_BETWEEN(log2(drift / finer), 1.8, 4.5);
    }
}

/* Largest error of the turned forces as a strain; energy relative to what it was. */
static double error_of_turn(struct fixture *f, const struct brc_model *model, int n,
                            double *energy_error)
{
    struct subject s = subject(model);
    f->random = 5;
    fixture_free_sim(f, model, s.elastic, "dt: 1e-9 s");
    shake(f, 1e-5, 3);
    fixture_forces(f);
    size_t n_rows = f->sim.pairs.n;
    double(*old)[3] = test_calloc(n_rows + 1, sizeof *old);
    double stored = fixture_stored(f), phi[3] = {-0.4, 0.8, 0.5}, q[4], error = 0;
    for (size_t r = 0; r < n_rows; r++)
        brc_copy(old[r], f->sim.pairs.f[r]);
    turn(f, phi, n);
    brc_quat_from_rotation(q, phi);
    assert_int_equal(f->sim.pairs.n, n_rows);
    for (size_t r = 0; r < n_rows; r++) {
        double d[3];
        brc_quat_rotate(d, q, old[r]);
        brc_sub(d, d, f->sim.pairs.f[r]);
        error = fmax(error, brc_norm(d) / force_of(&s, 1));
    }
    *energy_error = stored > 0 ? fabs(fixture_stored(f) / stored - 1) : 0;
    test_free(old);
    return error;
}

static void forces_turn_with_the_pack(void **state)
{
    /* a strained pack is turned: forces and energy turn with it. The memory of shear must be
     * carried along by tilt and twirl: without, the error is of the order of the strain itself. */
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        double energy[2], error[2];
        for (int k = 0; k < 2; k++)
            error[k] = error_of_turn(f, fixture_model(i), 400 << k, &energy[k]);
        print_message("%s: strained by 3e-5 and turned by 59 degrees: error of the forces as a "
                      "strain %.2e in 400 steps, %.2e in 800; of the energy %.2e, %.2e\n",
                      fixture_model(i)->name, error[0], error[1], energy[0], energy[1]);
        /* steps of 2.6 mrad: the chord is off by a third of 1e-9 of 1 cm each, 400 times */
        CHECK_NEAR(error[0], 0, 5e-6, 0);
        CHECK_NEAR(energy[1], 0, 0.02, 0);
        if (error[0] > 1e-10)
            CHECK_BETWEEN(log2(error[0] / error[1]), 1.8, 4.5);
    }
}

/* A free pack is set in random motion, without any damping. */
static void set_in_motion(struct fixture *f, const struct brc_model *model, const char *run,
                          double speed)
{
    char settings[320];
    snprintf(settings, sizeof settings, "%s%s", subject(model).elastic,
             fixture_is(model, "polyhedra") ? "; mu: 0; breakable: off" : "");
    fixture_free_sim(f, model, settings, fixture_is(model, "null") ? "dt: 1e-7 s" : run);
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        double v[3], w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = speed * fixture_draw(f);
            w[k] = model->flags & BRC_MODEL_ROTATES ? speed / H * fixture_draw(f) : 0;
        }
        fixture_velocity(f, i, v, w);
    }
    fixture_ledger(f);
}

static void ledger_is_the_stored_energy(void **state)
{
    /* elastic and undamped: each stored term of the ledger follows the energy that the model finds
     * from its state, and nothing is lost */
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        set_in_motion(f, fixture_model(i), "dt_margin: 0.1", 0.02);
        double total = f->sim.ledger.start, largest = 0;
        for (int k = 0; k < 400; k++) {
            double stored[3];
            fixture_steps(f, 1);
            const struct brc_ledger *l = &f->sim.ledger;
            brc_accounts_stored(&f->sim, stored);
            const double kept[3] = {l->bond, l->contact_normal, l->contact_shear};
            /* trapezoid rule at a tenth of the stable step: springs that begin or end within a step
             * are off by (0.1)^2 of one step's work */
            CHECK_NEAR_ARRAY(kept, stored, 3, 5e-4 * total, 0);
            CHECK_NEAR(fabs(brc_ledger_imbalance(l)), 0, 5e-4 * total, 0);
            largest = fmax(largest, stored[0] + stored[1] + stored[2]);
        }
        if (!fixture_is(fixture_model(i), "null"))
            assert_true(largest > 0.1 * total);
        CHECK_NEAR(f->sim.ledger.friction + f->sim.ledger.damage + f->sim.ledger.viscous, 0,
                   1e-12 * total, 0);
    }
}

static void nothing_is_lost_in_breaking(void **state)
{
    /* pulled apart by the rig, quasi-statically, with every kind of dissipation */
    struct fixture *f = *state;
    build_pack(f);
    const char *tests[2] = {"kind: tension; grip: full; loading: fixed; rate: 2e-6 1/s",
                            "kind: compression; friction: 0.3; loading: fixed; rate: 2e-6 1/s"};
    for (int i = 0; i < brc_registry_count(); i++)
        for (int t = 0; t < 2; t++) {
            struct subject s = subject(brc_registry_at(i));
            fixture_sim(f, brc_registry_at(i), s.breaking, tests[t], "");
            fixture_steps(f, t == 0 ? 600 : 2500);
            const struct brc_ledger *l = &f->sim.ledger;
            print_message("%s, %s: %zu events, residual %.2e; damage %.2e, friction %.2e, damping "
                          "%.2e, mass %.2e of the work\n",
                          brc_registry_at(i)->name, t == 0 ? "tension" : "compression",
                          f->sim.events.table.n, brc_ledger_residual(l), l->damage / l->boundary,
                          l->friction / l->boundary, l->local_damping / l->boundary,
                          l->mass_scaling / l->boundary);
            if (strlen(s.breaking) > 0)
                assert_true(f->sim.events.table.n > 0);
            CHECK_NEAR(brc_ledger_residual(l), 0, 0.01, 0);
        }
}

/* Largest kinetic energy over the start's in n steps at a part of the stable limit; above 1 the
 * step is forced on the framework, which would refuse it. */
static double energy_after(struct fixture *f, const struct brc_model *model, double factor, int n)
{
    char run[64];
    snprintf(run, sizeof run, "dt_margin: %g", fmin(factor, 0.95));
    set_in_motion(f, model, run, 1e-3);
    double start = f->sim.ledger.start, largest = 0;
    for (int i = 0; i < n; i++) {
        if (factor > 1)
            f->sim.dt = factor * f->sim.dt_limit;
        if (brc_sim_step(&f->sim) != 0) {
            brc_error_clear(&f->ctx);
            return HUGE_VAL;
        }
        largest = fmax(largest, fixture_kinetic(f) / start);
    }
    return largest;
}

static void the_default_step_keeps_the_energy(void **state)
{
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < brc_registry_count(); i++) {
        set_in_motion(f, brc_registry_at(i), "", 1e-3);
        double start = f->sim.ledger.start;
        fixture_steps(f, 1500);
        /* at 0.8 of the limit polyhedra come to 1.6 */
        CHECK_NEAR((f->sim.ledger.kinetic + fixture_stored(f)) / start, 1, 0.05, 0);
    }
}

static void the_step_limit_is_sharp(void **state)
{
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        double part = subject(model).stable_part;
        double below = energy_after(f, model, part, 1500);
        double above = energy_after(f, model, 1.5, 1500);
        print_message("%s: largest kinetic energy / start: %.2g at %g of the limit, %.2g at 1.5\n",
                      model->name, below, part, above);
        /* near the limit the leapfrog velocity of the fastest mode is amplified by
         * 1 / sqrt(1 - part^2) */
        CHECK_BETWEEN(below, 0, 2 / (1 - part * part));
        assert_true(above > 1e3);
    }
}

static void poison(struct brc_table *t)
{
    for (int i = 0; i < t->set.n; i++) {
        const struct brc_field *field = &t->set.fields[i];
        if (!(field->flags & BRC_SCRATCH) || field->type != BRC_F64)
            continue;
        double *column = brc_table_column(t, i);
        for (size_t k = 0; k < t->n * (size_t)field->width; k++)
            column[k] = NAN;
    }
}

static void scratch_is_derived_anew(void **state)
{
    struct fixture *f = *state;
    build_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject(fixture_model(i));
        uint64_t hash[2];
        for (int with = 0; with < 2; with++) {
            fixture_sim(f, fixture_model(i), s.breaking, "loading: fixed; rate: 1e-5 1/s", "");
            for (int k = 0; k < 60; k++) {
                struct brc_sim *sim = &f->sim;
                struct brc_table *tables[] = {&sim->bodies.table,  &sim->bodies.model,
                                              &sim->pairs.table,   &sim->pairs.model,
                                              &sim->pairs.points,  &sim->platens.table,
                                              &sim->platens.model, &sim->platens.points};
                for (size_t t = 0; with && t < sizeof tables / sizeof tables[0]; t++)
                    poison(tables[t]);
                fixture_steps(f, 1);
            }
            hash[with] = brc_sim_hash(&f->sim);
        }
        assert_true(hash[0] == hash[1]);
    }
}

static void runs_repeat_to_the_bit(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject(fixture_model(i));
        uint64_t hash[2], start = 0;
        for (int k = 0; k < 2; k++) {
            build_pack(f);
            fixture_sim(f, fixture_model(i), s.breaking,
                        "kind: tension; grip: full; loading: adaptive; rate: 2e-6 1/s", "");
            start = brc_sim_hash(&f->sim);
            fixture_steps(f, 400);
            hash[k] = brc_sim_hash(&f->sim);
        }
        assert_true(hash[0] == hash[1]);
        assert_true(hash[0] != start);
    }
}

/* --- another order of the grains ---------------------------------------------------------------
 */

struct facet_key {
    int32_t low, high;
    size_t old;
};

static int compare_keys(const void *p, const void *q)
{
    const struct facet_key *a = p, *b = q;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    uint32_t ha = (uint32_t)a->high, hb = (uint32_t)b->high; /* boundary (-1) last */
    if (ha != hb)
        return ha < hb ? -1 : 1;
    return (a->old > b->old) - (a->old < b->old);
}

/* Row i of a column becomes the old row from[i]. */
static void permute(void *column, const size_t *from, size_t n, size_t size)
{
    char *old = test_malloc(n * size);
    memcpy(old, column, n * size);
    for (size_t i = 0; i < n; i++)
        memcpy((char *)column + i * size, old + from[i] * size, size);
    test_free(old);
}

static void renumber_loops(struct brc_facets *s, const struct facet_key *key, const bool *turned)
{
    size_t *first = test_calloc(s->n_facets + 1, sizeof *first);
    int32_t *loop = test_calloc(s->first[s->n_facets], sizeof *loop);
    for (size_t m = 0; m < s->n_facets; m++) {
        size_t from = s->first[key[m].old], n = s->first[key[m].old + 1] - from;
        for (size_t j = 0; j < n; j++)
            loop[first[m] + j] = s->loop[from + (turned[m] ? n - 1 - j : j)];
        first[m + 1] = first[m] + n;
    }
    memcpy(s->first, first, (s->n_facets + 1) * sizeof *first);
    memcpy(s->loop, loop, first[s->n_facets] * sizeof *loop);
    test_free(first);
    test_free(loop);
}

static void list_cell_facets(struct brc_facets *s)
{
    size_t n = 0;
    for (size_t c = 0; c < s->n_cells; c++) {
        s->cell_first[c] = n;
        for (size_t m = 0; m < s->n_facets; m++)
            if (s->cell[m][0] == (int32_t)c || s->cell[m][1] == (int32_t)c)
                s->cell_facet[n++] = (int32_t)m;
    }
    s->cell_first[s->n_cells] = n;
}

/* Renumbers the cells: new cell i is the old cell from[i]. */
static void permute_specimen(struct brc_facets *s, const size_t *from)
{
    size_t n = s->n_cells, n_facets = s->n_facets;
    int32_t *to = test_calloc(n, sizeof *to);
    struct facet_key *key = test_calloc(n_facets, sizeof *key);
    size_t *old = test_calloc(n_facets, sizeof *old);
    bool *turned = test_calloc(n_facets, sizeof *turned);
    for (size_t i = 0; i < n; i++)
        to[from[i]] = (int32_t)i;
    for (size_t m = 0; m < n_facets; m++) {
        int32_t a = to[s->cell[m][0]], b = s->cell[m][1] < 0 ? -1 : to[s->cell[m][1]];
        bool swap = b >= 0 && b < a;
        key[m] = (struct facet_key){swap ? b : a, swap ? a : b, m};
    }
    qsort(key, n_facets, sizeof *key, compare_keys);
    for (size_t m = 0; m < n_facets; m++) {
        old[m] = key[m].old;
        turned[m] = to[s->cell[old[m]][0]] != key[m].low;
    }
    renumber_loops(s, key, turned);
    permute(s->volume, from, n, sizeof *s->volume);
    permute(s->centre, from, n, sizeof *s->centre);
    permute(s->seed, from, n, sizeof *s->seed);
    permute(s->radius, from, n, sizeof *s->radius);
    permute(s->face, old, n_facets, sizeof *s->face);
    permute(s->is_contact, old, n_facets, sizeof *s->is_contact);
    permute(s->area, old, n_facets, sizeof *s->area);
    permute(s->centroid, old, n_facets, sizeof *s->centroid);
    permute(s->normal, old, n_facets, sizeof *s->normal);
    for (size_t m = 0; m < n_facets; m++) {
        s->cell[m][0] = key[m].low;
        s->cell[m][1] = key[m].high;
        if (turned[m])
            brc_scale(s->normal[m], s->normal[m], -1);
    }
    list_cell_facets(s);
    test_free(to);
    test_free(key);
    test_free(old);
    test_free(turned);
}

/* A shear flow and a squeeze by place, so that it is the same for every numbering. */
static void set_flow(struct fixture *f, double speed)
{
    const double zero[3] = {0, 0, 0};
    for (size_t c = 0; c < f->sim.bodies.n_grains; c++) {
        const double *x = f->sim.bodies.x[c];
        double v[3] = {speed * (x[1] / H - 1.5), -speed * (x[0] * x[2] / H / H - 2),
                       -speed * (x[2] / H - 1.5)};
        fixture_velocity(f, c, v, zero);
    }
}

static void order_of_grains_does_not_matter(void **state)
{
    struct fixture *f = *state;
    size_t from[27];
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject(fixture_model(i));
        double(*x)[3] = test_calloc(27, sizeof *x), largest = 0;
        for (int k = 0; k < 2; k++) {
            build_pack(f);
            for (size_t c = 0; c < 27; c++)
                from[c] = k == 0 ? c : (c * 10 + 4) % 27; /* 10 and 27 have no common factor */
            if (k == 1)
                permute_specimen(&f->specimen.facets, from);
            fixture_free_sim(f, fixture_model(i), s.elastic, "dt: 1e-7 s");
            set_flow(f, 0.1);
            fixture_steps(f, 200);
            const struct brc_bodies *b = &f->sim.bodies;
            for (size_t c = 0; c < 27; c++) {
                double u[3];
                brc_sub(u, b->x[c], b->x0[c]);
                largest = fmax(largest, brc_norm(u));
                if (k == 0)
                    brc_copy(x[c], u);
                else /* places of 3 cm are rounded to 3e-18 m at each of 200 steps, of displacements
                      * of 1e-6 m: 1e-10 with the growth of 200 steps */
                    CHECK_NEAR_ARRAY(u, x[from[c]], 3, 1e-8 * largest, 0);
            }
        }
        assert_true(largest > 1e-7);
        test_free(x);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(forces_balance),
        FIXTURE_TEST(gather_is_the_sum_of_rows),
        FIXTURE_TEST(translation_gives_no_force),
        FIXTURE_TEST(rotation_at_once_gives_no_force),
        FIXTURE_TEST(rotation_in_steps_drifts_little),
        FIXTURE_TEST(forces_turn_with_the_pack),
        FIXTURE_TEST(ledger_is_the_stored_energy),
        FIXTURE_TEST(nothing_is_lost_in_breaking),
        FIXTURE_TEST(the_default_step_keeps_the_energy),
        FIXTURE_TEST(the_step_limit_is_sharp),
        FIXTURE_TEST(scratch_is_derived_anew),
        FIXTURE_TEST(runs_repeat_to_the_bit),
        FIXTURE_TEST(order_of_grains_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
