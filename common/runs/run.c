/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything that can be refused is refused before the folder is touched; the kept case is written
 * first, as it tells whether there is room; results are measured from the state alone, so that a
 * run that was resumed measures the same. */
#include "common/runs/run.h"

#include "common/base/folders.h"
#include "common/base/signals.h"
#include "common/rigs/acoustic.h"
#include "common/rigs/crack_fabric.h"
#include "common/rigs/curve.h"
#include "common/rigs/loading.h"
#include "common/rigs/sieve.h"
#include "common/engine/blowup.h"
#include "common/engine/fragments.h"
#include "common/output/frames.h"
#include "common/output/plot.h"
#include "common/runs/case_keep.h"
#include "common/runs/case_text.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { DESCRIPTION_SIZE = 4096 };

/* What a run counts beside its state; goes on when it is resumed. */
#define RUN_COUNTS(SCALAR, VECTOR)                                                             \
    SCALAR(double, cpu_s, BRC_STATE, "s", "processor time of the step loop")                   \
    SCALAR(double, wall_s, BRC_STATE, "s", "elapsed time of the step loop")                    \
    SCALAR(double, contact_steps, BRC_STATE, "1", "contacts with a spring, summed over steps") \
    SCALAR(int64_t, n_active, BRC_STATE, "1", "contacts with a spring at the last count")

