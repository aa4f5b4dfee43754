/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line: commands and options are tables, from which help, the manual page, completion
 * and the reader come, so that none of them can name an option that another does not know. getopt
 * would not do: it knows neither commands with options of their own nor the name that was meant.
 *
 * Nothing is done here but to choose what other rooms do. The order matters twice: what can be
 * refused is refused before a specimen is made, which may take minutes, and signals are held before
 * MPI starts its threads. */
#include "calib/bursts.h"
#include "calib/envelope_runs.h"
#include "common/parallel/comm.h"
#include "common/runs/compare.h"
#include "common/base/console.h"
#include "common/base/folders.h"
#include "common/base/signals.h"
#include "common/runs/converge.h"
#include "common/runs/export.h"
#include "common/output/info.h"
#include "common/runs/reference.h"
#include "common/runs/run.h"
#include "common/runs/sweep.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* More than anybody types: what a script sets beyond that belongs into a case file, which is kept
 * with the results as it stands. */
enum { MAX_OVERRIDES = 256 };

/* What a command was asked for. Members that options fill are found by their offsets. */
struct options {
    const char *operand;   /* CASE, or the section of `params`, or a file */
    const char **operands; /* of commands that take any number; the last one is also `operand` */
    size_t n_operands;
    const char *out, *table, *format, *pack;
    /* The ladder's own, and what a run is told: its members are those of runs and comparisons, too,
     * so that an option of several commands has one place. */
    struct brc_converge_options ladder;
    struct brc_sweep_options sweep;
    const char *overrides[MAX_OVERRIDES];
    int n_overrides;
    bool is_quiet, is_help, is_residual, can_resume; /* the last: the command has --resume */
    const char *program;
    /* The command and its words without flags, for the command that goes on: moved to the front of
     * argv as they are read. A program may change argv, so that no copy of
     * it, and no bound, is needed. */
    char **kept;
    int n_kept;
};

/* ---- commands ------------------------------------------------------------------------------ */

/* A large packing takes minutes in which there is nothing to save: signals end the program at once
 * until it is there, and are held for the step loop from then on. */
static int make_specimen(struct brc_context *ctx, const struct brc_case *run_case,
                         struct brc_specimen *specimen)
{
    brc_signals_leave();
    BRC_TRY(brc_specimen_create(ctx, &run_case->specimen, specimen));
    brc_log(ctx, "%s: %zu grains, %zu facets", run_case->name, specimen->facets.n_cells,
            specimen->facets.n_facets);
    brc_specimen_warn(ctx, specimen);
    brc_signals_hold();
    return 0;
}

/* After the signals are held: threads that MPI starts under a launcher must hold them, too. Ranks
 * are counted to refuse them: N processes of one run would write over each other in one folder. */
static int start_single(struct brc_context *ctx)
{
    struct brc_comm all;
    BRC_TRY(brc_comm_start(ctx, &all));
    int size = brc_comm_of(ctx)->size;
    ctx->comm = NULL;
    if (size > 1)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "this version runs in one process; start it without mpirun");
    return 0;
}

/* The option wins over the case, so that one case file serves all models. */
static const char *model_of(const struct options *o)
{
    return o->ladder.model ? o->ladder.model : o->ladder.run.run_case->file.head.model;
}

/* The folder is looked at before the specimen is made, and once more by the run itself under its
 * lock: minutes lie between the two. */
static int run_model(struct brc_context *ctx, const struct options *o)
{
    struct brc_specimen specimen = {0};
    struct brc_progress progress;
    struct brc_summary summary;
    const struct brc_summary *row = &summary;
    struct brc_run_options run = o->ladder.run;
    const char *name = model_of(o);
    if (!*name)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s names no model; add 'model: NAME' or use --model NAME",
                 o->operand);
    BRC_TRY(brc_case_model(ctx, name, &run.model));
    BRC_TRY(brc_run_check_folder(ctx, &run));
    run.specimen = &specimen;
    run.progress = &progress;
    int code = make_specimen(ctx, run.run_case, &specimen);
    if (code == 0)
        code = start_single(ctx);
    if (code == 0) {
        brc_progress_begin(&progress, stderr, &name, 1, o->is_quiet);
        code = brc_run(ctx, &run, &summary);
        brc_progress_end(&progress);
    }
    if (code == 0 || code == BRC_ERR_ENERGY)
        brc_compare_table(stdout, &row, 1);
    brc_specimen_free(&specimen);
    return code;
}

