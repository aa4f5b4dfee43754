/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each field that a saved state has holds something in some run of its model. */
#include "tests/fixture.h"

#include "common/engine/state.h"

#include <stdio.h>

enum { MAX_FIELDS = 400, N_RUNS = 5 };

/* What has been seen of the fields, in the order of the state's parts. */
struct seen {
    char name[64];
    bool is_filled;
};

static bool is_zero(const struct brc_state_part *part, int field)
{
    const size_t size = brc_field_size(&part->set.fields[field]);
    for (size_t row = 0; row < part->n; row++)
        for (size_t k = 0; k < size; k++)
            if (((const char *)brc_state_value(part, field, row))[k] != 0)
                return false;
    return true;
}

static int look(struct fixture *f, struct seen seen[MAX_FIELDS])
{
    struct brc_state state;
    int n = 0;
    brc_state_list(&f->sim, &state);
    for (int p = 0; p < state.n; p++) {
        const struct brc_state_part *part = &state.part[p];
        for (int i = 0; part->table && i < part->set.n; i++) {
            if (!brc_table_saves(part->table, i))
                continue;
            assert_true(n < MAX_FIELDS);
            snprintf(seen[n].name, sizeof seen[n].name, "%s/%s", part->path,
                     part->set.fields[i].name);
            seen[n++].is_filled |= !is_zero(part, i);
        }
    }
    return n;
}

/* 0 has a meaning there: spheres that no facet joins are rare, a bond of polyhedra is point 0. */
static const char *const RARE[] = {"pairs/model/rest", "platens/model/rest", "platens/model/plane",
                                   "events/point"};

static const char *const TEST[N_RUNS] = {
    "kind: tension; loading: fixed; rate: 4e-6 1/s; strain_max: 0.01; stop_drop: 0; grip: full",
    "kind: compression; loading: fixed; rate: 2e-5 1/s; strain_max: 0.1; stop_drop: 0; friction: "
    "0.5",
    "kind: compression; strain_max: 0.1; stop_drop: 0; friction: 0.5",
    "kind: compression; loading: fixed; rate: 10 1/s; strain_max: 0.1; stop_drop: 0; friction: 0.5",
    "kind: none"};
static const char *const RUN[N_RUNS] = {"", "", "", "regime: dynamic",
                                        "regime: dynamic; gravity: -1 m/s2, -2 m/s2, -9 m/s2"};

static void check_model(struct fixture *f, const char *name, const char *settings)
{
    static struct seen seen[MAX_FIELDS];
    int n = 0, empty = 0;
    memset(seen, 0, sizeof seen);
    for (int k = 0; k < N_RUNS; k++) {
        fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; "
                            "jitter: 0.7; seed: 3");
        fixture_sim(f, brc_registry_find(name), settings, TEST[k], RUN[k]);
        for (int step = 0; step < 10; step++) {
            fixture_steps(f, 200);
            n = look(f, seen);
        }
    }
    for (int i = 0; i < n; i++) {
        bool is_rare = false;
        for (size_t k = 0; k < sizeof RARE / sizeof *RARE; k++)
            is_rare |= strcmp(seen[i].name, RARE[k]) == 0;
        seen[i].is_filled |= is_rare;
        if (!seen[i].is_filled)
            print_message("%s: %s is always 0\n", name, seen[i].name);
        empty += !seen[i].is_filled;
    }
    assert_int_equal(empty, 0);
}

static void no_field_of_vgcm_is_empty(void **state)
{
    check_model(*state, "vgcm", "e_bar: 20 GPa; eta: 0.3; viscous: 1000 1/s; tau: 20 MPa");
}

static void no_field_of_polyhedra_is_empty(void **state)
{
    check_model(*state, "polyhedra", "eps_th: 1e-3; gn: 1000 1/s; gt: 1000 1/s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(no_field_of_vgcm_is_empty),
        FIXTURE_TEST(no_field_of_polyhedra_is_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
