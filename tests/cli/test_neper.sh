#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Neper's tessellations: a specimen that is written and read again is the same specimen; what is no
# tessellation of flat convex cells is refused with the place in the file.
set -u
breccia=$(realpath "$BRECCIA")
lamellae=$(realpath tests/data/lamellae.tess)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export BRECCIA_CACHE=$folder/cache
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
# case_file NAME SPECIMEN
case_file() {
    printf 'breccia: 1\nspecimen: {%s}\ntest: {kind: compression, strain_max: 0.001}\n' "$2" >"$1.yaml"
    printf 'run: {max_steps: 100}\noutput: {plots: off}\n' >>"$1.yaml"
}
# refused TEXT CASE
refused() {
    "$breccia" export "$2" --format tess >/dev/null 2>said.txt
    status=$?
    [ $status -ge 3 ] && [ "$(wc -l <said.txt)" -eq 1 ] && grep -qF -- "$1" said.txt ||
        fail "status $status, expected: $1; said: $(cat said.txt)"
}
# numbers of a summary: "n_facets" or a result
value() {
    sed -n "s/.*\"$2\": \({\"value\": \)\{0,1\}\([-0-9.e]*\).*/\2/p" "$1/summary.json"
}

case_file box 'shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], seed: 3'
case_file packing 'shape: cylinder, diameter: 20 mm, height: 30 mm, sides: 16, grains: packing, seed: 2'
case_file disc 'shape: cylinder, diameter: 20 mm, height: 5 mm, sides: 16, grains: mesh, triangle_area: 20 mm2'
for name in box packing disc; do
    spheres=off
    [ $name = packing ] && spheres=on
    case_file again "shape: polyhedron, grains: tess, tess: $name.tess, tess_spheres: $spheres"
    "$breccia" export $name.yaml --format tess -o $name.tess || fail "$name is not written"
    "$breccia" export again.yaml --format tess -o again.tess --force || fail "$name is not read"
    for part in '**cell' '**vertex' '**edge' '**face' '**polyhedron'; do
        count=$(awk -v part="$part" 'found { print $1; exit } $1 == part { found = 1 }' $name.tess)
        again=$(awk -v part="$part" 'found { print $1; exit } $1 == part { found = 1 }' again.tess)
        [ -n "$count" ] && [ "$count" = "$again" ] || fail "$name: $part $count, read: $again"
    done
done

# the same test on the specimen and on what was read, in millimetres; cells are numbered anew, and which
# of the features that just touch push first is left to rounding: forces agree to a percent, once all do
case_file again 'shape: polyhedron, grains: tess, tess: mm.tess, tess_unit: 1 mm'
awk '/^ *\*/ { section = /\*\*/ ? $1 : section "/" $1; n = 0 }
     { n++ }
     section == "**vertex" && n > 2 { for (i = 2; i < 5; i++) $i = sprintf("%.17g", 1000 * $i) }
     section == "**cell/*seed" && n > 1 { for (i = 2; i < 6; i++) $i = sprintf("%.17g", 1000 * $i) }
     { print }' box.tess >mm.tess
for model in $("$breccia" models | awk '{ print $1 }'); do
    "$breccia" run box.yaml --model "$model" -o "$model" --quiet >said.txt 2>&1 || fail "$(cat said.txt)"
    "$breccia" run again.yaml --model "$model" -o "$model-again" --quiet >said.txt 2>&1 ||
        fail "$(cat said.txt)"
    for key in n_grains n_facets n_contacts; do
        [ "$(value "$model" $key)" = "$(value "$model-again" $key)" ] || fail "$model: $key differs"
    done
    cut -d, -f5 "$model/curve.csv" >force
    cut -d, -f5 "$model-again/curve.csv" | paste -d, force - |
        awk -F, 'NR > 4 && ($1 - $2) ^ 2 > 0.02 ^ 2 * $1 ^ 2 { bad++ } END { exit bad > 0 || NR < 10 }' ||
        fail "$model: another curve"
done

# facets in one plane: what erosion takes away is said, whatever else is hard about the cells; fewer
# digits are as good, as far as they go, and the place does not matter
for form in "12 0" "8 0" "6 0" "12 3000"; do
    read -r digits far <<<"$form"
    awk -v d="$digits" -v far="$far" '$1 == "**vertex" { n = 1 } $1 == "**edge" { n = 0 }
         n && NF == 5 { printf "%s %.*f %.*f %.*f 0\n", $1, d, $2 + far, d, $3 - far, d, $4 + far; next } { print }' \
        "$lamellae" >lamellae.tess
    case_file lamellae 'shape: polyhedron, grains: tess, tess: lamellae.tess, tess_unit: 1 cm'
    "$breccia" run lamellae.yaml --model polyhedra --set polyhedra.radius=0.01mm -o lamellae --force --quiet \
        2>said.txt
    [ $? -eq 3 ] && [ "$(wc -l <said.txt)" -eq 1 ] && grep -q 'erodes grain .* away; all grains keep' said.txt ||
        fail "$digits digits at $far, too large a radius: $(cat said.txt)"
    for model in "polyhedra --set polyhedra.radius=0.002mm" "vgcm --set vgcm.softening=none --set vgcm.oblique=keep"; do
        # shellcheck disable=SC2086
        "$breccia" run lamellae.yaml --model $model --set run.max_steps=2 -o lamellae --force --quiet \
            >said.txt 2>&1 || fail "$digits digits at $far, $model: $(cat said.txt)"
    done
done

sed 's/shape: polyhedron/shape: box/' again.yaml >wrong.yaml
refused "write specimen.shape: polyhedron" wrong.yaml
sed 's/mm.tess/absent.tess/' again.yaml >wrong.yaml
refused "specimen.tess: cannot read 'absent.tess'" wrong.yaml
case_file wrong 'shape: polyhedron, grains: tess, tess: wrong.tess'
head -c 20000 box.tess >wrong.tess
refused "wrong.tess:" wrong.yaml
sed 's/^   3 standard/   2 standard/' box.tess >wrong.tess
refused "wrong.tess:5: expected a whole number" wrong.yaml
awk '$1 == "**vertex" { n = NR } n && NR == n + 22 { $2 += 0.002 } { print }' box.tess >wrong.tess
refused "is not flat" wrong.yaml
awk '$1 == "**polyhedron" { n = NR } n && NR == n + 3 { $3 = $4 } { print }' box.tess >wrong.tess
refused "a face belongs to one polyhedron" wrong.yaml
awk '$1 == "**vertex" { n = NR } n && NR == n + 1 { $1 = 2000000000 } { print }' box.tess >wrong.tess
refused "wrong.tess:" wrong.yaml
new=$(awk 'found { print $1 + 1; exit } $1 == "**face" { found = 1 }' box.tess)
awk -v new="$new" '$1 == "**face" { n = NR } n && NR == n + 1 { $1 = new }
     $1 == "**polyhedron" { n = 0; print new " 3 1 2 3\n 3 1 1 1\n 0 0 0 1\n 0 0 0 0 0" }
     $1 == "z1" { z = NR } z && NR == z + 1 { $1++; $0 = $0 " " new } { print }' box.tess >wrong.tess
refused "face $new is neither between two polyhedra nor" wrong.yaml
[ $failures -eq 0 ]
