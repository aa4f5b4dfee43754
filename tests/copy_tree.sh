# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by tests that follow a page of docs/ to the letter: enters a copy of the tree, NAME under
# $BUILD/tests, in which make compiles only what is new. unchanged: no existing file has changed.
# shellcheck shell=bash
BUILD=${BUILD:-build}
copy_tree() {
    copy=$BUILD/tests/$1
    rm -rf "$copy"
    mkdir -p "$copy/$BUILD"
    git ls-files -z | xargs -0 cp -p --parents -t "$copy"
    cp -p build/deps.mk "$copy/build/"
    cp -pr "$BUILD/obj" "$BUILD/flags" "$BUILD"/*.h "$BUILD"/*.a "$copy/$BUILD/"
    cd "$copy"
    find . -type f ! -path './build/*' | sort | xargs sha256sum >build/sums
    make="make --no-print-directory CFG=$(case $BUILD in build) echo release ;; *) echo "${BUILD#build/}" ;; esac)"
}
unchanged() {
    sha256sum --quiet -c build/sums
    cd - >/dev/null
    rm -rf "$copy"
}
