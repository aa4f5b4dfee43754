#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_comm on three ranks; on one, where MPI could not start and there is no home folder, silently.
set -eu
program=$BUILD/tests/unit/test_comm

# mpirun (Open MPI 5) needs a home folder
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
# the leak checker cannot follow the transport between ranks
ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    HOME=${HOME:-$home} mpirun --oversubscribe -n 3 "$program"

said=$(env -i PATH="$PATH" OMPI_MCA_pml=none TMPDIR=/nonexistent "$program" 2>&1 | grep -v '^\[' || true)
if [ -n "$said" ]; then
    echo "one process is not silent: $said"
    exit 1
fi
