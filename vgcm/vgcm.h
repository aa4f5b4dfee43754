/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VGCM-3D: spheres that interact through the points of their common Laguerre facet. What the files
 * of this folder share: parameters, state, and the functions that they call of each other. Field
 * lists say what is saved and hashed; the law of a point is in law.h, which does not know them. */
#ifndef VGCM_VGCM_H
#define VGCM_VGCM_H

#include "common/specimen/oblique.h"
#include "common/engine/sim.h"
#include "vgcm/law.h"

enum vgcm_softening { VGCM_SOFTENING_NONE, VGCM_SOFTENING_LINEAR, VGCM_SOFTENING_BILINEAR };
enum vgcm_damage { VGCM_DAMAGE_DISPLACEMENT, VGCM_DAMAGE_STRENGTH };
enum vgcm_energies { VGCM_ENERGIES_TOTAL, VGCM_ENERGIES_POST_PEAK };
enum vgcm_oblique { VGCM_OBLIQUE_REFUSE, VGCM_OBLIQUE_KEEP };
enum vgcm_interaction { VGCM_INTERACTION_GAP, VGCM_INTERACTION_ALL, VGCM_INTERACTION_AREA };

#define VGCM_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                                   \
    REAL(density, "kg/m3", "2650 kg/m3", "(0, inf)", "density of the grains")                     \
    REAL(e_bar, "Pa", "48.8 GPa", "(0, inf)", "modulus of the equivalent continuum, eq 28")       \
    REAL(eta, "1", "0.125", "[0, 10]", "shear stiffness over normal stiffness, eq 29")            \
    REAL(mu, "1", "0.05", "[0, 10]", "friction coefficient of grains, eq 33")                     \
    REAL(sigma_t, "Pa", "11.4 MPa", "(0, inf)", "tensile strength of a point, eq 32")             \
    REAL(tau, "Pa", "88.5 MPa", "(0, inf)", "cohesion of a point, eq 33")                         \
    CHOICE(softening, "none|linear|bilinear", "bilinear",                                         \
           "after the peak; none: brittle, the fracture energies are not used")                   \
    REAL(softening_beta, "1", "0.25", "(0, 1)",                                                   \
         "bilinear: strength at the kink over the peak strength", "softening=bilinear")           \
    REAL(softening_w1, "1", "0.75", "(0, 2)",                                                     \
         "bilinear: displacement past the peak at the kink, in (post-peak energy)/strength; it "  \
         "ends at (2 - w1)/beta",                                                                 \
         "softening=bilinear")                                                                    \
    REAL(g_fn, "J/m2", "auto", "(0, inf)", "fracture energy in tension; auto: by energy_ratio",   \
         "softening=linear|bilinear")                                                             \
    REAL(g_fs, "J/m2", "auto", "(0, inf)", "fracture energy in shear; auto: by energy_ratio",     \
         "softening=linear|bilinear")                                                             \
    REAL(energy_ratio, "1", "9.5", "(1, 1e6]",                                                    \
         "g_fn, g_fs auto: fracture energy over the elastic energy at the peak of a contact of "  \
         "the mean distance",                                                                     \
         "softening=linear|bilinear, g_fn=auto or g_fs=auto")                                     \
    CHOICE(damage, "displacement|strength", "displacement",                                       \
           "opening and slip add as parts of their end displacements, or as losses of strength",  \
           "softening=linear|bilinear")                                                           \
    CHOICE(energies, "total|post_peak", "total",                                                  \
           "g_fn and g_fs count from zero displacement, or from the peak on",                     \
           "softening=linear|bilinear")                                                           \
    CHOICE(                                                                                       \
        points, "paper|exact|one", "paper",                                                       \
        "paper: vertices and centroid; exact: the same drawn in to the facet's second moments; "  \
        "one: the centroid")                                                                      \
    CHOICE(interaction, "gap|all|area", "gap",                                                    \
           "which facets are contacts: spheres nearer than the gap, all, or large facets")        \
    REAL(interaction_gap, "m", "0 m", "[0, inf)",                                                 \
         "gap: largest gap of two spheres that are bonded; 0: interaction_gap_ratio holds",       \
         "interaction=gap")                                                                       \
    REAL(interaction_gap_ratio, "1", "0.17", "(0, 10]", "gap: the same in mean sphere diameters", \
         "interaction=gap, interaction_gap=0")                                                    \
    REAL(interaction_area, "1", "0.67", "[0, 10]",                                                \
         "area: smallest facet that is bonded, in mean areas of the inner facets",                \
         "interaction=area")                                                                      \
    CHOICE(oblique, "refuse|keep", "refuse",                                                      \
           "facets far from normal to the lines of centres: an error, or kept all the same")      \
    REAL(viscous, "1/s", "0 1/s", "[0, inf)",                                                     \
         "dynamic regime: viscous force = this times effective mass times relative velocity",     \
         "run.regime=dynamic")

