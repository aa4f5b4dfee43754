/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every contact model owes to the framework: runs that repeat to the bit, from the state
 * alone, and do not hang on how the grains are numbered. Runs over every registered model and the
 * null model. */
#include "tests/subjects.h"

#include <stdlib.h>

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
    subject_pack(f);
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject_of(fixture_model(i));
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
        struct subject s = subject_of(fixture_model(i));
        uint64_t hash[2], start = 0;
        for (int k = 0; k < 2; k++) {
            subject_pack(f);
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
        double v[3] = {speed * (x[1] / SUBJECT_GRAIN - 1.5),
                       -speed * (x[0] * x[2] / SUBJECT_GRAIN / SUBJECT_GRAIN - 2),
                       -speed * (x[2] / SUBJECT_GRAIN - 1.5)};
        fixture_velocity(f, c, v, zero);
    }
}

static void order_of_grains_does_not_matter(void **state)
{
    struct fixture *f = *state;
    size_t from[27];
    for (int i = 0; i < fixture_n_models(); i++) {
        struct subject s = subject_of(fixture_model(i));
        double(*x)[3] = test_calloc(27, sizeof *x), largest = 0;
        for (int k = 0; k < 2; k++) {
            subject_pack(f);
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
        FIXTURE_TEST(scratch_is_derived_anew),
        FIXTURE_TEST(runs_repeat_to_the_bit),
        FIXTURE_TEST(order_of_grains_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