#define COUNT_MEMBER(type, name, flags, unit, meaning) type name;
#define NO_VECTOR(type, name, n, flags, unit, meaning)
struct counts {
    RUN_COUNTS(COUNT_MEMBER, NO_VECTOR)
};
#define BRC_OWNER struct counts
static const struct brc_field count_fields[] = {RUN_COUNTS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

struct run {
    struct brc_context *ctx;
    const struct brc_run_options *options;
    struct brc_sim sim;
    struct counts counts;
    struct brc_frames frames;
    char *case_text, *parameters, seed[16]; /* for the files */
    /* what files tell of their origin, and what a state holds beside the simulation */
    struct brc_h5_text texts[4];
    struct brc_state_part parts[2];
    struct brc_h5_extra extra; /* those */
    FILE *log;
    double cpu_before, wall_before;
    double saved_at; /* s, wall clock at the last save */
    const char *ended_by;
};

/* ---- folder -------------------------------------------------------------------------------- */

/* A new run in an old folder. The case takes its place first: on a full disk that fails, and the
 * old results are still there. */
static int replace_old(struct run *r)
{
    const struct brc_run_options *o = r->options;
    BRC_TRY(brc_run_keep_case(r->ctx, o->dir, o->run_case, r->case_text, true));
    BRC_TRY(brc_run_remove_results(r->ctx, o->dir));
    if (ftruncate(fileno(r->log), 0) != 0)
        BRC_FAIL(r->ctx, BRC_ERR_IO, "cannot empty the log in %s: %s", o->dir, strerror(errno));
    return 0;
}

/* The log is flushed line by line: it is what is left of a run that was killed. */
static void __attribute__((format(printf, 2, 3))) log_line(struct run *r, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vfprintf(r->log, format, args);
    va_end(args);
    fputc('\n', r->log);
    fflush(r->log);
}

/* ---- state --------------------------------------------------------------------------------- */

/* Of the whole process: the cost of a run includes what its threads do. */
static double cpu_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Anew for each file, as the table of frames grows. */
static const struct brc_h5_extra *extra_of(struct run *r)
{
    r->texts[0] = (struct brc_h5_text){"case", r->case_text};
    r->texts[1] = (struct brc_h5_text){"case_name", r->options->run_case->name};
    r->texts[2] = (struct brc_h5_text){"parameters", r->parameters};
    r->texts[3] = (struct brc_h5_text){"seed", r->seed};
    r->parts[0] = (struct brc_state_part){.path = "run",
                                          .set = BRC_FIELDSET(count_fields, struct counts),
                                          .base = &r->counts,
                                          .n = 1,
                                          .is_fixed = true};
    r->parts[1] = (struct brc_state_part){.path = "frames",
                                          .set = r->frames.table.set,
                                          .table = &r->frames.table,
                                          .n = r->frames.table.n};
    r->extra = (struct brc_h5_extra){r->texts, 4, r->parts, 2};
    return &r->extra;
}

/* Times go on over the parts of a resumed run, so they are counters of the state, fed between
 * saves. Frames first: the state tells which of them are its own, and what a stop has left in
 * between is swept away when the run goes on. */
static int save(struct run *r)
{
    char path[BRC_PATH_SIZE];
    double cpu = cpu_now(), wall = brc_progress_clock();
    r->counts.cpu_s += cpu - r->cpu_before;
    r->counts.wall_s += wall - r->wall_before;
    r->cpu_before = cpu;
    r->wall_before = wall;
    BRC_TRY(brc_frames_flush(r->ctx, &r->frames, r->options->dir, extra_of(r)));
    BRC_TRY(brc_folder_path(r->ctx, r->options->dir, "state.h5", path));
    BRC_TRY(brc_h5_save(r->ctx, path, &r->sim, extra_of(r)));
    BRC_TRY(brc_frames_sweep(r->ctx, &r->frames, r->options->dir));
    /* limits of a run that goes on may have changed: so does the case, with the state */
    BRC_TRY(brc_run_keep_case(r->ctx, r->options->dir, r->options->run_case, r->case_text, false));
    r->saved_at = brc_progress_clock();
    return 0;
}

/* Named before parameters are compared: another model has others anyway, and the message would name
 * the first of them instead. */
static int check_model(struct run *r, const char *path)
{
    char *saved;
    int code = 0;
    BRC_TRY(brc_h5_read_text(r->ctx, path, "model", &saved));
    if (strcmp(saved, r->options->model->name) != 0)
        code = brc_error_set(r->ctx, BRC_ERR_INPUT, __FILE__, __LINE__,
                             "%s is a state of the model %s, not %s; choose it with --model, or "
                             "another folder with -o",
                             path, saved, r->options->model->name);
    free(saved);
    return code;
}

/* A state is taken only by the case that has made it: model, then parameters by name and text, then
 * (io_h5) specimen and fields. */
static int load(struct run *r)
{
    char path[BRC_PATH_SIZE], *saved;
    BRC_TRY(brc_folder_path(r->ctx, r->options->dir, "state.h5", path));
    BRC_TRY(check_model(r, path));
    BRC_TRY(brc_h5_read_text(r->ctx, path, "parameters", &saved));
    int code = brc_case_same(r->ctx, saved, r->parameters);
    free(saved);
    BRC_TRY(code);
    BRC_TRY(brc_h5_load(r->ctx, path, &r->sim, extra_of(r)));
    return brc_frames_sweep(r->ctx, &r->frames, r->options->dir);
}

/* ---- step loop ----------------------------------------------------------------------------- */

/* Over the contacts of grains and of platens. */
struct totals {
    size_t active; /* carry a spring */
    size_t points;
    double stiffness; /* N/m */
};

/* A pass over all rows, since models open and close springs by themselves and keep no count. */
static struct totals total(const struct brc_sim *sim)
{
    const struct brc_contacts *const sets[] = {&sim->pairs, &sim->platens};
    struct totals t = {0};
    for (int s = 0; s < 2; s++)
        for (size_t i = 0; i < sets[s]->n; i++) {
            t.active += sets[s]->k[i][0] > 0;
            t.points += (size_t)sets[s]->np[i];
            t.stiffness += sets[s]->k[i][0];
        }
    return t;
}

/* Time left is told by the loading, as far as it knows, and by max_steps, whichever comes first. */
static void report(struct run *r, bool is_done, bool is_stopped)
{
    const struct brc_rig *rig = &r->sim.rig;
    double most = (double)(r->sim.run.max_steps - r->sim.step);
    double by_rate = rig->n_platens > 0 ? brc_loading_steps_left(&r->sim) : most;
    struct brc_progress_report now = {.steps_left = isfinite(by_rate) ? fmin(by_rate, most) : NAN,
                                      .strain = rig->strain,
                                      .stress = rig->force / rig->section,
                                      .step = r->sim.step,
                                      .broken = (int64_t)r->sim.events.table.n,
                                      .is_done = is_done,
                                      .is_stopped = is_stopped};
    brc_progress_update(r->options->progress, 0, &now);
}

/* Why the run is over, NULL while it is not. The ends of the test come first: a signal in the last
 * step does not make a finished run an interrupted one. */
static const char *ended_by(const struct brc_sim *sim)
{
    const char *key = brc_rigs_end(sim);
    if (key)
        return key;
    if (sim->step >= sim->run.max_steps)
        return "run.max_steps";
    return brc_signals_held() ? "signal" : NULL;
}

/* By steps or by elapsed time. When a state is saved changes no bit of it. */
static bool save_is_due(const struct run *r)
{
    const struct brc_run_params *p = &r->sim.run;
    int64_t step = r->sim.step;
    if (p->checkpoint_steps > 0 && step % p->checkpoint_steps == 0)
        return true;
    return p->checkpoint > 0 && brc_progress_clock() - r->saved_at >= p->checkpoint;
}

/* Counting contacts costs a pass over them, so it is done once a row of the curve, and stands for
 * the steps in between. */
static int step_loop(struct run *r)
{
    struct brc_sim *sim = &r->sim;
    const char *dir = r->options->dir;
    const struct brc_output_params *output = &r->options->run_case->output;
    bool has_frames = brc_frames_are_on(output);
    r->cpu_before = cpu_now();
    r->wall_before = r->saved_at = brc_progress_clock();
    while (!(r->ended_by = ended_by(sim))) {
        if (r->counts.n_active == 0 || sim->step % sim->rig.params.sample_steps == 0)
            r->counts.n_active = (int64_t)total(sim).active;
        if (has_frames)
            BRC_TRY(brc_frames_update(r->ctx, &r->frames, dir, output, sim, extra_of(r)));
        BRC_TRY(brc_sim_step(sim));
        BRC_TRY(brc_blowup_energy(sim));
        r->counts.contact_steps += (double)r->counts.n_active;
        if (brc_progress_is_due(r->options->progress))
            report(r, false, false);
        if (save_is_due(r))
            BRC_TRY(save(r));
    }
    BRC_TRY(save(r));
    /* the last frame is no part of the state: a run that goes on replaces it */
    return has_frames && strcmp(r->ended_by, "signal") != 0
               ? brc_frames_write(r->ctx, &r->frames, dir, sim, extra_of(r))
               : 0;
}

/* ---- output -------------------------------------------------------------------------------- */

/* A number that is none would be null in the summary, which says "not measured": a failed
 * computation must not look so. */
static int check_finite(struct brc_context *ctx, const char *name, double value)
{
    if (isfinite(value))
        return 0;
    BRC_FAIL(ctx, BRC_ERR_BLOWUP,
             "the result %s is not finite (%g): values of the case, or what follows from them, are "
             "too large or too small for numbers of double precision",
             name, value);
}

/* A result without a note was measured, and is a number. */
static int check_results(const struct run *r, const struct brc_summary *s)
{
    for (int i = 0; i < s->n_results; i++)
        if (!s->results[i].note)
            BRC_TRY(check_finite(r->ctx, s->results[i].name, s->results[i].value));
    if (!r->sim.run.ledger)
        return 0;
    BRC_TRY(check_finite(r->ctx, "energy_residual", s->energy_residual));
    return check_finite(r->ctx, "energy_drift", s->energy_drift);
}

/* Energies that rounding alone makes: of all springs stretched by this part of the skin. */
static const double ROUNDING = 1e-8;

/* Everything that the summary holds, from the state alone: a run that was resumed at its end
 * measures the same. */
static int measure(struct run *r, struct brc_summary *s)
{
    struct brc_sim *sim = &r->sim;
    const struct brc_case *run_case = r->options->run_case;
    struct totals t = total(sim);
    double stretch = ROUNDING * sim->skin;
    struct brc_fragments fragments;
    double stored[3];
    brc_accounts_settle(sim);
    brc_accounts_stored(sim, stored);
    *s = (struct brc_summary){
        .seed = run_case->specimen.seed,
        .n_grains = sim->bodies.n_grains,
        .n_facets = sim->specimen->facets.n_facets,
        .n_contacts = t.active,
        .n_contacts_listed = sim->pairs.n + sim->platens.n,
        .n_points = t.points,
        .n_frames = r->frames.table.n,
        .steps = sim->step,
        .dt = sim->dt,
        .cpu_s = r->counts.cpu_s,
        .wall_s = r->counts.wall_s,
        .energy_residual = sim->run.ledger ? brc_ledger_residual(&sim->ledger) : NAN,
        .energy_drift = sim->run.ledger ? brc_ledger_drift(&sim->ledger, stored) : NAN,
        .energy_check = sim->run.ledger ? brc_ledger_check(&sim->ledger, stored,
                                                           t.stiffness * stretch * stretch)
                                        : BRC_ENERGY_OFF,
        .ledger = sim->ledger,
        .ledger_at_peak = sim->ledger_at_peak,
        .has_peak = sim->rig.n_platens > 0 && !brc_curve_why_no_peak(&sim->rig),
        .unbalanced_max = brc_curve_unbalanced_max(sim),
        .state_hash = brc_sim_hash(sim)};
    snprintf(s->model, sizeof s->model, "%s", sim->model.name);
    snprintf(s->title, sizeof s->title, "%s", run_case->file.head.title);
    snprintf(s->case_name, sizeof s->case_name, "%s", run_case->name);
    snprintf(s->ended_by, sizeof s->ended_by, "%s", r->ended_by ? r->ended_by : "failure");
    s->is_finished = brc_rigs_done(sim);
    s->n_contacts_mean = r->counts.contact_steps / (double)sim->step;
    s->ns_per_contact_step = 1e9 * r->counts.cpu_s / r->counts.contact_steps;
    s->n_results = brc_rigs_results(sim, s->results);
    BRC_TRY(r->ctx->code); /* memory for readings */
    BRC_TRY(check_results(r, s));
    memcpy(s->frame, r->frames.last, sizeof s->frame);
    int code = brc_fragments_find(r->ctx, sim, &fragments);
    s->n_fragments = fragments.n;
    brc_fragments_free(&fragments);
    return code;
}

/* What a test has to tell along the specimen, beside its curve over the steps. */
static int write_profile(struct run *r)
{
    const struct brc_rig_type *type = r->sim.rig.type;
    struct brc_table table;
    if (type->along.n == 0)
        return 0;
    void *columns = brc_alloc(r->ctx, 1, type->along.owner_size);
    if (!columns)
        return BRC_ERR_MEMORY;
    brc_table_init(&table, "profile", type->along, columns);
    int code = type->profile(&r->sim, &table);
    if (code == 0)
        code = brc_output_csv(r->ctx, r->options->dir, "profile.csv", &table, NULL);
    brc_table_free(&table);
    free(columns);
    return code;
}

/* Apart from the summary: they are written of a run that has failed, too. */
static int write_tables(struct run *r)
{
    const char *dir = r->options->dir;
    BRC_TRY(write_profile(r));
    BRC_TRY(
        brc_output_csv(r->ctx, dir, "curve.csv", &r->sim.rig.curve.table, &r->sim.rig.curve.own));
    return brc_output_csv(r->ctx, dir, "events.csv", &r->sim.events.table, NULL);
}

/* What is read off the finished run, each a table of its own: all are made before one is written.
 */
static int write_readings(struct run *r)
{
    const char *dir = r->options->dir;
    struct brc_acoustic events = {0};
    struct brc_crack_angles angles = {0};
    struct brc_sieve sieve = {0};
    int code = brc_acoustic_find(&r->sim, &events);
    if (code == 0)
        code = brc_crack_angles_measure(r->ctx, &r->sim.events, r->sim.rig.axis, &angles);
    if (code == 0)
        code = brc_sieve_make(&r->sim, &sieve);
    if (code == 0)
        code = brc_output_csv(r->ctx, dir, "events_clustered.csv", &events.table, NULL);
    if (code == 0)
        code = brc_output_csv(r->ctx, dir, "crack_angles.csv", &angles.table, NULL);
    if (code == 0)
        code = brc_output_csv(r->ctx, dir, "fragments.csv", &sieve.table, NULL);
    brc_acoustic_free(&events);
    brc_crack_angles_free(&angles);
    brc_sieve_free(&sieve);
    return code;
}

/* The data of curves and cracks are written without plots, too: the folder can be drawn later, and
 * a comparison draws its runs side by side from them. */
static int draw(struct run *r)
{
    const struct brc_case *run_case = r->options->run_case;
    struct brc_plot_runs runs = {.title = run_case->file.head.title,
                                 .view = brc_rigs_at(run_case->test.kind)->view,
                                 .n = 1,
                                 .label = {r->sim.model.name},
                                 .folder = {"."}};
    BRC_TRY(brc_plot_broken(r->ctx, r->options->dir, &r->sim));
    BRC_TRY(brc_plot_cracks(r->ctx, r->options->dir, &r->sim, &run_case->output));
    bool has_moved = r->sim.step > 0; /* else there is nothing to see */
    return has_moved && run_case->output.plots
               ? brc_plot_draw(r->ctx, r->options->dir, &runs, &run_case->output)
               : 0;
}

/* Tables before the summary, pictures last: whoever waits for summary.json finds all numbers, and a
 * missing gnuplot loses no result. */
static int write_results(struct run *r, struct brc_summary *out)
{
    char energy[512];
    BRC_TRY(measure(r, out));
    BRC_TRY(write_tables(r));
    BRC_TRY(write_readings(r));
    BRC_TRY(brc_output_summary(r->ctx, r->options->dir, "summary.json", out));
    for (int i = 0; i < out->n_results; i++)
        if (out->results[i].note)
            log_line(r, "%s%s: %s", out->results[i].name,
                     isfinite(out->results[i].value) ? "" : " was not measured",
                     out->results[i].note);
    if (*brc_output_energy(out, energy, sizeof energy))
        log_line(r, "%s", energy);
    log_line(r, "ended by %s at step %" PRId64 ", state hash %016" PRIx64, out->ended_by,
             out->steps, out->state_hash);
    return draw(r);
}

/* ---- one run ------------------------------------------------------------------------------- */

/* What one needs to make the run again: version, compiler, case, model, parameters; and the digest
 * by which a kept case is known to be the run's own. */
static void log_header(struct run *r)
{
    char description[DESCRIPTION_SIZE] = "";
    const struct brc_facets *f = &r->options->specimen->facets;
    if (r->sim.model.describe)
        r->sim.model.describe(&r->sim, r->sim.state, description, sizeof description);
    log_line(r, "breccia %s, compiler %s, case %s", BRC_VERSION, __VERSION__,
             r->options->run_case->name);
    log_line(r, "model %s: %s", r->sim.model.name, r->sim.model.citation);
    if (*description)
        log_line(r, "%s", description);
    log_line(r, "%zu grains, %zu facets, %zu pairs, %zu platen contacts", f->n_cells, f->n_facets,
             r->sim.pairs.n, r->sim.platens.n);
    log_line(r, "%s", r->parameters);
    log_line(r, "case.yaml: digest %016" PRIx64, brc_run_case_digest(r->case_text));
}

/* A log that a full disk has cut is a failure, unless there is another; buffered lines fail only as
 * it is closed. */
static int close_log(struct run *r, int code)
{
    if (!r->log)
        return code;
    bool has_failed = ferror(r->log);
    has_failed = fclose(r->log) != 0 || has_failed;
    if (has_failed && code == 0)
        BRC_FAIL(r->ctx, BRC_ERR_IO, "cannot write %s/log; is the disk full? The results are there",
                 r->options->dir);
    return code;
}

/* Everything that can be refused is refused before the folder is touched. The simulation is built
 * first, as it refuses most; a signal in that time leaves the folder as it was. What comes after
 * the folder's making is ordered by what a full disk or another run may do: the case is judged, the
 * log locked, the folder looked at once more, and only then old results go. */
static int prepare(struct run *r)
{
    const struct brc_run_options *o = r->options;
    BRC_TRY(brc_run_check_folder(r->ctx, o));
    r->parameters = brc_case_text(r->ctx, o->run_case, o->model);
    if (!r->parameters)
        return BRC_ERR_MEMORY;
    BRC_TRY(brc_case_sim(r->ctx, o->run_case, o->model, o->specimen, &r->sim));
    if (brc_signals_held())
        BRC_FAIL(r->ctx, BRC_ERR_NOT_BEGUN,
                 "interrupted before the first step; nothing was saved, and %s is as it was",
                 o->dir);
    BRC_TRY(brc_folder_make(r->ctx, o->dir));
    BRC_TRY(brc_case_keep(r->ctx, o->run_case, o->model, o->dir, &r->case_text));
    BRC_TRY(brc_run_check_case(r->ctx, o->dir, o->run_case, r->case_text, o->is_resumed));
    BRC_TRY(brc_run_open(r->ctx, o->dir, "log", &r->log));
    BRC_TRY(brc_run_check_folder(r->ctx, o)); /* another run may have begun, and ended, since */
    bool has_state = o->is_resumed && brc_folder_has(o->dir, "state.h5");
    BRC_TRY(has_state ? load(r) : replace_old(r));
    log_header(r);
    if (has_state)
        log_line(r, "resumed at step %" PRId64, r->sim.step);
    else if (o->is_resumed)
        log_line(r, "nothing was saved before the stop: started anew");
    return 0;
}

/* After a failure the curves so far are kept for a look; the last saved state stays. Where writing
 * has failed, what is there is left alone. A second failure is only logged, as the first one is
 * what counts. */
static void keep_traces(struct run *r)
{
    struct brc_context quiet = BRC_CONTEXT_INIT, *ctx = r->ctx;
    log_line(r, "failed at step %" PRId64 ": %s", r->sim.step, ctx->message);
    if (ctx->code == BRC_ERR_IO)
        return;
    r->ctx = &quiet;
    if (write_tables(r) != 0)
        log_line(r, "the curves could not be written either: %s", quiet.message);
    r->ctx = ctx;
}

/* Results are there whatever the energy says, so that one can look at what went wrong. A run that a
 * signal has ended is not judged yet: it goes on, and is at its end. */
static int check_energy(const struct run *r, const struct brc_summary *s)
{
    char text[512];
    brc_output_energy(s, text, sizeof text);
    if (s->energy_check == BRC_ENERGY_WRONG && strcmp(r->ended_by, "signal") != 0)
        BRC_FAIL(r->ctx, BRC_ERR_ENERGY, "%s; results are in %s", text, r->options->dir);
    if (*text)
        brc_log(r->ctx, "warning: %s", text);
    return 0;
}

/* Whatever happens, the log says it, the progress line ends, and memory is freed; of several
 * failures the first is returned. */
int brc_run(struct brc_context *ctx, const struct brc_run_options *options, struct brc_summary *out)
{
    struct run r = {.ctx = ctx, .options = options};
    brc_frames_init(&r.frames);
    snprintf(r.seed, sizeof r.seed, "%d", options->run_case->specimen.seed);
    bool is_stopped = false;
    int code = prepare(&r);
    if (code == 0) {
        report(&r, false, false);
        code = step_loop(&r);
        if (code != 0)
            keep_traces(&r);
        else
            code = write_results(&r, out);
        is_stopped = code == 0 && strcmp(r.ended_by, "signal") == 0;
        report(&r, true, is_stopped || code != 0);
    }
    if (code == 0)
        code = check_energy(&r, out);
    if (is_stopped)
        code = brc_error_set(ctx, BRC_ERR_INTERRUPTED, __FILE__, __LINE__,
                             "interrupted at step %" PRId64 "; the state is saved in %s",
                             r.sim.step, options->dir);
    brc_sim_free(&r.sim);
    brc_frames_free(&r.frames);
    free(r.case_text);
    free(r.parameters);
    return close_log(&r, code);
}
