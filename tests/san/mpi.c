/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into sanitizer builds only. MPI keeps memory of modules that it has unloaded again; no
 * suppression list can name those, so what MPI allocates while it starts and ends is not tracked.
 */
#include <sanitizer/lsan_interface.h>

int __real_MPI_Init(int *argc, char ***argv);
int __real_MPI_Finalize(void);
int __wrap_MPI_Init(int *argc, char ***argv);
int __wrap_MPI_Finalize(void);

int __wrap_MPI_Init(int *argc, char ***argv)
{
    __lsan_disable();
    int code = __real_MPI_Init(argc, argv);
    __lsan_enable();
    return code;
}

int __wrap_MPI_Finalize(void)
{
    __lsan_disable();
    int code = __real_MPI_Finalize();
    __lsan_enable();
    return code;
}
