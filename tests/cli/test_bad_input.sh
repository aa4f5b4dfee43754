#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bad input of every kind: the documented exit status, one message that says what, where, what is
# allowed and what to do, and a folder of results that is as it was before.
. tests/cli/begin.sh

# every file under the folder of results with its content; of the log the name only where $1 says so
contents() {
    find "$1" -type f -exec sha256sum {} + 2>/dev/null | sort
}

# refuse STATUS TEXT... -- COMMAND...: the status, nothing on standard output, one line on standard
# error that holds all texts, and results/ unchanged
refuse() {
    status=$1 texts=()
    shift
    while [ "$1" != -- ]; do
        texts+=("$1")
        shift
    done
    shift
    before=$(contents results)
    said=$("$@" 2>&1 >out.txt) # a pipe: limits of file sizes hold for the command alone
    got=$?
    printf '%s' "${said:+$said$'\n'}" >err.txt
    [ $got -eq "$status" ] || fail "status $got, expected $status: $*"
    [ "$(wc -l <err.txt)" -eq 1 ] || fail "$(wc -l <err.txt) lines on standard error: $*"
    [ ! -s out.txt ] || fail "words on standard output: $*"
    for text in "breccia: " "${texts[@]}"; do
        grep -qF -- "$text" err.txt || fail "no '$text' from: $*"
    done
    [ "$before" = "$(contents results)" ] || fail "results have changed: $*"
    [ $failures -eq 0 ] || { sed 's/^/  | /' err.txt; exit 1; }
}

run() {
    "$breccia" run "$@" --quiet
}

# edited NAME SED: the case with a change
edited() {
    sed "$2" case.yaml >"$1"
    cmp -s case.yaml "$1" && fail "nothing changed in $1"
}

cat >case.yaml <<'EOF'
breccia: 1
title: A small box
model: vgcm
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 0.002}
run:
  regime: quasi_static
output: {plots: off}
vgcm:
  e_bar: 48.8 GPa
  sigma_t: 11.4 MPa
  g_fn: 64.6 J/m2
  density: 2650 kg/m3
polyhedra:
  radius: 0.5 mm
  kn: 1e8 N/m
EOF

# good results that nothing below may touch
for model in vgcm polyhedra; do
    run case.yaml --model $model >/dev/null || fail "the good case does not run with $model"
done

# --- the case ---------------------------------------------------------------------------------------
edited bad.yaml 's/sigma_t/sigma_tt/'
refuse 3 bad.yaml:11 vgcm.sigma_tt "unknown key" "did you mean 'sigma_t'?" -- run bad.yaml
edited bad.yaml 's/^vgcm:/vgmc:/'
refuse 3 bad.yaml:9 vgmc "unknown section" "did you mean 'vgcm'?" -- run bad.yaml
edited bad.yaml 's/48.8 GPa/48.8 kg/'
refuse 3 bad.yaml:10 vgcm.e_bar "'kg' has the wrong dimension" "dimension of Pa" \
    "allowed (0, inf) Pa" -- run bad.yaml
edited bad.yaml 's/48.8 GPa/48.8 Gpa/'
refuse 3 bad.yaml:10 vgcm.e_bar "'Gpa' is not a unit" "capitals matter" "allowed (0, inf) Pa" -- \
    run bad.yaml
edited bad.yaml 's/48.8 GPa/48.8/'
refuse 3 bad.yaml:10 vgcm.e_bar "has no unit" "for example '48.8 Pa'" "allowed (0, inf) Pa" -- \
    run bad.yaml
edited bad.yaml 's/48.8 GPa/-48.8 GPa/'
refuse 3 bad.yaml:10 vgcm.e_bar "-48.8 GPa is out of range; allowed (0, inf) Pa" -- run bad.yaml
edited bad.yaml 's/1e8 N/-1e8 N/'
refuse 3 bad.yaml:16 polyhedra.kn "is out of range; allowed (0, inf) N/m" -- run bad.yaml
edited bad.yaml 's/2650/-2650/'
refuse 3 bad.yaml:13 vgcm.density "is out of range; allowed (0, inf) kg/m3" -- run bad.yaml
edited bad.yaml 's/48.8 GPa/nan GPa/'
refuse 3 bad.yaml:10 vgcm.e_bar "finite decimal number" -- run bad.yaml
edited bad.yaml 's/breccia: 1/breccia: 2/'
refuse 3 bad.yaml:1 "'2' is another version of the case format; allowed 1" "breccia params" -- \
    run bad.yaml
