#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Follows docs/add-a-model.md to the letter in a copy of the tree: first the null model under another
# name, then the springs of the page's code blocks. No existing file may change, and the conformance
# suite must pass over the new model.
set -eu
BUILD=${BUILD:-build}
copy=$BUILD/tests/add-a-model
rm -rf "$copy"
mkdir -p "$copy/$BUILD"
# what make needs; objects come along, so that only the new folder is compiled
git ls-files -z | xargs -0 cp -p --parents -t "$copy"
cp -p build/deps.mk "$copy/build/"
cp -pr "$BUILD/obj" "$BUILD/flags" "$BUILD"/*.h "$BUILD"/*.a "$copy/$BUILD/"
cd "$copy"
find . -type f ! -path './build/*' | sort | xargs sha256sum >build/sums

make="make --no-print-directory CFG=$(case $BUILD in build) echo release ;; *) echo "${BUILD#build/}" ;; esac)"
# section 1, as written
sed -n 's/^    \(cp -r .*\|sed -i .*\)$/\1/p' docs/add-a-model.md >first
[ "$(wc -l <first)" -eq 2 ]
sh -eu first
$make all >log 2>&1 || { cat log; exit 1; }
"$BUILD/breccia" params spring | grep -q spring

# sections 2 to 7
awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' docs/add-a-model.md >spring/model.c
$make all "$BUILD/tests/model/test_conformance" >log 2>&1 || { cat log; exit 1; }
"$BUILD/breccia" params spring | grep -q modulus
if command -v clang-format >/dev/null; then
    clang-format --dry-run -Werror spring/model.c
fi
"$BUILD/tests/model/test_conformance" >log 2>&1 || { cat log; exit 1; }
grep -q '^spring: turned' log || { echo "the suite did not run over the new model"; exit 1; }
grep '^    build/breccia run' docs/add-a-model.md | sed "s,build/breccia,$BUILD/breccia," >run
[ "$(wc -l <run)" -eq 1 ]
sh -eu run >log 2>&1 || { cat log; exit 1; }
grep -q '"E"' results/spring/summary.json
sha256sum --quiet -c build/sums
cd - >/dev/null
rm -rf "$copy"
echo "docs/add-a-model.md adds a model without a change to an existing file"
