/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gas.h"

static const double BOX = 0.045, SPEED = 1;

void gas_build(struct fixture *f, struct brc_convex *cell, const struct brc_model *model,
               const char *settings, const char *run)
{
    struct brc_convex own[GAS_N], *cells = cell ? cell : own;
    double radius[GAS_N];
    f->random = 77;
    for (int i = 0; i < GAS_N; i++) {
        cells[i] = (struct brc_convex){0};
        fixture_box(f, &cells[i],
                    (double[3]){0.0075 + 0.015 * (i % 3), 0.0075 + 0.015 * (i / 3 % 2),
                                0.0075 + 0.015 * (i / 6)},
                    (double[3]){0.01, 0.011, 0.009});
        radius[i] = 0.005;
    }
    fixture_loose(f, cells, radius, GAS_N);
    for (int i = 0; i < GAS_N && !cell; i++)
        brc_convex_free(&own[i]);
    fixture_free_sim(f, model, settings, run);
    for (size_t i = 0; i < GAS_N; i++) {
        double v[3], w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = SPEED * fixture_draw(f);
            w[k] = 100 * fixture_draw(f);
        }
        fixture_velocity(f, i, v, w);
    }
}

void gas_reflect(struct fixture *f)
{
    struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < GAS_N; i++)
        for (int k = 0; k < 3; k++)
            if ((b->x[i][k] > BOX - 0.005 && b->v[i][k] > 0) ||
                (b->x[i][k] < 0.005 && b->v[i][k] < 0))
                b->v[i][k] = -b->v[i][k];
}
