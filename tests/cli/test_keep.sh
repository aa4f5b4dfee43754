#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The case.yaml that a run keeps makes the same run, whatever options it had and wherever its files
# are; so does the state. The user's text and comments stay.
. tests/cli/begin.sh

# refuse TEXT COMMAND...
refuse() {
    text=$1
    shift
    if "$@" >said.txt 2>&1; then
        fail "not refused: $*"
    fi
    grep -qF -- "$text" said.txt || { fail "no '$text' from: $*"; sed 's/^/  | /' said.txt; }
}
# repeats RUN: what run kept in the folder makes the same bits, without any option
repeats() {
    rm -rf again
    good "$breccia" run "$1/case.yaml" -o again --quiet
    [ -n "$(hash_of "$1")" ] && [ "$(hash_of again)" = "$(hash_of "$1")" ] ||
        { fail "$1/case.yaml makes another run"; cat "$1/case.yaml"; }
}

cat >case.yaml <<'END'
# --set specimen.seed=99
breccia: 1
title: A small box   # its title
specimen:
  shape: box
  size:              # along x, y, z
  - 2 cm
  - 2 cm
  - 3 cm
  grains: grid
  cells: [2, 2,
    3]
  jitter: 0.6
test: {kind: compression, loading: fixed, rate: 2e-5 1/s,
  strain_max: "4e-4"}
output: {plots: off}
vgcm:
  # --set vgcm.e_bar=1 GPa
  interaction: {rule: gap, gap: 1 mm}
END

# without options the text stays as it is, but for the model that it does not name
models=$("$breccia" models | awk '{ print $1 }')
for model in $models; do
    good "$breccia" run case.yaml --model "$model" -o "plain_$model" --quiet
    cmp -s "plain_$model/case.yaml" <(cat case.yaml && echo "model: $model") || fail "the text has changed"
    repeats "plain_$model"
    sets=(--set specimen.seed=5 --set specimen.size="2 cm, 3 cm, 3 cm" --set specimen.cells=2,3,3
        --set title="It's #1: \"x\", \`y\`" --set test.strain_max=2e-4 --set test.strain_max=3e-4
        --set vgcm.interaction.rule=all --set polyhedra.radius="0.4 mm" --set run.ledger=off)
    good "$breccia" run case.yaml --model "$model" -o "set_$model" --quiet "${sets[@]}"
    repeats "set_$model"
    [ "$(hash_of "set_$model")" != "$(hash_of "plain_$model")" ] || fail "the options do nothing"
    for comment in '# --set specimen.seed=99' '# its title' '# along x, y, z' '  # --set vgcm.e_bar=1 GPa'; do
        grep -qF -- "$comment" "set_$model/case.yaml" || fail "the comment '$comment' is lost"
    done
    # the state holds the same case; the user's comments are no options
    "$breccia" export "set_$model/state.h5" --format tess >state.tess || fail "no tess of set_$model"
    "$breccia" export "set_$model/case.yaml" --format tess | cmp -s - state.tess ||
        fail "set_$model: state and case make two specimens"
done

# compare keeps a case of each model
good "$breccia" compare case.yaml -o pair --quiet --set specimen.seed=7 --set model=vgcm
for model in $models; do
    repeats "pair/$model"
done

# a run of a ladder, stopped on its way: what it kept has the parameters of its state
parameters() {
    grep '^[a-z]*\.[a-z_0-9]* = ' "$1/log" | grep -v max_steps
}
"$breccia" converge case.yaml --model vgcm --observable E --axes loading --seeds 1 --refine 2 \
    --set specimen.seed=7 --set test.rate="1e-10 1/s" --set run.checkpoint_steps=1 -o ladder >said.txt 2>&1 &
for try in $(seq 200); do
    ls ladder/converge_unfinished/*/state.h5 >/dev/null 2>&1 && break
    sleep 0.05
done
kill -TERM $!
wait $!
unfinished=$(dirname ladder/converge_unfinished/*/state.h5)
good "$breccia" run "$unfinished/case.yaml" -o again_ladder --quiet --set run.max_steps=1
[ "$(parameters "$unfinished" | wc -l)" -gt 20 ] &&
    [ "$(parameters "$unfinished")" = "$(parameters again_ladder)" ] ||
    fail "a run of a ladder keeps another case"

