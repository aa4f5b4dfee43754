#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make install puts all in place, a program builds and runs against it through pkg-config, the manual
# page and the completion know every command, and make uninstall leaves nothing behind.
set -u
case $BUILD in
*/san) echo "no shared library in a sanitizer build" && exit 0 ;;
esac
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
prefix=/opt/breccia
root=$stage$prefix
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
make_here() {
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make --no-print-directory \
        "CFG=${CFG:-release}" "DESTDIR=$stage" "PREFIX=$prefix" "$@" >"$stage.log" 2>&1 ||
        { cat "$stage.log"; exit 1; }
}
trap 'rm -rf "$stage" "$stage.log"' EXIT
make_here install

# --- a program on the installed library -------------------------------------------------------------
export PKG_CONFIG_PATH=$root/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$stage
version=$(pkg-config --modversion breccia) || fail "no pkg-config module"
[ "breccia $version" = "$("$root/bin/breccia" --version)" ] || fail "version $version"
# shellcheck disable=SC2046
gcc -std=c17 -Wall -Wextra -Wpedantic -Werror "$root/share/doc/breccia/example_library.c" \
    $(pkg-config --cflags --libs breccia) -o "$stage/example" || fail "the example does not build"
readelf -d "$stage/example" | grep -q "libbreccia.so.${version%.*}\]" || fail "no soname in the example"
[ -L "$root/lib/libbreccia.so.${version%.*}" ] || fail "no link for the soname"
cat >"$stage/case.yaml" <<'EOF'
breccia: 1
model: vgcm
specimen: {shape: box, size: [3 cm, 3 cm, 4 cm], grains: grid, cells: [3, 3, 4], jitter: 0.6}
test: {kind: compression, loading: fixed, rate: 2e-5 1/s, strain_max: 0.004}
output: {plots: off}
EOF
for model in $("$root/bin/breccia" models | awk '{ print $1 }'); do
    LD_LIBRARY_PATH=$root/lib "$stage/example" "$stage/case.yaml" "$model" >"$stage/said" ||
        fail "the example does not run $model"
    "$root/bin/breccia" run "$stage/case.yaml" --model "$model" -o "$stage/run-$model" --quiet \
        >/dev/null || fail "the installed program does not run $model"
    sed -n 's/^    "\(.*\)": {"value": \([-0-9.e+]*\), "unit": "\(.*\)"}.*/\1 = \2 \3/p' \
        "$stage/run-$model/summary.json" >"$stage/expected"
    [ -s "$stage/expected" ] || fail "no results of $model"
    grep -v '= -*nan' "$stage/said" | diff - "$stage/expected" >&2 ||
        fail "the example measures other values of $model"
done
rm -rf "$stage"/run-* "$stage/said" "$stage/expected" "$stage/case.yaml" "$stage/example"

# every header compiles alone, without those of other libraries
for header in "$root"/include/breccia/*.h; do
    echo "#include <breccia/${header##*/}>" |
        gcc -std=c17 -Wall -Werror -fsyntax-only -x c -I"$root/include" - || fail "$header alone"
done

# --- manual page, completion ------------------------------------------------------------------------
page=$root/share/man/man1/breccia.1
if command -v groff >/dev/null; then
    [ -z "$(groff -man -Tutf8 -ww "$page" 2>&1 >/dev/null)" ] || fail "groff warns of the page"
fi
# shellcheck source=/dev/null
. "$root/share/bash-completion/completions/breccia"
complete -p breccia | grep -q -- '-F _breccia breccia' || fail "no completion of breccia"
# completed WORD...: what bash would offer for the last word
completed() {
    COMP_WORDS=(breccia "$@") COMP_CWORD=$# COMPREPLY=()
    _breccia
    printf '%s\n' "${COMPREPLY[@]}"
}
commands=$("$root/bin/breccia" --help | awk '/^commands:/ { on = 1; next } !NF { on = 0 } on { print $1 }')
[ "$(printf '%s\n' $commands --help --version | sort)" = "$(completed '' | sort)" ] ||
    fail "completion offers $(completed '')"
for command in $commands; do
    grep -q "^\.SS $command" "$page" || fail "no $command in the manual page"
    options=$("$root/bin/breccia" "$command" --help |
        awk '/^options:/ { on = 1; next } !NF { on = 0 } on { print $1 }')
    [ "$(echo "$options" | sort)" = "$(completed "$command" - | sort)" ] ||
        fail "completion of $command offers $(completed "$command" -)"
    for option in $options; do
        sed 's/\\//g' "$page" | grep -q "^\.B $option" || fail "no $option in the manual page"
    done
done
[ "$(completed run --set vgcm.e_)" = "vgcm.e_bar=" ] || fail "keys are not completed"
[ "$(completed run --model po)" = "polyhedra" ] || fail "models are not completed"
[ "$(completed params spe)" = "specimen" ] || fail "sections are not completed"
[ "$(cd cases && completed run demo_b)" = "demo_brazilian.yaml" ] || fail "cases are not completed"

# --- away again -------------------------------------------------------------------------------------
make_here uninstall
left=$(find "$stage" ! -type d)
[ -z "$left" ] || fail "uninstall leaves $left"

[ $failures -eq 0 ] || exit 1
