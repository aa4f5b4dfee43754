#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_comm on three ranks, and its silence on one.
set -eu
program=$BUILD/tests/unit/test_comm

# the leak checker cannot follow the transport between ranks
ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    mpirun --oversubscribe -n 3 "$program"

said=$(env -i PATH="$PATH" "$program" 2>&1 | grep -v '^\[' || true)
if [ -n "$said" ]; then
    echo "one process is not silent: $said"
    exit 1
fi