# --- files --------------------------------------------------------------------------------------
# those that a case names are beside the case, those of --set in the working folder
mkdir -p project/cases project/data elsewhere/deep
"$breccia" export case.yaml --format tess >project/data/box.tess
printf '0.005 0.005 0.005\n0.015 0.005 0.006\n0.005 0.015 0.02\n0.015 0.014 0.025\n' >project/cases/seeds.txt
sed 's/0.005/0.004/' project/cases/seeds.txt >"elsewhere/my seeds.txt"
cat >project/cases/points.yaml <<'END'
breccia: 1
title: Given seeds
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: points, points: seeds.txt}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 2e-4}
output: {plots: off}
END
cat >project/cases/tess.yaml <<'END'
breccia: 1
title: Given cells
model: vgcm
specimen: {shape: polyhedron, grains: tess, tess: ../data/box.tess}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 2e-4}
output: {plots: off}
END
good "$breccia" run project/cases/points.yaml -o project/results/points --quiet
good "$breccia" run project/cases/tess.yaml -o project/results/tess --quiet
(cd project/cases && "$breccia" run points.yaml -o ../results/points_near --quiet >/dev/null) ||
    fail "a case beside its files"
[ "$(hash_of project/results/points)" = "$(hash_of project/results/points_near)" ] ||
    fail "the working folder decides the result"
grep -q 'tess: "../../data/box.tess"' project/results/tess/case.yaml || fail "no path to the cells is kept"
cd elsewhere
good "$breccia" run ../project/cases/points.yaml -o deep/set --quiet --set specimen.points="my seeds.txt"
cd ..
[ "$(hash_of elsewhere/deep/set)" != "$(hash_of project/results/points)" ] || fail "--set is ignored"
good "$breccia" compare project/cases/tess.yaml -o project/results/pair --quiet
for run in project/results/points project/results/points_near project/results/tess elsewhere/deep/set \
    project/results/pair/polyhedra; do
    repeats "$run"
done
# through a link, from another working folder, and when all has moved
mkdir far
ln -s "$folder/far" project/linked
good "$breccia" run project/cases/points.yaml -o project/linked/run --quiet
repeats far/run
mv project moved
cd /
repeats() {
    rm -rf "$folder/again"
    "$breccia" run "$1/case.yaml" -o "$folder/again" --quiet >"$folder/said.txt" 2>&1 ||
        { fail "run $1/case.yaml"; cat "$folder/said.txt"; }
    [ "$(hash_of "$folder/again")" = "$(hash_of "$1")" ] || fail "$1/case.yaml makes another run"
}
repeats "$folder/moved/results/points"
repeats "$folder/moved/results/tess"
cd "$folder" || exit 1
# a run goes on from any working folder; its files may have another name, not another content
good "$breccia" run moved/results/points/case.yaml -o parts --quiet --set run.max_steps=5
(cd moved/cases && "$breccia" run points.yaml -o ../../parts --quiet --resume >/dev/null) ||
    fail "does not go on from another folder"
[ "$(hash_of parts)" = "$(hash_of moved/results/points)" ] || fail "a resumed run has other bits"
refuse "the case makes another specimen now" "$breccia" run moved/cases/points.yaml -o parts --resume \
    --set specimen.points="elsewhere/my seeds.txt" --set test.strain_max=3e-4
# a case through a pipe has no folder: the working folder counts
good "$breccia" run <(sed 's/seeds.txt/moved\/cases\/seeds.txt/' moved/cases/points.yaml) -o piped --quiet
[ "$(hash_of piped)" = "$(hash_of moved/results/points)" ] || fail "a case through a pipe"
sed 's/seeds.txt/absent.txt/' moved/cases/points.yaml >moved/cases/absent.yaml
refuse "moved/cases/absent.txt" "$breccia" run moved/cases/absent.yaml -o none

# tables of a state need no other file
"$breccia" export moved/results/points/state.h5 --format tess >/dev/null || fail "no tess of a state"
for table in bodies pairs pairs/points curve; do
    "$breccia" export moved/results/points/state.h5 --table $table >"before_${table#*/}.csv"
done
mkdir alone
cp moved/results/points/state.h5 alone
for table in bodies pairs pairs/points curve; do
    good "$breccia" export alone/state.h5 --table $table -o alone.csv
    cmp -s alone.csv "before_${table#*/}.csv" && [ "$(wc -l <alone.csv)" -gt 1 ] ||
        fail "the table $table needs other files"
    rm -f alone.csv
done
refuse "seeds.txt" "$breccia" export alone/state.h5 --format stl
[ $failures -eq 0 ]
