#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# breccia converge: files and table of a small ladder, a stop and what follows it, bad input.
. tests/cli/begin.sh

model=$("$breccia" models | awk 'NR == 1 { print $1 }')
n_models=$("$breccia" models | wc -l)
cat >case.yaml <<EOF
breccia: 1
title: A small box
model: $model
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6}
test: {kind: compression, strain_max: 0.0004, rate: 1e-6 1/s, rate_max: 1e-5 1/s}
EOF

# bad input: what is allowed, nothing made
expect 2 "no axis 'stp'; there are: step, loading, rate, grains, " \
    "$breccia" converge case.yaml --axes loading,stp
expect 2 "does not measure 'strenth'; there are: E, nu, " "$breccia" converge case.yaml --observable strenth
expect 2 "--seeds takes a whole number from 1 to 64, not '0'" "$breccia" converge case.yaml --seeds 0
expect 2 "--seeds takes a whole number" "$breccia" converge case.yaml --seeds 3x
expect 2 "--refine takes a power of 2 from 2 to 256, not 3" "$breccia" converge case.yaml --refine 3
expect 2 "did you mean '--axes'?" "$breccia" converge case.yaml --axis step
expect 3 "use --seeds 1" "$breccia" converge case.yaml --set specimen.grains=points
expect 3 "nothing to converge" "$breccia" converge case.yaml --set test.kind=none
expect 3 "there are: " "$breccia" converge case.yaml --model nothing
for option in --axes=stp --observable=strenth; do
    [ "$("$breccia" converge case.yaml $option 2>&1 | wc -l)" -eq 1 ] || fail "$option: not one line"
done
[ ! -e results ] || fail "a refused ladder has made a folder"

# a ladder of all models
ladder="$breccia converge case.yaml --observable E --axes step,grains --seeds 2 --refine 2"
expect 0 "results in all" $ladder --jobs 2 -o all
for file in converge.txt converge.csv converge_runs.csv converge.gp; do
    [ -s all/$file ] || fail "no $file"
done
[ ! -e all/converge_unfinished ] || fail "finished runs leave folders"
if command -v gnuplot >/dev/null && [ ! -s all/converge.png ]; then fail "no chart"; fi
[ "$(grep -c ': reference E ' all/converge.txt)" -eq "$n_models" ] || fail "a model has no table"
# case, reference and two more, steps of 1/4, 1/2, 1, 1.4 and 2, three grain sizes; two seeds.
# Those that are the case or the reference's loading again are run once, but for models that have a
# literal evaluation: references are of that.
for name in $("$breccia" models | awk '{ print $1 }'); do
    runs=18
    if "$breccia" params "$name" | grep -q evaluation; then runs=20; fi
    [ "$(grep -c ",$name," all/converge_runs.csv)" -eq $runs ] || fail "runs of $name"
    [ "$(grep -c "^$name," all/converge.csv)" -eq 12 ] || fail "settings of $name"
done
expect 3 "already holds results (converge_runs.csv)" "$breccia" converge case.yaml -o all

# kept runs are not done again, and their figures stay
cp all/converge_runs.csv before.csv
cp all/converge.csv settings.csv
expect 0 "results in all" $ladder -o all --resume
cmp -s before.csv all/converge_runs.csv || fail "finished runs are done again"
cmp -s settings.csv all/converge.csv || fail "the same runs give another table"

# a stop keeps what is done, and a line that was cut is done again; the values are the same
$ladder -o part >stopped.txt 2>&1 &
for try in $(seq 200); do
    if [ -s part/converge_runs.csv ] && [ "$(wc -l <part/converge_runs.csv)" -ge 4 ]; then break; fi
    sleep 0.05
done
kill -TERM $!
wait $!
[ $? -eq 7 ] || fail "a stopped ladder does not end with 7"
grep -q -- "go on with: $breccia converge case.yaml --observable E .*-o part --resume" stopped.txt ||
    { fail "a stopped ladder does not say how to go on"; cat stopped.txt; }
head -c -20 part/converge_runs.csv >cut && cp cut part/converge_runs.csv
expect 0 "results in part" $ladder -o part --resume
# all but processor time, and the digest, which depends on it
values() {
    sed 's/,[^,]*$//' "$1" | cut -d, -f1-7,9- | sort
}
[ "$(values all/converge_runs.csv)" = "$(values part/converge_runs.csv)" ] ||
    fail "a stopped ladder has other values"

# a test whose load is given has no rate to refine, and ends by a key of its own
sed 's/^test:.*/test: {kind: cantilever}/' case.yaml >beam.yaml
expect 0 "its load is given, so the axis loading is left out" "$breccia" converge beam.yaml \
    --observable E_c --axes loading,step --seeds 1 --refine 2 -o beam
"$breccia" converge beam.yaml --observable E_c --axes loading,step --seeds 1 --refine 2 -o beam --resume 2>&1 |
    grep '^case ' | grep -q 'ended' && fail "a cantilever at rest is not counted as ended"
grep -q '^reference *step x 0.5 ' beam/converge.txt && ! grep -q 'loading x' beam/converge.txt ||
    { fail "a reference without a rate does not say what it varies"; cat beam/converge.txt; }

# a record of another test, and one that is damaged
expect 3 "holds other results" "$breccia" converge case.yaml --set test.kind=tension --seeds 1 \
    -o all --resume
size=$(wc -c <all/converge_runs.csv)
{ head -c 5000 /dev/zero | tr '\0' x; echo; } | cat all/converge_runs.csv - before.csv >long
cp long all/converge_runs.csv
expect 3 "the line 'xxx" "$breccia" converge case.yaml --seeds 1 -o all --resume
[ "$(wc -c <all/converge_runs.csv)" -gt $((size + 5000)) ] || fail "a damaged record is cut"
cp before.csv all/converge_runs.csv
echo nonsense >>all/converge_runs.csv
expect 3 "the line 'nonsense" "$breccia" converge case.yaml --seeds 1 -o all --resume

# a value out of its range is left out of the ladder, the ladder is not given up
expect 0 "out of range" "$breccia" converge case.yaml --observable E --axes step --seeds 1 --refine 2 \
    --model "$model" --set run.mass_margin=20 -o one

[ $failures -eq 0 ] || exit 1
