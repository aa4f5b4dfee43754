#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Follows docs/add-a-test.md to the letter in a copy of the tree. No existing file may change, and the
# conformance suite must pass over the new test.
set -eu
. tests/copy_tree.sh
copy_tree add-a-test

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0; print "" } inside' docs/add-a-test.md |
    sed '$d' >common/rigs/squeeze.c
if command -v clang-format >/dev/null; then
    clang-format --dry-run -Werror common/rigs/squeeze.c
fi
$make all "$BUILD/tests/model/test_rigs" >log 2>&1 || { cat log; exit 1; }
"$BUILD/breccia" tests | grep -q '^squeeze: compression along an axis'
"$BUILD/breccia" params squeeze | grep -q 'axis of the load'
"$BUILD/breccia" params test | grep -q squeeze
"$BUILD/tests/model/test_rigs" >log 2>&1 || { cat log; exit 1; }
grep -q '^vgcm, squeeze: ' log || { echo "the suite did not run over the new test"; exit 1; }
grep '^    build/breccia run' docs/add-a-test.md | sed "s,build/breccia,$BUILD/breccia," >run
[ "$(wc -l <run)" -eq 1 ]
sh -eu run >log 2>&1 || { cat log; exit 1; }
grep -q '"E_platen"' results/squeeze/summary.json
grep -q '^squeeze:' results/squeeze/case.yaml || grep -q 'squeeze.axis' results/squeeze/case.yaml
# a key of another test is refused, and the message knows the new one
"$BUILD/breccia" run cases/demo_compression.yaml --set test.kind=squeeze --set test.grip=full -o results/no >log 2>&1 && exit 1
grep -q 'test.grip: applies only with kind=tension' log
unchanged
echo "docs/add-a-test.md adds a test without a change to an existing file"
