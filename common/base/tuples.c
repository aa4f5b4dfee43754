/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/tuples.h"

#include "common/base/brc.h"

/* Compared, never subtracted: the difference of two numbers may overflow. */
static int compare(const int32_t *p, const int32_t *q, int n)
{
    for (int k = 0; k < n; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

int brc_tuple2_compare(const void *a, const void *b)
{
    return compare(a, b, 2);
}

int brc_tuple3_compare(const void *a, const void *b)
{
    return compare(a, b, 3);
}

int brc_tuple4_compare(const void *a, const void *b)
{
    return compare(a, b, 4);
}
