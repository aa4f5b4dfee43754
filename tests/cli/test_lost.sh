#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Nothing that a run did not write is replaced or removed without --force, and an input never; what is
# read back is what was written.
. tests/cli/begin.sh

contents() {
    find "$1" -type f ! -name said.txt ! -name out.txt -exec sha256sum {} + 2>/dev/null | sort
}
# refuse FOLDER TEXT COMMAND...: an error that says the text; the folder stays as it is
refuse() {
    before=$(contents "$1") place=$1 text=$2
    shift 2
    if "$@" >out.txt 2>said.txt; then
        fail "not refused: $*"
    fi
    grep -qF -- "$text" said.txt || { fail "no '$text' from: $*"; sed 's/^/  | /' said.txt; }
    [ "$before" = "$(contents "$place")" ] || fail "$place has changed by: $*"
}
run() {
    "$breccia" run case.yaml --quiet "$@"
}

cat >case.yaml <<'END'
breccia: 1
title: A small box
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6, seed: 3}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 4e-4}
output: {plots: off, frames: 1}
END

# --- a run --------------------------------------------------------------------------------------
good run -o whole
rm whole/state.h5
refuse whole "holds results (summary.json) but no state.h5" run -o whole --resume

# files of the user's own, one at a time
for file in case.yaml log summary.json curve.csv curves.gp cracks.gp gnuplot.log state.h5.part \
    curve.csv.part frames/grains_00000.hdf frames/bonds.hdf.series; do
    rm -rf own
    mkdir -p "own/$(dirname "$file")"
    echo "my own" >"own/$file"
    refuse own "own already holds results ($file)" run -o own
    [ "$file" = log ] && refuse own "holds no run to resume" run -o own --resume
done
# a file that begins with a byte 0 is not empty
printf '\0my own' >own.log
rm -rf own
mkdir own
cp own.log own/log
refuse own "own already holds results (log)" run -o own
refuse own "holds no run to resume" run -o own --resume
# frames of another name are never removed
rm -rf own
mkdir -p own/frames
echo mine | tee own/frames/grains_mine.hdf own/frames/grains_1.hdf own/frames/bonds_00000.hdf.txt >own/notes.txt
good run -o own
good run -o own --force
[ "$(cat own/frames/grains_mine.hdf own/frames/grains_1.hdf own/frames/bonds_00000.hdf.txt own/notes.txt | uniq -c |
    awk '{ print $1 $2 }')" = 4mine ] || fail "a file of the user's is lost"

# an input is not replaced, by no option
rm -rf own
mkdir own
cp case.yaml own
refuse own "already holds results (case.yaml)" "$breccia" run own/case.yaml -o own
refuse own "own/case.yaml is the case that is read" "$breccia" run own/case.yaml -o own --force --set specimen.seed=4
ln -s own linked
refuse own "linked/case.yaml is the case that is read" \
    "$breccia" run own/case.yaml -o linked --force --set specimen.seed=4
good "$breccia" run own/case.yaml -o own --force --quiet
cmp -s case.yaml own/case.yaml || fail "the case that was read is replaced"
rm -rf own
mkdir own
printf '0.005 0.005 0.005\n0.015 0.005 0.006\n0.005 0.015 0.02\n0.015 0.014 0.025\n' >own/curve.csv
sed 's/grains: grid, cells.*}/grains: points, points: own\/curve.csv}/' case.yaml >points.yaml
refuse own "own/curve.csv is an input of this run" "$breccia" run points.yaml -o own --force
cp own/curve.csv own/log
refuse own "own/log is an input of this run" "$breccia" run points.yaml -o own --force --set specimen.points=own/log
cp own/curve.csv own/compare.txt
refuse own "own/compare.txt is an input of this run" \
    "$breccia" compare points.yaml -o own --force --set specimen.points=own/compare.txt

# two runs that begin together: the slower one finds the results of the other
good run -o first
# the specimen is made between the first look at the folder and the lock: seeds through a pipe wait
mkfifo seeds.fifo
sed 's/grains: grid, cells.*}/grains: points, points: seeds.fifo}/' case.yaml >waits.yaml
"$breccia" run waits.yaml -o race --quiet >slow.txt 2>&1 &
slow=$!
for try in $(seq 100); do # until it waits for its seeds
    grep -q . "/proc/$slow/wchan" 2>/dev/null && break
    sleep 0.02
done
sleep 0.5
good run -o race
before=$(contents race)
cat own/compare.txt >seeds.fifo
wait $slow && fail "the slower of two runs is not refused"
grep -q "race already holds results" slow.txt || { fail "the slower of two runs"; cat slow.txt; }
[ "$before" = "$(contents race)" ] || fail "the slower of two runs has changed the results"

