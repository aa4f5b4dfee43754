/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports are small enough for one write to a pipe, which is atomic, so children need no lock. The
 * speed is a mean over half a minute: the time left would jump with each burst of breaking bonds.
 */
#include "common/base/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 24, LABEL_WIDTH = 12 };

/* s: on a terminal as often as an eye follows; in a log seldom, as each line stays. */
static const double interval[] = {[false] = 5, [true] = 0.2};
static const double smoothing_time = 30; /* s, of the speed */

/* Not the time of day, which may be set while a run goes on. */
double brc_progress_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

const char *brc_progress_duration(double seconds, char *buffer, size_t size)
{
    long s = lround(seconds);
    if (s >= 3600)
        snprintf(buffer, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(buffer, size, "%ld:%02ld", s / 60, s % 60);
    return buffer;
}

/* Terminals without cursor movements (TERM=dumb, or none: editors, batch systems) get plain lines.
 */
static bool is_terminal(FILE *out)
{
    const char *kind = getenv("TERM");
    return isatty(fileno(out)) && kind && strcmp(kind, "dumb") != 0;
}

void brc_progress_begin(struct brc_progress *p, FILE *out, const char *const *labels, int n,
                        bool quiet)
{
    *p = (struct brc_progress){.out = out, .is_quiet = quiet, .pipe = -1, .n = n};
    p->is_terminal = is_terminal(out);
    p->started = brc_progress_clock();
    /* the first plain line soon, so that a log shows at once that something runs */
    p->last_drawn = p->started + 1 - interval[false];
    for (int i = 0; i < n; i++) {
        snprintf(p->run[i].label, sizeof p->run[i].label, "%s", labels[i]);
        p->run[i].time_before = p->started;
    }
}

void brc_progress_begin_pipe(struct brc_progress *p, int descriptor)
{
    *p = (struct brc_progress){.pipe = descriptor, .n = 1};
    p->started = p->last_drawn = brc_progress_clock();
}

/* A pipe is fed as often as a terminal: what the parent draws on may be one. */
bool brc_progress_is_due(const struct brc_progress *p)
{
    double now = brc_progress_clock();
    return !p->is_quiet && now - p->last_drawn >= interval[p->is_terminal || p->pipe >= 0];
}

/* Steps a second, smoothed over the last seconds: a step costs more or less as contacts open.
 * Reports that follow at once are kept, but say nothing about the speed. */
static void store_report(struct brc_progress_run *run, const struct brc_progress_report *report)
{
    double now = brc_progress_clock(), dt = now - run->time_before;
    run->report = *report;
    if (run->has_begun && dt < 0.05)
        return;
    if (run->has_begun) {
        double speed = (double)(report->step - run->step_before) / dt;
        double weight = run->speed > 0 ? 1 - exp(-dt / smoothing_time) : 1;
        run->speed += weight * (speed - run->speed);
    }
    run->has_begun = true;
    run->step_before = report->step;
    run->time_before = now;
}

/* "at most 1:20 left": the test may end sooner, when the load has dropped. Beyond 100 hours the
 * speed is a guess of the first steps, and says nothing. */
static const char *time_left(const struct brc_progress_run *run, char *buffer, size_t size)
{
    char duration[32];
    double left = run->speed > 0 ? run->report.steps_left / run->speed : NAN;
    if (run->report.is_done)
        snprintf(buffer, size, run->report.is_stopped ? "stopped" : "done");
    else if (left < 360000)
        snprintf(buffer, size, "at most %s left",
                 brc_progress_duration(left, duration, sizeof duration));
    else
        snprintf(buffer, size, "time left unknown");
    return buffer;
}

static void draw_bar(FILE *out, double fraction)
{
    int full = (int)(fraction * BAR_WIDTH + 0.5);
    fputc('[', out);
    for (int i = 0; i < BAR_WIDTH; i++)
        fputc(i < full ? '#' : '.', out);
    fputc(']', out);
}

static void draw_run(const struct brc_progress *p, const struct brc_progress_run *run)
{
    const struct brc_progress_report *r = &run->report;
    char left[64], elapsed[32];
    double steps =
        (double)r->step + r->steps_left; /* NAN while the end is not known: no bar then */
    brc_progress_duration(brc_progress_clock() - p->started, elapsed, sizeof elapsed);
    fprintf(p->out, "%-*s ", LABEL_WIDTH, run->label);
    if (p->is_terminal)
        draw_bar(p->out, r->is_done ? 1 : steps > 0 ? (double)r->step / steps : 0);
    fprintf(p->out,
            " step %7" PRId64 "  strain %.4f %%  stress %8.3f MPa  broken %6" PRId64 "  %s  %s",
            r->step, 100 * r->strain, 1e-6 * r->stress, r->broken, elapsed,
            time_left(run, left, sizeof left));
    fputs(p->is_terminal ? "\033[K\n" : "\n", p->out);
}

/* On a terminal all lines are written over each other, whichever run reported: they are few, and
 * parts of the screen need not be known. Elsewhere a run that has ended is told of once. */
static void draw(struct brc_progress *p)
{
    if (p->is_terminal && p->n_drawn > 0)
        fprintf(p->out, "\033[%dA", p->n_drawn);
    p->n_drawn = p->n;
    for (int i = 0; i < p->n; i++) {
        struct brc_progress_run *run = &p->run[i];
        if (!p->is_terminal && run->has_ended)
            continue;
        draw_run(p, run);
        run->has_ended = run->report.is_done;
    }
    fflush(p->out);
    p->last_drawn = brc_progress_clock();
}

/* What is written to a full pipe waits and is not dropped: reports are smaller than what a pipe
 * takes at once. A parent that has gone is noticed elsewhere. */
void brc_progress_update(struct brc_progress *p, int run, const struct brc_progress_report *report)
{
    if (p->is_quiet)
        return;
    if (p->pipe >= 0) {
        ssize_t sent = write(p->pipe, report, sizeof *report);
        (void)sent;
        p->last_drawn = brc_progress_clock();
        return;
    }
    store_report(&p->run[run], report);
    if (brc_progress_is_due(p) || report->is_done)
        draw(p);
}

void brc_progress_end(struct brc_progress *p)
{
    if (p->is_quiet || p->pipe >= 0)
        return;
    bool all_ended = true;
    for (int i = 0; i < p->n; i++)
        all_ended = all_ended && p->run[i].has_ended;
    if (!all_ended)
        draw(p);
}

void brc_work_begin(struct brc_work *w, const struct brc_context *ctx, const char *what)
{
    *w = (struct brc_work){.ctx = ctx, .what = what, .is_terminal = is_terminal(stderr)};
    w->started = brc_progress_clock();
    w->last_drawn = w->started + 1 - interval[w->is_terminal];
}

void brc_work_update(struct brc_work *w, double fraction)
{
    double now = brc_progress_clock();
    if (w->ctx->quiet || now - w->last_drawn < interval[w->is_terminal])
        return;
    char elapsed[32];
    brc_progress_duration(now - w->started, elapsed, sizeof elapsed);
    w->last_drawn = now;
    if (!w->is_terminal) {
        brc_log(w->ctx, "%s: %.0f %%, %s", w->what, 100 * fraction, elapsed);
        return;
    }
    fprintf(stderr, "%s%-*s ", w->is_drawn ? "\r" : "", LABEL_WIDTH, w->what);
    draw_bar(stderr, fraction);
    fprintf(stderr, "  %s\033[K", elapsed);
    fflush(stderr);
    w->is_drawn = true;
}

void brc_work_end(struct brc_work *w)
{
    if (w->is_drawn)
        fputs("\r\033[K", stderr);
    w->is_drawn = false;
}
