/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Four doubles side by side, the unit in which hot loops work on every machine: compilers map them
 * to whatever registers there are. Nothing depends on the registers' width, and sums over lanes
 * have one order, so each machine gives the same bits. Loops are compiled for several instruction
 * sets and one is chosen as the program runs (simd.h).
 *
 * Vector extensions of the compiler rather than intrinsics: operators read like the formulas that
 * they implement, and the same source compiles for plain x86-64, where each operation becomes two.
 * Intrinsics stand only where the compilers' own choice was not the one instruction that there is,
 * each with the plain form beside it. A mask shuts off the lanes past the end of a list
 * (brc_lanes_first), so that a law need not be written a second time for single items. */
#ifndef BRC_LANES_H
#define BRC_LANES_H

#include "common/base/brc.h"

#include <math.h>

/* all functions that take lanes are inlined, so that the convention for passing them never matters
 */
#define BRC_LANES_INLINE static inline __attribute__((always_inline))

enum { BRC_LANES = 4 };
typedef double brc_lanes __attribute__((vector_size(32)));
/* all ones where true, as comparisons of lanes give it */
typedef int64_t brc_mask __attribute__((vector_size(32)));
/* the same in memory, at the alignment of a double */
typedef double brc_lanes_loose __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t brc_mask_loose __attribute__((vector_size(32), aligned(8), may_alias));
typedef double brc_pair_loose __attribute__((vector_size(16), aligned(8), may_alias));
typedef double brc_pair __attribute__((vector_size(16)));

BRC_LANES_INLINE brc_lanes brc_lanes_all(double x)
{
    return (brc_lanes){x, x, x, x};
}

BRC_LANES_INLINE brc_lanes brc_lanes_at(const double *x)
{
    return *(const brc_lanes_loose *)x;
}

BRC_LANES_INLINE void brc_lanes_put(double *x, brc_lanes a)
{
    *(brc_lanes_loose *)x = a;
}

/* a where the mask is set, b elsewhere. Both are computed, so either may divide by zero or be NAN
 * where it is not picked: traps are off. */
BRC_LANES_INLINE brc_lanes brc_lanes_pick(brc_mask m, brc_lanes a, brc_lanes b)
{
#ifdef __AVX2__
    return __builtin_ia32_blendvpd256(b, a, (brc_lanes)m);
#else
    return (brc_lanes)((m & (brc_mask)a) | (~m & (brc_mask)b));
#endif
}

/* a where the mask is set, 0 elsewhere */
BRC_LANES_INLINE brc_lanes brc_lanes_where(brc_mask m, brc_lanes a)
{
    return (brc_lanes)(m & (brc_mask)a);
}

/* Where a < b. Compilers split what is too wide for the machine, except for comparisons. */
BRC_LANES_INLINE brc_mask brc_lanes_less(brc_lanes a, brc_lanes b)
{
#ifdef __AVX2__
    return a < b;
#else
    typedef int64_t pair_mask __attribute__((vector_size(16)));
    brc_pair a0 = __builtin_shufflevector(a, a, 0, 1), a1 = __builtin_shufflevector(a, a, 2, 3);
    brc_pair b0 = __builtin_shufflevector(b, b, 0, 1), b1 = __builtin_shufflevector(b, b, 2, 3);
    pair_mask m0 = a0 < b0, m1 = a1 < b1;
    return __builtin_shufflevector(m0, m1, 0, 1, 2, 3);
#endif
}

BRC_LANES_INLINE bool brc_lanes_any(brc_mask m)
{
#ifdef __AVX2__
    return __builtin_ia32_movmskpd256((brc_lanes)m) != 0;
#else
    brc_mask both = m | __builtin_shufflevector(m, m, 2, 3, 0, 1);
    return __builtin_ia32_movmskpd((brc_pair)__builtin_shufflevector(both, both, 0, 1)) != 0;
#endif
}

/* The first n lanes; all for n of 4 or more, so that a loop needs no case for its end. */
BRC_LANES_INLINE brc_mask brc_lanes_first(int64_t n)
{
    static const int64_t mask[2 * BRC_LANES] = {-1, -1, -1, -1, 0, 0, 0, 0};
    return *(const brc_mask_loose *)&mask[BRC_LANES - (n < BRC_LANES ? n : BRC_LANES)];
}

