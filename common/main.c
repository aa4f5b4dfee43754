/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line: commands and options are tables, from which help, the manual page, completion
 * and the reader come. Nothing is done here but to choose what other rooms do; the order matters
 * where signals are held before MPI starts its threads. */
#include "common/parallel/comm.h"
#include "common/runs/compare.h"
#include "common/base/console.h"
#include "common/base/folders.h"
#include "common/base/signals.h"
#include "common/runs/converge.h"
#include "common/runs/export.h"
#include "common/output/info.h"
#include "common/runs/run.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_OVERRIDES = 256 };

struct options {
    const char *operand; /* CASE, or the section of `params`, or a file */
    const char *model, *dir, *table, *format;
    const char *observable, *axes;
    int seeds, refine, jobs;
    const char *program, *command; /* as they were called */
    const char **given; /* options with their values, as they were given; [2 * n_given] */
    int n_given;
    const char *overrides[MAX_OVERRIDES];
    int n_overrides;
    bool is_resumed, is_forced, is_quiet, is_help;
};

/* Options by command: R run, C compare, V converge, X export. */
static const struct option {
    const char *name, *value, *commands, *help;
} option_table[] = {
    {"--model", "NAME", "R", "contact model; default: `model` of the case"},
    {"--model", "NAME", "V", "this model alone; default: those that compare runs"},
    {"-o", "DIR", "V", "folder of results; default: results/<case>"},
    {"--observable", "NAME", "V", "the result to look at; default: strength"},
    {"--axes", "LIST", "V", "of step, loading, rate, grains, points, features, ...; default: all"},
    {"--seeds", "N", "V", "specimens, seeds from that of the case on; default: 4"},
    {"--refine", "N", "V",
     "loading of the reference finer by this power of 2, half the step; default: 8"},
    {"--jobs", "N", "V", "runs at a time; default: 1, for times that nothing disturbs"},
    {"-o", "DIR", "RC", "folder of results; default: results/<case>/<model>, results/<case>"},
    {"-o", "FILE", "X", "what to write; default: on standard output"},
    {"--table", "NAME", "X", "CSV of this table: curve, events, bodies, pairs, ..."},
    {"--format", "FORMAT", "X", "stl: a solid a fragment; tess: the specimen for Neper"},
    {"--set", "KEY=VALUE", "RCV",
     "replace a value of the case, as vgcm.e_bar=\"50 GPa\"; repeatable"},
    {"--resume", NULL, "RC", "go on from the saved state, to the same bits"},
    {"--resume", NULL, "V", "keep finished runs, go on with the others"},
    {"--force", NULL, "RCV", "replace results that are there"},
    {"--force", NULL, "X", "replace the file that is there"},
    {"--quiet", NULL, "RCV", "no progress, no log lines"},
    {"--help", NULL, "RCVPMIXT", "this text"},
};
enum { N_OPTIONS = sizeof option_table / sizeof option_table[0] };

struct command {
    const char *name;
    char letter; /* in option.commands */
    const char *operand, *does, *example, *more;
    int (*act)(struct brc_context *ctx, const struct options *o);
};

static int act_run(struct brc_context *ctx, const struct options *o);
static int act_compare(struct brc_context *ctx, const struct options *o);
static int act_converge(struct brc_context *ctx, const struct options *o);
static int act_info(struct brc_context *ctx, const struct options *o);
static int act_export(struct brc_context *ctx, const struct options *o);
static int act_params(struct brc_context *ctx, const struct options *o);
static int act_models(struct brc_context *ctx, const struct options *o);
static int act_tests(struct brc_context *ctx, const struct options *o);

