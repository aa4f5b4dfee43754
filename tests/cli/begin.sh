# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced first by the scripts of this folder, which run from the top of the tree. Each goes on in a
# folder of its own that is removed at the end, with a cache of its own: a packing that another test
# has left would hide what a test looks for. A script goes on after a failure, so that one run tells
# of all, and ends with `[ $failures -eq 0 ]`.
set -u
breccia=$(realpath "$BRECCIA") tree=$PWD
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export BRECCIA_CACHE=$folder/cache
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
# good COMMAND...: status 0
good() {
    "$@" >said.txt 2>&1 || { fail "$*"; sed 's/^/  | /' said.txt; }
}
# expect STATUS TEXT COMMAND...: the status, and a line that holds the text on either stream
expect() {
    status=$1 text=$2
    shift 2
    said=$("$@" 2>&1)
    got=$?
    if [ $got -ne "$status" ] || ! printf '%s\n' "$said" | grep -qF -- "$text"; then
        fail "$*"
        echo "  status $got, expected $status; expected the text: $text"
        printf '%s\n' "$said" | sed 's/^/  | /'
    fi
}
hash_of() {
    sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' "$1/summary.json"
}
