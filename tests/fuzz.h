/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fuzzers and the test of their corpus call: each takes any bytes, checks what must hold for
 * them, and ends the program where it does not. docs/failures.md says what is out of their reach.
 */
#ifndef BRC_TESTS_FUZZ_H
#define BRC_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* A case file, up to the first NUL; then assignments of --set, each up to a NUL. */
int fuzz_case(const uint8_t *data, size_t size);
/* A state file. First byte 0: the rest are its bytes. Else an intact file is written with changes
 * that the rest asks for, and sealed. */
int fuzz_state(const uint8_t *data, size_t size);
/* A file of seeds. */
int fuzz_numbers(const uint8_t *data, size_t size);

#endif
