#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The physics versions: small runs of every test, both models and their laws end with the bits that
# tests/data/physics/runs.jsonl keeps of them. Whoever changes bits moves a version, or results that
# were computed before would be taken for those of the present code.
. tests/cli/begin.sh
cp -r "$tree/tests/data/physics" kept
sweep="$breccia sweep kept/sweep.yaml -o out"

# a run that is not kept: a version or a default has moved, or a key was added that does not say what
# its `off` is
said=$($sweep --dry-run 2>&1)
if ! echo "$said" | grep -q '^0 of [0-9]* runs to do'; then
    fail "runs without a kept twin: a version, a default or a key is another one"
    echo "$said" | grep '^  ' | head -5
    echo "  if that is meant, add their bits: build/breccia sweep tests/data/physics/sweep.yaml -o results/physics"
fi

# Another C library, or a processor for which it has other routines, may round functions otherwise;
# bits can only be compared where it does not. ONLY=functions prints what kept/functions should
# hold.
functions() {
    awk 'BEGIN {
        for (i = 1; i <= 4000; i++) {
            x = i / 997
            printf "%.17g %.17g %.17g %.17g %.17g %.17g\n", exp(x), log(x), sin(x), cos(x), atan2(x, 1), x ^ 1.7
        }
    }' | cksum
}
if [ "${ONLY:-}" = functions ]; then
    functions
    exit 0
fi
if [ "$(functions)" != "$(cat kept/functions)" ]; then
    echo "another C library: bits are not compared"
    exit $((failures > 0))
fi

if ! $sweep --verify 100% --quiet >verified.txt 2>&1; then
    fail "the bits of results have changed, and no version has moved"
    $sweep --verify 100% 2>&1 | grep 'IS NOT AS KEPT' | cut -c1-200
    cat <<'END'
  Move the version of the part that computes otherwise, then add the new bits by
      build/breccia sweep tests/data/physics/sweep.yaml -o results/physics
  one model alone:  `physics` in MODEL/model.c: the model's, or that of the law whose runs differ
  one test alone:   .physics in common/rigs/TEST.c
  measures alone:   brc_rigs_physics in common/rigs/rigs.c (loading too, where states differ)
  seeds alone:      brc_specimen_physics in common/specimen/specimen.c
  everything:       brc_engine_physics in common/engine/sim.c (or one regime of it)
  Results that differ by 1e-12 or less everywhere: another compiler, C library or processor.
END
fi
[ $failures -eq 0 ]