/* MPI is not started here, as the models run in forked processes, which must not have its threads
 * and connections. */
static int compare_models(struct brc_context *ctx, const struct options *o)
{
    struct brc_specimen specimen = {0};
    struct brc_run_options run = o->ladder.run;
    run.specimen = &specimen;
    int code = make_specimen(ctx, run.run_case, &specimen);
    if (code == 0)
        code = brc_compare(ctx, &run);
    brc_specimen_free(&specimen);
    return code;
}

/* A power of two, as rungs are a factor of two apart and one of them must be the case as written.
 */
static int run_ladder(struct brc_context *ctx, const struct options *o)
{
    int refine = o->ladder.refine;
    if (refine < 2 || (refine & (refine - 1)) != 0)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--refine takes a power of 2 from 2 to %d, not %d",
                 BRC_CONVERGE_MAX_REFINE, refine);
    brc_signals_hold(); /* at once: a ladder keeps each run that is finished */
    return brc_converge(ctx, &o->ladder);
}

static int act_sweep(struct brc_context *ctx, const struct options *o)
{
    struct brc_sweep_options sweep = o->sweep;
    sweep.path = o->operand;
    sweep.set = o->overrides;
    sweep.n_set = o->n_overrides;
    brc_signals_hold(); /* at once: each run that is finished is kept */
    return brc_sweep(ctx, &sweep);
}

/* From the file alone, so that one of another version, or one whose case is gone, can still be
 * looked at. */
static int act_info(struct brc_context *ctx, const struct options *o)
{
    return brc_info_print(ctx, stdout, o->operand);
}

/* Either a table or a format. Both have their values in -o FILE or on standard output, and neither
 * is a default of the other. */
static int act_export(struct brc_context *ctx, const struct options *o)
{
    const char *what = o->format ? o->format : o->table;
    if (!what || (o->format && o->table))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "export needs either --table NAME or --format stl or tess");
    const struct brc_export_options options = {o->operand, o->out, o->ladder.run.is_forced};
    return o->table ? brc_export_table(ctx, &options, o->table)
                    : brc_export_format(ctx, &options, o->format);
}

static int act_envelope(struct brc_context *ctx, const struct options *o)
{
    return calib_envelope(ctx,
                          &(struct calib_envelope_options){.run = o->operands,
                                                           .n = o->n_operands,
                                                           .dir = o->out,
                                                           .is_residual = o->is_residual,
                                                           .is_forced = o->ladder.run.is_forced});
}

static int act_bursts(struct brc_context *ctx, const struct options *o)
{
    return calib_bursts(ctx, &(struct calib_bursts_options){.run = o->operands,
                                                            .n = o->n_operands,
                                                            .dir = o->out,
                                                            .pack = o->pack,
                                                            .is_forced = o->ladder.run.is_forced});
}

static int act_params(struct brc_context *ctx, const struct options *o)
{
    return brc_reference_params(ctx, o->operand);
}

static int act_models(struct brc_context *ctx, const struct options *o)
{
    (void)ctx, (void)o;
    brc_reference_models();
    return 0;
}

static int act_tests(struct brc_context *ctx, const struct options *o)
{
    (void)ctx, (void)o;
    brc_reference_tests();
    return 0;
}

/* ---- tables -------------------------------------------------------------------------------- */
/* Behind the functions that they name, so that none has to be declared twice. */

#define AT(member) offsetof(struct options, member)

/* Options by command: R run, C compare, V converge, S sweep, X export, E envelope, B bursts. One
 * name may stand in several rows, where commands mean different things by it. */
