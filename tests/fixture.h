/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small specimens and simulations for the tests of models. Everything here checks its own calls and
 * fails the running test; settings are written as in a case file: "key: value; key: value". */
#ifndef BRC_TESTS_FIXTURE_H
#define BRC_TESTS_FIXTURE_H

#include "common/rigs/curve.h"
#include "common/rigs/loading.h"
#include "common/rigs/rigs.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "tests/near.h"

extern const struct brc_model brc_model_null;

struct fixture {
    struct brc_context ctx;
    struct brc_specimen specimen;
    struct brc_sim sim;
    bool has_specimen, has_sim;
    const struct brc_rig_type *instead; /* table for the kind that is asked for; NULL: its own */
    uint64_t random;
};

/* cmocka set-up and tear-down: a fresh fixture in *state, freed again after the test. */
int fixture_open(void **state);
int fixture_close(void **state);
#define FIXTURE_TEST(name) cmocka_unit_test_setup_teardown(name, fixture_open, fixture_close)

/* --- building ----------------------------------------------------------------------------------
 */

/* A specimen by its parameters; caching off. */
void fixture_specimen(struct fixture *f, const char *settings);
/* nx x ny x nz cubes of the given edge, seeds moved at random within jitter (0: exact). */
void fixture_grid(struct fixture *f, int nx, int ny, int nz, double edge, double jitter);
/* Cells that share no facet: never bonded. radius 0 or a sphere's about the centroid. */
void fixture_loose(struct fixture *f, const struct brc_convex *cell, const double *radius,
                   size_t n);
/* A box, or a regular octahedron with its corners at distance size on the axes, about centre. */
void fixture_box(struct fixture *f, struct brc_convex *c, const double centre[3],
                 const double edges[3]);
void fixture_octahedron(struct fixture *f, struct brc_convex *c, const double centre[3],
                        double size);
/* Changes values of a parameter struct. */
void fixture_set(struct fixture *f, struct brc_param_list list, void *values, const char *settings);
/* A simulation of the specimen; replaces an earlier one. Settings may be "". */
void fixture_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                 const char *test, const char *run);
/* The same with keys of the test's own section; and with the code of brc_sim_create. */
void fixture_test(struct fixture *f, const struct brc_model *model, const char *settings,
                  const char *test, const char *own, const char *run);
int fixture_try_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                    const char *test, const char *own, const char *run);
/* Like fixture_sim without platens, in the dynamic regime, without damping of any kind but the
 * model's. */
void fixture_free_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                      const char *run);
/* Specimen and simulation of a case file, as `breccia run` makes them, after n overrides
 * "section.key=value". */
void fixture_case(struct fixture *f, const struct brc_model *model, const char *path,
                  const char *const *overrides, int n);
void fixture_drop_sim(struct fixture *f);
/* Every model that the tests run over: the registered ones, then null. */
int fixture_n_models(void);
const struct brc_model *fixture_model(int i);
bool fixture_is(const struct brc_model *model, const char *name);

/* Settings of the two papers, for tests whose numbers are of that set: Table 1 of gt12, and the
 * fracture energies of the softening set of vgcm. */
#define FIXTURE_TABLE_1                                                                      \
    "radius: 1 mm; kn: 1e8 N/m; kt: 1e8 N/m; mu: 0.3; bn: 20 GPa; bt: 20 GPa; bm: 3.3 GPa; " \
    "eps_th: 0.02"
#define FIXTURE_ENERGIES "g_fn: 64.6 J/m2; g_fs: 31114.4 J/m2"

/* Turns n vectors, or all that a specimen's cells are made of, by a matrix. */
void fixture_turn_vectors(double (*a)[3], size_t n, double m[3][3]);
void fixture_turn(struct fixture *f, double m[3][3]);

/* --- moving ------------------------------------------------------------------------------------
 */

double fixture_draw(struct fixture *f); /* uniform in [-1, 1) */
void fixture_draw_unit(struct fixture *f, double n[3]);
/* Velocity of a body with spin w (moments in use give l). */
void fixture_velocity(struct fixture *f, size_t body, const double v[3], const double w[3]);
/* All bodies stand still, and the ledger starts anew from what is stored now. */
void fixture_rest(struct fixture *f);
/* Ledger from zero: start = kinetic + stored now. The velocities are taken as those of the half
 * step, so the kinetic energy is that of the kick to come. */
void fixture_ledger(struct fixture *f);
/* Places every body as if the whole were turned by q about the origin, then moved by u, without
 * any history of it. */
void fixture_place(struct fixture *f, const double q[4], const double u[3]);
/* Bodies have been put elsewhere by hand: adds a long way to their travel, so that whatever hangs
 * on it is found anew, and lists candidates from the places now. */
void fixture_list(struct fixture *f);
/* The model's forces of all rows for the places and velocities now; fills bodies.f and t. */
void fixture_forces(struct fixture *f);
/* One kinematic step: every grain (and platen) moves by v dt and turns by w dt exactly; then
 * forces. */
void fixture_carry(struct fixture *f, double dt);
/* n whole steps of the simulation. */
void fixture_steps(struct fixture *f, int n);

/* --- measuring ---------------------------------------------------------------------------------
 */

/* Sum of what the model stores now. */
double fixture_stored(const struct fixture *f);
/* Kinetic energy with the velocities at hand. */
double fixture_kinetic(const struct fixture *f);
/* |sum f| / sum |f| and |sum of moments about the origin| / sum |r||f| over grains and platens, by
 * way of rows; 0 when nothing acts. */
void fixture_balance(const struct fixture *f, double balance[2]);
/* Largest |moment of a row about a's centre, both sides together| / (distance |f| + |t|). */
double fixture_third_law(const struct fixture *f);
/* Largest force of a row of grain pairs [N]. */
double fixture_largest_force(const struct fixture *f);
/* Mean stress sum (x_b - x_a) f / V of the grain pairs, tension positive. */
void fixture_stress(const struct fixture *f, double stress[3][3]);
/* A result of the test by its name, and a column of its own; fail when there is none. */
struct brc_result fixture_result(const struct fixture *f, const char *name);
const double *fixture_column(const struct fixture *f, const char *name);
/* Row of two grains; fails when there is none. */
size_t fixture_row(const struct fixture *f, int32_t a, int32_t b);

#endif
