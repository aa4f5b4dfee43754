/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames of a run for ParaView, in the folder frames of its results: grains_00000.hdf and so on
 * for grains, bonds and contacts (frame_mesh.h), and an index of each series with the times. */
#ifndef BRC_FRAMES_H
#define BRC_FRAMES_H

#include "io_h5.h"
#include "output.h"

#define BRC_FRAME_FIELDS(SCALAR, VECTOR)                                              \
    SCALAR(int64_t, step, BRC_STATE, "1", "step")                                     \
    SCALAR(double, time, BRC_STATE, "s", "time (steps in the quasi-static regime)")   \
    SCALAR(double, strain, BRC_STATE, "1", "platen strain, in the sense of the test") \
    SCALAR(double, force, BRC_STATE, "N", "mean platen force")

/* What has been written. The table is saved with the state, so that a resumed run goes on with it.
 */
struct brc_frames {
    BRC_FRAME_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    struct brc_table table;
    struct brc_frame_count last[BRC_N_FRAME_KINDS]; /* of the last frame that this process wrote */
};

void brc_frames_init(struct brc_frames *f);
void brc_frames_free(struct brc_frames *f);
/* Frames are asked for; the present state is one of them. */
bool brc_frames_are_on(const struct brc_output_params *p);
bool brc_frames_is_due(const struct brc_frames *f, const struct brc_output_params *p,
                       const struct brc_sim *sim);
/* Writes the present state as the next frame of DIR/frames, which is made; a frame of this very
 * step is written anew. */
int brc_frames_write(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra);
/* Is there a frame, or the series of frames, in dir? Its name from dir on. */
bool brc_frames_find(const char *dir, char *name, size_t size);
/* Removes the frames of an earlier run. */
int brc_frames_remove(struct brc_context *ctx, const char *dir);

#endif