static const struct option {
    const char *name, *value; /* value NULL: a flag */
    size_t member;
    int largest; /* of a whole number; 0: the value is a text */
    const char *commands, *help;
} option_table[] = {
    {"--model", "NAME", AT(ladder.model), 0, "R", "contact model; default: `model` of the case"},
    {"--model", "NAME", AT(ladder.model), 0, "V",
     "this model alone; default: those that compare runs"},
    {"-o", "DIR", AT(out), 0, "V", "folder of results; default: results/<case>"},
    {"--observable", "NAME", AT(ladder.observable), 0, "V",
     "the result to look at; default: strength"},
    {"--axes", "LIST", AT(ladder.axes), 0, "V",
     "of step, loading, rate, grains, points, features, ...; default: all"},
    {"--seeds", "N", AT(ladder.seeds), BRC_CONVERGE_MAX_SEEDS, "V",
     "specimens, seeds from that of the case on; default: 4"},
    {"--refine", "N", AT(ladder.refine), BRC_CONVERGE_MAX_REFINE, "V",
     "loading of the reference finer by this power of 2, half the step; default: 8"},
    {"--jobs", "N", AT(ladder.jobs), BRC_PROGRESS_MAX_RUNS, "V",
     "runs at a time; default: 1, for times that nothing disturbs"},
    {"-o", "DIR", AT(sweep.dir), 0, "S", "folder of tables; default: results/<name of FILE>"},
    {"--dry-run", NULL, AT(sweep.is_dry), 0, "S",
     "check all runs, print them and the time that they will take"},
    {"--jobs", "N", AT(sweep.jobs), BRC_SWEEP_MAX_JOBS, "S",
     "runs at a time; default: all processors"},
    {"--cache", "FILE", AT(sweep.cache), 0, "S",
     "where finished runs are kept; default: `cache` of FILE, else DIR/runs.jsonl"},
    {"--verify", "PART", AT(sweep.verify), 0, "S",
     "do a random part of the kept runs again, as 2%, and compare to the bit"},
    {"--fresh", NULL, AT(sweep.is_fresh), 0, "S", "do all runs again, whatever is kept"},
    {"--keep", NULL, AT(sweep.keeps), 0, "S", "keep the folder of each run, in DIR/runs"},
    {"-o", "DIR", AT(out), 0, "RC",
     "folder of results; default: results/<case>/<model>, results/<case>"},
    {"-o", "DIR", AT(out), 0, "E", "folder of tables and picture; default: the table is printed"},
    {"--residual", NULL, AT(is_residual), 0, "E", "of what is left at the end, not of the peaks"},
    {"-o", "DIR", AT(out), 0, "B", "folder of tables; default: the fits are printed"},
    {"--pack", "FILE", AT(pack), 0, "B",
     "write all breaks to this .csv, which stands for the runs from then on"},
    {"-o", "FILE", AT(out), 0, "X", "what to write; default: on standard output"},
    {"--table", "NAME", AT(table), 0, "X", "CSV of this table: curve, events, bodies, pairs, ..."},
    {"--format", "FORMAT", AT(format), 0, "X",
     "stl: a solid a fragment; tess: the specimen for Neper"},
    {"--set", "KEY=VALUE", AT(overrides), 0, "RCVS",
     "replace a value of the case, as vgcm.e_bar=\"50 GPa\"; repeatable"},
    {"--resume", NULL, AT(ladder.run.is_resumed), 0, "RC",
     "go on from the saved state, to the same bits"},
    {"--resume", NULL, AT(ladder.run.is_resumed), 0, "V",
     "keep finished runs, go on with the others"},
    {"--force", NULL, AT(ladder.run.is_forced), 0, "RCVEB", "replace results that are there"},
    {"--force", NULL, AT(sweep.is_forced), 0, "S", "replace tables that are there"},
    {"--force", NULL, AT(ladder.run.is_forced), 0, "X", "replace the file that is there"},
    {"--quiet", NULL, AT(is_quiet), 0, "RCVS", "no progress, no log lines"},
    {"--help", NULL, AT(is_help), 0, "RCVEBSPMIXT", "this text"},
};
enum { N_OPTIONS = sizeof option_table / sizeof option_table[0] };