/* Which of four bytes are x. */
BRC_LANES_INLINE brc_mask brc_lanes_equal(const uint8_t *bytes, uint8_t x)
{
    typedef int8_t quad __attribute__((vector_size(4)));
    quad b = {(int8_t)bytes[0], (int8_t)bytes[1], (int8_t)bytes[2], (int8_t)bytes[3]};
    return __builtin_convertvector(b == (int8_t)x, brc_mask);
}

BRC_LANES_INLINE brc_lanes brc_lanes_abs(brc_lanes a)
{
    return (brc_lanes)((brc_mask)a & INT64_MAX);
}

/* The size of a with the sign of b. */
BRC_LANES_INLINE brc_lanes brc_lanes_sign(brc_lanes a, brc_lanes b)
{
    return (brc_lanes)(((brc_mask)a & INT64_MAX) | ((brc_mask)b & INT64_MIN));
}

/* a where a < b, b elsewhere: the machine's instruction does just that. So b is what comes of a
 * NAN in either, unlike fmin, which gives the number. */
BRC_LANES_INLINE brc_lanes brc_lanes_min(brc_lanes a, brc_lanes b)
{
#ifdef __AVX2__
    return __builtin_ia32_minpd256(a, b);
#else
    return brc_lanes_pick(brc_lanes_less(a, b), a, b);
#endif
}

BRC_LANES_INLINE brc_lanes brc_lanes_max(brc_lanes a, brc_lanes b)
{
#ifdef __AVX2__
    return __builtin_ia32_maxpd256(a, b);
#else
    return brc_lanes_pick(brc_lanes_less(b, a), a, b);
#endif
}

BRC_LANES_INLINE brc_lanes brc_lanes_sqrt(brc_lanes a)
{
    return (brc_lanes){sqrt(a[0]), sqrt(a[1]), sqrt(a[2]), sqrt(a[3])};
}

/* In pairs, as two halves of a register are added; no other order may be used, or machines would
 * differ. */
BRC_LANES_INLINE double brc_lanes_sum(brc_lanes a)
{
    return (a[0] + a[1]) + (a[2] + a[3]);
}