struct vgcm_params {
    BRC_PARAM_MEMBERS(VGCM_PARAMS)
};

#define VGCM_BODY_FIELDS(SCALAR) SCALAR(double, radius, BRC_STATE, "m", "radius of the sphere")

struct vgcm_bodies {
    VGCM_BODY_FIELDS(BRC_COLUMN)
};

/* A contact is a sphere contact (new neighbours), or a facet. The displacement of a facet's points
 * is the affine field u: exact, not an approximation, as each point's increment is affine in its
 * place. While no point has been damaged nothing else is kept; then its plastic slip and damage.
 * The slip of a broken point that is open is not kept: it is the whole displacement. A facet is
 * loose where all of its points are broken and surely open: it has no forces. */
enum vgcm_phase { VGCM_SPHERE, VGCM_AFFINE, VGCM_POINTS, VGCM_LOOSE, VGCM_N_PHASES };

/* order of generalised displacements and forces in the contact frame */
enum { VGCM_OPEN, VGCM_S, VGCM_T, VGCM_TWIST, VGCM_BEND_S, VGCM_BEND_T, VGCM_N_MOTION };
/* order of the area moments about the reference point: sums of A, A s, A t, A s s, A s t, A t t */
enum { VGCM_A, VGCM_A_S, VGCM_A_T, VGCM_A_SS, VGCM_A_ST, VGCM_A_TT, VGCM_N_MOMENTS };
/* order of what is kept of a point: place in the contact plane [m], area [m2], energy dissipated
 * until the damage was 1 [J]; plastic slip, which is the shear force on b over the stiffness plus
 * the slip [m], damage by opening and by slip. One line of a cache. */
enum {
    VGCM_AT_S,
    VGCM_AT_T,
    VGCM_AREA,
    VGCM_DISSIPATED,
    VGCM_SLIP_S,
    VGCM_SLIP_T,
    VGCM_DN,
    VGCM_DS,
    VGCM_N_POINT
};

#define VGCM_CONTACT_FIELDS(SCALAR, VECTOR, RENAMED, VECTOR_RENAMED)                            \
    SCALAR(uint8_t, phase, BRC_STATE, "1",                                                      \
           "0 sphere contact, facets: 1 affine, 2 points, 3 loose")                             \
    SCALAR(double, kn, BRC_STATE, "Pa m-1", "normal stiffness per unit area")                   \
    SCALAR(double, plane, BRC_STATE, "m", "facet plane at d/2 + plane from a along n")          \
    SCALAR(double, facet_radius, BRC_STATE, "m",                                                \
           "largest distance of a point from the reference point")                              \
    RENAMED(double, contact_distance, rest, BRC_STATE, "m",                                     \
            "sphere contact: distance where it begins; facets: 0")                              \
    VECTOR(double, n, 3, BRC_STATE, "1", "contact normal from a to b; platens: carried by a")   \
    VECTOR(double, s, 3, BRC_STATE, "1", "first axis of the contact plane, carried along")      \
    VECTOR(double, u, 6, BRC_STATE, "m, 1", "facets: opening, slip s t, turn about n s t")      \
    VECTOR(double, moment, 6, BRC_STATE, "m2, m3, m4", "sums of A, A s, A t, A ss, A st, A tt") \
    VECTOR_RENAMED(double, viscous_force, drag, 6, BRC_STATE, "N, N m",                         \
                   "viscous part of the generalised force")