struct command {
    const char *name;
    char letter;   /* in option.commands: a list of names a row would leave no room for its help */
    bool has_case; /* the operand is one, and is read before */
    const char *operand, *does, *example, *more;
    /* One table of both kinds, so that neither help nor completion has to know which is which. */
    int (*act)(struct brc_context *ctx, const struct options *o);
};

/* Examples can be pasted where the sources are, as they name the cases that come with them. */
static const struct command commands[] = {
    {"run", 'R', true, "CASE", "run one model through the test of a case file",
     "breccia run cases/demo_tension.yaml --model vgcm -o results/first --set specimen.seed=2",
     "Writes summary.json, curve.csv, events.csv, state.h5, case.yaml, log and pictures.\n"
     "Ctrl-C saves the state and ends with status 7; the same command with --resume goes on.\n",
     run_model},
    {"compare", 'C', true, "CASE", "run all models of a case side by side and print a table",
     "breccia compare cases/demo_tension.yaml -o results/pair",
     "Each model's results go to DIR/<model>; the table to DIR/compare.txt, the pictures to DIR.\n",
     compare_models},
    {"converge", 'V', true, "CASE",
     "what accuracy costs: ladders of settings against a finer reference",
     "breccia converge cases/demo_tension.yaml --observable E --axes step,loading --seeds 8",
     "Runs the case with one setting changed at a time, on several specimens, with all models;\n"
     "tells error, its uncertainty and cost of each, and the cheapest within 1 % and 5 %. Writes\n"
     "converge.txt, converge.csv, converge_runs.csv and converge.png; finished runs are never "
     "lost.\n",
     run_ladder},
    {"envelope", 'E', false, "RUN...", "fit Mohr-Coulomb and Hoek-Brown through the peaks of runs",
     "breccia envelope results/confined_*/vgcm -o results/envelope",
     "RUN is a folder of results of compression, direct tension or a confined test, or a .csv of\n"
     "stresses with columns as 'sigma_3 [MPa],sigma_1 [MPa]'; with -o writes envelope.csv,\n"
     "envelope_fits.csv and envelope.png. Runs without a peak are left out.\n",
     act_envelope},
    {"bursts", 'B', false, "RUN...", "how bonds break in bursts: exponents of all breaks of runs",
     "breccia bursts results/confined_*/polyhedra -o results/bursts",
     "RUN is a folder of results, or a .csv that --pack has written. Fits a line to the histogram "
     "of\n"
     "breaks in equal spans of strain, and power laws to avalanches; with -o writes bursts.csv "
     "and\n"
     "bursts_histogram.csv.\n",
     act_bursts},
    {"sweep", 'S', false, "FILE", "many runs: all combinations of values, seeds, models and cases",
     "breccia sweep cases/sweeps/strength.yaml --dry-run",
     "Runs all combinations of the axes of a sweep file side by side, or over the ranks of "
     "mpirun;\n"
     "writes sweep.csv (means, standard errors, 95 % intervals), runs.csv and sweep.h5. Finished "
     "runs\n"
     "are kept under a hash of their complete input and are not done again: the same command goes "
     "on.\n",
     act_sweep},
    {"info", 'I', false, "FILE", "tell what a saved state or a frame holds",
     "breccia info results/pair/vgcm/state.h5",
     "Prints case, seed, version, step, counts, and each field with its unit and meaning.\n",
     act_info},
    {"export", 'X', false, "FILE", "write tables, fragments or the specimen for other programs",
     "breccia export results/pair/vgcm/state.h5 --format stl -o fragments.stl",
     "FILE is a saved state, or for --format tess a case file, too.\n", act_export},
    {"params", 'P', false, "[SECTION]",
     "list the keys of a section of the case file: a model, specimen, test, run, output",
     "breccia params vgcm", "Without a section: all of them.\n", act_params},
    {"models", 'M', false, "", "list the contact models", "breccia models", "", act_models},
    {"tests", 'T', false, "",
     "list the tests: keys of `test:` that each uses, and what it measures", "breccia tests", "",
     act_tests},
};
enum { N_COMMANDS = sizeof commands / sizeof commands[0] };

