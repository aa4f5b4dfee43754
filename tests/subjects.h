/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The models as the conformance suite takes them: settings that suit each, and a small pack. */
#ifndef BRC_TESTS_SUBJECTS_H
#define BRC_TESTS_SUBJECTS_H

#include "tests/fixture.h"

/* Settings of the models here: no viscosity, grains of 1 cm; modulus makes forces of strains. */
struct subject {
    const char *name;
    const char *elastic;
    const char *breaking;
    double modulus;
    double stable_part; /* of the step limit; less where springs begin and end within a step */
};
struct subject subject_of(const struct brc_model *model);

/* A pack of 3 x 3 x 3 grains of this size [m]. */
#define SUBJECT_GRAIN 1e-2
void subject_pack(struct fixture *f);
/* Force of a strain on a facet of it, for tolerances. */
double subject_force(const struct subject *s, double strain);

#endif
