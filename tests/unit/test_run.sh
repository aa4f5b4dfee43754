#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/run counts what passes and fails, and lets no kind of failure through.
set -eu
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
failed=0

program() {
    printf '#!/bin/sh\n%s\n' "$2" >"$dir/$1"
    chmod +x "$dir/$1"
}
# expect LAST STATUS PROGRAM...
expect() {
    last=$1 status=$2
    shift 2
    got=0
    said=$(BUILD=$dir LIMIT=2 tests/run "$@") || got=$?
    if [ "$(printf '%s\n' "$said" | tail -n 1)" != "$last" ] || [ $got -ne "$status" ]; then
        printf '%s: expected "%s" and status %d, got %d and:\n%s\n' "$*" "$last" "$status" $got "$said"
        failed=1
    fi
}

program good 'echo "[  PASSED  ] 3 test(s)."'
program bad 'echo "[  PASSED  ] 2 test(s)."; echo "[  FAILED  ] 1 test(s), listed below:"; exit 1'
program crash 'echo "[==========] Running 2 test(s)."; kill -SEGV $$'
program hang 'sleep 60'
program plain 'exit 0'

expect '4 passed, 0 failed' 0 "$dir/good" "$dir/plain"
expect '5 passed, 1 failed' 1 "$dir/good" "$dir/bad"
expect '3 passed, 1 failed' 1 "$dir/good" "$dir/crash"
expect '3 passed, 1 failed' 1 "$dir/good" "$dir/hang"
expect '3 passed, 1 failed' 1 "$dir/good" "$dir/missing"
expect '0 passed, 0 failed' 1
exit $failed