/* ---- help ---------------------------------------------------------------------------------- */

/* From the list of errors, in which several share a status: those stand on one line. */
static void print_statuses(FILE *out)
{
    int last = -1;
    fputs("exit status:\n", out);
#define STATUS_LINE(name, code, status, text)                               \
    if ((status) != last)                                                   \
        fprintf(out, "%s  %d  %s", last < 0 ? "" : "\n", (status), (text)); \
    else                                                                    \
        fprintf(out, "; %s", (text));                                       \
    last = (status);
    BRC_ERRORS(STATUS_LINE)
#undef STATUS_LINE
    fputc('\n', out);
}

/* The manual page and the completion of the shell are made from what these two print
 * (docs/make-man, docs/make-completion), so that their form is part of the interface. */
static void print_help(FILE *out)
{
    fputs("breccia " BRC_VERSION ": fracture of bonded-grain rock, contact models side by side\n\n"
          "usage: breccia COMMAND [OPTION]...\n\ncommands:\n",
          out);
    for (int i = 0; i < N_COMMANDS; i++)
        fprintf(out, "  %-8s %-10s %s\n", commands[i].name, commands[i].operand, commands[i].does);
    fputs("\n  breccia COMMAND --help    options and an example\n"
          "  breccia --version\n\n"
          "example: breccia compare cases/demo_compression.yaml\n\n",
          out);
    print_statuses(out);
}

/* Rows of the table in their order: options that belong together stand together there. */
static void print_command_help(FILE *out, const struct command *c)
{
    fprintf(out, "usage: breccia %s%s%s%s\n\n%s\n%s", c->name, *c->operand ? " " : "", c->operand,
            strchr("RCVES", c->letter) ? " [OPTION]..." : "", c->does, c->more);
    fputs("\noptions:\n", out);
    for (int i = 0; i < N_OPTIONS; i++) {
        char left[40];
        if (!strchr(option_table[i].commands, c->letter))
            continue;
        snprintf(left, sizeof left, "%s %s", option_table[i].name,
                 option_table[i].value ? option_table[i].value : "");
        fprintf(out, "  %-18s %s\n", left, option_table[i].help);
    }
    fprintf(out, "\nexample:\n  %s\n\n", c->example);
    print_statuses(out);
}

/* ---- reading the command line -------------------------------------------------------------- */

/* By the whole name: names that are cut are not taken, as the next version may have another option
 * that begins alike. */
static const struct option *find_option(const struct command *c, const char *name, size_t length)
{
    for (int i = 0; i < N_OPTIONS; i++)
        if (strchr(option_table[i].commands, c->letter) && strlen(option_table[i].name) == length &&
            strncmp(option_table[i].name, name, length) == 0)
            return &option_table[i];
    return NULL;
}

/* The options of other commands are no candidates: to be sent from one command to an option of
 * another would help nobody. */
static int fail_option(struct brc_context *ctx, const struct command *c, const char *text)
{
    char name[64], hint[BRC_HINT_SIZE];
    struct brc_nearest nearest = {.text = name};
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    for (int i = 0; i < N_OPTIONS; i++)
        if (strchr(option_table[i].commands, c->letter))
            brc_nearest_add(&nearest, option_table[i].name);
    brc_nearest_hint(&nearest, hint);
    BRC_FAIL(ctx, BRC_ERR_USAGE, "%s has no option '%s'%s%s", c->name, name, hint,
             *hint ? "" : "; see breccia COMMAND --help");
}

/* Numbers are bounded by the table: what a user types is refused here, with the name of the option,
 * and no other room has to judge it again.
 *
 * Puts the value, NULL for a flag, where the table says. Of an option that is given twice the last
 * value counts, but for --set, of which each is one more. */
