/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the hard cases share: cases/hard, and rows of the table in docs/stability.md. */
#ifndef BRC_TESTS_HARD_H
#define BRC_TESTS_HARD_H

#include "tests/fixture.h"

#include <stdio.h>

static int hard_failed; /* rows that do not hold */

/* A row, "case | model | what must hold | measured | holds". */
__attribute__((format(printf, 5, 6))) static inline void hard_row(const char *name,
                                                                  const char *model, bool holds,
                                                                  const char *must,
                                                                  const char *measured, ...)
{
    char text[512];
    va_list list;
    va_start(list, measured);
    vsnprintf(text, sizeof text, measured, list);
    va_end(list);
    printf("| %s | %s | %s | %s | %s |\n", name, model, must, text, holds ? "yes" : "**no**");
    fflush(stdout);
    hard_failed += !holds;
}

static inline void hard_case(struct fixture *f, const char *name, const struct brc_model *model,
                             const char *const *overrides, int n)
{
    char path[128];
    snprintf(path, sizeof path, "cases/hard/%s.yaml", name);
    fixture_case(f, model, path, overrides, n);
}

/* Kinetic energy of the leapfrog form and stored energy of the state: what a linear system keeps.
 */
static inline double hard_energy(const struct fixture *f)
{
    return f->sim.ledger.kinetic + fixture_stored(f);
}

/* Random velocities v [m/s] and spins w [1/s] of all grains. */
static inline void hard_stir(struct fixture *f, double v, double w)
{
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++) {
        double u[3], s[3];
        for (int k = 0; k < 3; k++) {
            u[k] = v * fixture_draw(f);
            s[k] = w * fixture_draw(f);
        }
        fixture_velocity(f, i, u, s);
    }
    fixture_ledger(f);
}

#endif
