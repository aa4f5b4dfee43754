/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames of a run for ParaView, in the folder frames of its results: grains_00120.hdf and so on for
 * grains, bonds and contacts (frame_mesh.h), named by step, and an index of each series with the
 * times.
 *
 * Frames stand where something happens: evenly along strain, load and number of breaks. As nobody
 * knows beforehand how far these go, a new frame takes the place of the one that is missed least.
 * One more is always at the peak: that of the largest row of the curve so far, kept in memory until
 * the state is saved. */
#ifndef BRC_FRAMES_H
#define BRC_FRAMES_H

#include "common/output/frame_mesh.h"
#include "common/output/io_h5.h"
#include "common/output/output.h"

#define BRC_FRAME_FIELDS(SCALAR, VECTOR)                                              \
    SCALAR(int64_t, step, BRC_STATE, "1", "step")                                     \
    SCALAR(double, time, BRC_STATE, "s", "time (steps in the quasi-static regime)")   \
    SCALAR(double, strain, BRC_STATE, "1", "platen strain, in the sense of the test") \
    SCALAR(double, force, BRC_STATE, "N", "mean platen force")                        \
    SCALAR(int64_t, broken, BRC_STATE, "1", "events so far")                          \
    SCALAR(uint8_t, role, BRC_STATE, "1", "1 by what happens, 2 at the peak, 3 both; 0 the last")

/* Why a row is in the table; one row may have both roles, and goes when it has lost all. */
enum brc_frame_role { BRC_FRAME_SPACED = 1, BRC_FRAME_PEAK = 2 };

/* The frames that there are. The table is saved with the state, so that a resumed run goes on with
 * it. */
struct brc_frames {
    BRC_FRAME_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
    struct brc_frame_mesh *peak;                    /* not yet written; NULL: there is none */
    struct brc_frame_count last[BRC_N_FRAME_KINDS]; /* of the last frame that this process wrote */
};

void brc_frames_init(struct brc_frames *f);
void brc_frames_free(struct brc_frames *f);
/* Frames are asked for, by any key. */
bool brc_frames_are_on(const struct brc_output_params *p);
/* The frames of the present state, if it is one of them: at most one a row of the curve, where they
 * are not asked for by steps. To be called at each step, and once more after a load. */
int brc_frames_update(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                      const struct brc_output_params *p, const struct brc_sim *sim,
                      const struct brc_h5_extra *extra);
/* Writes the frame of the peak that is still in memory: before the table is saved. */
int brc_frames_flush(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_h5_extra *extra);
/* Writes the present state as the next frame of DIR/frames, which is made; a frame of this very
 * step is written anew. */
int brc_frames_write(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra);
/* Removes the files of frames that are not in the table, after it has been saved or loaded; with f
 * NULL all frames of an earlier run. What is not a frame's stays. */
int brc_frames_sweep(struct brc_context *ctx, const struct brc_frames *f, const char *dir);
/* Is there a frame, or the series of frames, in dir? Its name from dir on. */
bool brc_frames_find(const char *dir, char *name, size_t size);

#endif