static const struct command commands[] = {
    {"run", 'R', "CASE", "run one model through the test of a case file",
     "breccia run cases/demo_tension.yaml --model vgcm -o results/first --set specimen.seed=2",
     "Writes summary.json, curve.csv, events.csv, state.h5, case.yaml, log and pictures.\n"
     "Ctrl-C saves the state and ends with status 7; the same command with --resume goes on.\n",
     act_run},
    {"compare", 'C', "CASE", "run all models of a case side by side and print a table",
     "breccia compare cases/demo_tension.yaml -o results/pair",
     "Each model's results go to DIR/<model>; the table to DIR/compare.txt, the pictures to DIR.\n",
     act_compare},
    {"converge", 'V', "CASE", "what accuracy costs: ladders of settings against a finer reference",
     "breccia converge cases/demo_tension.yaml --observable E --axes step,loading --seeds 8",
     "Runs the case with one setting changed at a time, on several specimens, with all models;\n"
     "tells error, its uncertainty and cost of each, and the cheapest within 1 % and 5 %. Writes\n"
     "converge.txt, converge.csv, converge_runs.csv and converge.png; finished runs are never "
     "lost.\n",
     act_converge},
    {"info", 'I', "FILE", "tell what a saved state or a frame holds",
     "breccia info results/pair/vgcm/state.h5",
     "Prints case, seed, version, step, counts, and each field with its unit and meaning.\n",
     act_info},
    {"export", 'X', "FILE", "write tables, fragments or the specimen for other programs",
     "breccia export results/pair/vgcm/state.h5 --format stl -o fragments.stl",
     "FILE is a saved state, or for --format tess a case file, too.\n", act_export},
    {"params", 'P', "[SECTION]",
     "list the keys of a section of the case file: a model, specimen, test, run, output",
     "breccia params vgcm", "Without a section: all of them.\n", act_params},
    {"models", 'M', "", "list the contact models", "breccia models", "", act_models},
    {"tests", 'T', "", "list the tests: keys of `test:` that each uses, and what it measures",
     "breccia tests", "", act_tests},
};
enum { N_COMMANDS = sizeof commands / sizeof commands[0] };

/* ---- help ---------------------------------------------------------------------------------- */

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

static void print_command_help(FILE *out, const struct command *c)
{
    fprintf(out, "usage: breccia %s%s%s%s\n\n%s\n%s", c->name, *c->operand ? " " : "", c->operand,
            strchr("RCV", c->letter) ? " [OPTION]..." : "", c->does, c->more);
    fputs("\noptions:\n", out);
    for (int i = 0; i < N_OPTIONS; i++) {
        char left[40];
        if (!strchr(option_table[i].commands, c->letter))
            continue;
        snprintf(left, sizeof left, "%s%s%s", option_table[i].name,
                 option_table[i].value ? " " : "",
                 option_table[i].value ? option_table[i].value : "");
        fprintf(out, "  %-18s %s\n", left, option_table[i].help);
    }
    fprintf(out, "\nexample:\n  %s\n\n", c->example);
    print_statuses(out);
}

/* ---- reading the command line -------------------------------------------------------------- */

static const char *suggest(const char *text, const char *const *names, int n,
                           char hint[BRC_HINT_SIZE])
{
    struct brc_nearest nearest = {.text = text};
    for (int i = 0; i < n; i++)
        brc_nearest_add(&nearest, names[i]);
    return brc_nearest_hint(&nearest, hint);
}

static const struct option *find_option(const struct command *c, const char *name, size_t length)
{
    for (int i = 0; i < N_OPTIONS; i++)
        if (strchr(option_table[i].commands, c->letter) && strlen(option_table[i].name) == length &&
            strncmp(option_table[i].name, name, length) == 0)
            return &option_table[i];
    return NULL;
}

static int fail_option(struct brc_context *ctx, const struct command *c, const char *text)
{
    const char *names[N_OPTIONS];
    char name[64], hint[BRC_HINT_SIZE];
    int n = 0;
    for (int i = 0; i < N_OPTIONS; i++)
        if (strchr(option_table[i].commands, c->letter))
            names[n++] = option_table[i].name;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    suggest(name, names, n, hint);
    BRC_FAIL(ctx, BRC_ERR_USAGE, "%s has no option '%s'%s%s", c->name, name, hint,
             *hint ? "" : "; see breccia COMMAND --help");
}

static int read_count(struct brc_context *ctx, const char *name, const char *value, int largest,
                      int *count)
{
    char *end;
    long n = strtol(value, &end, 10);
    if (*end || n < 1 || n > largest)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes a whole number from 1 to %d, not '%.40s'", name,
                 largest, value);
    *count = (int)n;
    return 0;
}

/* Options of converge alone; false when the name is none. */
static bool read_converge_option(struct brc_context *ctx, struct options *o, const char *name,
                                 const char *value, int *code)
{
    if (strcmp(name, "--observable") == 0)
        o->observable = value;
    else if (strcmp(name, "--axes") == 0)
        o->axes = value;
    else if (strcmp(name, "--seeds") == 0)
        *code = read_count(ctx, name, value, BRC_CONVERGE_MAX_SEEDS, &o->seeds);
    else if (strcmp(name, "--refine") == 0)
        *code = read_count(ctx, name, value, BRC_CONVERGE_MAX_REFINE, &o->refine);
    else if (strcmp(name, "--jobs") == 0)
        *code = read_count(ctx, name, value, BRC_PROGRESS_MAX_RUNS, &o->jobs);
    else
        return false;
    return true;
}

