#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The same bits from another process and from a build without optimisation (all C sources; the
# tessellation's C++ and the files of libraries stay as they are).
set -eu
BUILD=${BUILD:-build}
program=$BUILD/tests/determinism/test_repeat
out=$BUILD/tests/O0
[ -x "$program" ] || make --no-print-directory "$program" >&2

deps=$(sed -n 's/^DEPS_CFLAGS := //p' build/deps.mk)
libs=$(sed -n 's/^DEPS_LIBS := //p' build/deps.mk)
# a build without optimisation and with sanitizers takes minutes, and says no more about bits
case $BUILD in */san) echo "not under sanitizers"; exit 0 ;; esac
models=$(ls -- */model.c | sed 's,/model.c,,')
sources=$(ls common/*/*.c tests/fixture.c tests/null/model.c tests/determinism/test_repeat.c |
    grep -v -e main.c -e io_h5.c -e comm_mpi.c)
for model in $models; do
    sources="$sources $(ls "$model"/*.c)"
done

mkdir -p "$out"
if [ ! -e "$out/test_repeat" ] || [ "$program" -nt "$out/test_repeat" ]; then
    rm -f "$out"/*.o
    # shellcheck disable=SC2086
    printf '%s\n' $sources | xargs -P 2 -I{} sh -c \
        'gcc -std=c17 -O0 -ffp-contract=off -fno-math-errno -Wno-psabi -D_POSIX_C_SOURCE=200809L \
            -I. -I"$0" $2 -c "$3" -o "$1/$(echo "$3" | tr / _).o"' "$BUILD" "$out" "$deps" {}
    # shellcheck disable=SC2086
    g++ "$out"/*.o "$BUILD/libbreccia.a" $libs -lcmocka -o "$out/test_repeat"
fi

"$program" 2>&1 | grep '^hash' >"$out/first"
"$program" 2>&1 | grep '^hash' >"$out/second"
"$out/test_repeat" 2>&1 | grep '^hash' >"$out/unoptimised"
[ "$(wc -l <"$out/first")" -ge 13 ]
diff "$out/first" "$out/second" || { echo "another process gives other bits"; exit 1; }
diff "$out/first" "$out/unoptimised" || { echo "-O0 gives other bits"; exit 1; }
echo "$(wc -l <"$out/first") hashes are the same in two processes and without optimisation"