edited bad.yaml '/breccia: 1/d'
refuse 3 bad.yaml "required key is missing" '`breccia: 1`' -- run bad.yaml
edited bad.yaml 's/strain_max: 0.002}/strain_max: 0.002/'
refuse 3 bad.yaml:6 "not valid YAML" -- run bad.yaml
printf 'breccia: 1\ntitle: \377\n' >bad.yaml
refuse 3 bad.yaml:2 "byte 0xff" "save the file as plain UTF-8" -- run bad.yaml
head -c 1100000 /dev/zero | tr '\0' '#' >bad.yaml
refuse 3 bad.yaml "larger than 1048576 bytes" -- run bad.yaml
refuse 4 absent.yaml "No such file" -- run absent.yaml
refuse 4 "cannot read the case file $folder" -- run "$folder"
refuse 3 --set vgcm.e_bar "allowed (0, inf) Pa" -- run case.yaml --set vgcm.e_bar="-1 Pa"
if [ "$(id -u)" -ne 0 ]; then
    cp case.yaml bad.yaml
    chmod 000 bad.yaml
    refuse 4 bad.yaml "Permission denied" -- run bad.yaml
    rm -f bad.yaml
fi

# --- the case as a whole; --force would have replaced the results ------------------------------------
results=results/case/vgcm
edited bad.yaml 's/64.6 J/0.5 J/'
refuse 3 bad.yaml:12 "vgcm.g_fn = 0.5 J/m2 must be above 19.7134 J/m2, the elastic energy" \
    "raise it" -- run bad.yaml -o $results --force
edited bad.yaml 's/0.5 mm/4.2 mm/'
refuse 3 bad.yaml:15 "polyhedra.radius = 0.0042 m erodes grain" "below 0.00355643 m" \
    "use a smaller radius" -- run bad.yaml --model polyhedra -o results/case/polyhedra --force
edited good.yaml 's/0.5 mm/3.55 mm/'
run good.yaml --model polyhedra -o results/good --set run.max_steps=1 >/dev/null 2>err.txt ||
    fail "the radius that the message gives does not do: $(cat err.txt)"
edited bad.yaml 's/0.5 mm/6 mm/'
refuse 3 bad.yaml:15 "polyhedra.radius = 0.006 m" "below half of the mean grain size (0.01 m)" -- \
    run bad.yaml --model polyhedra -o results/case/polyhedra --force
mkdir results/pair
cp -r results/case/* results/pair
refuse 3 bad.yaml:15 "polyhedra.radius = 0.006 m" -- \
    "$breccia" compare bad.yaml -o results/pair --force --quiet
edited bad.yaml 's/cells: \[3, 3, 4\]/cells: [3, 0, 4]/'
refuse 3 bad.yaml:4 "specimen.cells: 0 is out of range; allowed [1, 1000]" -- \
    run bad.yaml -o $results --force
refuse 3 "no sphere fits" "enlarge the specimen or lower specimen.diameter_min" -- \
    run case.yaml -o $results --force --set specimen.grains=packing \
    --set specimen.diameter_min="9 cm" --set specimen.diameter_max="9 cm"
sed 's/grains: grid.*/grains: points, points: seeds.txt}/' case.yaml >points.yaml
printf '# x y z\n0.01 0.01 0.01\n0.02 0.01 0.01\n0.01 0.01 0.01 # again\n' >seeds.txt
refuse 3 points.yaml:4 "seeds.txt:4: the seed at (0.01, 0.01, 0.01) m is 0 m from that of line 2" \
    "remove or move one of them" -- run points.yaml -o $results --force
: >seeds.txt
refuse 3 points.yaml:4 "'seeds.txt' holds no row" -- run points.yaml -o $results --force
printf '0.01 0.01 0.01\n0.02 0.01 x\n' >seeds.txt
refuse 3 points.yaml:4 "seeds.txt:2: no row of numbers" "x y z" -- run points.yaml -o $results --force
printf '0.01 0.01 0.01\n0.02 0.01 9\n' >seeds.txt
refuse 3 "seed 1 at (0.02, 0.01, 9) m lies outside" -- run points.yaml -o $results --force
edited bad.yaml 's/strain_max: 0.002/strain_max: 2/'
refuse 3 bad.yaml:5: "test.strain_max = 2: the platens meet at a strain of 1" \
    "allowed in compression and in the Brazilian test (0, 1)" -- run bad.yaml -o $results --force