static int read_option(struct brc_context *ctx, struct options *o, const char *name,
                       const char *value)
{
    int code = 0;
    if (read_converge_option(ctx, o, name, value, &code))
        return code;
    if (strcmp(name, "--model") == 0) {
        o->model = value;
    } else if (strcmp(name, "-o") == 0) {
        o->dir = value;
    } else if (strcmp(name, "--table") == 0) {
        o->table = value;
    } else if (strcmp(name, "--format") == 0) {
        o->format = value;
    } else if (strcmp(name, "--set") == 0) {
        if (o->n_overrides == MAX_OVERRIDES)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "more than %d --set; write a case file", MAX_OVERRIDES);
        o->overrides[o->n_overrides++] = value;
    } else if (strcmp(name, "--resume") == 0) {
        o->is_resumed = true;
    } else if (strcmp(name, "--force") == 0) {
        o->is_forced = true;
    } else if (strcmp(name, "--quiet") == 0) {
        o->is_quiet = true;
    } else {
        o->is_help = true;
    }
    return 0;
}

/* One word of the command line, with the next one where it needs a value. */
static int read_word(struct brc_context *ctx, const struct command *c, char **words, int *i,
                     struct options *o)
{
    const char *word = words[*i];
    if (word[0] != '-') {
        if (o->operand || !*c->operand)
            BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes %s, '%.80s' is too much", c->name,
                     *c->operand ? c->operand : "no operand", word);
        o->operand = word;
        return 0;
    }
    size_t length = strcspn(word, "=");
    const struct option *option = find_option(c, word, length);
    if (!option)
        return fail_option(ctx, c, word);
    const char *value = word[length] == '=' ? word + length + 1 : NULL;
    if (value && !option->value)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s takes no value", option->name);
    if (!value && option->value)
        value = words[*i + 1] ? words[++*i] : NULL;
    if (option->value && !(value && *value))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s needs a value: %s %s", option->name, option->name,
                 option->value);
    if (value) {
        o->given[2 * o->n_given] = option->name;
        o->given[2 * o->n_given++ + 1] = value;
    }
    return read_option(ctx, o, option->name, value);
}

static int read_words(struct brc_context *ctx, const struct command *c, char **words,
                      struct options *o)
{
    size_t n = 0;
    while (words[n])
        n++;
    o->given = brc_alloc(ctx, 2 * n, sizeof *o->given);
    if (!o->given)
        return BRC_ERR_MEMORY;
    for (int i = 0; words[i]; i++)
        BRC_TRY(read_word(ctx, c, words, &i, o));
    bool needs_file = *c->operand && *c->operand != '[';
    if (o->is_help)
        return 0;
    if (needs_file && !o->operand)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "%s needs a %s: %s", c->name,
                 strcmp(c->operand, "CASE") == 0 ? "case file" : "file", c->example);
    if (o->is_resumed && o->is_forced)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--resume and --force exclude each other");
    return 0;
}

/* ---- commands ------------------------------------------------------------------------------ */

/* What commands on a case have in common: it is read, and places in it are told in their messages.
 */
static int with_case(struct brc_context *ctx, const struct options *o,
                     int (*command)(struct brc_context *ctx, const struct options *o,
                                    const struct brc_case *run_case))
{
    struct brc_case run_case;
    int code = brc_case_read(ctx, &run_case, o->operand, o->overrides, o->n_overrides);
    if (code == 0) {
        code = command(ctx, o, &run_case);
        brc_case_locate(ctx, &run_case);
    }
    brc_case_free(&run_case);
    return code;
}

/* Where results go: as the user says, else by the names of the case and, for a run, of its model.
 */
static void choose_dir(char dir[BRC_PATH_SIZE], const struct options *o,
                       const struct brc_case *run_case, const char *model)
{
    if (o->dir)
        snprintf(dir, BRC_PATH_SIZE, "%s", o->dir);
    else
        snprintf(dir, BRC_PATH_SIZE, "results/%s%s%s", run_case->name, *model ? "/" : "", model);
}

static int make_specimen(struct brc_context *ctx, const struct brc_case *run_case,
                         struct brc_specimen *specimen)
{
    BRC_TRY(brc_specimen_create(ctx, &run_case->specimen, specimen));
    brc_log(ctx, "%s: %zu grains, %zu facets", run_case->name, specimen->facets.n_cells,
            specimen->facets.n_facets);
    brc_specimen_warn(ctx, specimen);
    return 0;
}

