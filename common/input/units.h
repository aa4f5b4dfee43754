/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units by UDUNITS-2; units.c is the only file with udunits2.h. The unit system is read once, at
 * the first use. Only units that are a plain factor are accepted: no offsets (degC), dates or
 * decibels. */
#ifndef BRC_UNITS_H
#define BRC_UNITS_H

#include "common/base/error.h"

/* How many `to` one `from` is (1e9 for GPa in Pa). Another dimension is an error that names `to`;
 * so is a reciprocal (s for 1/s), and a pure number for an angle. where is the place that starts
 * the message. An unknown `to` is BRC_ERR_INTERNAL: it comes from a declaration, not from a user.
 */
int brc_units_factor(struct brc_context *ctx, const char *from, const char *to, const char *where,
                     double *factor);

#endif
