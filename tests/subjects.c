/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/subjects.h"

static const struct subject SUBJECTS[] = {
    {"polyhedra", FIXTURE_TABLE_1 "; gn: 0 1/s; evaluation: literal",
     FIXTURE_TABLE_1 "; gn: 0 1/s; eps_th: 5e-4; theta_th: 2e-3 rad", 20e9, 0.7},
    {"vgcm",
     "interaction: all; e_bar: 20 GPa; eta: 0.3; sigma_t: 1 TPa; tau: 1 TPa; softening: none",
     "interaction: all; e_bar: 20 GPa; eta: 0.3; " FIXTURE_ENERGIES, 20e9, 0.95},
    {"null", "", "", 1e9, 0.95},
};

struct subject subject_of(const struct brc_model *model)
{
    for (size_t i = 0; i < sizeof SUBJECTS / sizeof SUBJECTS[0]; i++)
        if (fixture_is(model, SUBJECTS[i].name))
            return SUBJECTS[i];
    return (struct subject){model->name, "", "", 1e9, 0.95}; /* a model added later: its defaults */
}

void subject_pack(struct fixture *f)
{
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; "
                        "jitter: 0.7; seed: 3");
}

double subject_force(const struct subject *s, double strain)
{
    return s->modulus * SUBJECT_GRAIN * SUBJECT_GRAIN * strain;
}
