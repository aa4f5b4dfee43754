/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A disc that has been split is in pieces in both models, though not every point of the crack is
 * gone. */
#include "common/engine/fragments.h"
#include "tests/fixture.h"

#include <stdio.h>

static void a_split_disc_is_in_halves(void **state)
{
    struct fixture *f = *state;
    struct brc_fragments pieces;
    fixture_specimen(f, "diameter: 58 mm; height: 20 mm");
    for (int i = 0; i < brc_registry_count(); i++) {
        fixture_sim(f, brc_registry_at(i), "", "kind: brazilian; stop_drop: 0.3", "");
        CHECK_OK(&f->ctx, brc_fragments_find(&f->ctx, &f->sim, &pieces));
        assert_int_equal(pieces.n, 1);
        brc_fragments_free(&pieces);
        while (!brc_rigs_done(&f->sim))
            CHECK_OK(&f->ctx, brc_sim_step(&f->sim));
        CHECK_OK(&f->ctx, brc_fragments_find(&f->ctx, &f->sim, &pieces));
        print_message(
            "%s: %zu pieces, the largest %.3f and %.3f of the disc, strain %g\n",
            brc_registry_at(i)->name, pieces.n, pieces.volume[0] / f->specimen.domain_volume,
            pieces.n > 1 ? pieces.volume[1] / f->specimen.domain_volume : 0.0, f->sim.rig.strain);
        assert_true(pieces.n > 1);
        CHECK_BETWEEN(pieces.volume[1] / f->specimen.domain_volume, 0.2, 0.5);
        brc_fragments_free(&pieces);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(a_split_disc_is_in_halves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
