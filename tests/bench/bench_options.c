/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What each option costs while it is on, and that one which is off costs nothing, in instructions a
 * step (valgrind's callgrind counts them, the same on each run). The second is the difference to a
 * library in which all options were off as it was compiled (CFG=bare). Steps of 216 grains that are
 * pressed together.
 *
 *   bench_options                the table, and the lines of bench.json
 *   bench_options MODEL SETUP    the steps of one set-up, to be counted */
#include "bench.h"

#include "tests/fixture.h"

enum { STEPS = 32 }; /* as many as the sides are looked up after */

/* What is on, beyond friction, damping, walls, ledger and softening all being off. */
static const struct setup {
    const char *name, *model, *settings, *test, *run;
} setups[] = {
    {"none", "polyhedra", "", "", ""},
    {"friction", "polyhedra", "mu: 0.3; kt: 1e7 N/m", "", ""},
    {"torsion", "polyhedra", "torsion: on", "", ""},
    {"local_damping", "polyhedra", "", "", "local_damping: 0.7"},
    {"damping_along_velocity", "polyhedra", "", "", "local_damping: 0.7; damping: along_velocity"},
    {"dynamic", "polyhedra", "", "", "regime: dynamic; dt: 1e-9 s"},
    {"dynamic_viscous", "polyhedra", "gn: 10 1/s; gt: 10 1/s", "", "regime: dynamic; dt: 1e-9 s"},
    {"walls", "polyhedra", "", "kind: compression; loading: fixed; rate: 1e-6 1/s", ""},
    {"wall_friction", "polyhedra", "",
     "kind: compression; loading: fixed; rate: 1e-6 1/s; friction: 0.3", ""},
    {"pressure", "polyhedra", "", "kind: triaxial; loading: fixed; rate: 1e-6 1/s", ""},
    {"condensed", "polyhedra", "evaluation: condensed", "", ""},
    {"gravity", "polyhedra", "", "", "gravity: 0 m/s2, 0 m/s2, -9.81 m/s2"},
    {"ledger", "polyhedra", "", "", "ledger: on"},
    {"none", "vgcm", "", "", ""},
    {"friction", "vgcm", "mu: 0.3", "", ""},
    {"softening", "vgcm", "softening: bilinear", "", ""},
    {"local_damping", "vgcm", "", "", "local_damping: 0.7"},
    {"damping_along_velocity", "vgcm", "", "", "local_damping: 0.7; damping: along_velocity"},
    {"dynamic", "vgcm", "", "", "regime: dynamic; dt: 1e-9 s"},
    {"dynamic_viscous", "vgcm", "viscous: 10 1/s", "", "regime: dynamic; dt: 1e-9 s"},
    {"walls", "vgcm", "", "kind: compression; loading: fixed; rate: 1e-6 1/s", ""},
    {"wall_friction", "vgcm", "",
     "kind: compression; loading: fixed; rate: 1e-6 1/s; friction: 0.3", ""},
    {"pressure", "vgcm", "", "kind: triaxial; loading: fixed; rate: 1e-6 1/s", ""},
    {"gravity", "vgcm", "", "", "gravity: 0 m/s2, 0 m/s2, -9.81 m/s2"},
    {"ledger", "vgcm", "", "", "ledger: on"},
};
enum { N_SETUPS = sizeof setups / sizeof setups[0] };

/* Settings of a model with all its options off. */
static const char *plain_of(const char *model)
{
    return strcmp(model, "vgcm") == 0 ? "softening: none; mu: 0; viscous: 0 1/s"
                                      : FIXTURE_TABLE_1
               "; mu: 0; torsion: off; gn: 0 1/s; gt: 0 1/s; evaluation: literal";
}

static void run_setup(const struct setup *s)
{
    char settings[512], run[256], test[256];
    void *state;
    fixture_open(&state);
    struct fixture *f = state;
    snprintf(settings, sizeof settings, "%s; %s", plain_of(s->model), s->settings);
    snprintf(run, sizeof run, "local_damping: 0; ledger: off; simd: avx2; %s", s->run);
    snprintf(test, sizeof test, "kind: none; %s", s->test);
    fixture_grid(f, 6, 6, 6, 0.01, 1);
    fixture_sim(f, brc_registry_find(s->model), settings, test, run);
    struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < b->n_grains; i++)
        for (int k = 0; k < 3; k++)
            b->v[i][k] = -1e-6 / f->sim.dt * (b->x[i][k] - 0.03);
    fixture_steps(f, STEPS);
    fixture_close(&state);
}

/* Instructions a step of a program's run of one set-up. */
static double count(const char *program, int i)
{
    char command[1024], line[512];
    double counted = 0;
    snprintf(command, sizeof command,
             "valgrind --tool=callgrind --callgrind-out-file=/dev/null "
             "--toggle-collect=brc_sim_step %s %s %s 2>&1",
             program, setups[i].model, setups[i].name);
    FILE *pipe = popen(command, "r");
    while (pipe && fgets(line, sizeof line, pipe)) {
        const char *at = strstr(line, "Collected : ");
        if (at)
            counted = strtod(at + 12, NULL);
    }
    if (!pipe || pclose(pipe) != 0 || counted == 0) {
        fprintf(stderr, "no count from: %s\n", command);
        exit(1);
    }
    return counted / STEPS;
}

static void report_option(int i, double on, double none)
{
    char name[128];
    snprintf(name, sizeof name, "option_%s_%s_cost_ratio", setups[i].model, setups[i].name);
    bench_report(&(struct bench_value){name, on / none - 1, "1", 0, 0, 0});
}

int main(int argc, char **argv)
{
    char bare[512];
    double none = 0, worst = 0;
    if (argc == 3) {
        for (int i = 0; i < N_SETUPS; i++)
            if (strcmp(setups[i].model, argv[1]) == 0 && strcmp(setups[i].name, argv[2]) == 0)
                run_setup(&setups[i]);
        return 0;
    }
    snprintf(bare, sizeof bare, "build/bare/%s", argv[0] + strlen("build/"));
    for (int i = 0; i < N_SETUPS; i++) {
        double on = count(argv[0], i);
        if (strcmp(setups[i].name, "none") != 0) {
            report_option(i, on, none);
            continue;
        }
        none = on;
        double without = count(bare, i);
        printf("%s: %.0f instructions a step with all options off, %.0f without them\n",
               setups[i].model, none, without);
        worst = fmax(worst, none / without - 1);
    }
    bench_report(&(struct bench_value){"options_off_cost_ratio", worst, "1", 0.01, 0, 0});
    return 0;
}
