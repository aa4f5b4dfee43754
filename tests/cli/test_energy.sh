#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run whose energy does not add up says so on the screen, in its log and summary, and ends with status 8;
# its results are kept. Sound runs, runs in which nothing happens, and runs without a ledger say nothing.
. tests/cli/begin.sh

cat >case.yaml <<'END'
breccia: 1
title: A small box
model: polyhedra
specimen: {shape: box, size: [3 cm, 3 cm, 5 cm], grains: grid, cells: [3, 3, 5], jitter: 0}
test: {kind: compression, strain_max: 0.01}
output: {plots: off}
polyhedra: {radius: 1 mm}
END

# expect STATUS CHECK WARNED ARGUMENT...: status, energy_check of the summary, 1 where a line tells of it
expect() {
    local status=$1 check=$2 warned=$3 now
    shift 3
    "$breccia" run case.yaml -o run --force "$@" >out.txt 2>err.txt
    now=$?
    [ $now = "$status" ] || fail "status $now, expected $status: $*"
    grep -q "\"energy_check\": \"$check\"" run/summary.json || fail "not $check: $*"
    for file in out.txt run/log; do
        [ "$(grep -c 'polyhedra: energy .* of the work' $file)" = "$warned" ] || fail "$file does not fit: $*"
    done
    [ "$(grep -c 'energy .* of the work' err.txt)" = "$warned" ] || fail "standard error does not fit: $*"
    [ -s run/state.h5 ] && [ -s run/curve.csv ] || fail "results were not kept: $*"
    grep -q "energy drift" out.txt || fail "no table: $*"
}

# strictly inside feet do not exist on faces that coincide: springs come and go with rounding
expect 8 wrong 1 --set polyhedra.features=strict
expect 8 wrong 1 --set polyhedra.features=strict --quiet
grep -q "^breccia: .*energy drift of .*results are in run$" err.txt || fail "no message with the folder"
expect 0 off 0 --set polyhedra.features=strict --set run.ledger=off
expect 0 good 0 --set specimen.jitter=0.5 --set test.strain_max=0.002
# nothing moves but rounding, which is a large part of no work at all
expect 0 good 0 --set specimen.jitter=0.5 --set test.kind=none --set run.max_steps=500

"$breccia" compare case.yaml -o pair --set polyhedra.features=strict --set test.strain_max=0.002 \
    >out.txt 2>err.txt
[ $? = 8 ] || fail "compare does not end with 8"
grep -q "polyhedra: energy drift of" out.txt || fail "compare's table does not tell"
[ -s pair/compare.txt ] && [ -s pair/vgcm/summary.json ] || fail "compare has not kept its results"

exit $((failures > 0))
