#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# info and export: what they say, and that tables, surfaces and tessellations are whole.
. tests/cli/begin.sh
# says TEXT COMMAND...
says() {
    text=$1
    shift
    "$@" >said.txt 2>&1
    grep -qF -- "$text" said.txt || { fail "$* does not say: $text"; head -5 said.txt; }
}
cat >case.yaml <<'END'
breccia: 1
title: A small box
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6, seed: 3}
test: {kind: compression, loading: fixed, rate: 5e-5 1/s, strain_max: 0.04, stop_drop: 0}
output: {plots: off, frames: 1}
END

# each directed edge of a solid once, and its reverse; volumes within 1 % of the grains' 36 cm3
check_stl() {
    awk '
    $1 == "solid" { n++; delete seen }
    $1 == "outer" { k = 0 }
    $1 == "vertex" { p[k] = $2 " " $3 " " $4; x[k] = $2; y[k] = $3; z[k++] = $4 }
    $1 == "endloop" {
        for (i = 0; i < 3; i++) seen[p[i] "|" p[(i + 1) % 3]]++
        v += x[0] * (y[1] * z[2] - z[1] * y[2]) / 6
        v += y[0] * (z[1] * x[2] - x[1] * z[2]) / 6
        v += z[0] * (x[1] * y[2] - y[1] * x[2]) / 6
    }
    $1 == "endsolid" {
        for (e in seen) {
            split(e, end, "|")
            if (seen[e] != seen[end[2] "|" end[1]]) open++
        }
    }
    END {
        if (n != wanted) print "solids: " n ", expected " wanted
        if (open) print open " open edges"
        if (v < 0.99 * 36e-6 || v > 1.01 * 36e-6) print "volume " v
    }' wanted="$2" "$1" 2>&1
}
# loops of faces follow their signed edges; faces of a polyhedron meet in each edge once each way; each
# face is of one polyhedron (then of the domain) or of two with opposite signs
check_tess() {
    awk '
    /^ *\*/ { section = /\*\*/ ? $1 : section "/" $1; count = -1; next }
    count < 0 { count = $1; next }
    section == "**edge" { from[$1] = $2; to[$1] = $3 }
    section == "**face" && $1 ~ /^[0-9]+$/ && line % 4 == 0 { face = $1; for (i = 3; i <= NF; i++) v[i - 3] = $i; n = $2 }
    section == "**face" && line % 4 == 1 {
        edges[face] = ""
        for (i = 2; i <= NF; i++) {
            e = $i < 0 ? -$i : $i
            a = $i < 0 ? to[e] : from[e]; b = $i < 0 ? from[e] : to[e]
            if (a != v[i - 2] || b != v[(i - 1) % n]) bad++
            edges[face] = edges[face] " " $i
        }
    }
    section == "**face" { line++; next }
    section == "**polyhedron" {
        delete seen
        for (i = 3; i <= NF; i++) {
            f = $i < 0 ? -$i : $i
            use[f] += $i < 0 ? -1 : 1; uses[f]++
            m = split(edges[f], list, " ")
            for (j = 1; j <= m; j++) seen[$i < 0 ? -list[j] : +list[j]]++
        }
        for (e in seen) if (seen[e] != 1 || !((-e) in seen)) bad++
        cells++
    }
    section == "**domain/*general/*vertex/*edge/*face" && domain_line++ % 6 == 5 {
        for (i = 2; i <= NF; i++) { outer++; if (uses[$i] != 1 || use[$i] != 1) bad++ }
    }
    END {
        for (f in uses) { if (uses[f] == 1) boundary++; else if (use[f] != 0) bad++ }
        if (bad) print bad " faults"
        if (outer != boundary || !outer) print outer + 0 " faces of the domain, " boundary " of cells"
        if (cells != wanted) print cells " cells, expected " wanted
    }' wanted="$2" "$1" 2>&1
}

for model in $("$breccia" models | awk '{ print $1 }'); do
    "$breccia" run case.yaml --model "$model" -o "$model" --quiet --set specimen.seed=5 \
        >said.txt 2>&1 || { fail "$(cat said.txt)"; continue; }
    state=$model/state.h5
    steps=$(sed -n 's/.*"steps": \([0-9]*\),/\1/p' "$model/summary.json")
    says "saved state of breccia, step $steps" "$breccia" info "$state"
    says "model          $model" "$breccia" info "$state"
    says "seed           5" "$breccia" info "$state"
    says "x(3)                   float64  [m]  centre of mass" "$breccia" info "$state"
    says "jitter: 0.6, seed: 5}" "$breccia" info "$state"
    says "frame (VTKHDF) of breccia, step 0" "$breccia" info "$model/frames/grains_00000.hdf"
    for table in curve events; do
        "$breccia" export "$state" --table $table | cmp -s - "$model/$table.csv" ||
            fail "$model: the exported $table is not $table.csv"
        "$breccia" export "$state" --table $table -o $table.csv --force
        cmp -s $table.csv "$model/$table.csv" || fail "$model: no $table.csv"
    done
    [ "$("$breccia" export "$state" --table bodies | wc -l)" -eq 39 ] || fail "$model: bodies"
    grep -q '"n_grains": 36,' "$model/summary.json" || fail "$model: platens count as grains"
    "$breccia" export "$state" --format stl -o fragments.stl --force || fail "$model: no STL"
    fragments=$(sed -n 's/.*"n_fragments": \([0-9]*\),/\1/p' "$model/summary.json")
    wrong=$(check_stl fragments.stl "$fragments")
    [ -z "$wrong" ] || fail "$model: STL: $wrong"
    "$breccia" export "$state" --format tess -o state.tess --force
    wrong=$(check_tess state.tess 36)
    [ -z "$wrong" ] || fail "$model: tess: $wrong"
done
"$breccia" export case.yaml --format tess >case.tess
wrong=$(check_tess case.tess 36)
[ -z "$wrong" ] || fail "tess of a case: $wrong"
cmp -s case.tess state.tess && fail "the seed of the state is lost"

says "there are: bodies" "$breccia" export "$state" --table bodyes
says "there are: stl, tess" "$breccia" export "$state" --format obj
says "export needs either" "$breccia" export "$state"
says "export needs a file" "$breccia" export --format stl
says "cannot read" "$breccia" info absent.h5
says "neither a saved state nor a frame" "$breccia" info case.yaml
[ $failures -eq 0 ]