edited bad.yaml 's/loading: fixed, rate: 2e-5 1\/s/rate_min: 2e-5 1\/s, rate_max: 1e-5 1\/s/'
refuse 3 bad.yaml:5: "test.rate_min = 2e-05 1/s is above test.rate_max = 1e-05 1/s" -- \
    run bad.yaml -o $results --force
edited bad.yaml 's/cells: .3, 3, 4./diameter: 3 cm/'
refuse 3 bad.yaml:4: "specimen.diameter: applies only with shape=cylinder, but specimen.shape is box" \
    "what applies now is size" -- run bad.yaml -o $results --force
edited bad.yaml 's/regime: quasi_static/dt: 1e-8 s/'
refuse 3 bad.yaml:7: "run.dt: applies only with regime=dynamic" "mass_margin" -- \
    run bad.yaml -o $results --force
name=$(printf 'c\351.yaml')
if cp case.yaml "$name" 2>/dev/null; then
    refuse 3 "the name of the case file is not valid UTF-8" "rename the file" -- run "$name"
fi
edited bad.yaml 's/regime: quasi_static/{regime: dynamic, dt: 1 s}/'
refuse 3 bad.yaml:7 "run.dt = 1 s is above the stable limit of" "use at most that, or 0 s" -- \
    run bad.yaml -o $results --force

# --- folders ----------------------------------------------------------------------------------------
refuse 3 "$results already holds results" "--resume" "--force" "-o" -- run case.yaml
: >file
refuse 4 "file is not a folder" "choose another with -o" -- run case.yaml -o file/below
if [ "$(id -u)" -ne 0 ]; then
    mkdir closed
    chmod 500 closed
    refuse 4 "cannot write to the folder closed" "Permission denied" -- run case.yaml -o closed/new
    chmod 700 closed
elif [ -d /proc/self ]; then
    refuse 4 "/proc/breccia" "cannot" -- run case.yaml -o /proc/breccia
fi

# --- states -----------------------------------------------------------------------------------------
resume() {
    run case.yaml -o "$results" --resume "$@"
}
state=$results/state.h5
cp $state good.h5
refuse 3 "empty holds no run to resume" -- run case.yaml -o empty --resume
refuse 3 --set "'specimen.seed = 1'" "'specimen.seed = 2'" "or start anew with --force" -- \
    resume --set specimen.seed=2
refuse 3 "vgcm.e_bar = 48.8 GPa" "vgcm.e_bar = 50 GPa" -- resume --set vgcm.e_bar="50 GPa"
refuse 3 "$state is a state of the model vgcm, not polyhedra" "--model" -- resume --model polyhedra
cp results/case/polyhedra/state.h5 $state
refuse 3 "$state is a state of the model polyhedra, not vgcm" "--model" -- resume
for part in 0 100 512 4000 $(($(stat -c %s good.h5) - 1)); do
    head -c "$part" good.h5 >$state
    refuse 4 "$state" "cut short" "--force" -- resume
done
{ cat good.h5; echo; } >$state
refuse 4 "$state" "overwritten" "--force" -- resume
for at in 1 30 60 511 513 4321 $(($(stat -c %s good.h5) - 1)); do
    cp good.h5 $state
    byte=$(od -A n -t u1 -j "$at" -N 1 good.h5)
    # shellcheck disable=SC2059
    printf "\\$(printf %03o $((byte ^ 1)))" |
        dd of=$state bs=1 seek="$at" conv=notrunc status=none
    refuse 4 "$state" "--force" -- resume
done
echo "a text" >$state
refuse 4 "$state: it is not a state file of breccia" "--force" -- resume
printf '\211HDF\r\n\032\n' >$state
refuse 4 "$state: it is not a state file of breccia" -- resume
tail -c +513 good.h5 >$state # an HDF5 file, but without a seal
refuse 4 "$state: it is not a state file of breccia" -- resume
sed '1s/format [0-9]*/format 9/' good.h5 >$state
refuse 3 "$state has the state format 9, breccia" "reads " "resume with the version" -- resume
rm $state && mkdir $state
refuse 4 "$state" -- resume
rmdir $state && cp good.h5 $state