struct vgcm_contacts {
    VGCM_CONTACT_FIELDS(BRC_COLUMN, BRC_COLUMN3, BRC_COLUMN_RENAMED, BRC_COLUMN3_RENAMED)
};

#define VGCM_POINT_FIELDS(SCALAR, VECTOR)                                                      \
    VECTOR(double, law, 8, BRC_STATE, "m, m2, J, 1", "s, t, area, lost, slip s t, damage n s") \
    SCALAR(double, h, BRC_STATE, "m", "platens: height over the centre of a along n")          \
    SCALAR(double, un, BRC_STATE, "m", "platens: opening; facets have it from u")              \
    VECTOR(double, onset, 3, BRC_STATE, "N", "facets: force as damage began: n, s, t")

struct vgcm_points {
    VGCM_POINT_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};

struct vgcm_loops;
/* Made by create and select; holds nothing that a restart would miss. */
struct vgcm_state {
    struct vgcm_law law;
    const struct vgcm_loops *loops;
    int flags; /* of law.h */
};

static inline struct vgcm_contacts *vgcm_columns(const struct brc_contacts *c)
{
    return c->model_columns;
}

static inline struct vgcm_points *vgcm_point_columns(const struct brc_contacts *c)
{
    return c->point_columns;
}

/* What holds a contact at a platen: grains that came near later are not held. */
static inline enum brc_bonding vgcm_platen_bonding(const struct brc_contacts *c, size_t i,
                                                   const struct brc_platen *platen)
{
    return vgcm_columns(c)->phase[i] == VGCM_SPHERE ? BRC_BONDING_NONE : platen->bonding;
}

/* A plane has one normal for all points, and the loop leaves out their turns. */
static inline bool vgcm_platen_is_curved(const struct brc_platen *platen)
{
    return platen->surface == BRC_SURFACE_CYLINDER ||
           (platen->surface == BRC_SURFACE_STRIP && platen->edge_radius > 0);
}

/* model.c */
void vgcm_law_of(struct vgcm_law *law, const struct vgcm_params *params);

/* make_contacts.c: which pairs interact, and the contacts of new contacts */

/* Facets that the interaction rule keeps. Measured from the facets whenever it is asked for, before
 * a run and at its start, so that no copy can be out of date. */
struct vgcm_census {
    size_t n_inner, n_contacts;             /* inner facets, those that are contacts */
    double mean_distance, largest_distance; /* m, of the contacts */
    double gap, mean_area;                  /* limit of the gap rule, m; of inner facets, m2 */
    /* facets are not normal to the lines of centres: their areas count as seen along these */
    bool is_projected;
    struct brc_oblique oblique; /* of the areas that count */
};
void vgcm_census_measure(struct vgcm_census *census, const struct vgcm_params *params,
                         const struct brc_facets *facets);
/* Fracture energies that are `auto`, which go along with the grain size; given ones stay. */
void vgcm_scale_params(struct vgcm_params *params, const struct brc_facets *facets);
/* Radius of a cell's sphere; for a plain Voronoi cell the largest about the seed that fits in. */
double vgcm_radius(const struct brc_facets *facets, size_t cell);
/* Operations of the model (common/engine/model.h). */
int vgcm_bond(struct brc_sim *sim, void *state);
int vgcm_update_contacts(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                         const struct brc_neighbours *platens);

/* forces_kernels.inc.h and platens_kernels.inc.h for each instruction set: the loops over contacts
 * of grains, specialised by the flags of law.h, and the loop over those with platens A table for
 * each instruction set, so that which one runs is chosen in one place. */
struct vgcm_loops {
    void (*forces[VGCM_N_LOOPS])(struct brc_sim *sim, const struct vgcm_law *law);
    void (*platens)(struct brc_sim *sim, const struct vgcm_law *law, int flags);
};
extern const struct vgcm_loops vgcm_loops_base, vgcm_loops_avx2, vgcm_loops_avx512;

/* energy.c: operations of the model. */
void vgcm_energy(const struct brc_sim *sim, const void *state, double (*of_grain)[BRC_N_ACCOUNTS]);
/* Tensile strength of a bonded contact that its points have left, over that at the start, by area.
 */
double vgcm_strength_left(const struct brc_sim *sim, const void *state, size_t contact);
int vgcm_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out);

#endif
