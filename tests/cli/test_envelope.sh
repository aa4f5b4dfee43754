#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# breccia envelope: points and fits of runs of any mixture of tests, what is left out, and what is refused.
. tests/cli/begin.sh

model=$("$breccia" models | awk 'END { print $1 }')
cat >case.yaml <<EOF
breccia: 1
title: A small box
model: $model
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 0.03}
output: {plots: off}
EOF
run() {
    name=$1
    shift
    good "$breccia" run case.yaml --quiet -o "$name" "$@"
}
run pressed
run pulled --set test.kind=tension --set test.strain_max=0.01
run pressed_2 --set specimen.seed=2
run confined --set test.kind=triaxial --set "triaxial.pressure=10 MPa"
run confined_2 --set test.kind=triaxial --set "triaxial.pressure=20 MPa"
run rising --set test.strain_max=2e-4
run other --set run.local_damping=0.3 --set specimen.jitter=0.5

# every test is there with the stresses of its own summary
value() {
    sed -n "s/.*\"$2\": {\"value\": \([^,]*\),.*/\1/p" "$1/summary.json"
}
expect 0 "results in out" "$breccia" envelope pressed pulled pressed_2 confined confined_2 rising pressed -o out
expect 0 "rising is left out: no peak" "$breccia" envelope pressed pulled confined rising
expect 0 "pressed is left out: it is a run that is there already" "$breccia" envelope pressed pulled confined pressed
expect 0 "without the 1 points in tension" "$breccia" envelope pressed confined confined_2 pulled
expect 0 "they differ in specimen.jitter" "$breccia" envelope pressed confined confined_2 other
[ "$("$breccia" envelope pressed pressed_2 confined | grep -c 'of different rock')" -eq 0 ] ||
    fail "seeds count as different rock"
for name in pressed pulled pressed_2 confined confined_2; do
    strength=$(value $name strength)
    grep "^$name," out/envelope.csv | awk -F, -v strength="$strength" '
        function abs(x) { return x < 0 ? -x : x }
        { exit !(abs($6 - $5 - strength) <= 1e-9 * strength) }' ||
        fail "$name: sigma_1 - sigma_3 is not the strength $strength"
done
[ "$(wc -l <out/envelope.csv)" -eq 6 ] || fail "envelope.csv has not 5 runs"
expect 3 "already holds envelope.csv" "$breccia" envelope pressed pressed_2 confined -o out
expect 0 "results in out" "$breccia" envelope pressed pressed_2 confined -o out --force

# runs by hand, whose law is known: cohesion 20 MPa, sin(angle) 0.6; m 10, sigma_ci 100 MPa
by_hand() {
    mkdir -p "$1"
    cat >"$1/summary.json" <<EOF
{
  "model": "$model",
  "state_hash": "$1",
  "results": {
    "sigma_1": {"value": $3, "unit": "Pa"},
    "sigma_3": {"value": $2, "unit": "Pa"},
    "sigma_1_residual": {"value": null, "unit": "Pa", "note": "why not"},
    "sigma_3_residual": {"value": null, "unit": "Pa", "note": "why not"}
  }
}
EOF
}
by_hand line_1 0 80e6
by_hand line_2 5e6 100e6
by_hand line_3 20e6 160e6
expect 0 "c               20  20 to 20" "$breccia" envelope line_1 line_2 line_3
expect 0 "phi          36.87" "$breccia" envelope line_1 line_2 line_3
expect 0 "R2 1.0000" "$breccia" envelope line_1 line_2 line_3
by_hand curve_1 0 100e6
by_hand curve_2 12.5e6 162.5e6
by_hand curve_3 80e6 380e6
by_hand curve_4 -9.6e6 10.4e6
expect 0 "sigma_ci       100  100 to 100" "$breccia" envelope curve_1 curve_2 curve_3 curve_4 -o hand
grep -q '^Hoek-Brown,m,1,10\(\.0000\|,\)\|^Hoek-Brown,m,1,9\.9999' hand/envelope_fits.csv || fail "m is not 10"
grep -q '^Hoek-Brown,A,MPa,1000\|^Hoek-Brown,A,MPa,999\.99' hand/envelope_fits.csv || fail "A is not 1000 MPa"

# points of a table: the same law, whatever the unit and the other columns are; what envelope.csv has it can read
cat >points.csv <<'END'
rock,sigma_1 [MPa],note,sigma_3 [kPa]
a,80,"dry, cut",0
a,100,,5000

b,,not broken,7000
b,160,,20000
END
expect 0 "c               20  20 to 20" "$breccia" envelope points.csv
expect 0 "c               20  20 to 20" "$breccia" envelope points.csv line_1 line_2
"$breccia" envelope pressed pressed_2 confined confined_2 -o again >again.txt
"$breccia" envelope again/envelope.csv >of_table.txt
[ "$(grep '^Hoek\|^Mohr' again.txt)" = "$(grep '^Hoek\|^Mohr' of_table.txt)" ] || fail "a table is fitted otherwise than its runs"
expect 3 "points.csv:1: no column sigma_1_residual" "$breccia" envelope points.csv --residual
bad_points() {
    printf "$1" >bad.csv
    expect 3 "$2" "$breccia" envelope bad.csv
}
bad_points 'sigma_1,sigma_3 [MPa]\n1,2\n' "bad.csv:1: column sigma_1 has no unit"
bad_points 'sigma_1 [mm],sigma_3 [MPa]\n1,2\n' "bad.csv:1: column sigma_1 has no unit"
bad_points 'sigma_1 [MPa]\n1\n' "bad.csv:1: no column sigma_3"
bad_points 'sigma_1 [MPa],sigma_3 [MPa]\n1,2\n3,4x\n' "bad.csv:3: '4x' is not a stress"
bad_points "" "bad.csv:1: no column sigma_1"
expect 4 "cannot read the file of points" "$breccia" envelope nothing.csv

# what is refused, and what to do about it
expect 3 "2 points, it takes 3" "$breccia" envelope line_1 line_2
expect 3 "at one confining stress (sigma_3 = 0 MPa)" "$breccia" envelope line_1 curve_1 pressed
expect 3 "0 points" "$breccia" envelope line_1 line_2 line_3 --residual
expect 0 "line_1 is left out: why not" sh -c "'$breccia' envelope line_1 --residual || true"
mkdir empty
expect 3 "empty holds no summary.json" "$breccia" envelope empty
head -c 60 line_1/summary.json >empty/summary.json
expect 3 "is not a summary that breccia has written whole" "$breccia" envelope empty
sed 's/sigma/tau/' line_1/summary.json >empty/summary.json
expect 0 "empty is left out: its summary has no sigma_" "$breccia" envelope line_1 line_2 line_3 empty
expect 2 "envelope needs a folder of a run" "$breccia" envelope
expect 0 "example:" "$breccia" envelope --help

[ $failures -eq 0 ]
