#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# breccia sweep: tables, what is kept and taken again, a stop, failures, ranks, bad input.
. tests/cli/begin.sh
mkdir cases
cat >cases/box.yaml <<'END'
breccia: 1
title: A small box
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6}
test: {kind: compression, strain_max: 0.0004, rate: 1e-6 1/s, rate_max: 1e-5 1/s}
END
cat >cases/sweep.yaml <<'END'
breccia: 1
title: Stiffness of a small box
case: box.yaml
axes:
  model: [polyhedra, vgcm]
  specimen.seed: 1..3
  vgcm.e_bar: [0.5x, 1x, 2x]
collect: [E_platen, nu]
END
sweep="$breccia sweep cases/sweep.yaml"

# bad input: one line with file and line, before anything is made
bad() {
    status=3
    [ $# -lt 3 ] || status=$3
    printf 'breccia: 1\ncase: box.yaml\n%b\n' "$1" >cases/bad.yaml
    expect "$status" "$2" "$breccia" sweep cases/bad.yaml -o made
    [ "$("$breccia" sweep cases/bad.yaml -o made 2>&1 | wc -l)" -eq 1 ] || fail "$1: not one line"
    [ ! -e made ] || fail "$1: has made a folder"
}
bad 'axes: {vgcm.e_barr: [1 GPa]}' "bad.yaml:3: vgcm.e_barr: unknown key"
bad 'axes: {vgcm.e_bar: []}' "bad.yaml:3: vgcm.e_bar: the axis has no value"
bad 'axes:\n  vgcm.eta: [1]\n  vgcm.e_bar:' "bad.yaml:5: vgcm.e_bar: the axis has no value"
bad 'axes: {vgcm.e_bar: [1 GPa, -1 GPa]}' "bad.yaml:3: vgcm.e_bar: -1 GPa is out of range"
bad 'axes: {vgcm.e_bar: [1x, 1 kg]}' "bad.yaml:3: vgcm.e_bar: the unit 'kg' has the wrong dimension"
bad 'axes: {model: [vgcmm]}' "bad.yaml:3: model: unknown model 'vgcmm'; there are: "
bad 'axes:\n  vgcm.eta: [1]\n  vgcm.eta: [2]' "bad.yaml:5: vgcm.eta: given twice, first in line 4"
bad 'axes:\n  vgcm.eta: [1]\n  vgcm.eta, vgcm.mu: [2]' "bad.yaml:5: vgcm.eta: is set by the axis vgcm.eta, too, in line 4"
bad 'axes: {vgcm.eta: [1, 1]}' "bad.yaml:3: vgcm.eta: has the same value twice"
bad 'axes: {specimen.seed: 3..1}' "a range is"
bad 'axis: {specimen.seed: 1..3}' "did you mean 'axes'?"
bad 'collect: [E, strenth]' "does not measure 'strenth'; there are: E, nu, "
bad 'axes: {specimen.seed: 1..3}\nover: [model]' "bad.yaml:4: over: no axis 'model'"
bad 'axes: {specimen.diameter: [1 cm]}' "bad.yaml:3: specimen.diameter: applies only with shape=cylinder"
bad 'axes: {vgcm.g_fn: [2x]}' "bad.yaml:3: vgcm.g_fn: 2x is a factor on the value of the case, which is 'auto'"
bad 'groups: {a: {case: nothing.yaml}}' "bad.yaml:3: case: cannot read the case file cases/nothing.yaml" 4
bad 'axes: {model: [&a vgcm]}' "anchors and aliases"
expect 3 "unknown key of a sweep" "$breccia" sweep cases/box.yaml -o made
for option in --jobs=0 --verify=3 --set=vgcm.e_bar=3; do
    expect 2 "breccia: --" $sweep -o made "$option"
done
expect 4 "cannot read the sweep file" "$breccia" sweep nothing.yaml
[ ! -e made ] || fail "a refused sweep has made a folder"

# a dry run tells, and makes nothing
expect 0 "12 of 18 runs to do" $sweep -o all --dry-run
[ ! -e all ] || fail "a dry run has made a folder"

# axes without effect share a run; factors are of the case's value
expect 0 "results in all" $sweep -o all
[ "$(wc -l <all/runs.jsonl)" -eq 12 ] || fail "lines of the record: $(wc -l <all/runs.jsonl)"
[ "$(wc -l <all/runs.csv)" -eq 19 ] || fail "rows of runs.csv"
[ "$(wc -l <all/sweep.csv)" -eq 13 ] || fail "rows of sweep.csv"
[ -s all/sweep.h5 ] || fail "no sweep.h5"
if command -v gnuplot >/dev/null && [ ! -s all/sweep.png ]; then fail "no picture"; fi
[ "$(grep -c '^1 ' all/sweep.gp)" -eq 4 ] || fail "points of the picture: 1x for two models and two results"
[ ! -e all/unfinished ] || fail "finished runs leave folders"
grep -q '"vgcm.e_bar": "97.6 GPa"' all/runs.jsonl || fail "2x is not twice the value"
awk -F, '$1 == "all" && $2 == "vgcm" && $5 == "E_platen" { e[$4] = $8; n += $7 }
    END { exit !(n == 9 && (e["2x"] / e["1x"] - 2) ^ 2 < 1e-12 && (e["1x"] / e["0.5x"] - 2) ^ 2 < 1e-12) }' \
    all/sweep.csv || fail "a stiffer contact does not make a stiffer box"

# what is kept is not done again, from a fresh folder neither
cp -r all before
expect 0 " 0 to do" $sweep -o all
for file in sweep.csv runs.csv sweep.h5 runs.jsonl; do
    cmp -s before/$file all/$file || fail "$file is another one without a run"
done
expect 0 " 0 to do" $sweep -o fresh --cache before/runs.jsonl
cmp -s before/sweep.csv fresh/sweep.csv || fail "another folder has another table"
[ ! -e fresh/runs.jsonl ] || fail "--cache is not alone"
# a key that changes no bit, and a value in another unit, are the same run; another value is another
expect 0 " 0 to do" $sweep -o all --set run.simd=base --set "vgcm.sigma_t=11400 kPa" --set run.checkpoint="1 s"
expect 0 "12 of 18 runs to do" $sweep -o all --set run.skin=0.21 --dry-run
expect 0 "verified: 6 of 12 runs, 0 not as kept" $sweep -o all --verify 50%
cmp -s before/runs.jsonl all/runs.jsonl || fail "verifying has changed the record"
expect 0 " 12 to do" $sweep -o all --fresh
[ "$(wc -l <all/runs.jsonl)" -eq 24 ] || fail "--fresh takes what is kept"
[ ! -e all/verified ] || fail "verifying leaves folders"

# a folder that holds something else of these names
mkdir mine
echo "my own" >mine/sweep.csv
expect 3 "no sweep has written" $sweep -o mine
grep -q "my own" mine/sweep.csv || fail "a file of the user is replaced"
expect 0 "results in mine" $sweep -o mine --force --cache before/runs.jsonl

# a record that a stop has cut, and one that was changed
head -c -20 before/runs.jsonl >cut.jsonl
expect 0 " 1 to do" $sweep -o cut --cache cut.jsonl
[ "$(wc -l <cut.jsonl)" -eq 12 ] || fail "a cut line is not replaced"
sed 's/"steps": 314/"steps": 315/' before/runs.jsonl >changed.jsonl
expect 3 "is not as it was written" $sweep -o changed --cache changed.jsonl

# a record that is no record is the user's, also without an end of line
printf 'my notes' >notes.txt
expect 3 "no line of a record" $sweep -o notes --cache notes.txt
[ "$(cat notes.txt)" = "my notes" ] || fail "a file that is no record is cut"

# failures are told, the others go on, and the raw runs are kept where that is asked for
cat >cases/failing.yaml <<'END'
breccia: 1
case: box.yaml
groups:
  a:
    axes:
      way: {good: {vgcm.eta: 0.2}, bad: {run.regime: dynamic, run.dt: 1 s}}
  b: {set: {model: polyhedra}, axes: {specimen.seed: 1..2}}
END
expect 9 "1 of 4 runs failed, see runs.csv; the first: a way=bad: run.dt = 1 s is above the stable limit" \
    "$breccia" sweep cases/failing.yaml -o failing --keep
grep -q '^a,bad,.*above the stable limit' failing/runs.csv || fail "no message in runs.csv"
grep -q '^a,bad,,*E_platen,Pa,0,.*,1,1$' failing/sweep.csv || fail "a failure is not counted"
[ "$(ls failing/runs/*/summary.json | wc -l)" -eq 3 ] || fail "--keep keeps no runs"
expect 9 " 0 to do" "$breccia" sweep cases/failing.yaml -o failing

# a stop: what is finished stays, what is not goes on
cat >cases/long.yaml <<'END'
breccia: 1
case: box.yaml
set:
  specimen: {cells: [5, 5, 5], size: [5 cm, 5 cm, 5 cm]}
  test: {strain_max: 0.005, stop_drop: 0, target: 0.0005}
axes: {model: [vgcm, polyhedra], specimen.seed: 1..3}
END
long="$breccia sweep cases/long.yaml"
$long -o part >stopped.txt 2>&1 &
# until one run is kept and another has listed its pairs, which is the last thing before its first step
for try in $(seq 400); do
    if [ -s part/runs.jsonl ] && grep -qs ' pairs, ' part/unfinished/*/log; then break; fi
    sleep 0.05
done
sleep 0.2
kill -TERM $!
wait $!
[ $? -eq 7 ] || fail "a stopped sweep does not end with 7"
grep -q "go on with: $breccia sweep cases/long.yaml -o part" stopped.txt || { fail "no way to go on"; cat stopped.txt; }
kept=$(wc -l <part/runs.jsonl)
if [ "$kept" -eq 0 ] || [ "$kept" -eq 6 ]; then fail "the stop came too early or too late: $kept"; fi
ls part/unfinished/*/state.h5 >/dev/null || fail "a run that was stopped has saved nothing"
expect 0 " $((6 - kept)) to do" $long -o part
expect 0 " 6 to do" $long -o whole --jobs 1
# all but the record's order and times
values() {
    cut -d, -f1-7 "$1"
}
[ "$(values part/runs.csv)" = "$(values whole/runs.csv)" ] || fail "a stopped sweep has other values"

# a record that is replaced while the sweep runs (git does so) does not take runs with it
$long -o moved >moved.txt 2>&1 &
for try in $(seq 400); do
    if [ -s moved/runs.jsonl ]; then break; fi
    sleep 0.05
done
cp moved/runs.jsonl copy.jsonl
mv copy.jsonl moved/runs.jsonl
wait $!
[ $? -eq 4 ] || fail "a record that was replaced goes unnoticed"
grep -q "was removed or replaced" moved.txt || { fail "no word of a record that was replaced"; cat moved.txt; }
good $long -o moved
[ "$(wc -l <moved/runs.jsonl)" -eq 6 ] || fail "runs are lost with a record that was replaced"

# ranks share the runs
if command -v mpirun >/dev/null; then
    mpi="mpirun --allow-run-as-root --oversubscribe -n 3"
    expect 0 " 12 to do, 3 at a time" $mpi $sweep -o ranks
    [ "$(values ranks/runs.csv)" = "$(values before/runs.csv)" ] || fail "ranks have other values"
    expect 0 "verified: 12 of 12 runs, 0 not as kept" $mpi $sweep -o ranks --verify 1
    expect 9 "1 of 4 runs failed" $mpi "$breccia" sweep cases/failing.yaml -o ranks_failing
    expect 3 "unknown key" $mpi "$breccia" sweep cases/sweep.yaml --set vgcm.eat=1 -o ranks_bad
fi

# many at the same time
for i in $(seq 8); do
    $sweep -o "many/$i" --quiet >"many_$i.txt" 2>&1 || echo "$i" >>bad.txt &
done
wait
[ ! -e bad.txt ] || fail "of sweeps side by side these have failed: $(tr '\n' ' ' <bad.txt)"
for i in $(seq 8); do
    [ "$(values "many/$i/runs.csv")" = "$(values before/runs.csv)" ] || fail "many/$i has other values"
done
expect 0 "" $sweep -o many/1 # the lock is gone
[ $failures -eq 0 ]
