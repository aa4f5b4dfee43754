/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into sanitizer builds only. HDF5 loses some of its own memory when it refuses a damaged
 * file, which the tests of state files make on purpose. */
#include <sanitizer/lsan_interface.h>

const char *__lsan_default_suppressions(void)
{
    return "leak:libhdf5";
}
