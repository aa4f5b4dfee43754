/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The compiler's own test of the processor, not cpuid by hand: it also asks whether the system
 * saves the registers. A set that is missing is an error rather than replaced, as the user named
 * it. */
#include "common/base/simd.h"

#include "common/base/error.h"

static bool has(enum brc_simd set)
{
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    const bool is_there[BRC_N_SIMD] = {true, __builtin_cpu_supports("avx2"), avx512};
    return is_there[set];
}

enum brc_simd brc_simd_of(int choice)
{
    int set = choice > 0 ? choice - 1 : BRC_N_SIMD - 1;
    while (choice == 0 && !has((enum brc_simd)set))
        set--;
    return (enum brc_simd)set;
}

int brc_simd_check(struct brc_context *ctx, int choice)
{
    static const char *const name[BRC_N_SIMD] = {"base", "avx2", "avx512"};
    enum brc_simd set = brc_simd_of(choice);
    if (has(set))
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "run.simd = %s: this machine does not have these instructions; choose %s or auto",
             name[set], name[brc_simd_of(0)]);
}
