/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/fuzz.h"

#include "common/input/numbers.h"
#include "common/specimen/seeds.h"
#include "common/geometry/vec.h"
#include "tests/fuzz_aid.h"

#include <stdio.h>

int fuzz_numbers(const uint8_t *data, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_specimen_params p = {.grains = BRC_GRAINS_POINTS};
    struct brc_seeds seeds = {0};
    fuzz_write(data, size);
    snprintf(p.points, sizeof p.points, "%s", fuzz_path());
    int code = brc_seeds_points(&ctx, &p, 1, &seeds);
    fuzz_check_record(&ctx, code);
    FUZZ_MUST(code != 0 || seeds.n > 0);
    for (size_t i = 0; code == 0 && i < seeds.n; i++)
        FUZZ_MUST(isfinite(seeds.x[i][0] + 0 * seeds.x[i][1] + 0 * seeds.x[i][2]));
    brc_seeds_free(&seeds);
    return 0;
}