BRC_LANES_INLINE brc_lanes brc_lanes_dot(const brc_lanes a[3], const brc_lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

BRC_LANES_INLINE void brc_lanes_cross(brc_lanes r[3], const brc_lanes a[3], const brc_lanes b[3])
{
    brc_lanes x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    r[2] = a[0] * b[1] - a[1] * b[0];
    r[0] = x;
    r[1] = y;
}

/* Lane i of r[j] becomes lane j of r[i]. Values of a grain lie side by side in memory, since one
 * contact reads all of them: three coordinates for one fetch of a cache line. Loops want them lane
 * by lane, and these shuffles are the price. */
BRC_LANES_INLINE void brc_lanes_transpose(brc_lanes r[BRC_LANES])
{
    brc_lanes even = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    brc_lanes odd = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    brc_lanes even_up = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    brc_lanes odd_up = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(even, even_up, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(odd, odd_up, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(even, even_up, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(odd, odd_up, 2, 3, 6, 7);
}

/* Two values from each of four places, to lanes: lane i of r[j] is p[i][j]. Loaded in halves, as
 * registers of 32 bytes are in effect two of 16: the two shuffles that follow stay within halves,
 * where a transposition of four whole rows crosses them. */
BRC_LANES_INLINE void brc_lanes_gather2(brc_lanes r[2], const double *const p[BRC_LANES])
{
    brc_lanes even = __builtin_shufflevector(*(const brc_pair_loose *)p[0],
                                             *(const brc_pair_loose *)p[2], 0, 1, 2, 3);
    brc_lanes odd = __builtin_shufflevector(*(const brc_pair_loose *)p[1],
                                            *(const brc_pair_loose *)p[3], 0, 1, 2, 3);
    r[0] = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    r[1] = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}

BRC_LANES_INLINE void brc_lanes_gather4(brc_lanes r[BRC_LANES], const double *const p[BRC_LANES])
{
    for (int k = 0; k < BRC_LANES; k += 2)
        brc_lanes_gather2(r + k, (const double *const[]){p[0] + k, p[1] + k, p[2] + k, p[3] + k});
}

/* Four rows of 3 values, one after the other, to and from lanes. */
BRC_LANES_INLINE void brc_lanes_at3(brc_lanes r[3], const double (*x)[3])
{
    const double *v = (const double *)x; /* across the rows */
    brc_lanes a = brc_lanes_at(v), b = brc_lanes_at(v + 4), c = brc_lanes_at(v + 8);
    brc_lanes ab = __builtin_shufflevector(a, b, 0, 1, 6, 7); /* x0 y0 x2 y2 */
    brc_lanes bc = __builtin_shufflevector(b, c, 0, 1, 6, 7); /* y1 z1 y3 z3 */
    brc_lanes ca = __builtin_shufflevector(a, c, 2, 3, 4, 5); /* z0 x1 z2 x3 */
    r[0] = __builtin_shufflevector(ab, ca, 0, 5, 2, 7);
    r[1] = __builtin_shufflevector(ab, bc, 1, 4, 3, 6);
    r[2] = __builtin_shufflevector(ca, bc, 0, 5, 2, 7);
}

BRC_LANES_INLINE void brc_lanes_put3(double (*x)[3], const brc_lanes r[3])
{
    brc_lanes ab = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    brc_lanes ca = __builtin_shufflevector(r[2], r[0], 0, 5, 2, 7);
    brc_lanes bc = __builtin_shufflevector(r[1], r[2], 1, 5, 3, 7);
    double *v = (double *)x; /* across the rows */
    brc_lanes_put(v, __builtin_shufflevector(ab, ca, 0, 1, 4, 5));
    brc_lanes_put(v + 4, __builtin_shufflevector(bc, ab, 0, 1, 6, 7));
    brc_lanes_put(v + 8, __builtin_shufflevector(ca, bc, 2, 3, 6, 7));
}

/* Rows of 6 values at four places, to lanes. */
BRC_LANES_INLINE void brc_lanes_gather6(brc_lanes r[6], double (*x)[6], const int32_t row[4])
{
    for (int k = 0; k < 6; k += 2)
        brc_lanes_gather2(r + k, (const double *const[]){x[row[0]] + k, x[row[1]] + k,
                                                         x[row[2]] + k, x[row[3]] + k});
}

/* Two values of four rows, from lanes. The first of equal rows is what stays. */
BRC_LANES_INLINE void brc_lanes_scatter2(double *const x[4], brc_lanes r0, brc_lanes r1)
{
    brc_lanes lo = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);
    brc_lanes hi = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
    *(brc_pair_loose *)x[3] = __builtin_shufflevector(hi, hi, 2, 3);
    *(brc_pair_loose *)x[2] = __builtin_shufflevector(lo, lo, 2, 3);
    *(brc_pair_loose *)x[1] = __builtin_shufflevector(hi, hi, 0, 1);
    *(brc_pair_loose *)x[0] = __builtin_shufflevector(lo, lo, 0, 1);
}

/* Rows of 6 and of 3 values at four places, from lanes. The first of equal rows is what stays. */
BRC_LANES_INLINE void brc_lanes_scatter6(double (*x)[6], const int32_t row[4], const brc_lanes r[6])
{
    for (int k = 0; k < 6; k += 2)
        brc_lanes_scatter2(
            (double *const[]){&x[row[0]][k], &x[row[1]][k], &x[row[2]][k], &x[row[3]][k]}, r[k],
            r[k + 1]);
}

BRC_LANES_INLINE void brc_lanes_scatter3(double (*x)[3], const int32_t row[4], const brc_lanes r[3])
{
    brc_lanes_scatter2((double *const[]){x[row[0]], x[row[1]], x[row[2]], x[row[3]]}, r[0], r[1]);
    for (int i = 3; i >= 0; i--)
        x[row[i]][2] = r[2][i];
}

/* Rows of 3 values at four places, to lanes. */
BRC_LANES_INLINE void brc_lanes_gather3(brc_lanes r[3], double (*x)[3], const int32_t row[4])
{
    brc_lanes_gather2(r, (const double *const[]){x[row[0]], x[row[1]], x[row[2]], x[row[3]]});
    r[2] = (brc_lanes){x[row[0]][2], x[row[1]][2], x[row[2]][2], x[row[3]][2]};
}

/* Rows of 3 values at the places b less those at a, to lanes. Reads one value past each row. */
BRC_LANES_INLINE void brc_lanes_between3(brc_lanes r[3], double (*x)[3], const int32_t a[4],
                                         const int32_t b[4])
{
    brc_lanes row[BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++)
        row[k] = brc_lanes_at(x[b[k]]) - brc_lanes_at(x[a[k]]);
    brc_lanes_transpose(row);
    for (int k = 0; k < 3; k++)
        r[k] = row[k];
}

#endif
