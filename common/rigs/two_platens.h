/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two platens that face each other along one axis and move alike: what compression, tension and the
 * Brazilian test share. */
#ifndef BRC_TWO_PLATENS_H
#define BRC_TWO_PLATENS_H

#include "common/engine/rig.h"
#include "common/rigs/curve.h"
#include "common/rigs/loading.h"

/* Places the platens at the specimen's ends along axis, shaped and bonded as `like` is, and gives
 * them and the grains the velocity field of a uniform strain at the starting rate. sense: +1 where
 * they approach. The load is divided by the section [m2]. Ends that do not face their platens, are
 * tilted, or cannot be held are an error. */
int brc_two_platens_place(struct brc_sim *sim, int axis, double sense, double section,
                          const struct brc_platen *like);
/* Parts of it: platens first and first + 1 at the ends along an axis; and lengths, gauge, starting
 * rate and the grains' velocities of a test that is loaded along one. */
void brc_two_platens_face(struct brc_sim *sim, int first, int axis, const struct brc_platen *like);
void brc_two_platens_begin(struct brc_sim *sim, int axis, double sense, double section);
/* Mean of the platens' forces now, in the sense of the test [N]. */
double brc_two_platens_force(const struct brc_rig *rig);
/* Strain and load of the step, then the rate and the velocities of the platens. Platens that meet
 * are an error. */
int brc_two_platens_drive(struct brc_sim *sim);
/* The same for a test whose load is a part of the platens' force [N]. */
int brc_two_platens_load(struct brc_sim *sim, double force);
/* The field of a uniform strain about the middle of the specimen. */
void brc_two_platens_field(const struct brc_sim *sim, size_t grain, double v[3]);
/* Operations for `check`: the keys of loading and moduli together, where a test uses them; closing:
 * platens that approach, too, meet at a strain of 1. */
int brc_two_platens_check(struct brc_context *ctx, const struct brc_test_params *test,
                          const void *own);
int brc_two_platens_check_closing(struct brc_context *ctx, const struct brc_test_params *test,
                                  const void *own);
/* What such a test has beside its place, check and results, to stand in its table. */
#define BRC_TWO_PLATENS                                                          \
    .n_platens = 2, .drive = brc_two_platens_drive, .measure = brc_curve_sample, \
    .field = brc_two_platens_field
/* Operation `stresses` of a specimen that such a pair loads along its axis, its sides free. */
void brc_two_platens_stresses(const struct brc_sim *sim, size_t row, double sigma[3]);
/* Mean area of the specimen across an axis [m2]. */
double brc_two_platens_section(const struct brc_sim *sim, int axis);

#endif
