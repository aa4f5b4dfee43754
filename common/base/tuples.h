/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order of structs that begin with whole numbers, for qsort and bsearch: edges by their ends,
 * facets by their cells. Such a struct names its key by putting it first. */
#ifndef BRC_TUPLES_H
#define BRC_TUPLES_H

/* By the first 2, 3 or 4 members, all int32_t, the first one foremost. Equal ones come in no
 * certain order, so that what follows must not depend on it. */
int brc_tuple2_compare(const void *a, const void *b);
int brc_tuple3_compare(const void *a, const void *b);
int brc_tuple4_compare(const void *a, const void *b);

#endif
