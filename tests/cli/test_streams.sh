#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What cannot be written to standard output is a failure, told on standard error; descriptors that
# are closed at the start do no harm to the files of a run.
. tests/cli/begin.sh
cat >case.yaml <<'END'
breccia: 1
title: A small box
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 1e-4 1/s, strain_max: 0.002, sample_steps: 1}
output: {plots: off}
END
"$breccia" run case.yaml --quiet -o good >/dev/null || fail "the case itself"

# fails COMMAND...: with standard output full, and closed: status 4 and one line that says it
fails() {
    "$@" >/dev/full 2>said.txt
    [ $? -eq 4 ] || fail "no status 4 with a full standard output: $*"
    grep -q "cannot write all to standard output" said.txt ||
        { fail "a full standard output is not told: $*"; cat said.txt; }
    [ -z "$again" ] || rm -rf again
    "$@" >&- 2>said.txt
    [ $? -eq 4 ] || fail "no status 4 with a closed standard output: $*"
    grep -q "cannot write all to standard output" said.txt ||
        { fail "a closed standard output is not told: $*"; cat said.txt; }
}
again=
fails "$breccia" --help
fails "$breccia" --version
fails "$breccia" run --help
fails "$breccia" models
fails "$breccia" params
fails "$breccia" params vgcm
fails "$breccia" info good/state.h5
fails "$breccia" export good/state.h5 --table pairs
fails "$breccia" export good/state.h5 --format stl
fails "$breccia" export case.yaml --format tess
again=yes
rm -rf again
fails "$breccia" run case.yaml --quiet -o again
[ "$(hash_of again)" = "$(hash_of good)" ] || fail "a run without standard output leaves other files"
rm -rf again
fails "$breccia" compare case.yaml --quiet -o again
[ -s again/compare.txt ] || fail "compare without standard output leaves no table in its folder"
ladder="--model vgcm --observable E --axes step --seeds 1 --refine 2"
rm -rf again
fails "$breccia" converge case.yaml --quiet -o again $ladder

# what goes to a file needs no standard output
"$breccia" export good/state.h5 --table pairs -o pairs.csv >&- 2>said.txt || fail "export -o"
"$breccia" export good/state.h5 --table pairs | cmp - pairs.csv || fail "export -o writes another file"

# any of the three closed, or all: files are as ever, and hold no message
for closed in '2>&-' '0<&-' '0<&- 2>&-'; do
    rm -rf pair ladder alone
    eval '"$breccia" run case.yaml -o alone >/dev/null' "$closed" || fail "run $closed: $?"
    [ "$(hash_of alone)" = "$(hash_of good)" ] || fail "run $closed leaves another state"
    eval '"$breccia" compare case.yaml -o pair >/dev/null' "$closed" || fail "compare $closed: $?"
    [ "$(hash_of pair/vgcm)" = "$(hash_of good)" ] || fail "compare $closed leaves another state"
    eval '"$breccia" converge case.yaml -o ladder $ladder >/dev/null' "$closed" ||
        fail "converge $closed: $?"
    grep -vq '^key,\|^[0-9a-f]\{16\},' ladder/converge_runs.csv && fail "converge $closed: foreign lines"
    eval '"$breccia" converge case.yaml -o ladder --resume $ladder >/dev/null' "$closed" ||
        fail "converge --resume $closed: $?"
done
rm -rf pair
"$breccia" compare case.yaml -o pair 0<&- >&- 2>&-
[ $? -eq 4 ] || fail "all closed: no status 4"
[ "$(hash_of pair/vgcm)" = "$(hash_of good)" ] || fail "all closed: another state"

[ $failures -eq 0 ] || exit 1
