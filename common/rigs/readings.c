/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All of it is made when results are asked for, from the log of cracks, the curve and the bonds
 * that hold: a step pays nothing, and a resumed run measures the same. Called by rigs.c alone. */
#include "common/rigs/readings.h"

#include "common/engine/sim.h"
#include "common/rigs/acoustic.h"
#include "common/rigs/b_value.h"
#include "common/rigs/crack_fabric.h"
#include "common/rigs/curve.h"
#include "common/rigs/sieve.h"

#include <math.h>
#include <stdlib.h>

const struct brc_quantity brc_readings_quantities[BRC_N_READINGS] = {
    {"broken_tension", "1", "breaks in tension: bonds, or local points"},
    {"broken_shear", "1", "breaks in shear"},
    {"broken_torsion", "1", "breaks in torsion"},
    {"work_at_peak", "J", "work of the platens up to the peak"},
    {"break_energy_at_peak", "J", "of it dissipated by breaks"},
    {"drop_before_peak", "1", "largest fall of the load up to the peak, over the peak"},
    {"strain_at_end", "1", "platen strain at the end, as strain_at_peak is counted"},
    {"load_at_end", "1", "load there, over the peak"},
    {"crack_angle", "rad", "mean angle between cracks and the load"},
    {"crack_alignment", "1", "1: all cracks along the load, 0: all across it"},
    {"localisation", "1", "part of the broken area in the best plane, 2 grains thick"},
    {"localisation_angle", "rad", "angle between this plane and the load"},
    {"n_events", "1", "acoustic events"},
    {"b_value", "1", "b of their magnitudes"},
    {"b_value_error", "1", "its standard error"},
    {"sigma_1", "Pa", "largest principal stress at the peak, compression positive"},
    {"sigma_3", "Pa", "smallest one there"},
    {"sigma_1_residual", "Pa", "largest one at the end, where the load has settled"},
    {"sigma_3_residual", "Pa", "smallest one there"},
    {"n_pieces", "1", "fragments of 2 grains or more"},
    {"largest_piece", "1", "part of the mass in the largest fragment"}};

static const char no_memory[] = "out of memory", no_break[] = "nothing has broken",
                  few_facets[] = "fewer than 10 facets have broken",
                  not_uniform[] = "the stress in this test is not uniform",
                  few_rows[] = "fewer than 8 rows of the curve since the peak",
                  unsettled[] = "the load was still changing at the end: a larger test.strain_max, "
                                "with test.stop_drop: 0, shows what is left";

/* A few facets always have a plane in common. */
enum { PLANE_FACETS = 10 };

/* A value beside a note is none: who reads one without the other must not take a number of an
 * unfinished test for its result. */
static struct brc_measured measured(double value, const char *note)
{
    return (struct brc_measured){note ? NAN : value, note};
}

/* By the trapezoid rule over the rows, each of which holds means over its steps. The ledger's term
 * is exact, but kept for the present step alone. */
static double work_to(const struct brc_rig *rig, size_t row)
{
    const struct brc_curve *c = &rig->curve;
    double work = 0.5 * c->force[0] * c->strain[0];
    for (size_t i = 1; i <= row; i++)
        work += 0.5 * (c->force[i] + c->force[i - 1]) * (c->strain[i] - c->strain[i - 1]);
    return work * rig->length[rig->axis];
}

/* Breaks alone: what softening points have lost before they are gone is in the ledger, which is
 * kept for the present step and not along the curve. */
static void read_peak(const struct brc_sim *sim, struct brc_measured out[2])
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_events *e = &sim->events;
    const char *note = brc_curve_why_no_peak(rig);
    double energy = 0;
    size_t row = note ? 0 : brc_curve_peak_row(rig);
    for (size_t i = 0; !note && i < e->table.n && e->step[i] <= rig->curve.step[row]; i++)
        energy += e->energy[i];
    out[0] = measured(note ? NAN : work_to(rig, row), note);
    out[1] = measured(energy, note);
}

/* From a row to a later one, so that a load that shakes about a rise counts for little. */
static double drop_before(const struct brc_rig *rig, size_t peak)
{
    double largest = 0, drop = 0;
    for (size_t i = (size_t)rig->stage_row; i <= peak; i++) {
        largest = fmax(largest, rig->curve.force[i]);
        drop = fmax(drop, largest - rig->curve.force[i]);
    }
    return drop / rig->force_peak;
}

/* How brittle it is: how soon after the peak the load has fallen to what ended the test. */
static void read_shape(const struct brc_sim *sim, struct brc_measured out[3])
{
    const struct brc_rig *rig = &sim->rig;
    const char *note = brc_curve_why_no_peak(rig);
    size_t last = rig->curve.table.n - 1; /* there is one if there is a peak */
    out[0] = measured(note ? NAN : drop_before(rig, brc_curve_peak_row(rig)), note);
    out[1] = measured(note ? NAN : rig->curve.strain[last] - rig->stage_strain, note);
    out[2] = measured(note ? NAN : rig->curve.force[last] / rig->force_peak, note);
}

/* ---- principal stresses ---------------------------------------------------------------------- */

/* Halves of a residual's rows differ in their mean load by less than this part of the peak: rows of
 * broken rock shake by some per cent, and a load that falls to half of the peak on its way to
 * test.stop_drop differs by far more. */