static int read_option(struct brc_context *ctx, struct options *o, const struct option *option,
                       const char *value)
{
    void *member = (char *)o + option->member;
    if (!value) {
        *(bool *)member = true;
    } else if (option->largest > 0) {
        char *end;
        long n = strtol(value, &end, 10);
        if (*end || n < 1 || n > option->largest)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes a whole number from 1 to %d, not '%.40s'",
                     option->name, option->largest, value);
        *(int *)member = (int)n;
    } else if (option->member == AT(overrides)) {
        if (o->n_overrides == MAX_OVERRIDES)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "more than %d --set; write a case file", MAX_OVERRIDES);
        o->overrides[o->n_overrides++] = value;
    } else {
        *(const char **)member = value;
    }
    return 0;
}

static bool takes_many(const struct command *c)
{
    return strstr(c->operand, "...") != NULL;
}

/* One word of the command line, with the next one where it needs a value. Flags are not kept: the
 * command that goes on says --resume, in place of --force, and is not quiet. */
static int read_word(struct brc_context *ctx, const struct command *c, char **words, int *i,
                     struct options *o)
{
    char *word = words[*i];
    if (word[0] != '-') {
        bool is_more = o->operand && !takes_many(c);
        if (is_more || !*c->operand)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes %s, '%.80s' is too much", c->name,
                     *c->operand ? c->operand : "no operand", word);
        o->operand = o->operands[o->n_operands++] = o->kept[o->n_kept++] = word;
        return 0;
    }
    size_t length = strcspn(word, "=");
    const struct option *option = find_option(c, word, length);
    if (!option)
        return fail_option(ctx, c, word);
    const char *value = word[length] == '=' ? word + length + 1 : NULL;
    if (value && !option->value)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes no value", option->name);
    if (option->value)
        o->kept[o->n_kept++] = word;
    if (!value && option->value && words[*i + 1])
        value = o->kept[o->n_kept++] = words[++*i];
    if (option->value && !(value && *value))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s needs a value: %s %s", option->name, option->name,
                 option->value);
    return read_option(ctx, o, option, value);
}

/* ---- the program --------------------------------------------------------------------------- */

/* Here and not in each command, so that all name folders and tell of the case in the same way.
 *
 * Reads the case for a command, and tells in its message where in the case a failure comes from.
 * Results go where the user says, else by the names of the case and, for a run, of its model. A
 * path that is cut here is refused later, as too long for any file in it. */
static int act_on_case(struct brc_context *ctx, const struct options *o, const struct command *c)
{
    char dir[BRC_PATH_SIZE];
    struct brc_case run_case;
    int code = brc_case_read(ctx, &run_case, o->operand, o->overrides, o->n_overrides);
    /* a copy: the options outlive the case and the name of its folder, as print_resume needs them
     */
    struct options own = *o;
    own.ladder.run.run_case = &run_case;
    own.ladder.run.dir = dir;
    if (code == 0) {
        const char *model = c->act == run_model ? model_of(&own) : "";
        if (o->out)
            snprintf(dir, sizeof dir, "%s", o->out);
        else
            snprintf(dir, sizeof dir, "results/%s%s%s", run_case.name, *model ? "/" : "", model);
        code = c->act(ctx, &own);
        brc_case_locate(ctx, &run_case);
    }
    if (code == 0 || code == BRC_ERR_ENERGY) /* wrong ones are kept, too: the status says so */
        printf("results in %s\n", dir);
    brc_case_free(&run_case);
    return code;
}

