#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Stops: the signals of terminals and batch systems save and end with status 7; the command that is
# printed then goes on, whatever the names; before the first step nothing is claimed and nothing left.
. tests/cli/begin.sh
write_case() {
    cat >"$1" <<'END'
breccia: 1
title: A small box
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 1e-9 1/s, strain_max: 0.01}
output: {plots: off}
END
}
# wait_for FILE
wait_for() {
    for _ in $(seq 400); do
        [ -s "$1" ] && return
        sleep 0.05
    done
    fail "no $1 within 20 s"
}

# stop SIGNAL FOLDER COMMAND...: stops the command when it has begun in the folder; what it says is
# in said.txt
stop() {
    signal=$1 begun=$2
    shift 2
    "$@" >out.txt 2>said.txt &
    wait_for "$begun/log"
    sleep 0.2
    kill "-$signal" $!
    wait $!
    status=$?
    [ $status -eq 7 ] || { fail "$signal: status $status, expected 7"; cat said.txt; }
}

write_case case.yaml
for signal in INT TERM HUP USR1 USR2 XCPU; do
    # a shell without job control starts background commands with INT ignored
    stop $signal "by $signal" env --default-signal=$signal "$breccia" run case.yaml --model vgcm \
        --quiet -o "by $signal"
    [ -s "by $signal/state.h5" ] || fail "$signal: nothing is saved"
    grep -q "interrupted at step [0-9]*; the state is saved in by $signal" said.txt ||
        { fail "$signal: no such words"; cat said.txt; }
done
# the limit of processor time itself
(
    ulimit -S -t 1
    exec "$breccia" run case.yaml --model vgcm --quiet -o limited >/dev/null 2>said.txt
)
[ $? -eq 7 ] && [ -s limited/state.h5 ] || { fail "the limit of processor time"; cat said.txt; }

# the printed command goes on, as a shell reads it: quotes, blanks, and many words
ln -s "$breccia" "brec'cia \"x\""
breccia="./brec'cia \"x\""
name="it's a \"case\" \`touch OWNED\` \$(touch OWNED) \\ *.yaml"
write_case "$name"
dir="an o'dd 'folder' \$HOME;&|<>?[a]~"
many=()
for i in $(seq 200); do
    many+=(--set "test.rate=0.$(printf '%0200d' 0)$((i % 10))e190 1/s")
done
many+=(--set "test.rate=1e-9 1/s")
for command in run compare; do
    begun=$dir
    [ $command = compare ] && begun=$dir/vgcm
    model=()
    [ $command = run ] && model=(--model vgcm)
    rm -rf "$dir"
    stop TERM "$begun" "$breccia" $command "$name" "${model[@]}" "${many[@]}" -o "$dir"
    grep -q "stopped$\|stopped *$" said.txt || grep -q "; go on with: " said.txt ||
        fail "$command: does not say how to go on"
    grep -qw done said.txt && fail "$command: a stopped run is done"
    next=$(sed -n 's/^breccia: interrupted.*; go on with: //p' said.txt)
    # a later end, so that it ends by itself
    eval "$next --set test.strain_max=1e-12" >out.txt 2>said.txt ||
        { fail "$command: the printed command fails"; tail -c 600 said.txt; }
    grep -q '"finished": true' "$begun/summary.json" || fail "$command: it did not go on"
done
[ ! -e OWNED ] || fail "a name was run as a command"

# while the specimen is made: nothing is saved, nothing is claimed, nothing is left
cat >packing.yaml <<'END'
breccia: 1
title: Many grains
specimen: {shape: box, size: [20 cm, 20 cm, 20 cm], grains: packing, count: 60000}
test: {kind: compression}
END
for command in "run --model vgcm" compare; do
    for signal in TERM USR1 XCPU; do
        "$breccia" ${command%% *} packing.yaml ${command#"${command%% *}"} -o packed \
            --set specimen.cache=off >out.txt 2>said.txt &
        # once it is the program and catches signals, however busy the machine is
        for _ in $(seq 400); do
            [ "$(cat /proc/$!/comm)" != bash ] && grep -q '^SigCgt:.*[1-9a-f]' /proc/$!/status && break
            sleep 0.05
        done
        sleep 0.2
        kill -$signal $!
        wait $!
        [ $? -eq 7 ] || fail "$command: $signal in the packing does not end with 7"
        grep -q "nothing was saved" said.txt || { fail "$command: $signal in the packing"; cat said.txt; }
        grep -qw "done\|saved in\|gnuplot" said.txt && { fail "$command: false words"; cat said.txt; }
        [ ! -e packed ] || fail "$command: a folder is left"
    done
done

# a folder takes one run at a time, --force or not, whatever the first has read there
cat >slow.yaml <<'END'
breccia: 1
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [4, 4, 6], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 1e-9 1/s}
run: {max_steps: 50000}
END
"$breccia" run slow.yaml --model vgcm -o busy >/dev/null 2>&1 &
for _ in $(seq 400); do
    [ -s busy/log ] && break
    sleep 0.05
done
expect 4 "another run writes to busy now" "$breccia" run slow.yaml --model vgcm -o busy --force
kill -TERM $!
wait $!

[ $failures -eq 0 ] || exit 1
