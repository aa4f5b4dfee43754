/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which instruction set hot loops use. Asked once as a run starts, by whatever has loops compiled
 * for several sets; all sets give the same bits, so that a state may go on on another machine. */
#ifndef BRC_SIMD_H
#define BRC_SIMD_H

#include "common/base/brc.h"

/* Instruction sets in ascending order: a choice of `auto` walks down from the last. */
enum brc_simd { BRC_SIMD_BASE, BRC_SIMD_AVX2, BRC_SIMD_AVX512, BRC_N_SIMD };
/* The set that the choice `run.simd` (0: the best that this machine has) stands for, and whether
 * this machine has it. */
enum brc_simd brc_simd_of(int choice);
int brc_simd_check(struct brc_context *ctx, int choice);

#endif
