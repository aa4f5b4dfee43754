#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Neper's tessellations: a specimen that is written and read again is the same specimen; what is no
# tessellation of flat convex cells is refused with the place in the file.
. tests/cli/begin.sh
lamellae=$tree/tests/data/lamellae.tess
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
    sed -i 's/^test:.*/test: {kind: none}/' lamellae.yaml # a cube on its corner, which no platen can load
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
# kinds of file that are not read are named
cat >wrong.tess <<'END'
***tess
 **format
   3.5
 **general
   2 standard
 **cell
  2
 **vertex
 6
   1 0 0 0 0
   2 1 0 0 0
   3 2 0 0 0
   4 0 1 0 0
   5 1 1 0 0
   6 2 1 0 0
 **edge
 7
   1 1 2 0
   2 2 5 0
   3 5 4 0
   4 4 1 0
   5 2 3 0
   6 3 6 0
   7 6 5 0
 **face
 2
   1 4 1 2 5 4
     4 1 2 3 4
    0 0 0 1
     0 -1 0 0 0
   2 4 2 3 6 5
     4 5 6 7 -2
    0 0 0 1
     0 -1 0 0 0
***end
END
refused "wrong.tess:5: the tessellation is two-dimensional" wrong.yaml
sed 's/^   3 standard/   3 periodic/' box.tess >wrong.tess
refused "wrong.tess:5: the tessellation is periodic" wrong.yaml
sed 's/^   3.4/   1.10/' box.tess >wrong.tess
refused "wrong.tess:3: this format is not read" wrong.yaml
sed 's/^\*\*\*tess/***tesr/' box.tess >wrong.tess
refused "wrong.tess:1: not a tessellation file of Neper" wrong.yaml
# format 2.0 has the equations of the domain's faces without a type
case_file again 'shape: polyhedron, grains: tess, tess: box.tess'
"$breccia" export again.yaml --format tess -o expected.tess || fail "box is not read"
awk '$1 == "3.4" { print "   2.0"; next } $1 == "plane" { plane = 1; next }
     plane { plane = 0; $1 = "" } { print }' box.tess >old.tess
case_file again 'shape: polyhedron, grains: tess, tess: old.tess'
"$breccia" export again.yaml --format tess -o again.tess --force 2>said.txt || fail "format 2.0: $(cat said.txt)"
cmp -s again.tess expected.tess || fail "format 2.0 is read as something else"
# a cell without faces is left out, and said to be
awk '$1 == "**cell" { n = NR } n && NR == n + 1 { $1++; last = $1 }
     $1 == "**vertex" { print "  " last " 0.01 0.01 0.01 0" }
     $1 == "**polyhedron" { p = NR } p && NR == p + 1 { $1++ }
     $1 == "**domain" { print "  " last " 0" } { print }' box.tess >empty.tess
case_file again 'shape: polyhedron, grains: tess, tess: empty.tess'
"$breccia" export again.yaml --format tess -o again.tess --force 2>said.txt || fail "empty cell: $(cat said.txt)"
cmp -s again.tess expected.tess || fail "a file with an empty cell is read as something else"
grep -q 'empty.tess: 1 of the cells have no faces' said.txt || fail "empty cell: $(cat said.txt)"
# what is not flat: too few digits, a curved domain, or regularized
small() {
    awk -v scale="$1" '$1 == "**vertex" { n = 1 } $1 == "**edge" { n = 0 }
        n && NF == 5 { printf "%s %.12f %.12f %.12f 0\n", $1, scale * $2, scale * $3, scale * $4; next } { print }' \
        box.tess
}
small 1e-6 >wrong.tess
refused "specimen.tess_unit" wrong.yaml
small 1e-3 >small.tess
case_file again 'shape: polyhedron, grains: tess, tess: small.tess'
"$breccia" export again.yaml --format tess -o again.tess --force || fail "eight digits are too few"
awk '$1 == "**vertex" { n = NR } n && NR == n + 22 { $2 += 0.002 }
     { sub("plane$", "cylinder"); print }' box.tess >wrong.tess
refused "lies on a curved face of the domain" wrong.yaml
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