/* After the signals are held: threads that MPI starts under a launcher must hold them, too. */
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

static void print_summary(const struct brc_summary *s, const char *dir)
{
    brc_compare_table(stdout, &s, 1);
    printf("results in %s\n", dir);
}

static int run_model(struct brc_context *ctx, const struct options *o,
                     const struct brc_case *run_case)
{
    char dir[BRC_PATH_SIZE];
    struct brc_specimen specimen = {0};
    struct brc_progress progress;
    struct brc_summary summary;
    struct brc_run_options options = {.run_case = run_case,
                                      .specimen = &specimen,
                                      .dir = dir,
                                      .is_resumed = o->is_resumed,
                                      .is_forced = o->is_forced,
                                      .progress = &progress};
    const char *name = o->model ? o->model : run_case->file.head.model;
    if (!*name)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s names no model; add 'model: NAME' or use --model NAME",
                 o->operand);
    BRC_TRY(brc_case_model(ctx, name, &options.model));
    choose_dir(dir, o, run_case, name);
    BRC_TRY(brc_run_check_folder(ctx, dir, run_case, o->is_resumed, o->is_forced));
    brc_signals_leave();
    int code = make_specimen(ctx, run_case, &specimen);
    if (code == 0) {
        brc_signals_hold();
        code = start_single(ctx);
    }
    if (code == 0) {
        brc_progress_begin(&progress, stderr, &name, 1, o->is_quiet);
        code = brc_run(ctx, &options, &summary);
        brc_progress_end(&progress);
    }
    if (code == 0 || code == BRC_ERR_ENERGY)
        print_summary(&summary, dir);
    brc_specimen_free(&specimen);
    return code;
}

static int act_run(struct brc_context *ctx, const struct options *o)
{
    int code = with_case(ctx, o, run_model);
    brc_comm_end();
    return code;
}

static int compare_case(struct brc_context *ctx, const struct options *o,
                        const struct brc_case *run_case)
{
    char dir[BRC_PATH_SIZE];
    struct brc_specimen specimen = {0};
    const struct brc_compare_options options = {.run_case = run_case,
                                                .specimen = &specimen,
                                                .dir = dir,
                                                .is_resumed = o->is_resumed,
                                                .is_forced = o->is_forced,
                                                .is_quiet = o->is_quiet};
    choose_dir(dir, o, run_case, "");
    brc_signals_leave();
    int code = make_specimen(ctx, run_case, &specimen);
    if (code == 0) {
        brc_signals_hold();
        code = brc_compare(ctx, &options);
    }
    if (code == 0)
        printf("results in %s\n", dir);
    brc_specimen_free(&specimen);
    return code;
}

static int act_compare(struct brc_context *ctx, const struct options *o)
{
    return with_case(ctx, o, compare_case);
}

static int converge_case(struct brc_context *ctx, const struct options *o,
                         const struct brc_case *run_case)
{
    char dir[BRC_PATH_SIZE];
    const struct brc_converge_options options = {.run_case = run_case,
                                                 .model = o->model,
                                                 .dir = dir,
                                                 .observable =
                                                     o->observable ? o->observable : "strength",
                                                 .axes = o->axes ? o->axes : "",
                                                 .seeds = o->seeds ? o->seeds : 4,
                                                 .refine = o->refine ? o->refine : 8,
                                                 .jobs = o->jobs ? o->jobs : 1,
                                                 .is_resumed = o->is_resumed,
                                                 .is_forced = o->is_forced};
    if (options.refine < 2 || (options.refine & (options.refine - 1)) != 0)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "--refine takes a power of 2 from 2 to %d, not %d",
                 BRC_CONVERGE_MAX_REFINE, options.refine);
    choose_dir(dir, o, run_case, "");
    brc_signals_hold();
    int code = brc_converge(ctx, &options);
    if (code == 0)
        printf("results in %s\n", dir);
    return code;
}

static int act_converge(struct brc_context *ctx, const struct options *o)
{
    return with_case(ctx, o, converge_case);
}

static int act_info(struct brc_context *ctx, const struct options *o)
{
    return brc_info_print(ctx, stdout, o->operand);
}

static int act_export(struct brc_context *ctx, const struct options *o)
{
    const char *what = o->format ? o->format : o->table;
    if (!what || (o->format && o->table))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "export needs either --table NAME or --format stl or tess");
    const struct brc_export_options options = {o->operand, o->dir, o->is_forced};
    return o->table ? brc_export_table(ctx, &options, o->table)
                    : brc_export_format(ctx, &options, o->format);
}