# the seeds of a file have moved since
for i in 0.005 0.015 0.025; do
    for j in 0.005 0.015 0.025; do
        for k in 0.005 0.015 0.025 0.035; do echo "$i $j $k"; done
    done
done >seeds.txt
run points.yaml -o results/points --set run.max_steps=5 >/dev/null || fail "seeds from a file"
sed -i '7s/.*/0.006 0.014 0.026/' seeds.txt
refuse 3 "the case makes another specimen now" -- run points.yaml -o results/points --resume

# --- full disks -------------------------------------------------------------------------------------
# limit BLOCKS COMMAND...: no file may grow beyond that many KiB
limit() {
    (
        ulimit -f "$1"
        shift
        "$@"
    )
}
size=$(($(stat -c %s good.h5) / 1024))
more() {
    run case.yaml -o $results --resume --set test.strain_max=0.003
}
# the log, which tells of the failure, may grow; results that were there stay
contents() {
    find "$1" -type f ! -name log -exec sha256sum {} + 2>/dev/null | sort
}
for part in 4 $((size / 2)) $((size - 1)); do
    refuse 4 "$state: File too large" "what was saved before stays" "--resume" -- \
        limit "$part" more
done
refuse 4 "case.yaml: File too large" -- limit 0 run case.yaml -o $results --force

# a file system that is full, where one may be mounted
cat >full.sh <<'EOF'
mount -t tmpfs -o size=$1k none disk || exit 99
mkdir disk/results
cp -r "$3" disk/results/vgcm
before=$(find disk -type f ! -name log -exec sha256sum {} + | sort)
head -c 9999999 /dev/zero >disk/filler 2>/dev/null
truncate -s -"$2" disk/filler
"$4" run case.yaml -o disk/results/vgcm --quiet --resume --set test.strain_max=0.003 >out.txt
status=$?
rm disk/filler
[ "$before" = "$(find disk -type f ! -name log -exec sha256sum {} + | sort)" ] || exit 98
exit $status
EOF
mkdir disk
as_root=-m
[ "$(id -u)" -eq 0 ] || as_root=-rm
if unshare $as_root mount -t tmpfs none disk 2>/dev/null; then
    for left in 0 20k 100k; do
        TMPDIR=$folder unshare $as_root sh full.sh 4000 $left $results "$breccia" 2>err.txt
        got=$?
        [ $got -eq 4 ] || fail "a full disk with $left left ends with $got"
        grep -q "state.h5[.a-z]*: No space left on device" err.txt || fail "no word of the full disk"
        [ "$(wc -l <err.txt)" -eq 1 ] || fail "more than one line about a full disk"
    done
fi

# after all this the run goes on
more >/dev/null || fail "the run does not go on after all refusals"

# --- blow-ups ---------------------------------------------------------------------------------------
# the largest step that is accepted at rest is too large for the contacts that close
for model in vgcm polyhedra; do
    run case.yaml --model $model -o fast/$model --set test.rate="0.5 1/s" \
        --set test.strain_max=0.9 >out.txt 2>err.txt
    got=$?
    [ $got -eq 6 ] || fail "a blow-up of $model ends with $got"
    for text in "unstable at step 1, time 1 s: platen 36" "its contact with grain" "stiffness" \
        "points" "raise run.mass_margin (now 1.2)" "test.rate"; do
        grep -qF "$text" err.txt || fail "a blow-up of $model does not say '$text': $(cat err.txt)"
    done
    [ "$(wc -l <err.txt)" -eq 1 ] || fail "a blow-up of $model says more than one line"
done

# numbers that leave the range of doubles: no result that is not finite, and no success
run case.yaml -o huge --set vgcm.e_bar="1e250 Pa" >out.txt 2>err.txt
got=$?
[ $got -eq 6 ] || fail "energies that are not finite end with $got"
grep -qF "the result energy_drift is not finite" err.txt || fail "no word of what is not finite"

[ $failures -eq 0 ] || { cat err.txt; exit 1; }
