#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# .ci/deps in each situation, with made-up package tools that lie in front of the real ones.
# shellcheck disable=SC2015,SC2016
set -eu
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/bin" "$dir/plain"
failed=0

# the tools that .ci/deps itself uses; "plain" is a system that has these and no package tools
for tool in sh awk sed tr dirname mkdir mv rm touch tail cat g++ gcc pkg-config env true; do
    ln -s "$(command -v $tool)" "$dir/plain/$tool"
done
fake() {
    printf '#!/bin/sh\n%s\n' "$2" >"$dir/bin/$1"
    chmod +x "$dir/bin/$1"
}
all_but_cgal='for a; do case $a in -*|*{*|libcgal-dev) ;; *) echo "installed $a" ;; esac; done
[ -e "$FAKE/done" ] && echo "installed libcgal-dev"; exit 1'
apt='echo "$*" >>"$FAKE/calls"; case "$*" in *install*) [ -e "$FAKE/offline" ] && { echo "E: no network"; exit 100; }; : >"$FAKE/done" ;; esac'

# expect NAME STATUS PATTERN... : runs .ci/deps and looks for the patterns in what it says
expect() {
    name=$1 status=$2
    shift 2
    got=0
    said=$(FAKE=$dir PATH=$dir/bin:$dir/plain .ci/deps build "$dir/out/deps.mk" 2>&1 </dev/null) ||
        got=$?
    if [ $got -ne "$status" ]; then
        echo "$name: status $got, expected $status"
        failed=1
    fi
    for pattern; do
        if ! printf '%s' "$said" | grep -q -e "$pattern"; then
            echo "$name: does not say '$pattern'"
            failed=1
        fi
    done
    printf '== %s (status %d)\n%s\n' "$name" $got "$said"
}

fake dpkg-query 'for a; do case $a in -*|*{*) ;; *) echo "installed $a" ;; esac; done; exit 1'
fake apt-get "$apt"
fake id 'echo 0'
expect "nothing missing" 0
[ -z "$said" ] || { echo "nothing missing: is not silent"; failed=1; }
grep -q DEPS_LIBS "$dir/out/deps.mk" || { echo "nothing missing: no flags"; failed=1; }

fake dpkg-query "$all_but_cgal"
expect "root" 0 'missing packages' 'libcgal-dev .*Voronoi' 'installing them by apt-get;'
grep -q 'update' "$dir/calls" && grep -q 'install -y .*libcgal-dev$' "$dir/calls" ||
    { echo "root: wrong calls of apt-get"; failed=1; }
rm "$dir/done"

: >"$dir/offline"
expect "root, offline" 1 'E: no network' 'apt-get failed' 'apt-get install -y'
rm "$dir/offline"

fake id 'echo 1000'
expect "neither root nor sudo" 1 'neither root nor sudo' 'apt-get install -y .*libcgal-dev'

fake sudo '[ "$1" = -n ] && exit 1; "$@"'
expect "sudo with a password" 1 'asks for a password' 'sudo apt-get install -y .*libcgal-dev'

fake sudo 'echo "sudo $*" >>"$FAKE/calls"; [ "$1" = -n ] && shift; "$@"'
expect "sudo" 0 'with sudo'
grep -q 'sudo env DEBIAN_FRONTEND=noninteractive apt-get .*install' "$dir/calls" ||
    { echo "sudo: wrong call"; failed=1; }

rm "$dir/bin/dpkg-query" "$dir/bin/apt-get"
expect "another system that has everything" 0
[ -z "$said" ] || { echo "another system: is not silent"; failed=1; }

fake pkg-config '[ "$1" = --exists ] && [ "$2" = gsl ] && exit 1; exit 0'
expect "another system" 1 'libgsl-dev .*GSL' 'not a Debian system' 'pkg-config module gsl'

exit $failed