static int act_params(struct brc_context *ctx, const struct options *o)
{
    const char *names[64];
    struct brc_param_list list;
    char hint[BRC_HINT_SIZE];
    bool is_found = false;
    int n = 0;
    for (; n < 64 && brc_case_section(n, &names[n], &list); n++) {
        if (o->operand && strcmp(o->operand, names[n]) != 0)
            continue;
        if (is_found)
            putchar('\n');
        brc_params_print(stdout, names[n], list);
        is_found = true;
    }
    if (!is_found)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "no section '%.60s'%s; breccia params lists all", o->operand,
                 suggest(o->operand, names, n, hint));
    return 0;
}

static int act_models(struct brc_context *ctx, const struct options *o)
{
    (void)ctx, (void)o;
    for (int i = 0; i < brc_registry_count(); i++)
        printf("%-12s %s\n", brc_registry_at(i)->name, brc_registry_at(i)->citation);
    return 0;
}

static int act_tests(struct brc_context *ctx, const struct options *o)
{
    (void)ctx, (void)o;
    for (int i = 0; i < brc_rigs_count(); i++) {
        const struct brc_rig_type *rig = brc_rigs_at(i);
        printf("%s: %s\n  keys: %s\n", rig->name, rig->meaning, rig->keys);
        for (int k = 0; k < rig->n_quantities; k++)
            printf("  %-15s %-3s %s\n", rig->quantities[k].name, rig->quantities[k].unit,
                   rig->quantities[k].meaning);
    }
    return 0;
}

static int act(struct brc_context *ctx, char **words, struct options *o)
{
    const char *names[N_COMMANDS + 2] = {"--help", "--version"};
    char hint[BRC_HINT_SIZE];
    for (int i = 0; i < N_COMMANDS; i++) {
        names[i + 2] = commands[i].name;
        if (strcmp(words[0], commands[i].name) != 0)
            continue;
        o->command = commands[i].name;
        BRC_TRY(read_words(ctx, &commands[i], words + 1, o));
        ctx->quiet = o->is_quiet;
        if (o->is_help)
            print_command_help(stdout, &commands[i]);
        return o->is_help ? 0 : commands[i].act(ctx, o);
    }
    suggest(words[0], names, N_COMMANDS + 2, hint);
    BRC_FAIL(ctx, BRC_ERR_USAGE, "no command '%.60s'%s%s", words[0], hint,
             *hint ? "" : "; see breccia --help");
}

static int act_first(struct brc_context *ctx, char **words, struct options *o)
{
    if (!words[0]) {
        print_help(stderr);
        return BRC_ERR_USAGE;
    }
    if (strcmp(words[0], "--help") == 0 || strcmp(words[0], "-h") == 0)
        print_help(stdout);
    else if (strcmp(words[0], "--version") == 0)
        puts("breccia " BRC_VERSION);
    else
        return act(ctx, words, o);
    return 0;
}

/* The command that goes on with an interrupted one, or does it anew where nothing was saved. */
static void print_resume(FILE *out, int code, const struct options *o)
{
    bool is_saved = code == BRC_ERR_INTERRUPTED;
    fputs(is_saved ? "; go on with:" : "; start again with:", out);
    brc_console_word(out, o->program);
    brc_console_word(out, o->command);
    brc_console_word(out, o->operand);
    for (int i = 0; i < 2 * o->n_given; i++)
        brc_console_word(out, o->given[i]);
    if (is_saved || o->is_resumed)
        brc_console_word(out, "--resume");
    else if (o->is_forced)
        brc_console_word(out, "--force");
}

int main(int argc, char **argv)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct options o = {.program = argc > 0 ? argv[0] : "breccia"};
    int code = brc_console_open(&ctx);
    signal(SIGXFSZ, SIG_IGN); /* a file over the allowed size is a failed write like any other */
    if (code == 0)
        code = act_first(&ctx, argv + (argc > 0), &o);
    int closed = brc_console_close(&ctx);
    code = code != 0 ? code : closed;
    if (*ctx.message) {
        fprintf(stderr, "breccia: %s", ctx.message);
        if (code == BRC_ERR_INTERRUPTED || code == BRC_ERR_NOT_BEGUN)
            print_resume(stderr, code, &o);
        fputc('\n', stderr);
    }
    free(o.given);
    return brc_error_exit_status(code);
}
