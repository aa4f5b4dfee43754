/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/engine/fragments.h"
#include "tests/near.h"

#include <stdlib.h>

enum { N = 60 };

static uint64_t draw(uint64_t *random)
{
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    return *random;
}

/* Bonds between pairs of a random graph; some rows are broken or were never bonded. */
static void make_pairs(struct brc_context *ctx, struct brc_contacts *c, uint64_t *random, int part)
{
    const struct brc_fieldset none = {0};
    int32_t pair[N * N][2];
    size_t n = 0;
    CHECK_OK(ctx, brc_contacts_create(ctx, c, "pairs", N, none, none));
    for (int32_t a = 0; a < N; a++)
        for (int32_t b = a + 1; b < N; b++)
            if (draw(random) % 1000 < (uint64_t)part) {
                pair[n][0] = a;
                pair[n++][1] = b;
            }
    CHECK_OK(ctx, brc_contacts_set(ctx, c, (const int32_t(*)[2])pair, n));
    for (size_t i = 0; i < n; i++)
        c->status[i] = (uint8_t)(draw(random) % 3);
}

/* The naive twin: the lowest grain that can be reached, spread until nothing changes. */
static void spread(const struct brc_contacts *c, int32_t low[N])
{
    bool is_changed = true;
    for (int32_t i = 0; i < N; i++)
        low[i] = i;
    while (is_changed) {
        is_changed = false;
        for (size_t k = 0; k < c->n; k++) {
            int32_t *a = &low[c->a[k]], *b = &low[c->b[k]];
            if (c->status[k] != BRC_INTACT || *a == *b)
                continue;
            *a = *b = *a < *b ? *a : *b;
            is_changed = true;
        }
    }
}

static void check_graph(struct brc_context *ctx, uint64_t *random, int part)
{
    struct brc_contacts c;
    struct brc_fragments f;
    double volume[N], sum = 0, all = 0;
    int32_t low[N], size = 0;
    make_pairs(ctx, &c, random, part);
    for (int i = 0; i < N; i++)
        all += volume[i] = (double)(1 + draw(random) % 4); /* equal ones, too */
    uint8_t *holds = malloc(c.n + 1);
    assert_non_null(holds);
    for (size_t k = 0; k < c.n; k++)
        holds[k] = c.status[k] == BRC_INTACT;
    CHECK_OK(ctx, brc_fragments_connect(ctx, N, volume, &c, holds, &f));
    free(holds);
    spread(&c, low);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            assert_int_equal(f.of[i] == f.of[j], low[i] == low[j]);
    for (size_t k = 0; k < f.n; k++) {
        double own = 0;
        int32_t grains = 0;
        for (int i = 0; i < N; i++) {
            own += f.of[i] == (int32_t)k ? volume[i] : 0;
            grains += f.of[i] == (int32_t)k;
        }
        assert_true(f.volume[k] == own && f.size[k] == grains && grains > 0);
        assert_true(k == 0 || f.volume[k] <= f.volume[k - 1]);
        sum += own;
        size += grains;
    }
    assert_true(sum == all && size == N);
    brc_fragments_free(&f);
    brc_contacts_free(&c);
}

static void test_random_graphs(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    uint64_t random = 88172645463325252U;
    for (int part = 0; part < 200; part += 5)
        check_graph(&ctx, &random, part);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_graphs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
