#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs that `kill -9` ends at random moments go on with --resume, and end with the state hash and the
# tables of a run that was left in peace. KILL_SEED repeats the moments of a run of this test.
. tests/cli/begin.sh
seed=${KILL_SEED:-$(($(date +%s%N) % 1000000))}
kills_wanted=${KILL_N:-20} # of each model
echo "moments from KILL_SEED=$seed"
RANDOM=$((seed % 32768))

# the load breaks bonds over most of the way
cat >case.yaml <<'END'
breccia: 1
title: A small box
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6, seed: 3}
test: {kind: compression, loading: fixed, rate: 5e-5 1/s, strain_max: 0.05, stop_drop: 0}
run: {checkpoint_steps: 20}
output: {plots: off, frames: 8}
END

now_ms() {
    echo $(($(date +%s%N) / 1000000))
}

# compare_with REFERENCE RUN
compare_with() {
    [ -n "$(hash_of "$2")" ] && [ "$(hash_of "$1")" = "$(hash_of "$2")" ] ||
        fail "$2 ends with hash $(hash_of "$2"), expected $(hash_of "$1")"
    (cd "$1" && find . -type f ! -name log ! -name summary.json ! -name state.h5) | sort >"$1.files"
    (cd "$2" && find . -type f ! -name log ! -name summary.json ! -name state.h5) | sort >"$2.files"
    cmp -s "$1.files" "$2.files" || fail "$2 has other files than $1: $(diff "$1.files" "$2.files")"
    cmp -s <(grep -v '"cpu_s"\|"wall_s"\|"ns_per_contact_step"' "$1/summary.json") \
        <(grep -v '"cpu_s"\|"wall_s"\|"ns_per_contact_step"' "$2/summary.json") ||
        fail "$2/summary.json differs: $(diff "$1/summary.json" "$2/summary.json")"
    while read -r file; do
        cmp -s "$1/$file" "$2/$file" || fail "$2/$file differs from that of a run left in peace"
    done <"$1.files"
}

# one_run MODEL LONGEST: starts and kills one run until it comes to its end
one_run() {
    rm -rf run
    way=
    while :; do
        "$breccia" run case.yaml --model "$1" -o run --quiet $way >said.txt 2>&1 &
        process=$!
        if [ $kills -lt "$kills_wanted" ]; then
            sleep "$(printf '0.%03d' $((RANDOM % $2)))"
            kill -KILL $process 2>/dev/null
        fi
        wait $process 2>/dev/null
        status=$?
        [ $status -eq 0 ] && return
        [ $status -eq 137 ] || { fail "status $status: $(cat said.txt)"; return; }
        kills=$((kills + 1))
        # before it has a log, a run is nothing that could go on
        way=
        [ -e run/log ] && way=--resume
    done
}

for model in $("$breccia" models | awk '{ print $1 }'); do
    start=$(now_ms)
    "$breccia" run case.yaml --model "$model" -o "$model" --quiet >said.txt 2>&1 ||
        fail "$model: $(cat said.txt)"
    took=$(($(now_ms) - start))
    longest=$((took / 3 > 999 ? 999 : took / 3))
    kills=0 resumed=0
    while [ $kills -lt "$kills_wanted" ] && [ $failures -eq 0 ]; do
        one_run "$model" $((longest > 5 ? longest : 5))
        compare_with "$model" run
        resumed=$((resumed + $(grep -c '^resumed at step [1-9]' run/log)))
    done
    broken=$(($(wc -l <"$model/events.csv") - 1))
    echo "$model: $took ms, $broken breaks, $kills kills, $resumed resumed past the start"
    [ $broken -gt 0 ] || fail "$model: nothing broke"
    # under sanitizers most of a run is its start
    case ${BUILD:-build} in */san) continue ;; esac
    [ $resumed -gt 0 ] || fail "$model: no run was resumed past its start"
done
[ $failures -eq 0 ]
