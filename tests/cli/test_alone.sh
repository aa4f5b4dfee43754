#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What breccia does in one process does without MPI: it needs no home folder, no temporary folder and
# no working MPI, leaves no session folder, and runs side by side by the dozen.
. tests/cli/begin.sh

cat >case.yaml <<'END'
breccia: 1
title: A small box
model: vgcm
specimen: {shape: box, size: [2 cm, 2 cm, 3 cm], grains: grid, cells: [2, 2, 3], jitter: 0.6, seed: 3}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 4e-4}
output: {plots: off}
END

printf 'breccia: 1\ncase: case.yaml\naxes: {specimen.seed: 1..4}\n' >sweep.yaml

# `pml` names the layer of Open MPI that carries messages: with one that there is not, MPI_Init ends the
# process
bare() {
    env -u HOME -u XDG_CACHE_HOME -u BRECCIA_CACHE OMPI_MCA_pml=none "$@"
}
# every command, with results into the folder that is given
all_commands() {
    good bare "$breccia" run case.yaml -o "$1/run" --quiet
    good bare "$breccia" compare case.yaml -o "$1/pair" --quiet
    good bare "$breccia" converge case.yaml --observable E --axes step --seeds 1 --refine 2 --model vgcm \
        -o "$1/ladder"
    good bare "$breccia" sweep sweep.yaml -o "$1/sweep"
    good bare "$breccia" info "$1/run/state.h5"
    good bare "$breccia" export "$1/run/state.h5" --table curve
    good bare "$breccia" params run
    good bare "$breccia" models
}

TMPDIR=/nonexistent all_commands nowhere
mkdir empty
TMPDIR=$folder/empty all_commands somewhere
[ -z "$(ls -A empty)" ] || fail "a run leaves in the temporary folder: $(ls -A empty)"

# /tmp on which nothing can be written, where one may be mounted
export -f all_commands bare good fail
export breccia failures
cat >sealed.sh <<'END'
exec 9<"$breccia" # the program may lie below /tmp itself
mount -t tmpfs -o ro none /tmp || exit 99
breccia=/proc/self/fd/9
unset TMPDIR
all_commands results
exit $failures
END
mkdir sealed
as_root=-m
[ "$(id -u)" -eq 0 ] || as_root=-rm
if unshare $as_root mount -t tmpfs none sealed 2>/dev/null; then
    # results must lie outside /tmp
    other=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d -p /var/tmp)
    trap 'rm -rf "$folder" "$other"' EXIT
    cp case.yaml sweep.yaml sealed.sh "$other"
    (cd "$other" && unshare $as_root bash sealed.sh) || fail "with /tmp sealed"
fi

# side by side: each with the same bits
jobs=36
for i in $(seq $jobs); do
    "$breccia" run case.yaml -o "many/$i" --quiet >"many_$i.txt" 2>&1 || echo "$i" >>bad.txt &
done
wait
[ ! -e bad.txt ] || fail "of $jobs runs side by side these have failed: $(tr '\n' ' ' <bad.txt)"
kinds=$(sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' many/*/summary.json nowhere/run/summary.json |
    sort | uniq -c | awk '{ print $1 }')
[ "$kinds" = $((jobs + 1)) ] || fail "$jobs runs side by side end with other bits: $kinds"
[ $failures -eq 0 ]