# the kept case follows the limits; one that the user has changed stays
good run -o parts --set run.max_steps=7
good run -o parts --resume --set test.strain_max=2e-4
grep -q 'strain_max: 2e-4}' parts/case.yaml && ! grep -q max_steps parts/case.yaml ||
    fail "the kept case is stale after a resume"
good "$breccia" run parts/case.yaml -o again --quiet
[ "$(grep state_hash again/summary.json)" = "$(grep state_hash parts/summary.json)" ] ||
    fail "the kept case of a resumed run makes another run"
echo "# my note" >>parts/case.yaml
refuse parts "parts/case.yaml is not the case that the run has kept" run -o parts --resume
good "$breccia" run parts/case.yaml -o parts --quiet --resume
grep -q "# my note" parts/case.yaml || fail "the note is lost"

# --- compare ------------------------------------------------------------------------------------
for file in compare.txt curves.gp cracks.png vgcm/case.yaml polyhedra/frames/grains_00000.hdf; do
    rm -rf pair
    mkdir -p "pair/$(dirname "$file")"
    echo "my own" >"pair/$file"
    refuse pair "already holds results (${file#*[mna]/})" "$breccia" compare case.yaml -o pair --quiet
    good "$breccia" compare case.yaml -o pair --quiet --force
done
good "$breccia" compare case.yaml -o pair --quiet --resume
rm pair/vgcm/state.h5
refuse pair "pair/vgcm holds results" "$breccia" compare case.yaml -o pair --quiet --resume

# --- converge -----------------------------------------------------------------------------------
ladder() {
    "$breccia" converge case.yaml --model vgcm --observable E --axes step --seeds 1 --refine 2 "$@"
}
for file in converge.txt converge.csv converge.gp converge_runs.csv converge_unfinished/notes.txt; do
    rm -rf steps
    mkdir -p "steps/$(dirname "$file")"
    printf 'my own' >"steps/$file"
    refuse steps "already holds results (${file%/*})" ladder -o steps
done
rm -rf steps
mkdir steps
printf 'my own' >steps/converge_runs.csv
refuse steps "holds other results" ladder -o steps --resume
rm -rf steps
good ladder -o steps
cp -r steps saved
runs=$(grep -c ,vgcm, steps/converge_runs.csv)
good ladder -o steps --resume
cmp -s steps/converge_runs.csv saved/converge_runs.csv || fail "finished runs are done again"
# one digit of each line, each column of one line
for line in $(seq 2 "$((runs + 1))"); do
    cp saved/converge_runs.csv steps
    awk -F, -v OFS=, -v line="$line" -v column=$((6 + line % 3)) \
        'NR == line { match($column, /[0-9]/); digit = substr($column, RSTART, 1)
                      sub(/[0-9]/, digit == 1 ? 2 : 1, $column) } { print }' saved/converge_runs.csv \
        >steps/converge_runs.csv
    cmp -s steps/converge_runs.csv saved/converge_runs.csv && fail "nothing was changed in line $line"
    refuse steps "is not as it was written" ladder -o steps --resume
done
# a byte 0, as a power cut may leave: the lines behind it stay
awk 'NR == 2 { sub(/,/, "@") } { print }' saved/converge_runs.csv | tr @ '\0' >steps/converge_runs.csv
refuse steps "is not as it was written" ladder -o steps --resume
cp saved/converge_runs.csv steps
good ladder -o steps --force

# --- export -------------------------------------------------------------------------------------
state=first/state.h5
refuse first "-o: first/state.h5 is what is read" "$breccia" export $state --table curve -o $state --force
refuse first "-o: first/curve.csv is there; replace it with --force" \
    "$breccia" export $state --table curve -o first/curve.csv
refuse first "-o: first/./state.h5 is what is read" "$breccia" export $state --format stl -o first/./state.h5 --force
echo mine >box.tess.part
refuse . "box.tess.part is there" "$breccia" export case.yaml --format tess -o box.tess
rm box.tess.part
refuse . "case.yaml is what is read" "$breccia" export case.yaml --format tess -o case.yaml --force
sed 's/own.curve/own\/compare/; s/csv/txt/' points.yaml >seeds.yaml
refuse own "own/compare.txt is what is read" "$breccia" export seeds.yaml --format tess -o own/compare.txt --force
mkfifo pipe
refuse . "pipe is there and is not a plain file" timeout 5 "$breccia" export $state --table curve -o pipe --force
echo old >table.csv
refuse . "table.csv is there" "$breccia" export $state --table curve -o table.csv
good "$breccia" export $state --table curve -o table.csv --force
cmp -s table.csv first/curve.csv || fail "--force does not replace"
[ $failures -eq 0 ]
