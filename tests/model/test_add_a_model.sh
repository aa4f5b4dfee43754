#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Follows docs/add-a-model.md to the letter in a copy of the tree: first the null model under another
# name, then the springs of the page's code blocks. No existing file may change, and the conformance
# suite must pass over the new model.
set -eu
. tests/copy_tree.sh
copy_tree add-a-model

# section 1, as written
sed -n 's/^    \(cp -r .*\|sed -i .*\)$/\1/p' docs/add-a-model.md >first
[ "$(wc -l <first)" -eq 2 ]
sh -eu first
$make all >log 2>&1 || { cat log; exit 1; }
"$BUILD/breccia" params spring | grep -q spring

# sections 2 to 7
awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' docs/add-a-model.md >spring/model.c
suite="$BUILD/tests/model/test_conformance"
$make all "$suite" "${suite}_energy" "${suite}_bits" >log 2>&1 || { cat log; exit 1; }
"$BUILD/breccia" params spring | grep -q modulus
if command -v clang-format >/dev/null; then
    clang-format --dry-run -Werror spring/model.c
fi
for part in energy bits; do
    "${suite}_$part" >log 2>&1 || { cat log; exit 1; }
done
"$suite" >log 2>&1 || { cat log; exit 1; }
grep -q '^spring: turned' log || { echo "the suite did not run over the new model"; exit 1; }
grep '^    build/breccia run' docs/add-a-model.md | sed "s,build/breccia,$BUILD/breccia," >run
[ "$(wc -l <run)" -eq 1 ]
sh -eu run >log 2>&1 || { cat log; exit 1; }
grep -q '"E"' results/spring/summary.json
unchanged
echo "docs/add-a-model.md adds a model without a change to an existing file"
