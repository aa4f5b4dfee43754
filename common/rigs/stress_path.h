/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths of stress and strain on a box, stage by stage: what a case writes as `stages`, and what the
 * axes across the driven one do in each. */
#ifndef BRC_STRESS_PATH_H
#define BRC_STRESS_PATH_H

#include "common/base/error.h"

enum { BRC_MAX_STAGES = 16 };

/* What the axes x and y do while z is driven. */
enum brc_path_kind {
    BRC_PATH_ISOTROPIC,  /* sigma_x = sigma_y = sigma_z */
    BRC_PATH_P_CONSTANT, /* sigma_x = sigma_y, and the mean stress stays */
    BRC_PATH_LATERAL,    /* sigma_x and sigma_y stay */
    BRC_PATH_PLANE,      /* y does not move, sigma_x stays */
    BRC_PATH_UNIAXIAL,   /* x and y do not move */
    BRC_PATH_LODE,       /* mean stress stays, Lode angle value[0] [rad] */
    BRC_PATH_RATIO,      /* sigma_x = value[0] sigma_z, sigma_y = value[1] sigma_z */
    BRC_PATH_STRESS      /* straight to the stresses value[0..2] [Pa] along x, y, z */
};

struct brc_stage {
    enum brc_path_kind kind;
    double value[3];
    bool is_to_strain;
    double to; /* strain along z since the stage began, or the stress that ends it [Pa]: the mean
                  stress of an isotropic stage, else that along z; compression positive */
};

/* The law of an axis during a stage: it does not move, or sigma = constant + part sigma_z. */
struct brc_axis_law {
    bool is_held;
    double constant, part; /* Pa, 1 */
};

/* Reads stages from text, "isotropic to 110 MPa, p constant to strain 0.2"; the message of a
 * failure names the stage and what there is to choose from. */
int brc_stages_read(struct brc_context *ctx, const char *text, struct brc_stage *stages, int *n);
/* Laws of x and y in a stage that begins at the stresses sigma [Pa]. */
void brc_stage_laws(const struct brc_stage *stage, const double sigma[3],
                    struct brc_axis_law law[2]);
/* +1 where z shortens in a stage that begins at sigma, -1 where it lengthens. */
double brc_stage_sense(const struct brc_stage *stage, const double sigma[3]);
/* Whether the stage has come to its end: strain is that along z since it began, in its sense. */
bool brc_stage_is_over(const struct brc_stage *stage, double sense, double strain,
                       const double sigma[3]);

/* Stresses that a stage ends at: those that it names, else those now. */
void brc_stage_reaches(const struct brc_stage *stage, const double now[3], double sigma[3]);

/* Invariants, compression positive. */
double brc_mean_stress(const double sigma[3]);       /* eq 20 of gt12 */
double brc_deviatoric_stress(const double sigma[3]); /* eq 21 of gt12 */
/* Lode angle [rad]: 0 in triaxial compression, pi/3 in extension. */
double brc_lode_angle(const double sigma[3]);
double brc_volume_strain(const double eps[3]); /* eq 22 of gt12 */
/* The conjugate of the deviatoric stress: dW = p d eps_v + q d eps_d where principal axes agree. */
double brc_deviatoric_strain(const double eps[3]);

#endif
