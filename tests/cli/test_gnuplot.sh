#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What reaches gnuplot is text: titles, names of cases and folders with backquotes, quotes, macros,
# markup and newlines run no command, and stand in the pictures as they are.
. tests/cli/begin.sh
command -v gnuplot >/dev/null || { echo "gnuplot is not installed: nothing to test"; exit 0; }

# the text of an SVG picture that the script DIR/NAME.gp draws, with its characters restored
words_of() {
    sed 's/pngcairo/svg/; s/\.png/.svg/' "$1/$2.gp" >"$1/$2.svg.gp"
    (cd "$1" && LC_ALL=C.UTF-8 gnuplot "$2.svg.gp" 2>>gnuplot.log)
    sed 's/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g' "$1/$2.svg"
}

# check TITLE FOLDER PICTURE...: no command was run, gnuplot had nothing to say, pictures are whole
check() {
    title=$1 dir=$2
    shift 2
    [ -z "$(find . -name 'OWNED*')" ] || fail "a command was run for: $title"
    for name in "$@"; do
        [ "$(tail -c 8 "$dir/$name.png" 2>/dev/null | head -c 4)" = IEND ] || fail "no $name.png of: $title"
        words_of "$dir" "$name" | grep -qF -- ">$title<" || fail "$name.png does not say: $title"
    done
    # before the first crack the second plot is empty
    if grep -v '^$\|empty y range' "$dir/gnuplot.log" >complaints; then
        fail "gnuplot complains of: $title"
        head -c 500 complaints
    fi
    find . -name 'OWNED*' -delete
}

# write_case FILE TITLE
write_case() {
    yaml=${2//\\/\\\\}
    cat >"$1" <<END
breccia: 1
title: "${yaml//\"/\\\"}"
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 1e-4 1/s, strain_max: 0.002, sample_steps: 1}
END
}

# titles, each also the name of a folder
titles=('Core of `touch OWNED` granite' "it's \"quoted\", ''twice'' '" '$(touch OWNED) | touch OWNED; < touch OWNED #'
    '@title @run {/Bold a_b^c} &{x} ~a{b} end\' 'a \n b \140touch OWNED\140 %d %s \')
for title in "${titles[@]}"; do
    write_case case.yaml "$title"
    dir="run ${title//\//_}"
    "$breccia" run case.yaml --quiet -o "$dir" >/dev/null || fail "run: $title"
    check "$title" "$dir" curves cracks
done

all='`touch OWNED` '"\"it's''\" @title {/Bold a_b} \\"
write_case case.yaml "$all"
"$breccia" compare case.yaml --quiet -o "$all" >/dev/null || fail "compare: $all"
check "$all" "$all" curves cracks
"$breccia" converge case.yaml --quiet -o "$all" --model vgcm --observable E --axes loading --seeds 1 \
    --refine 2 >/dev/null 2>&1 || fail "converge: $all"
check "$all" "$all" converge

# without a title the name of the case stands for it
name='`touch OWNED` '$'\n'"\"it's\" @x {a}_b"
write_case "$name.yaml" ""
"$breccia" converge "$name.yaml" --quiet -o named --model vgcm --observable E --axes loading --seeds 1 \
    --refine 2 >/dev/null 2>&1 || fail "converge: $name"
check "\"it's\" @x {a}_b" named converge

[ $failures -eq 0 ] || exit 1
