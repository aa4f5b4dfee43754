#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# breccia bursts: breaks of runs, of tables that it has packed, and what it refuses.
. tests/cli/begin.sh

# breaks by hand: 40 avalanches a run of 1, 2, 4, ... breaks, 1000 steps and 2.5 % of the strain apart
by_hand() {
    mkdir -p "$1"
    awk -v shift="$2" 'BEGIN {
        print "step [1],stress [Pa],strain [1],broken [1]"
        for (k = 0; k < 40; k++) {
            n = 2 ^ int(-log(1 - (k * 7 + shift) % 40 / 40) / log(2))
            printf "%d,5,%g,%d\n", 1000 * k + 10, 0.025 * k + 0.001, all
            all += n
            printf "%d,5,%g,%d\n", 1000 * k + 20, 0.025 * k + 0.0011, all
        }
        printf "40000,5,1,%d\n", all
    }' >"$1/curve.csv"
}
by_hand a 0
by_hand b 3
expect 0 " breaks of 2 runs" "$breccia" bursts a b
expect 0 "gaps of 100 steps: 80 avalanches, the largest of 32 breaks" "$breccia" bursts a b --pack all.csv
"$breccia" bursts a b >of_runs.txt
"$breccia" bursts all.csv >of_pack.txt
cmp -s of_runs.txt of_pack.txt || fail "a pack has other numbers than its runs"
"$breccia" bursts a b >again.txt
cmp -s of_runs.txt again.txt || fail "the same breaks have other numbers"
expect 0 "results in out" "$breccia" bursts all.csv -o out
[ "$(wc -l <out/bursts.csv)" -eq 7 ] || fail "rows of bursts.csv"
# the rate's histogram has all spans with breaks: one an avalanche
awk -F, '$1 == 0.001 { n++ } END { exit !(n == 6) }' out/bursts_histogram.csv || fail "six sizes are six classes"
expect 3 "already holds bursts.csv" "$breccia" bursts all.csv -o out
expect 0 "results in out" "$breccia" bursts a b -o out --force

mkdir none empty
printf 'step [1],strain [1],broken [1]\n10,0.1,0\n20,0.2,0\n' >none/curve.csv
expect 3 "no bond has broken in these 1 runs" "$breccia" bursts none
expect 0 "gaps of 10 steps: 40 avalanches" "$breccia" bursts none a
expect 4 "cannot read the breaks of a run" "$breccia" bursts empty
printf 'step,strain\n' >bad.csv
expect 3 "bad.csv:1: no columns step, strain and broken" "$breccia" bursts bad.csv
printf 'step,strain,broken\n1,x,3\n2,nan,4\n' >bad.csv
expect 3 "bad.csv:3: not four numbers" "$breccia" bursts bad.csv
: >bad.csv
expect 3 "bad.csv:1: no columns" "$breccia" bursts bad.csv
expect 2 "bursts needs" "$breccia" bursts
expect 0 "example:" "$breccia" bursts --help

[ $failures -eq 0 ]