/* Words are judged together only when all are read: with --help anything may be missing. */
static int act(struct brc_context *ctx, const struct command *c, char **words, struct options *o)
{
    bool needs_file = *c->operand && *c->operand != '[';
    o->kept = words;
    o->n_kept = 1; /* the command itself */
    o->can_resume = find_option(c, "--resume", strlen("--resume")) != NULL;
    for (int i = 1; words[i]; i++)
        BRC_TRY(read_word(ctx, c, words, &i, o));
    /* by the context, from which the processes of a comparison or a ladder have it, too */
    ctx->quiet = o->is_quiet;
    if (o->is_help) {
        print_command_help(stdout, c);
        return 0;
    }
    if (needs_file && !o->operand)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s needs a %s: %s", c->name,
                 strcmp(c->operand, "CASE") == 0 ? "case file"
                 : takes_many(c)                 ? "folder of a run"
                                                 : "file",
                 c->example);
    if (o->ladder.run.is_resumed && o->ladder.run.is_forced)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--resume and --force exclude each other");
    return c->has_case ? act_on_case(ctx, o, c) : c->act(ctx, o);
}

/* --help and --version are no rows of the table: they take neither operand nor options.
 *
 * Without a word the help goes to standard error, with the status of a bad command line: a script
 * that has lost its arguments shall notice. */
static int act_first(struct brc_context *ctx, char **words, struct options *o)
{
    char hint[BRC_HINT_SIZE];
    struct brc_nearest nearest = {.text = words[0]};
    if (!words[0]) {
        print_help(stderr);
        return BRC_ERR_USAGE;
    }
    for (int i = 0; i < N_COMMANDS; i++) {
        if (strcmp(words[0], commands[i].name) == 0)
            return act(ctx, &commands[i], words, o);
        brc_nearest_add(&nearest, commands[i].name);
    }
    if (strcmp(words[0], "--help") == 0 || strcmp(words[0], "-h") == 0) {
        print_help(stdout);
        return 0;
    }
    if (strcmp(words[0], "--version") == 0) {
        puts("breccia " BRC_VERSION);
        return 0;
    }
    brc_nearest_add(&nearest, "--help");
    brc_nearest_add(&nearest, "--version");
    brc_nearest_hint(&nearest, hint);
    BRC_FAIL(ctx, BRC_ERR_USAGE, "no command '%.60s'%s%s", words[0], hint,
             *hint ? "" : "; see breccia --help");
}

/* The command that goes on with an interrupted one, or does it anew where nothing was saved. The
 * words are those of the user, quoted for the shell, so that it can be pasted whatever is in them.
 */
static void print_resume(FILE *out, int code, const struct options *o)
{
    bool is_saved = code == BRC_ERR_INTERRUPTED;
    fputs(is_saved ? "; go on with:" : "; start again with:", out);
    brc_console_word(out, o->program);
    for (int i = 0; i < o->n_kept; i++)
        brc_console_word(out, o->kept[i]);
    if (o->can_resume && (is_saved || o->ladder.run.is_resumed))
        brc_console_word(out, "--resume");
    else if (o->ladder.run.is_forced)
        brc_console_word(out, "--force");
}

/* Standard output is closed here, not by exit: a table that did not arrive whole, as on a full
 * disk, is a failure of the command. The first failure is the one that is told. */
int main(int argc, char **argv)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct options o = {
        .program = argc > 0 ? argv[0] : "breccia",
        .ladder = {.observable = "strength", .axes = "", .seeds = 4, .refine = 8, .jobs = 1}};
    o.operands = brc_alloc(&ctx, (size_t)argc + 1, sizeof *o.operands);
    int code = o.operands ? brc_console_open(&ctx) : BRC_ERR_MEMORY;
    signal(SIGXFSZ, SIG_IGN); /* a file over the allowed size is a failed write like any other */
    if (code == 0)
        code = act_first(&ctx, argv + (argc > 0), &o);
    brc_comm_end();
    int closed = brc_console_close(&ctx);
    code = code != 0 ? code : closed;
    if (*ctx.message) {
        fprintf(stderr, "breccia: %s", ctx.message);
        if (code == BRC_ERR_INTERRUPTED || code == BRC_ERR_NOT_BEGUN)
            print_resume(stderr, code, &o);
        fputc('\n', stderr);
    }
    free(o.operands);
    return brc_error_exit_status(code);
}
