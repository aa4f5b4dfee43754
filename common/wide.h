/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eight doubles that are treated alike: in one vector where the machine has room for it, else in
 * two halves, one after the other, the first four first. What is summed stays apart for each of
 * the eight, and folds to lanes in one order, so that the bits are the same either way. */
#ifndef BRC_WIDE_H
#define BRC_WIDE_H

#include "lanes.h"

#ifdef __AVX512F__
#include <immintrin.h>
#endif

/* numbers that are treated alike; the halves of one width that make them up */
enum { BRC_EIGHT = 8 };

#ifdef __AVX512F__
enum { BRC_WIDE = 8 };
typedef double brc_wide __attribute__((vector_size(64)));
typedef double brc_wide_loose __attribute__((vector_size(64), aligned(8), may_alias));
typedef __mmask8 brc_wide_mask; /* a bit each */
#else
enum { BRC_WIDE = 4 };
typedef brc_lanes brc_wide;
typedef brc_lanes_loose brc_wide_loose;
typedef brc_mask brc_wide_mask;
#endif
enum { BRC_HALVES = BRC_EIGHT / BRC_WIDE };

BRC_LANES_INLINE brc_wide brc_wide_all(double x)
{
#ifdef __AVX512F__
    return (brc_wide){x, x, x, x, x, x, x, x};
#else
    return brc_lanes_all(x);
#endif
}

BRC_LANES_INLINE brc_wide brc_wide_at(const double *x)
{
    return *(const brc_wide_loose *)x;
}

BRC_LANES_INLINE void brc_wide_put(double *x, brc_wide a)
{
    *(brc_wide_loose *)x = a;
}

/* a where the mask is set, b elsewhere */
BRC_LANES_INLINE brc_wide brc_wide_pick(brc_wide_mask m, brc_wide a, brc_wide b)
{
#ifdef __AVX512F__
    return (brc_wide)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a);
#else
    return brc_lanes_pick(m, a, b);
#endif
}

/* a where the mask is set, 0 elsewhere */
BRC_LANES_INLINE brc_wide brc_wide_where(brc_wide_mask m, brc_wide a)
{
#ifdef __AVX512F__
    return (brc_wide)_mm512_maskz_mov_pd(m, (__m512d)a);
#else
    return brc_lanes_where(m, a);
#endif
}

BRC_LANES_INLINE brc_wide_mask brc_wide_less(brc_wide a, brc_wide b)
{
#ifdef __AVX512F__
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
#else
    return brc_lanes_less(a, b);
#endif
}

BRC_LANES_INLINE brc_wide_mask brc_wide_not(brc_wide_mask m)
{
    return (brc_wide_mask)~m;
}

BRC_LANES_INLINE brc_wide_mask brc_wide_both(brc_wide_mask m, brc_wide_mask n)
{
    return (brc_wide_mask)(m & n);
}

BRC_LANES_INLINE bool brc_wide_any(brc_wide_mask m)
{
#ifdef __AVX512F__
    return m != 0;
#else
    return brc_lanes_any(m);
#endif
}

/* Whether number k is set. */
BRC_LANES_INLINE bool brc_wide_is(brc_wide_mask m, int k)
{
#ifdef __AVX512F__
    return m >> k & 1;
#else
    return m[k] != 0;
#endif
}

/* The first n. */
BRC_LANES_INLINE brc_wide_mask brc_wide_first(int64_t n)
{
#ifdef __AVX512F__
    return (brc_wide_mask)(n < BRC_WIDE ? (1 << n) - 1 : 255);
#else
    return brc_lanes_first(n < 0 ? 0 : n);
#endif
}

BRC_LANES_INLINE brc_wide brc_wide_min(brc_wide a, brc_wide b)
{
#ifdef __AVX512F__
    return (brc_wide)_mm512_min_pd((__m512d)a, (__m512d)b);
#else
    return brc_lanes_min(a, b);
#endif
}

BRC_LANES_INLINE brc_wide brc_wide_max(brc_wide a, brc_wide b)
{
#ifdef __AVX512F__
    return (brc_wide)_mm512_max_pd((__m512d)a, (__m512d)b);
#else
    return brc_lanes_max(a, b);
#endif
}

BRC_LANES_INLINE brc_wide brc_wide_sqrt(brc_wide a)
{
#ifdef __AVX512F__
    return (brc_wide)_mm512_sqrt_pd((__m512d)a);
#else
    return brc_lanes_sqrt(a);
#endif
}

/* Numbers k and k + 4 of the eight together, from their halves, which lie `stride` apart. */
BRC_LANES_INLINE brc_lanes brc_wide_fold(const brc_wide *a, int stride)
{
#ifdef __AVX512F__
    (void)stride;
    return __builtin_shufflevector(a[0], a[0], 0, 1, 2, 3) +
           __builtin_shufflevector(a[0], a[0], 4, 5, 6, 7);
#else
    return a[0] + a[stride];
#endif
}

/* Adds to partial sums in lanes, four after four; the same for the least. */
BRC_LANES_INLINE brc_lanes brc_wide_add(brc_lanes sum, brc_wide a)
{
#ifdef __AVX512F__
    return sum + __builtin_shufflevector(a, a, 0, 1, 2, 3) +
           __builtin_shufflevector(a, a, 4, 5, 6, 7);
#else
    return sum + a;
#endif
}

BRC_LANES_INLINE brc_lanes brc_wide_least(brc_lanes least, brc_wide a)
{
#ifdef __AVX512F__
    return brc_lanes_min(brc_lanes_min(least, __builtin_shufflevector(a, a, 0, 1, 2, 3)),
                         __builtin_shufflevector(a, a, 4, 5, 6, 7));
#else
    return brc_lanes_min(least, a);
#endif
}

#endif