static const double SETTLED = 0.05;

static double mean_load(const struct brc_rig *rig, size_t first, size_t end)
{
    double sum = 0;
    for (size_t i = first; i < end; i++)
        sum += rig->curve.force[i];
    return sum / (double)(end - first);
}

/* The last quarter of the rows since the peak, from *first on: the residual state, or why there is
 * none. By rows and not by strain, as the adaptive loading spends its rows where things happen. */
static const char *residual_rows(const struct brc_rig *rig, size_t peak, size_t *first)
{
    size_t n = rig->curve.table.n, quarter = (n - peak) / 4, middle = n - quarter / 2;
    *first = n - quarter;
    if (quarter < 2)
        return few_rows;
    double change = mean_load(rig, *first, middle) - mean_load(rig, middle, n);
    return fabs(change) > SETTLED * rig->force_peak ? unsettled : NULL;
}

/* Largest and smallest mean stress of rows. */
static void extremes(const struct brc_sim *sim, size_t first, size_t end, const char *note,
                     struct brc_measured out[2])
{
    double mean[3] = {0, 0, 0}, sigma[3];
    for (size_t i = first; !note && i < end; i++) {
        sim->rig.type->stresses(sim, i, sigma);
        for (int k = 0; k < 3; k++)
            mean[k] += sigma[k] / (double)(end - first);
    }
    out[0] = measured(fmax(fmax(mean[0], mean[1]), mean[2]), note);
    out[1] = measured(fmin(fmin(mean[0], mean[1]), mean[2]), note);
}

/* Both states by one operation of the test, so that a peak and what is left of it are measured over
 * the same area. */
static void read_stresses(const struct brc_sim *sim, struct brc_measured out[4])
{
    const struct brc_rig *rig = &sim->rig;
    size_t first = 0;
    const char *note = rig->type->stresses ? brc_curve_why_no_peak(rig) : not_uniform;
    size_t peak = note ? 0 : brc_curve_peak_row(rig);
    extremes(sim, peak, peak + 1, note, out);
    if (!note)
        note = residual_rows(rig, peak, &first);
    extremes(sim, first, rig->curve.table.n, note, out + 2);
}

/* ---- cracks ---------------------------------------------------------------------------------- */

/* Against the axis of the load, as geologists count dips against the horizontal: the test may be
 * loaded along any axis. */
static void read_angles(const struct brc_sim *sim, struct brc_measured out[2])
{
    struct brc_crack_angles a;
    const char *note = sim->events.table.n == 0 ? no_break : NULL;
    if (brc_crack_angles_measure(sim->ctx, &sim->events, sim->rig.axis, &a) != 0)
        note = no_memory;
    out[0] = measured(a.mean, note);
    out[1] = measured(a.alignment, note);
    brc_crack_angles_free(&a);
}

/* The slab is two mean grain diameters thick: a crack between grains zigzags by one. */
static void read_plane(const struct brc_sim *sim, struct brc_measured out[2])
{
    struct brc_crack_plane plane;
    double thickness = 4 * sim->skin / sim->run.skin; /* run.skin is in mean grain radii */
    int code =
        brc_crack_plane_find(sim->ctx, &sim->events, &sim->specimen->facets, thickness, &plane);
    const char *note = code != 0 ? no_memory : plane.n < PLANE_FACETS ? few_facets : NULL;
    out[0] = measured(plane.part, note);
    out[1] = measured(asin(fmin(fabs(plane.normal[sim->rig.axis]), 1)), note);
}

/* b by magnitudes of energy, as every break has one; moments are zero where twins cancel. */
static void read_acoustic(const struct brc_sim *sim, struct brc_measured out[3])
{
    struct brc_acoustic a;
    struct brc_b_value b = {0};
    const char *failed = brc_acoustic_find(sim, &a) != 0 ? no_memory : NULL, *note = failed;
    size_t n = 0;
    for (size_t i = 0; i < a.table.n; i++) /* those that have a magnitude */
        if (isfinite(a.magnitude[i]))
            a.magnitude[n++] = a.magnitude[i];
    if (!note)
        note = brc_b_value_fit(a.magnitude, n, &b);
    out[0] = measured((double)a.table.n, failed);
    out[1] = measured(b.b, note);
    out[2] = measured(b.error, note);
    brc_acoustic_free(&a);
}

/* Dust is left out of the number of pieces and not of the mass: a largest piece of half of the rock
 * is that, whatever has crumbled. */
static void read_fragments(const struct brc_sim *sim, struct brc_measured out[2])
{
    struct brc_sieve s;
    const char *note = brc_sieve_make(sim, &s) != 0 ? no_memory : NULL;
    out[0] = measured((double)s.n_pieces, note);
    out[1] = measured(note ? NAN : s.mass[0] / s.whole, note);
    brc_sieve_free(&s);
}

void brc_readings(const struct brc_sim *sim, struct brc_measured out[BRC_N_READINGS])
{
    for (int m = 0; m < BRC_N_MODES; m++)
        out[m] = measured((double)sim->events.count[m], NULL);
    out += BRC_N_MODES;
    read_peak(sim, out);
    read_shape(sim, out + 2);
    read_angles(sim, out + 5);
    read_plane(sim, out + 7);
    read_acoustic(sim, out + 9);
    read_stresses(sim, out + 12);
    read_fragments(sim, out + 16);
}
