/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress of one or several runs side by side: bars that are redrawn on a terminal, a plain line a
 * run every few seconds elsewhere. A run in a child process sends its reports to the parent through
 * a pipe; the parent draws, as two processes that move one cursor would spoil each other's lines.
 * Called by the step loops of runs, and by packing and tessellating, which is why it lies in base;
 * knows nothing of simulations. */
#ifndef BRC_PROGRESS_H
#define BRC_PROGRESS_H

#include "common/base/error.h"

#include <stdio.h>

/* What a run says about itself; plain data. */
struct brc_progress_report {
    double steps_left; /* at most; NAN: not known yet */
    double strain;     /* platen strain */
    double stress;     /* Pa */
    int64_t step, broken;
    bool is_done;
    bool is_stopped; /* done before its end: by a signal or a failure */
};

enum { BRC_PROGRESS_MAX_RUNS = 16 };

struct brc_progress {
    FILE *out;
    bool is_quiet, is_terminal;
    int pipe; /* >= 0: reports go there instead */
    int n, n_drawn;
    double started, last_drawn; /* s */
    struct brc_progress_run {
        char label[64];
        struct brc_progress_report report;
        int64_t step_before;
        double time_before, speed; /* steps a second, smoothed; 0: not known yet */
        bool has_begun, has_ended;
    } run[BRC_PROGRESS_MAX_RUNS];
};

/* Starts n lines named by labels on a stream. quiet: nothing is ever drawn. */
void brc_progress_begin(struct brc_progress *p, FILE *out, const char *const *labels, int n,
                        bool quiet);
/* One run in a child: reports are written to this descriptor. */
void brc_progress_begin_pipe(struct brc_progress *p, int descriptor);
/* Enough time has passed since the last drawing; cheap. */
bool brc_progress_is_due(const struct brc_progress *p);
/* Takes a report of a run and draws what is due. */
void brc_progress_update(struct brc_progress *p, int run, const struct brc_progress_report *report);
/* Draws the last state and leaves the lines on the screen. */
void brc_progress_end(struct brc_progress *p);
/* Progress of work before a run, whose end is known by a fraction alone: a bar on a terminal that
 * is wiped at the end, a line every few seconds elsewhere, nothing at all for what is over at once.
 */
struct brc_work {
    const struct brc_context *ctx;
    const char *what;
    bool is_terminal, is_drawn;
    double started, last_drawn; /* s */
};
void brc_work_begin(struct brc_work *w, const struct brc_context *ctx, const char *what);
void brc_work_update(struct brc_work *w, double fraction);
void brc_work_end(struct brc_work *w);
/* Seconds of a clock that never goes back. */
double brc_progress_clock(void);
/* "1:05", "2:03:04"; returns buffer. */
const char *brc_progress_duration(double seconds, char *buffer, size_t size);

#endif
