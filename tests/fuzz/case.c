/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Entry of libFuzzer. */
#include "tests/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_case(data, size);
}
