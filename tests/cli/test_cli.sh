#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The command line: exit statuses, messages, files, and that nothing is overwritten or lost.
. tests/cli/begin.sh

# one error is one line
expect_one_line() {
    lines=$("$@" 2>&1 >/dev/null | wc -l)
    [ "$lines" -eq 1 ] || { echo "FAILED: $* says $lines lines"; failures=$((failures + 1)); }
}

model=$("$breccia" models | awk 'NR == 1 { print $1 }')
cat >case.yaml <<EOF
breccia: 1
title: A small box
model: $model
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 0.004}
EOF
sed 's/strain_max/strain_mx/' case.yaml >wrong.yaml

# help and usage
expect 0 "exit status:" "$breccia" --help
expect 0 "breccia " "$breccia" --version
for command in run compare params models; do
    expect 0 "example:" "$breccia" $command --help
done
expect 2 "usage: breccia" "$breccia"
expect 2 "did you mean 'compare'?" "$breccia" comparre case.yaml
expect 2 "did you mean '--resume'?" "$breccia" run case.yaml --resum
expect 2 "run needs a case file" "$breccia" run
expect 2 "-o needs a value" "$breccia" run case.yaml -o
expect 2 "'other.yaml' is too much" "$breccia" run case.yaml other.yaml
expect 2 "exclude each other" "$breccia" run case.yaml --resume --force
expect 2 "--resume takes no value" "$breccia" run case.yaml --resume=yes
expect 0 "diameter_min" "$breccia" params specimen
expect 0 "strain_max" "$breccia" params
expect 2 "no section 'specimn'; did you mean 'specimen'?" "$breccia" params specimn

# input
expect 3 "there are: " "$breccia" run case.yaml --model nothing
expect 3 "did you mean 'strain_max'?" "$breccia" run wrong.yaml
expect 3 "wrong.yaml:5" "$breccia" compare wrong.yaml
expect 3 "out of range" "$breccia" run case.yaml --set test.strain_max=-1
expect_one_line "$breccia" run wrong.yaml
expect_one_line "$breccia" run absent.yaml
[ ! -e results ] || { echo "FAILED: a refused case has made a folder"; failures=$((failures + 1)); }

# a run, and what protects it
expect 0 "results in results/case/$model" "$breccia" run case.yaml
for file in summary.json curve.csv events.csv broken.csv events_clustered.csv crack_angles.csv fragments.csv \
    state.h5 case.yaml log; do
    [ -s "results/case/$model/$file" ] ||
        { echo "FAILED: no $file"; failures=$((failures + 1)); }
done
cmp -s case.yaml "results/case/$model/case.yaml" ||
    { echo "FAILED: case.yaml is not a copy"; failures=$((failures + 1)); }
hash=$(grep state_hash "results/case/$model/summary.json")
expect 3 "already holds results" "$breccia" run case.yaml
expect 3 "holds no run to resume" "$breccia" run case.yaml -o other --resume
expect 3 "the case says 'specimen.seed = 2'" "$breccia" run case.yaml --resume --set specimen.seed=2
: >file
expect 4 "is not a folder" "$breccia" run case.yaml -o file/x
expect 0 "results in" "$breccia" run case.yaml --force
[ "$hash" = "$(grep state_hash "results/case/$model/summary.json")" ] ||
    { echo "FAILED: a repeated run has other bits"; failures=$((failures + 1)); }

# a run in two parts has the bits of the whole; so has one that a signal has stopped
expect 0 "ended by run.max_steps" "$breccia" run case.yaml -o parts --set run.max_steps=77
expect 0 "results in parts" "$breccia" run case.yaml -o parts --resume
[ "$hash" = "$(grep state_hash parts/summary.json)" ] ||
    { echo "FAILED: a resumed run has other bits"; failures=$((failures + 1)); }
# in each number but for times
counts() {
    grep -v '"cpu_s"\|"wall_s"\|"ns_per_contact_step"\|"case"' "$1/summary.json"
}
for model_name in $("$breccia" models | awk '{ print $1 }'); do
    # bonds break, and the parts end between two samples, in which contacts are counted
    bits="case.yaml --model $model_name --set output.frames=3 --set output.plots=off --quiet"
    bits="$bits --set test.kind=tension --set test.rate=1e-4s-1 --set test.strain_max=0.03"
    bits="$bits --set test.stop_drop=0 --set test.sample_steps=200"
    expect 0 "" "$breccia" run $bits -o "whole_$model_name"
    expect 0 "" "$breccia" run $bits -o "three_$model_name" --set run.max_steps=190
    expect 0 "" "$breccia" run $bits -o "three_$model_name" --set run.max_steps=290 --resume
    expect 0 "" "$breccia" run $bits -o "three_$model_name" --resume
    [ "$(counts "whole_$model_name")" = "$(counts "three_$model_name")" ] ||
        { echo "FAILED: the summary of a resumed run differs"; failures=$((failures + 1))
          diff "whole_$model_name/summary.json" "three_$model_name/summary.json"; }
done

# an automatic rate hangs on strain_max: with another one, the run would not be that of one part
auto="case.yaml --set test.rate=0s-1 --set test.loading=adaptive --quiet"
expect 0 "" "$breccia" run $auto -o auto --set test.strain_max=2e-4
expect 3 "an automatic rate follows test.strain_max" \
    "$breccia" run $auto -o auto --set test.strain_max=4e-4 --resume
rate=$(printf '%s\n' "$said" | sed -n "s/.*made with 'test.rate = \([^ ]*\) 1\/s'.*/\1/p")
given="$auto --set test.rate=${rate}s-1 --set test.strain_max=4e-4"
expect 0 "" "$breccia" run $given -o auto --resume
expect 0 "" "$breccia" run $given -o auto_whole
[ "$(counts auto)" = "$(counts auto_whole)" ] ||
    { echo "FAILED: a run with a new limit is not that of one part"; failures=$((failures + 1)); }

slow="--set test.rate=1e-8s-1"
"$breccia" run case.yaml $slow -o stopped --quiet >stopped.txt 2>&1 &
for try in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    [ -s stopped/case.yaml ] && break
    sleep 0.25
done
kill -TERM $!
wait $!
[ $? -eq 7 ] || { echo "FAILED: a stopped run does not end with 7"; failures=$((failures + 1)); }
grep -qF "go on with: $breccia run case.yaml --set test.rate=1e-8s-1 -o stopped --resume" stopped.txt ||
    { echo "FAILED: a stopped run does not say how to go on"; cat stopped.txt; failures=$((failures + 1)); }
expect 0 "results in stopped" "$breccia" run case.yaml $slow -o stopped --resume \
    --set test.strain_max=1e-6

# both models
expect 0 "energy residual" "$breccia" compare case.yaml -o pair
[ -s pair/compare.txt ] && [ -s "pair/$model/summary.json" ] ||
    { echo "FAILED: compare leaves no table"; failures=$((failures + 1)); }
[ "$hash" = "$(grep state_hash "pair/$model/summary.json")" ] ||
    { echo "FAILED: compare has other bits than run"; failures=$((failures + 1)); }
if command -v gnuplot >/dev/null; then
    for picture in pair/curves.png pair/cracks.png "pair/$model/cracks.png"; do
        [ -s "$picture" ] || { echo "FAILED: no $picture"; failures=$((failures + 1)); }
    done
fi

[ $failures -eq 0 ] || exit 1
