#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Devices, folders, endless pipes and files that are too large, wherever a file is read: one message
# at once, and neither the memory nor the time is used up. A pipe that ends is a file like any other.
. tests/cli/begin.sh

# refuse TEXT COMMAND...: within seconds, in little memory, with status 3 or 4 and one line that holds
# the text; an endless file would take either
refuse() {
    text=$1
    shift
    (
        [ "${CFG:-}" = san ] || ulimit -v 4000000
        timeout 30 "$@" >said.txt 2>&1
    )
    status=$?
    case $status in 3 | 4) ;; *) fail "status $status from: $*" ;; esac
    grep -qF -- "$text" said.txt || { fail "no '$text' from: $*"; head -c 300 said.txt; }
    [ "$(wc -l <said.txt)" -eq 1 ] || fail "$(wc -l <said.txt) lines from: $*"
}

# write_case FILE SPECIMEN
write_case() {
    cat >"$1" <<END
breccia: 1
title: Some grains
model: vgcm
specimen: {$2, tess_unit: 1 cm}
test: {kind: compression, loading: fixed, rate: 5e-5 1/s, strain_max: 1e-6}
output: {plots: off}
END
    grep -q tess: "$1" || sed -i 's/, tess_unit: 1 cm//' "$1"
}

cat >planes.txt <<END
1 0 0 0.01
-1 0 0 0.01
0 1 0 0.01
0 -1 0 0.01
0 0 1 0.02
0 0 -1 0.02
END
for z in -0.015 -0.005 0.005 0.015; do echo "0 0 $z"; done >points.txt
write_case case.yaml "shape: polyhedron, planes: planes.txt, grains: points, points: points.txt"
"$breccia" run case.yaml --quiet -o good >/dev/null || fail "the case itself"
"$breccia" export good/state.h5 --format tess -o grains.tess || fail "no tessellation"

mkdir a_folder
# devices and folders
for what in /dev/zero /dev/random a_folder; do
    why="it is a device"
    [ $what = a_folder ] && why="it is a folder"
    write_case planes.yaml "shape: polyhedron, planes: $what, grains: points, points: points.txt"
    refuse "specimen.planes: cannot read" "$breccia" run planes.yaml --quiet
    refuse "$why" "$breccia" run planes.yaml --quiet
    write_case points.yaml "shape: polyhedron, planes: planes.txt, grains: points, points: $what"
    refuse "specimen.points: cannot read" "$breccia" compare points.yaml --quiet
    refuse "$why" "$breccia" run points.yaml --quiet
    write_case tess.yaml "shape: polyhedron, grains: tess, tess: $what"
    refuse "specimen.tess: cannot read" "$breccia" run tess.yaml --quiet
    refuse "$why" "$breccia" converge tess.yaml --seeds 1 --quiet
    refuse "$why" "$breccia" run $what --quiet
    refuse "$why" "$breccia" export $what --format tess
    refuse "$why" "$breccia" export $what --table curve
    refuse "$why" "$breccia" info $what
    cp -r good resumed
    rm resumed/state.h5
    ln -s "$(realpath $what)" resumed/state.h5
    refuse "$why" "$breccia" run case.yaml --quiet -o resumed --resume
    rm -r resumed
done

# pipes that never end, with and without lines, and sizes beyond what is read
write_case pipe.yaml "shape: polyhedron, planes: planes.txt, grains: points, points: /dev/fd/3"
refuse "the most that is read from a pipe" "$breccia" run pipe.yaml --quiet 3< <(yes "0 0 1")
refuse "specimen.points" "$breccia" run pipe.yaml --quiet 3< <(cat /dev/zero)
refuse "larger than 1048576 bytes" "$breccia" run /dev/fd/3 --quiet 3< <(yes "# no end")
refuse "it is a pipe" "$breccia" info /dev/fd/3 3< <(cat good/state.h5)
truncate -s 3G large.txt
write_case large.yaml "shape: polyhedron, grains: tess, tess: large.txt"
refuse "larger than 2147483648 bytes" "$breccia" run large.yaml --quiet
# a state that has grown by a hole is not gone through
cp -r good resumed
truncate -s 2000G resumed/state.h5 2>/dev/null &&
    refuse "it is cut short or overwritten" "$breccia" run case.yaml --quiet -o resumed --resume

# a pipe that ends
"$breccia" run pipe.yaml --quiet -o piped 3< <(cat points.txt) >/dev/null || fail "points from a pipe"
[ "$(grep state_hash piped/summary.json)" = "$(grep state_hash good/summary.json)" ] ||
    fail "points from a pipe give another state"
write_case grid.yaml "shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3]"
"$breccia" run /dev/stdin --quiet -o cased < <(cat grid.yaml) >/dev/null || fail "a case from standard input"

[ $failures -eq 0 ] || exit 1
